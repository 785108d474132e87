//! Displacements of HSMC whose cells compete for room.
//!
//! Whether such a displacement is possible depends on counts that change with every displacement. To
//! make the result independent of threads, cells are grouped into blocks of two or three
//! along each axis, blocks into 2ᴰ colours. Colours come one after another; blocks of one colour
//! touch disjoint cells, because no grain gets further than the cells beside its block.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::blocks::{Block, cut};
use super::cell_pairs::Displaced;
use super::parallel;
use super::rules::DisplacementRule;
use super::wishes::{Places, Wish};
use crate::matter::columns::Columns;
use crate::matter::grid::Grid;
use crate::random::PhaseStreams;
use crate::space::Vector;

/// A cell that waits for its turn, and what its collisions wish.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contested<'a, V> {
    pub(crate) cell: u32,
    /// The row from which the rows of the wishes count.
    pub(crate) first_row: usize,
    pub(crate) wishes: &'a [Wish<V>],
}

/// The parts of the pass.
pub(crate) struct ColouredPass<'a, V: Vector> {
    pub(crate) places: Places<'a, V>,
    /// `[cell]`: grains now.
    pub(crate) occupancy: &'a [AtomicU32],
}

impl<V: Vector> ColouredPass<'_, V> {
    /// Grants what can be granted of the wishes of `cells`, which are in rising order. `scratch` `[row]` is overwritten.
    /// Returns the momentum that the displacements carry, times the way.
    pub(crate) fn run(
        &self,
        cells: &[Contested<'_, V>],
        columns: &mut Columns<V>,
        scratch: &mut [u32],
        order: PhaseStreams,
    ) -> f64 {
        let last = V::DIMENSION - 1;
        let colours: Vec<Vec<u32>> = (0..3).map(|axis| parities(self.places.grid, axis)).collect();
        let stride = self.places.grid.stride(last);
        let slabs = spans(self.places.grid, last);
        let cells_of_slabs = slabs.iter().map(|slab| slab.start * stride..slab.end * stride);
        let grains = columns.len();
        let mut slabs = cut(cells_of_slabs, self.places.offsets, columns, scratch);
        let mut rest = cells;
        let mut work: Vec<_> = slabs
            .iter_mut()
            .map(|slab| {
                let cells;
                (cells, rest) =
                    rest.split_at(rest.partition_point(|contested| contested.cell < slab.cells.end));
                (slab, cells)
            })
            .collect();
        let mut carried = 0.0;
        for colour in colours_in_order(V::DIMENSION, order) {
            let parity = (colour >> last) as usize & 1;
            let turns = work
                .iter_mut()
                .enumerate()
                .filter(|(slab, (_, cells))| slab % 2 == parity && !cells.is_empty());
            let sums = parallel::map(grains, turns.collect(), |(_, (slab, cells))| {
                self.slab(colour, &colours, slab, cells)
            });
            carried += sums.into_iter().sum::<f64>();
        }
        carried
    }

    /// The cells of one colour in a slab, in the order of their numbers.
    fn slab(
        &self,
        colour: u32,
        parities: &[Vec<u32>],
        slab: &mut Block<'_, V>,
        cells: &[Contested<'_, V>],
    ) -> f64 {
        let mut carried = 0.0;
        for contested in cells {
            let home = self.places.grid.coordinates(contested.cell);
            let own = (0..V::DIMENSION).map(|axis| parities[axis][home[axis] as usize] << axis).sum::<u32>();
            if own == colour {
                carried += self.cell(home, contested, slab);
            }
        }
        carried
    }

    fn cell(&self, home: [u32; 3], contested: &Contested<'_, V>, slab: &mut Block<'_, V>) -> f64 {
        let cell = contested.cell;
        let rows = slab.rows_of(cell, self.places.offsets);
        let start = slab.first_row + rows.start - contested.first_row;
        let positions = &mut slab.positions[rows.clone()];
        let cells = &mut slab.targets[rows];
        cells.fill(cell);
        let mut carried = 0.0;
        for Wish { asked, .. } in contested.wishes {
            let &Displaced { pair: (i, j), shift, carried: momentum, .. } = asked;
            let full = self.occupancy[cell as usize].load(Relaxed) >= self.places.capacity;
            if !full && self.displace(home, (i - start, j - start), shift, positions, cells) {
                carried += momentum;
            }
        }
        carried
    }

    /// Displaces both partners or none.
    fn displace(
        &self,
        home: [u32; 3],
        (i, j): (usize, usize),
        shift: V,
        positions: &mut [V],
        cells: &mut [u32],
    ) -> bool {
        let first = self.places.place(home, positions[i] + shift);
        let second = self.places.place(home, positions[j] - shift);
        let (Some((first, cell_i)), Some((second, cell_j))) = (first, second) else { return false };
        if self.places.rule == DisplacementRule::Paired {
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

    fn has_room(&self, cell: u32, newcomers: u32) -> bool {
        self.occupancy[cell as usize].load(Relaxed) + newcomers <= self.places.capacity
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

/// `[coordinate]`: whether the span of a coordinate is an even or an odd one.
fn parities<V: Vector>(grid: &Grid<V>, axis: usize) -> Vec<u32> {
    let spans = spans(grid, axis).into_iter().enumerate();
    spans.flat_map(|(k, span)| span.map(move |_| k as u32 & 1)).collect()
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

/// `cells`, which are in rising order, as they come to their turn where one thread serves them.
#[cfg(test)]
pub(crate) fn in_turn<V: Vector>(grid: &Grid<V>, cells: &[u32], order: PhaseStreams) -> Vec<u32> {
    let parities: Vec<Vec<u32>> = (0..V::DIMENSION).map(|axis| parities(grid, axis)).collect();
    let colour = |cell: u32| -> u32 {
        let at = grid.coordinates(cell);
        (0..V::DIMENSION).map(|axis| parities[axis][at[axis] as usize] << axis).sum()
    };
    let of_colour = |turn: u32| cells.iter().copied().filter(move |&cell| colour(cell) == turn);
    colours_in_order(V::DIMENSION, order).into_iter().flat_map(of_colour).collect()
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
