//! Who may enter a cell: advection with full-cell rejection (Müller 2001, section 2.3.2).
//!
//! The strict rule lets all movers go, credits departures, and then rejects surplus arrivals until
//! no cell is above its capacity. Arrivals are ranked by a hash of identity and step. The
//! accepted ones are always a prefix of that ranking and only ever become fewer, so every
//! order of work reaches the same set: the result depends on no order of cells or threads.

use rayon::prelude::*;

use crate::matter::grid::Grid;
use crate::matter::sort::{CountingSort, FEWEST_GRAINS, REMOVED};
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves of one step: from where, to where, and how many grains each cell will hold.
pub(crate) struct Moves<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    /// Grains that make a cell full.
    pub(crate) capacity: u32,
    /// `[row]`: positions before the move [length].
    pub(crate) positions: &'a [V],
    /// `[row]`.
    pub(crate) ids: &'a [u32],
    /// `[row]`: the cell each grain goes to.
    pub(crate) targets: &'a mut [u32],
    /// The grains counted by these cells; kept up to date.
    pub(crate) counts: &'a mut CountingSort,
    pub(crate) ranks: PhaseStreams,
}

/// A grain whose move is rejected: it stays where it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Rejected {
    pub(crate) row: u32,
    /// The cell it is in.
    source: u32,
    /// The cell it wanted to enter.
    wanted: u32,
}

/// A mover that wants to enter a contested cell; the lower rank has precedence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Bid {
    cell: u32,
    rank: u64,
    id: u32,
    row: u32,
    source: u32,
}

/// Arrivals at contested cells.
#[derive(Debug, Default)]
struct Contests {
    /// By cell, and in it by rank.
    bids: Vec<Bid>,
    /// `[bid]`: of the first bid at a cell, how many of the last ones there have lost.
    lost: Vec<u32>,
    /// Whether all movers have bid; otherwise only those to the cells that were above capacity first.
    complete: bool,
}

impl<V: Vector> Moves<'_, V> {
    /// The cell that the grain in `row` comes from.
    fn source(&self, row: u32) -> u32 {
        self.grid.cell_of(self.positions[row as usize])
    }

    /// The thesis' rule: a cell is open to any number when below capacity before the moves.
    pub(crate) fn reject_at_full_cells(&mut self) -> Vec<Rejected> {
        let mut occupancy = vec![0_u32; self.grid.number_of_cells()];
        self.positions.iter().for_each(|&position| occupancy[self.grid.cell_of(position) as usize] += 1);
        let mut rejected = Vec::new();
        for row in 0..self.targets.len() as u32 {
            let wanted = self.targets[row as usize];
            let refused = wanted != REMOVED && occupancy[wanted as usize] >= self.capacity;
            let source = self.source(row);
            if refused && wanted != source {
                self.send(row, source);
                rejected.push(Rejected { row, source, wanted });
            }
        }
        rejected
    }

    /// The strict rule: the least set of rejections that leaves no cell above its capacity. In rising order of rows.
    pub(crate) fn reject_surplus(&mut self) -> Vec<Rejected> {
        let mut above = self.counts.cells_above(self.capacity);
        if above.is_empty() {
            return Vec::new();
        }
        let mut contests = Contests::new(self.bids(Some(&above)), false);
        let mut rejected = Vec::new();
        while let Some(cell) = above.pop() {
            let surplus = self.counts.total(cell).saturating_sub(self.capacity);
            for _ in 0..surplus {
                let Some(Bid { row, source, .. }) = contests.reject_last(cell) else {
                    if contests.complete {
                        break;
                    }
                    contests = Contests::new(self.bids(None), true);
                    above.push(cell);
                    break;
                };
                rejected.push(Rejected { row, source, wanted: cell });
                self.send(row, source);
                if self.counts.total(source) > self.capacity {
                    above.push(source);
                }
            }
        }
        rejected.sort_unstable();
        rejected
    }

    /// The bids of grains that would change cells; only at `cells`, where these are given.
    fn bids(&self, cells: Option<&[u32]>) -> Vec<Bid> {
        let mut contested = vec![0_u64; cells.map_or(0, |_| self.grid.number_of_cells().div_ceil(64))];
        for &cell in cells.into_iter().flatten() {
            contested[cell as usize / 64] |= 1 << (cell % 64);
        }
        let is_contested =
            |cell: u32| cells.is_none() || contested[cell as usize / 64] >> (cell % 64) & 1 == 1;
        let bid = |(row, &cell): (usize, &u32)| {
            if cell == REMOVED || !is_contested(cell) {
                return None;
            }
            let source = self.source(row as u32);
            (cell != source).then(|| self.bid(row as u32, source, cell))
        };
        let targets = &*self.targets;
        if targets.len() < FEWEST_GRAINS {
            targets.iter().enumerate().filter_map(bid).collect()
        } else {
            targets.par_iter().enumerate().with_min_len(FEWEST_GRAINS).filter_map(bid).collect()
        }
    }

    fn bid(&self, row: u32, source: u32, cell: u32) -> Bid {
        let id = self.ids[row as usize];
        Bid { cell, rank: self.ranks.hash(u64::from(id)), id, row, source }
    }

    /// Sends a grain elsewhere.
    pub(crate) fn send(&mut self, row: u32, target: u32) {
        let before = std::mem::replace(&mut self.targets[row as usize], target);
        self.counts.recount(row as usize, before, target);
    }

    /// Lets rejected diagonal movers take the part of their move along `axis`, where the
    /// face neighbour has room; winners by the same ranking. Returns their rows, in rising order; they
    /// are no longer among the rejected.
    pub(crate) fn slide(&mut self, axis: usize, rejected: &mut Vec<Rejected>) -> Vec<u32> {
        let mut bids: Vec<Bid> = rejected
            .iter()
            .filter_map(|&Rejected { row, source, wanted }| {
                Some(self.bid(row, source, face_cell(self.grid, axis, source, wanted)?))
            })
            .collect();
        bids.sort_unstable();
        let mut winners = Vec::new();
        for contest in bids.chunk_by(|a, b| a.cell == b.cell) {
            let room = self.capacity.saturating_sub(self.counts.total(contest[0].cell)) as usize;
            winners.extend_from_slice(&contest[..room.min(contest.len())]);
        }
        for winner in &winners {
            self.send(winner.row, winner.cell);
        }
        let mut rows: Vec<u32> = winners.iter().map(|winner| winner.row).collect();
        rows.sort_unstable();
        rejected.retain(|rejected| rows.binary_search(&rejected.row).is_err());
        rows
    }
}

