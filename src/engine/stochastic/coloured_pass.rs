//! Pair collisions of HSMC, with displacements that respect the room in the cells around.
//!
//! Whether a displacement is possible depends on counts that change with every displacement. To
//! make the result independent of threads, cells are grouped into blocks of two or three
//! along each axis, blocks into 2ᴰ colours. Colours come one after another; blocks of one colour
//! touch disjoint cells, because no grain gets further than the cells beside its block.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::blocks::{Block, cut};
use super::cell_pairs::{Displaced, PairCollisions};
use super::laws::Room;
use super::parallel;
use super::rules::DisplacementRule;
use super::tally::Tally;
use crate::law::restitution::Restitution;
use crate::matter::columns::Columns;
use crate::matter::grid::Grid;
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The parts of the pass.
pub(crate) struct ColouredPass<'a, V: Vector, R: Restitution> {
    pub(crate) grid: &'a Grid<V>,
    pub(crate) offsets: &'a [u32],
    pub(crate) collisions: PairCollisions<'a, V, R>,
    pub(crate) room: Room<V>,
    pub(crate) capacity: u32,
    pub(crate) rule: DisplacementRule,
    /// `[cell]`: grains now.
    pub(crate) occupancy: &'a [AtomicU32],
}

impl<V: Vector, R: Restitution> ColouredPass<'_, V, R> {
    /// Collides all pairs; `cells` `[row]` receives the cell each grain is in afterwards.
    pub(crate) fn run(&self, columns: &mut Columns<V>, cells: &mut [u32], order: PhaseStreams) -> Tally<V> {
        let axes: Vec<Vec<Range<u32>>> = (0..3).map(|axis| spans(self.grid, axis)).collect();
        let slabs = &axes[V::DIMENSION - 1];
        let stride = self.grid.stride(V::DIMENSION - 1);
        let cells_of_slabs = slabs.iter().map(|slab| slab.start * stride..slab.end * stride);
        let grains = columns.len();
        let mut blocks = cut(cells_of_slabs, self.offsets, columns, cells);
        let mut total = Tally::default();
        for colour in colours_in_order(V::DIMENSION, order) {
            let slab_parity = (colour >> (V::DIMENSION - 1)) as usize & 1;
            let slabs = blocks.iter_mut().enumerate();
            let slabs = slabs.filter(|(slab, block)| slab % 2 == slab_parity && !block.ids.is_empty());
            let tallies =
                parallel::map(grains, slabs.collect(), |(slab, block)| self.slab(&axes, slab, colour, block));
            total.add(&Tally::total(tallies));
        }
        total
    }

    /// All blocks of one colour in a slab: their cells in the order of their numbers.
    fn slab(&self, axes: &[Vec<Range<u32>>], slab: usize, colour: u32, block: &mut Block<'_, V>) -> Tally<V> {
        let mut tally = Tally::default();
        let ranges = |axis: usize| {
            let wanted = if axis == V::DIMENSION - 1 { slab } else { usize::MAX };
            let parity = (colour >> axis) as usize & 1;
            axes[axis]
                .iter()
                .enumerate()
                .filter(move |&(k, _)| if wanted == usize::MAX { k % 2 == parity } else { k == wanted })
                .map(|(_, range)| range.clone())
        };
        for outer in ranges(2) {
            for middle in ranges(1) {
                let occupied = self.occupied(&middle, &outer);
                for inner in
                    ranges(0).filter(|inner| inner.start < occupied.end && inner.end > occupied.start)
                {
                    self.cells([inner, middle.clone(), outer.clone()], block, &mut tally);
                }
            }
        }
        tally
    }

    /// The stretch along the first axis that holds all grains of the given rows of cells.
    fn occupied(&self, middle: &Range<u32>, outer: &Range<u32>) -> Range<u32> {
        let length = self.grid.cells()[0];
        let mut stretch = length..0;
        for k in outer.clone() {
            for j in middle.clone() {
                let row = self.grid.cell_at([0, j, k]) as usize;
                let offsets = &self.offsets[row..=row + length as usize];
                let (begin, end) = (offsets[0], offsets[length as usize]);
                if begin < end {
                    let first = offsets.partition_point(|&offset| offset <= begin) as u32 - 1;
                    let last = offsets.partition_point(|&offset| offset < end) as u32;
                    stretch = stretch.start.min(first)..stretch.end.max(last);
                }
            }
        }
        stretch
    }

    fn cells(&self, [inner, middle, outer]: [Range<u32>; 3], block: &mut Block<'_, V>, tally: &mut Tally<V>) {
        for k in outer {
            for j in middle.clone() {
                for i in inner.clone() {
                    self.cell([i, j, k], block, tally);
                }
            }
        }
    }

    #[inline]
    fn cell(&self, home: [u32; 3], block: &mut Block<'_, V>, tally: &mut Tally<V>) {
        let cell = self.grid.cell_at(home);
        let rows = block.rows_of(cell, self.offsets);
        block.targets[rows.clone()].fill(cell);
        if rows.len() < 2 {
            return;
        }
        let _ = tally; todo!()
    }

    /// Displaces both partners or none.
    fn displace(
        &self,
        home: [u32; 3],
        displaced: Displaced<V>,
        positions: &mut [V],
        cells: &mut [u32],
    ) -> bool {
        let (i, j) = displaced.pair;
        let first = self.place(home, positions[i] + displaced.shift);
        let second = self.place(home, positions[j] - displaced.shift);
        let (Some((first, cell_i)), Some((second, cell_j))) = (first, second) else { return false };
        if self.rule == DisplacementRule::Paired {
            let (enters_i, enters_j) = (cell_i != cells[i], cell_j != cells[j]);
            let together = u32::from(enters_i && enters_j && cell_i == cell_j);
            if (enters_i && !self.has_room(cell_i, 1 + together)) || (enters_j && !self.has_room(cell_j, 1)) {
                return false;
            }
        }
        (positions[i], positions[j]) = (first, second);
        self.enter(&mut cells[i], cell_i);
        self.enter(&mut cells[j], cell_j);
        true
    }

    /// A displaced position and its cell; `None` behind a wall or beyond the cells beside `home`.
    #[inline]
    fn place(&self, home: [u32; 3], mut position: V) -> Option<(V, u32)> {
        if !self.room.holds(position) {
            return None;
        }
        let mut there = [0; 3];
        for axis in 0..V::DIMENSION {
            self.grid.wrap(&mut position, axis);
            there[axis] = self.grid.coordinate_of(position, axis);
            let distance = there[axis].abs_diff(home[axis]);
            if distance > 1 && !(self.grid.is_periodic(axis) && distance == self.grid.cells()[axis] - 1) {
                return None;
            }
        }
        Some((position, self.grid.cell_at(there)))
    }

    fn has_room(&self, cell: u32, newcomers: u32) -> bool {
        self.occupancy[cell as usize].load(Relaxed) + newcomers <= self.capacity
    }

    /// Counts a grain over from its cell to `target`. Nobody else touches these counts now.
    #[inline]
    fn enter(&self, cell: &mut u32, target: u32) {
        if *cell != target {
            let (from, to) = (&self.occupancy[*cell as usize], &self.occupancy[target as usize]);
            from.store(from.load(Relaxed) - 1, Relaxed);
            to.store(to.load(Relaxed) + 1, Relaxed);
            *cell = target;
        }
    }
}

