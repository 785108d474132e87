//! More arrivals than there is room for: who of them loses.
//!
//! Arrivals at a cell are ranked. The accepted ones are always a prefix of that ranking and only ever become
//! fewer, so every order of work ends at the same set: threads may take a region of cells each.

use std::ops::Range;

use rayon::prelude::*;

use super::number_set::{NumberSet, WORD};
use crate::matter::grid::Grid;
use crate::matter::sort::{CountingSort, FEWEST_GRAINS, REMOVED};
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves that grains want to make.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    /// Where the rows of each cell begin, `[cell + 1]`; grains may have been displaced into other cells since.
    pub(crate) offsets: &'a [u32],
    /// `[row]`: positions before the move [length].
    pub(crate) positions: &'a [V],
    /// `[row]`: the cell each grain goes to.
    pub(crate) targets: &'a [u32],
    /// `[row]`.
    pub(crate) ids: &'a [u32],
    /// Grains that make a cell full.
    pub(crate) capacity: u32,
    /// The lower hash of an identity has precedence.
    pub(crate) ranks: PhaseStreams,
}

/// A cell that could get above capacity.
#[derive(Clone, Copy, Debug, Default)]
struct Contest {
    /// Grains that it would hold now.
    total: u32,
    /// Where its arrivals begin.
    first: u32,
    /// How many of them are still accepted.
    accepted: u32,
    /// Whether they stand in the order of their ranks.
    is_ranked: bool,
}

/// A grain that wants to enter a contested cell.
#[derive(Clone, Copy, Debug, Default)]
struct Arrival {
    row: u32,
    /// The contest of the cell it comes from, or [`CALM`].
    from: u32,
}

/// A cell that cannot get above capacity, whatever happens.
const CALM: u32 = u32::MAX;

/// Some contested cells, which one thread looks after.
struct Region<'a> {
    first: u32,
    contests: &'a mut [Contest],
    arrivals: &'a mut [Arrival],
    first_arrival: u32,
    /// Cells above capacity.
    queue: Vec<u32>,
    /// Rows of those who have lost.
    losers: Vec<u32>,
}

