//! More arrivals than there is room for: who of them loses.
//!
//! Arrivals at a cell are ranked. The accepted ones are always a prefix of that ranking and only ever become
//! fewer, so every order of work ends at the same set: threads may take a region of cells each.

use rayon::prelude::*;

use super::movers::Mover;
use super::number_set::NumberSet;
use crate::matter::sort::{CountingSort, FEWEST_GRAINS, REMOVED};
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves that grains want to make.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a, V: Vector> {
    /// Those who want to change their cell, in rising order of rows.
    pub(crate) movers: &'a [Mover<V>],
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
    /// Its place among the movers.
    mover: u32,
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
    /// Movers who have lost.
    losers: Vec<u32>,
}

impl<V: Vector> Wanted<'_, V> {
    /// The least set of movers without whose moves no cell gets above its capacity, in rising order; `above` are the
    /// cells that would be, were all accepted.
    pub(crate) fn losers(&self, counts: &CountingSort, number_of_cells: usize, above: &[u32]) -> Vec<u32> {
        let cells = self.contested(counts, number_of_cells, above);
        let (mut contests, mut arrivals) = self.contests(counts, &cells);
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
        let mut losers: Vec<u32> = regions.iter().flat_map(|region| &region.losers).copied().collect();
        losers.sort_unstable();
        losers
    }

    /// Cells that would be above capacity if none of their own grains left, whatever becomes of the others.
    fn contested(&self, counts: &CountingSort, number_of_cells: usize, above: &[u32]) -> NumberSet {
        let mut leaving = vec![0_u32; number_of_cells];
        self.movers.iter().for_each(|mover| leaving[mover.source as usize] += 1);
        let mut cells = NumberSet::below(number_of_cells);
        above.iter().for_each(|&cell| cells.insert(cell));
        for &Mover { source, .. } in self.movers {
            // Each cell is looked at once.
            let leaving = std::mem::take(&mut leaving[source as usize]);
            if leaving > 0 && counts.total(source) + leaving > self.capacity {
                cells.insert(source);
            }
        }
        cells.number();
        cells
    }

    /// The contests at `cells`, and all arrivals there.
    fn contests(&self, counts: &CountingSort, cells: &NumberSet) -> (Vec<Contest>, Vec<Arrival>) {
        let find = |(place, movers): (usize, &[Mover<V>])| {
            let mut found: Vec<(u32, Arrival)> = Vec::new();
            for (mover, Mover { row, source, .. }) in (place * FEWEST_GRAINS..).zip(movers) {
                let target = self.targets[*row as usize];
                let contest = if target == REMOVED { None } else { cells.place(target) };
                let Some(contest) = contest else { continue };
                found.push((
                    contest,
                    Arrival { mover: mover as u32, from: cells.place(*source).unwrap_or(CALM) },
                ));
            }
            found
        };
        let found: Vec<Vec<_>> = self.movers.par_chunks(FEWEST_GRAINS).enumerate().map(find).collect();
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

    /// The grain of a mover.
    fn id(&self, mover: u32) -> u32 {
        self.ids[self.movers[mover as usize].row as usize]
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
                let Arrival { mover, from } = self.arrivals[loser];
                self.losers.push(mover);
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
                let id = wanted.id(arrival.mover);
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
        // Some have been displaced into the next cell.
        let source = |row: u32| (row / per_cell + u32::from(row.is_multiple_of(9))).min(cells - 1);
        let targets: Vec<u32> = (0..cells * per_cell)
            .map(|row| (row / per_cell + (3.0 * random.uniform()) as u32).min(cells - 1))
            .collect();
        let movers: Vec<Mover<DVec2>> = (0..cells * per_cell)
            .filter(|&row| targets[row as usize] != source(row))
            .map(|row| Mover { row, source: source(row), position: DVec2::ZERO, velocity: DVec2::ZERO })
            .collect();
        let ids: Vec<u32> = (0..targets.len() as u32).rev().collect();
        let losers = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut counts = CountingSort::default();
                counts.count(&targets, cells as usize);
                let ranks = Streams::new(3).at(5, Phase::Admission);
                let wanted = Wanted { movers: &movers, targets: &targets, ids: &ids, capacity, ranks };
                wanted.losers(&counts, cells as usize, &counts.cells_above(capacity))
            })
        };
        let alone = losers(1);
        assert!(alone.len() > 1000 && alone.len() < 20_000, "{}", alone.len());
        assert_eq!(alone, losers(2));
        assert_eq!(alone, losers(5));
    }
}