/// Cuts an axis into spans of two or three cells; an even number of them where it is periodic, whose
/// number of cells is then even and at least 4.
fn spans<V: Vector>(grid: &Grid<V>, axis: usize) -> Vec<Range<u32>> {
    let cells = grid.cells()[axis];
    let pairs = (cells / 2).max(1);
    let number = if grid.is_periodic(axis) && pairs > 1 { pairs & !1 } else { pairs };
    let threes = cells.saturating_sub(2 * number);
    let mut spans = Vec::with_capacity(number as usize);
    let mut first = 0;
    for k in 0..number {
        let last = (first + 2 + u32::from(k < threes)).min(cells);
        spans.push(first..last);
        first = last;
    }
    spans
}

/// The colours in an order that the step draws.
fn colours_in_order(dimension: usize, order: PhaseStreams) -> Vec<u32> {
    let mut colours: Vec<u32> = (0..1 << dimension).collect();
    colours.sort_by_key(|&colour| order.hash(u64::from(colour)));
    colours
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn spans_cover_every_axis_in_twos_and_threes() {
        for cells in 1_u32..40 {
            for periodic in [false, true] {
                if periodic && (cells < 4 || !cells.is_multiple_of(2)) {
                    continue;
                }
                let grid = Grid::new(DVec2::ZERO, DVec2::ONE, &[cells, 1], &[periodic, false]);
                let spans = spans(&grid, 0);
                assert_eq!(spans.first().map(|s| s.start), Some(0));
                assert_eq!(spans.last().map(|s| s.end), Some(cells));
                assert!(spans.windows(2).all(|w| w[0].end == w[1].start));
                assert!(cells < 4 || spans.iter().all(|s| (2..=3).contains(&s.len())));
                assert!(!periodic || spans.len().is_multiple_of(2));
            }
        }
    }
}
