//! The stable counting sort that brings grains into cell order.
//!
//! The result depends on the keys alone: by cell, and inside a cell by previous
//! place. How the work is cut for the threads cannot change it.

use std::ops::Range;

use rayon::prelude::*;

/// The cell number of a grain that leaves the container.
pub const REMOVED: u32 = u32::MAX;

/// Below this many grains, waking threads costs more than they save.
pub const FEWEST_GRAINS: usize = 8192;

/// Cells of a group: a group that no grain goes to costs next to nothing.
const GROUP: usize = 1 << GROUP_BITS;
const GROUP_BITS: u32 = 8;

/// Memory of the sort, kept from step to step.
///
/// First all grains are counted by the cell they go to, part by part, then the counts become places,
/// then each part puts its grains where they belong.
#[derive(Debug, Default)]
pub struct CountingSort {
    /// Contiguous rows; a thread takes one part.
    parts: Vec<Range<usize>>,
    number_of_cells: usize,
    /// `[part][cell]`: first counts, then the place of the next grain; zero in untouched groups.
    cursors: Vec<u32>,
    /// `[part][group]`: whether a grain of the part goes to a cell of the group.
    touched: Vec<bool>,
}

/// Counts the grains of one part by the cell they go to.
#[derive(Debug)]
pub struct Counter<'a> {
    counts: &'a mut [u32],
    touched: &'a mut [bool],
}

impl Counter<'_> {
    /// One more grain goes to `cell`.
    #[inline(always)]
    pub fn add(&mut self, cell: u32) {
        if cell != REMOVED {
            self.counts[cell as usize] += 1;
            self.touched[(cell >> GROUP_BITS) as usize] = true;
        }
    }
}

/// How many parts are worth while: one per thread, but never so many that their counts outweigh the grains.
/// Cells that no grain goes near cost nothing.
pub fn number_of_parts(grains: usize, occupied_cells: usize) -> usize {
    if grains < FEWEST_GRAINS {
        return 1;
    }
    let affordable = (2 * grains / occupied_cells.max(1)).max(1);
    rayon::current_num_threads().min(affordable)
}