impl<V: Vector> Wanted<'_, V> {
    /// Rows of the least set of moves without which no cell gets above its capacity; `above` are the cells that
    /// would be, were all accepted.
    pub(crate) fn losers(&self, counts: &CountingSort, above: &[u32]) -> NumberSet {
        let spans = self.spans();
        let cells = self.contested(counts, above, &spans);
        let (mut contests, mut arrivals) = self.contests(counts, &cells, &spans);
        let mut regions = regions(&mut contests, &mut arrivals, self.capacity);
        let mut news: Vec<Vec<u32>> = regions.iter().map(|_| Vec::new()).collect();
        loop {
            let work = |(region, news): (&mut Region<'_>, &Vec<u32>)| region.settle(self, news);
            let outside: Vec<Vec<u32>> = if regions.len() > 1 {
                regions.par_iter_mut().zip(&news).map(work).collect()
            } else {
                regions.iter_mut().zip(&news).map(work).collect()
            };
            news.iter_mut().for_each(Vec::clear);
            for contest in outside.into_iter().flatten() {
                let place = regions.partition_point(|region| region.first <= contest) - 1;
                news[place].push(contest);
            }
            if news.iter().all(Vec::is_empty) {
                break;
            }
        }
        let mut rows = NumberSet::of(vec![0; self.targets.len().div_ceil(WORD as usize)]);
        regions.iter().flat_map(|region| &region.losers).for_each(|&row| rows.insert(row));
        rows
    }

    /// All cells, cut into spans of whole words and of about the same number of grains.
    fn spans(&self) -> Vec<Range<u32>> {
        let cells = self.offsets.len() - 1;
        let grains = self.targets.len();
        let parts = if grains < FEWEST_GRAINS { 1 } else { rayon::current_num_threads() };
        let end = |part: usize| {
            let cell = self.offsets.partition_point(|&offset| (offset as usize) < grains * part / parts);
            if part == parts { cells as u32 } else { cell as u32 / WORD * WORD }
        };
        (0..parts).map(|part| if part == 0 { 0 } else { end(part) }..end(part + 1)).collect()
    }

    /// Cells that would be above capacity if none of their own grains left, whatever becomes of the others.
    fn contested(&self, counts: &CountingSort, above: &[u32], spans: &[Range<u32>]) -> NumberSet {
        let find = |span: &Range<u32>| {
            // Cells that displaced grains would leave.
            let mut others = Vec::new();
            let words = span.clone().step_by(WORD as usize).map(|first| {
                let cells = first..(first + WORD).min(span.end);
                let mut word = 0_u64;
                if self.offsets[cells.start as usize] == self.offsets[cells.end as usize] {
                    return word;
                }
                for cell in cells {
                    let leaving = self.leaving(cell, &mut others);
                    let is_contested = leaving > 0 && counts.total(cell) + leaving > self.capacity;
                    word |= u64::from(is_contested) << (cell % WORD);
                }
                word
            });
            (words.collect::<Vec<u64>>(), others)
        };
        let (words, others): (Vec<_>, Vec<_>) = self.each(spans, find).into_iter().unzip();
        let mut cells = NumberSet::of(words.concat());
        above.iter().chain(others.iter().flatten()).for_each(|&cell| cells.insert(cell));
        cells.number();
        cells
    }

    /// How many grains of `cell` want to leave it; where one has been displaced to `others` and wants to leave from there,
    /// that cell is noted.
    fn leaving(&self, cell: u32, others: &mut Vec<u32>) -> u32 {
        let mut leaving = 0;
        for row in self.rows(cell) {
            let source = self.source(row);
            if self.targets[row] == source {
                continue;
            }
            if source == cell {
                leaving += 1;
            } else {
                others.push(source);
            }
        }
        leaving
    }

    /// The contests at `cells`, and all arrivals there.
    fn contests(
        &self,
        counts: &CountingSort,
        cells: &NumberSet,
        spans: &[Range<u32>],
    ) -> (Vec<Contest>, Vec<Arrival>) {
        let find = |span: &Range<u32>| {
            let mut found: Vec<(u32, Arrival)> = Vec::new();
            for row in self.offsets[span.start as usize]..self.offsets[span.end as usize] {
                let target = self.targets[row as usize];
                let contest = if target == REMOVED { None } else { cells.place(target) };
                let Some(contest) = contest else { continue };
                let source = self.source(row as usize);
                if target != source {
                    found.push((contest, Arrival { row, from: cells.place(source).unwrap_or(CALM) }));
                }
            }
            found
        };
        let found = self.each(spans, find);
        let mut contests: Vec<Contest> =
            cells.iter().map(|cell| Contest { total: counts.total(cell), ..Contest::default() }).collect();
        for &(contest, _) in found.iter().flatten() {
            contests[contest as usize].accepted += 1;
        }
        let mut first = 0;
        for contest in &mut contests {
            contest.first = first;
            first += std::mem::take(&mut contest.accepted);
        }
        let mut arrivals = vec![Arrival::default(); first as usize];
        for &(contest, arrival) in found.iter().flatten() {
            let contest = &mut contests[contest as usize];
            arrivals[(contest.first + contest.accepted) as usize] = arrival;
            contest.accepted += 1;
        }
        (contests, arrivals)
    }

    fn rows(&self, cell: u32) -> Range<usize> {
        self.offsets[cell as usize] as usize..self.offsets[cell as usize + 1] as usize
    }

    /// The cell that a grain would leave.
    fn source(&self, row: usize) -> u32 {
        self.grid.cell_of(self.positions[row])
    }

    fn each<T: Send>(&self, spans: &[Range<u32>], work: impl Fn(&Range<u32>) -> T + Sync + Send) -> Vec<T> {
        if spans.len() > 1 {
            spans.par_iter().with_max_len(1).map(work).collect()
        } else {
            spans.iter().map(work).collect()
        }
    }
}

/// Cuts the contests into regions with about as many arrivals.
fn regions<'a>(
    mut contests: &'a mut [Contest],
    mut arrivals: &'a mut [Arrival],
    capacity: u32,
) -> Vec<Region<'a>> {
    let parts = if arrivals.len() < FEWEST_GRAINS { 1 } else { rayon::current_num_threads() };
    let (all, number) = (arrivals.len(), contests.len());
    let (mut first, mut first_arrival) = (0, 0);
    let mut regions = Vec::new();
    for part in 1..=parts {
        let wanted = (all * part / parts) as u32;
        let taken = if part == parts {
            number - first
        } else {
            contests.partition_point(|contest| contest.first < wanted)
        };
        let end = contests.get(taken).map_or(all as u32, |next| next.first);
        let cells = contests.split_off_mut(..taken).expect("there are as many left");
        let grains =
            arrivals.split_off_mut(..(end - first_arrival) as usize).expect("there are as many left");
        let queue = (0..taken as u32).filter(|&cell| cells[cell as usize].total > capacity);
        regions.push(Region {
            first: first as u32,
            queue: queue.map(|cell| first as u32 + cell).collect(),
            contests: cells,
            arrivals: grains,
            first_arrival,
            losers: Vec::new(),
        });
        (first, first_arrival) = (first + taken, end);
    }
    regions
}