impl Contests {
    fn new(mut bids: Vec<Bid>, complete: bool) -> Self {
        bids.sort_unstable();
        let lost = vec![0; bids.len()];
        Contests { bids, lost, complete }
    }

    /// The last of the arrivals at `cell` that are still accepted loses; `None` where there is none, or nobody has bid.
    fn reject_last(&mut self, cell: u32) -> Option<Bid> {
        let first = self.bids.partition_point(|bid| bid.cell < cell);
        let all = self.bids[first..].partition_point(|bid| bid.cell == cell);
        let accepted = all.checked_sub(*self.lost.get(first)? as usize + 1)?;
        self.lost[first] += 1;
        Some(self.bids[first + accepted])
    }
}

/// The cell that the part along `axis` of a diagonal move from `source` to `target` leads
/// to; `None` where that part is no move, or is all of it.
fn face_cell<V: Vector>(grid: &Grid<V>, axis: usize, source: u32, target: u32) -> Option<u32> {
    let (from, to) = (grid.coordinates(source), grid.coordinates(target));
    let mut face = from;
    face[axis] = to[axis];
    let cell = grid.cell_at(face);
    (cell != source && cell != target).then_some(cell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::DVec2;
    use proptest::prelude::*;

    fn ranks() -> PhaseStreams {
        Streams::new(3).at(5, Phase::Admission)
    }

    /// Rows that the strict rule rejects, of grains sorted by source cell on a line of `cells`, and how many
    /// grains each cell holds in the end.
    fn rejected(cells: u32, capacity: u32, sources: &[u32], targets: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let size = DVec2::new(f64::from(cells), 1.0);
        let grid = Grid::new(DVec2::ZERO, size, &[cells, 1], &[false, false]);
        let positions: Vec<DVec2> = sources.iter().map(|&cell| grid.centre(cell)).collect();
        let ids: Vec<u32> = (0..sources.len() as u32).collect();
        let (mut targets, mut counts) = (targets.to_vec(), CountingSort::default());
        counts.count(&targets, cells as usize);
        let mut moves = Moves {
            grid: &grid,
            capacity,
            positions: &positions,
            ids: &ids,
            targets: &mut targets,
            counts: &mut counts,
            ranks: ranks(),
        };
        let rejected = moves.reject_surplus().iter().map(|rejected| rejected.row).collect();
        (rejected, (0..cells).map(|cell| counts.total(cell)).collect())
    }

    /// The same fixed point by repeated sweeps over all cells, slowly.
    fn by_sweeps(cells: usize, capacity: u32, sources: &[u32], targets: &[u32]) -> Vec<u32> {
        let mut rejected = vec![false; sources.len()];
        loop {
            let mut changed = false;
            for cell in 0..cells as u32 {
                let stay = (0..sources.len())
                    .filter(|&r| sources[r] == cell && (targets[r] == cell || rejected[r]))
                    .count() as u32;
                let mut arrivals: Vec<usize> = (0..sources.len())
                    .filter(|&r| targets[r] == cell && sources[r] != cell && !rejected[r])
                    .collect();
                arrivals.sort_by_key(|&r| (ranks().hash(r as u64), r));
                for &row in arrivals.iter().skip(capacity.saturating_sub(stay) as usize) {
                    rejected[row] = true;
                    changed = true;
                }
            }
            if !changed {
                return (0..sources.len() as u32).filter(|&r| rejected[r as usize]).collect();
            }
        }
    }

    proptest! {
        #[test]
        fn rejections_are_the_least_fixed_point(
            mut plan in proptest::collection::vec((0_u32..12, 0_u32..12), 0..60),
            capacity in 1_u32..7,
        ) {
            plan.sort_by_key(|&(source, _)| source);
            let (sources, targets): (Vec<u32>, Vec<u32>) = plan.into_iter().unzip();
            let (rejected, held) = rejected(12, capacity, &sources, &targets);
            prop_assert_eq!(&rejected, &by_sweeps(12, capacity, &sources, &targets));
            for cell in 0..12_u32 {
                let before = sources.iter().filter(|&&s| s == cell).count() as u32;
                prop_assert!(held[cell as usize] <= capacity.max(before));
            }
        }
    }

    #[test]
    fn a_swap_between_full_cells_is_admitted() {
        assert!(rejected(2, 2, &[0, 0, 1, 1], &[1, 0, 0, 1]).0.is_empty());
    }
}
