//! The stable counting sort that brings grains into cell order.
//!
//! The result depends on the keys alone: by cell, and inside a cell by previous
//! place. How the work is cut for the threads cannot change it.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

/// The cell number of a grain that leaves the container.
pub const REMOVED: u32 = u32::MAX;

/// Memory of the sort, kept from step to step.
#[derive(Debug, Default)]
pub struct CountingSort {
    /// `[part][cell]`: first counts, then the place of the next grain.
    cursors: Vec<u32>,
    /// `[place]`: which grain belongs there.
    order: Vec<AtomicU32>,
}

impl CountingSort {
    /// Finds the stable order of `cells` `[grain]` and writes the start of each cell
    /// to `offsets` `[cell + 1]`. Returns the order `[place]`, without removed grains.
    pub fn order(&mut self, cells: &[u32], offsets: &mut [u32]) -> &[AtomicU32] {
        let number_of_cells = offsets.len() - 1;
        let part_length = part_length(cells.len(), number_of_cells);
        let parts = cells.len().div_ceil(part_length).max(1);
        self.cursors.clear();
        self.cursors.resize(parts * number_of_cells, 0);
        if self.order.len() < cells.len() {
            self.order.resize_with(cells.len(), AtomicU32::default);
        }
        self.count(cells, part_length, number_of_cells);
        let kept = self.accumulate(offsets, number_of_cells);
        self.place(cells, part_length, number_of_cells);
        &self.order[..kept]
    }

    fn count(&mut self, cells: &[u32], part_length: usize, number_of_cells: usize) {
        self.cursors.par_chunks_mut(number_of_cells).zip(cells.par_chunks(part_length)).for_each(
            |(counts, cells)| {
                for &cell in cells.iter().filter(|&&cell| cell != REMOVED) {
                    counts[cell as usize] += 1;
                }
            },
        );
    }

    /// Turns counts into starting places: by cell, and inside a cell by part.
    fn accumulate(&mut self, offsets: &mut [u32], number_of_cells: usize) -> usize {
        let mut place = 0;
        for (cell, offset) in offsets[..number_of_cells].iter_mut().enumerate() {
            *offset = place;
            for cursor in self.cursors[cell..].iter_mut().step_by(number_of_cells) {
                place += std::mem::replace(cursor, place);
            }
        }
        offsets[number_of_cells] = place;
        place as usize
    }

    fn place(&mut self, cells: &[u32], part_length: usize, number_of_cells: usize) {
        let order = &self.order;
        self.cursors.par_chunks_mut(number_of_cells).zip(cells.par_chunks(part_length)).enumerate().for_each(
            |(part, (cursors, cells))| {
                let first = part * part_length;
                for (k, &cell) in cells.iter().enumerate().filter(|(_, cell)| **cell != REMOVED) {
                    let cursor = &mut cursors[cell as usize];
                    order[*cursor as usize].store((first + k) as u32, Relaxed);
                    *cursor += 1;
                }
            },
        );
    }
}

/// One part per thread, but never so many that their counts outweigh the grains.
fn part_length(grains: usize, number_of_cells: usize) -> usize {
    let affordable = (2 * grains / number_of_cells.max(1)).max(1);
    let parts = rayon::current_num_threads().min(affordable).min(grains / 1024 + 1);
    grains.div_ceil(parts).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sorted(cells: &[u32], number_of_cells: usize, threads: usize) -> (Vec<u32>, Vec<u32>) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut sort = CountingSort::default();
            let mut offsets = vec![0; number_of_cells + 1];
            let order = sort.order(cells, &mut offsets).iter().map(|o| o.load(Relaxed)).collect();
            (order, offsets)
        })
    }

    proptest! {
        #[test]
        fn it_is_the_stable_sort_for_any_number_of_threads(
            cells in proptest::collection::vec((0_u32..41).prop_map(|c| if c == 40 { REMOVED } else { c }), 0..5000),
            threads in 1_usize..6,
        ) {
            let mut expected: Vec<u32> = (0..cells.len() as u32).filter(|&i| cells[i as usize] != REMOVED).collect();
            expected.sort_by_key(|&i| cells[i as usize]);
            let (order, offsets) = sorted(&cells, 40, threads);
            prop_assert_eq!(&order, &expected);
            for cell in 0..40_usize {
                for place in offsets[cell]..offsets[cell + 1] {
                    prop_assert_eq!(cells[order[place as usize] as usize], cell as u32);
                }
            }
            prop_assert_eq!(offsets[40] as usize, expected.len());
        }
    }
}