impl CountingSort {
    /// Begins a sort of grains that stand in these `parts`, contiguous rows from 0 on; a counter for each.
    pub fn begin(&mut self, parts: Vec<Range<usize>>, number_of_cells: usize) -> Vec<Counter<'_>> {
        let groups = number_of_cells.div_ceil(GROUP);
        if (self.parts.len(), self.number_of_cells) == (parts.len(), number_of_cells) {
            self.clear();
        } else {
            self.cursors = vec![0; parts.len() * number_of_cells];
            self.touched = vec![false; parts.len() * groups];
            self.number_of_cells = number_of_cells;
        }
        self.parts = parts;
        let counts = self.cursors.chunks_mut(number_of_cells).zip(self.touched.chunks_mut(groups));
        counts.map(|(counts, touched)| Counter { counts, touched }).collect()
    }

    fn clear(&mut self) {
        let groups = self.number_of_cells.div_ceil(GROUP);
        for (cursors, touched) in
            self.cursors.chunks_mut(self.number_of_cells).zip(self.touched.chunks_mut(groups))
        {
            for (cursors, touched) in cursors.chunks_mut(GROUP).zip(touched) {
                if std::mem::take(touched) {
                    cursors.fill(0);
                }
            }
        }
    }

    /// Counts grains that go to `cells` `[grain]`.
    pub fn count(&mut self, cells: &[u32], number_of_cells: usize) {
        let length = cells.len().div_ceil(number_of_parts(cells.len(), number_of_cells)).max(1);
        let parts: Vec<_> = (0..cells.len().max(1))
            .step_by(length)
            .map(|first| first..(first + length).min(cells.len()))
            .collect();
        let counters = self.begin(parts.clone(), number_of_cells);
        counters.into_par_iter().zip(parts).for_each(|(mut counter, rows)| {
            cells[rows].iter().for_each(|&cell| counter.add(cell));
        });
    }

    /// Grains that go to `cell`.
    #[inline]
    pub fn total(&self, cell: u32) -> u32 {
        // A loop of its own: the steps of an iterator begin with a division.
        let (mut total, mut place) = (0, cell as usize);
        while place < self.cursors.len() {
            total += self.cursors[place];
            place += self.number_of_cells;
        }
        total
    }

    /// Cells that more than `capacity` grains go to, in rising order.
    pub fn cells_above(&self, capacity: u32) -> Vec<u32> {
        let groups = self.number_of_cells.div_ceil(GROUP);
        let mut above = Vec::new();
        for group in (0..groups).filter(|&group| self.is_touched(group)) {
            let mut totals = [0; GROUP];
            for counts in self.cursors.chunks(self.number_of_cells) {
                let counts = &counts[group * GROUP..((group + 1) * GROUP).min(self.number_of_cells)];
                totals.iter_mut().zip(counts).for_each(|(total, count)| *total += count);
            }
            if totals.iter().any(|&total| total > capacity) {
                let cells = (group * GROUP) as u32..;
                above.extend(cells.zip(totals).filter(|&(_, total)| total > capacity).map(|(cell, _)| cell));
            }
        }
        above
    }

    /// Whether some grain goes to a cell of the group.
    fn is_touched(&self, group: usize) -> bool {
        let groups = self.number_of_cells.div_ceil(GROUP);
        self.touched[group..].iter().step_by(groups).any(|&touched| touched)
    }

    /// Counts a grain of `row` over from one cell to another.
    pub fn recount(&mut self, row: usize, from: u32, to: u32) {
        let part = self.parts.partition_point(|rows| rows.end <= row);
        let groups = self.number_of_cells.div_ceil(GROUP);
        if from != REMOVED {
            self.cursors[part * self.number_of_cells + from as usize] -= 1;
        }
        let counts = &mut self.cursors[part * self.number_of_cells..][..self.number_of_cells];
        Counter { counts, touched: &mut self.touched[part * groups..][..groups] }.add(to);
    }

    /// Turns counts into places, by cell and inside a cell by part, and writes the start of each cell to `offsets`
    /// `[cell + 1]`. Returns how many grains stay in the container.
    pub fn accumulate(&mut self, offsets: &mut [u32]) -> usize {
        let cells = self.number_of_cells;
        let groups = cells.div_ceil(GROUP);
        let mut place = 0;
        for group in 0..groups {
            let span = group * GROUP..((group + 1) * GROUP).min(cells);
            if !self.is_touched(group) {
                offsets[span].fill(place);
                continue;
            }
            // The cursors of all parts are about to be written.
            self.touched[group..].iter_mut().step_by(groups).for_each(|touched| *touched = true);
            if self.parts.len() == 1 {
                for (offset, cursor) in offsets[span.clone()].iter_mut().zip(&mut self.cursors[span]) {
                    *offset = place;
                    place += std::mem::replace(cursor, place);
                }
                continue;
            }
            for cell in span {
                offsets[cell] = place;
                for cursor in self.cursors[cell..].iter_mut().step_by(cells) {
                    place += std::mem::replace(cursor, place);
                }
            }
        }
        offsets[cells] = place;
        place as usize
    }

    /// Tells `put` the row and the place of every grain that stays. No two grains have the same place.
    pub(super) fn place(&mut self, cells: &[u32], put: impl Fn(usize, usize) + Copy + Sync) {
        let work = |(cursors, rows): (&mut [u32], Range<usize>)| {
            // A copy whose address nobody knows: its parts can stay in registers.
            #[expect(clippy::redundant_locals, reason = "it is the copy that matters")]
            let put = put;
            for row in rows {
                let cell = cells[row];
                if cell != REMOVED {
                    let cursor = &mut cursors[cell as usize];
                    let place = *cursor as usize;
                    *cursor += 1;
                    put(row, place);
                }
            }
        };
        let parts = self.cursors.chunks_mut(self.number_of_cells).zip(self.parts.iter().cloned());
        if self.parts.len() == 1 {
            parts.for_each(work);
        } else {
            parts.par_bridge().for_each(work);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::sync::Mutex;

    /// The order `[place]` and the offsets. A sort of something else comes first: none of it may be left.
    fn sorted(cells: &[u32], number_of_cells: usize, threads: usize) -> (Vec<u32>, Vec<u32>) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut sort = CountingSort::default();
            let mut offsets = vec![0; number_of_cells + 1];
            let others: Vec<u32> = (0..cells.len() as u32).map(|row| row * 7 % 60).collect();
            sort.count(&others, number_of_cells);
            sort.accumulate(&mut offsets);
            sort.count(cells, number_of_cells);
            let kept = sort.accumulate(&mut offsets);
            let order = Mutex::new(vec![u32::MAX; kept]);
            sort.place(cells, |row, place| order.lock().unwrap()[place] = row as u32);
            (order.into_inner().unwrap(), offsets)
        })
    }

    proptest! {
        #[test]
        fn it_is_the_stable_sort_for_any_number_of_threads(
            cells in proptest::collection::vec((0_u32..701).prop_map(|c| if c == 700 { REMOVED } else { c }), 0..20_000),
            threads in 1_usize..6,
        ) {
            let mut expected: Vec<u32> = (0..cells.len() as u32).filter(|&i| cells[i as usize] != REMOVED).collect();
            expected.sort_by_key(|&i| cells[i as usize]);
            let (order, offsets) = sorted(&cells, 700, threads);
            prop_assert_eq!(&order, &expected);
            for cell in 0..700_usize {
                for place in offsets[cell]..offsets[cell + 1] {
                    prop_assert_eq!(cells[order[place as usize] as usize], cell as u32);
                }
            }
            prop_assert_eq!(offsets[700] as usize, expected.len());
        }
    }
}