impl Region<'_> {
    /// Rejects until no cell here is above capacity, after the grains in `news` have come back to their cells.
    /// Returns the contests elsewhere to which grains come back.
    fn settle(&mut self, wanted: &Wanted<'_, impl Vector>, news: &[u32]) -> Vec<u32> {
        let mut outside = Vec::new();
        news.iter().for_each(|&contest| self.come_back(contest, wanted.capacity));
        while let Some(place) = self.queue.pop() {
            let here = (place - self.first) as usize;
            self.rank(here, wanted);
            let Contest { total, first, accepted, .. } = self.contests[here];
            let rejected = (total.saturating_sub(wanted.capacity)).min(accepted);
            self.contests[here].total -= rejected;
            self.contests[here].accepted -= rejected;
            let first = (first - self.first_arrival) as usize;
            for loser in first + (accepted - rejected) as usize..first + accepted as usize {
                let Arrival { row, from } = self.arrivals[loser];
                self.losers.push(row);
                if from == CALM {
                    continue;
                }
                let is_here = from >= self.first && ((from - self.first) as usize) < self.contests.len();
                if is_here { self.come_back(from, wanted.capacity) } else { outside.push(from) }
            }
        }
        outside
    }

    /// One grain more stays in a cell.
    fn come_back(&mut self, contest: u32, capacity: u32) {
        let here = &mut self.contests[(contest - self.first) as usize];
        here.total += 1;
        // Above that it waits already, or has nobody left to reject.
        if here.total == capacity + 1 {
            self.queue.push(contest);
        }
    }

    /// Brings the arrivals at a cell into the order of their ranks.
    fn rank(&mut self, here: usize, wanted: &Wanted<'_, impl Vector>) {
        let Contest { first, accepted, ref mut is_ranked, .. } = self.contests[here];
        if std::mem::replace(is_ranked, true) {
            return;
        }
        let first = (first - self.first_arrival) as usize;
        let arrivals = &mut self.arrivals[first..first + accepted as usize];
        if arrivals.len() > 1 {
            arrivals.sort_by_cached_key(|arrival| {
                let id = wanted.ids[arrival.row as usize];
                (wanted.ranks.hash(u64::from(id)), id)
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::DVec2;

    /// A crowd on a line of cells, where everybody wants to go to a cell nearby.
    #[test]
    fn regions_end_at_the_same_set() {
        let (cells, per_cell, capacity) = (9000_u32, 4_u32, 5_u32);
        let mut random = Streams::new(8).at(0, Phase::Source).stream(0);
        let offsets: Vec<u32> = (0..=cells).map(|cell| cell * per_cell).collect();
        let grid = Grid::new(DVec2::ZERO, DVec2::new(f64::from(cells), 1.0), &[cells, 1], &[false, false]);
        // Some have been displaced into the next cell.
        let home = |row: u32| (row / per_cell + u32::from(row.is_multiple_of(9))).min(cells - 1);
        let positions: Vec<DVec2> = (0..cells * per_cell).map(|row| grid.centre(home(row))).collect();
        let targets: Vec<u32> = (0..cells * per_cell)
            .map(|row| (row / per_cell + (3.0 * random.uniform()) as u32).min(cells - 1))
            .collect();
        let ids: Vec<u32> = (0..targets.len() as u32).rev().collect();
        let losers = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut counts = CountingSort::default();
                counts.count(&targets, cells as usize);
                let ranks = Streams::new(3).at(5, Phase::Admission);
                let wanted = Wanted {
                    grid: &grid,
                    offsets: &offsets,
                    positions: &positions,
                    targets: &targets,
                    ids: &ids,
                    capacity,
                    ranks,
                };
                let above = counts.cells_above(capacity);
                wanted.losers(&counts, &above).iter().collect::<Vec<u32>>()
            })
        };
        let alone = losers(1);
        assert!(alone.len() > 1000 && alone.len() < 20_000, "{}", alone.len());
        assert_eq!(alone, losers(2));
        assert_eq!(alone, losers(5));
    }
}
