//! Contiguous spans of cells, each with its own rows of the columns, for threads to share.

use std::ops::Range;

use super::onlooker::Counter;
use crate::engine::cell_counts::CellCount;
use crate::matter::columns::Columns;
use crate::matter::sort::number_of_parts;
use crate::space::Vector;

/// Cells of a block. It is fixed: sums are added block by block, so it is part of the bits. What a block holds
/// fits into the nearer caches.
const CELLS_PER_BLOCK: usize = 256;

/// Blocks that one thread takes one after another.
pub(crate) struct Part<'a, V: Vector> {
    pub(crate) blocks: Vec<Block<'a, V>>,
}

/// A span of cells and the rows that belong to it.
#[derive(Debug)]
pub(crate) struct Block<'a, V: Vector> {
    /// The cells.
    pub(crate) cells: Range<u32>,
    /// The first row.
    pub(crate) first_row: usize,
    /// Positions of the rows [length].
    pub(crate) positions: &'a mut [V],
    /// Velocities of the rows [length/time].
    pub(crate) velocities: &'a mut [V],
    /// Identities of the rows.
    pub(crate) ids: &'a [u32],
    /// The cell each row goes to.
    pub(crate) targets: &'a mut [u32],
    /// `[cell]`: what happens there; empty where nothing is counted.
    counts: &'a mut [CellCount],
}

/// Cuts all cells into blocks of a fixed number of cells, and those into parts with about the same number of
/// grains; blocks without grains are left out.
pub(crate) fn parts<'a, V: Vector>(
    offsets: &[u32],
    columns: &'a mut Columns<V>,
    targets: &'a mut [u32],
) -> Vec<Part<'a, V>> {
    let (cells, grains) = (offsets.len() - 1, columns.len());
    let starts = (0..cells).step_by(CELLS_PER_BLOCK);
    let spans = starts.map(|first| first as u32..(first + CELLS_PER_BLOCK).min(cells) as u32);
    let mut blocks = cut(spans, offsets, columns, targets);
    blocks.retain(|block| !block.ids.is_empty());
    let parts = number_of_parts(grains, blocks.len() * CELLS_PER_BLOCK);
    let mut blocks = blocks.into_iter().peekable();
    (1..=parts)
        .map(|part| {
            let end = grains * part / parts;
            let blocks =
                std::iter::from_fn(|| blocks.next_if(|block| block.rows().end <= end || part == parts));
            Part { blocks: blocks.collect() }
        })
        .collect()
}

/// Gives each block the counts of its cells out of those of all, `[cell]`; none where there are none. Bounds are forgotten.
pub(crate) fn with_counts<'a, V: Vector>(
    mut parts: Vec<Part<'a, V>>,
    counts: &'a mut [CellCount],
) -> Vec<Part<'a, V>> {
    counts.iter_mut().for_each(|count| count.bound = 0.0);
    let (mut rest, mut next) = (counts, 0);
    if rest.is_empty() {
        return parts;
    }
    for block in parts.iter_mut().flat_map(|part| &mut part.blocks) {
        // Blocks without grains were left out.
        let behind = std::mem::take(&mut rest).split_at_mut((block.cells.start - next) as usize).1;
        (block.counts, rest) = behind.split_at_mut(block.cells.len());
        next = block.cells.end;
    }
    parts
}

/// The rows of each part, contiguous from 0 on.
pub(crate) fn rows_of<V: Vector>(parts: &[Part<'_, V>]) -> Vec<Range<usize>> {
    let mut first = 0;
    let rows = parts.iter().map(|part| {
        let end = part.blocks.last().map_or(first, |block| block.rows().end);
        std::mem::replace(&mut first, end)..end
    });
    rows.collect()
}

/// Cuts the columns at the given contiguous spans of cells, the first of which starts at cell 0.
pub(crate) fn cut<'a, V: Vector>(
    spans: impl Iterator<Item = Range<u32>>,
    offsets: &[u32],
    columns: &'a mut Columns<V>,
    targets: &'a mut [u32],
) -> Vec<Block<'a, V>> {
    let Columns { positions, velocities, ids, .. } = columns;
    let (mut positions, mut velocities) = (positions.as_mut_slice(), velocities.as_mut_slice());
    let (mut ids, mut targets) = (ids.as_slice(), targets);
    spans
        .map(|cells| {
            let first_row = offsets[cells.start as usize] as usize;
            let rows = offsets[cells.end as usize] as usize - first_row;
            Block {
                cells,
                first_row,
                positions: positions.split_off_mut(..rows).expect("offsets count the rows"),
                velocities: velocities.split_off_mut(..rows).expect("offsets count the rows"),
                ids: ids.split_off(..rows).expect("offsets count the rows"),
                targets: targets.split_off_mut(..rows).expect("offsets count the rows"),
                counts: &mut [],
            }
        })
        .collect()
}

impl<'a, V: Vector> Block<'a, V> {
    /// The place of the block that holds `cell` among all blocks of a fixed number of cells.
    pub(crate) fn number_of(cell: u32) -> usize {
        cell as usize / CELLS_PER_BLOCK
    }

    /// The first cell of a block.
    pub(crate) fn first_cell(number: usize) -> u32 {
        (number * CELLS_PER_BLOCK) as u32
    }

    /// Who counts what happens in its cells, where somebody does.
    pub(crate) fn take_counter(&mut self) -> Option<Counter<'a>> {
        let counts = std::mem::take(&mut self.counts);
        (!counts.is_empty()).then_some(Counter { first: self.cells.start, counts })
    }

    /// All its rows.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.first_row..self.first_row + self.ids.len()
    }

    /// The rows of `cell`, counted from the start of the block.
    #[inline(always)]
    pub(crate) fn rows_of(&self, cell: u32, offsets: &[u32]) -> Range<usize> {
        let cell = cell as usize;
        offsets[cell] as usize - self.first_row..offsets[cell + 1] as usize - self.first_row
    }
}
