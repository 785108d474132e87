//! Who may enter a cell: advection with full-cell rejection (Müller 2001, section 2.3.2).
//!
//! The strict rule lets all movers go, credits departures, and then rejects surplus arrivals until
//! no cell is above its capacity. Arrivals are ranked by a hash of identity and step. The
//! accepted ones are always a prefix of that ranking and only ever become fewer, so every
//! order of work reaches the same set: the result depends on no order of cells or threads.

use super::contests::Wanted;
use super::movers::Mover;
use crate::matter::grid::Grid;
use crate::matter::sort::{CountingSort, REMOVED};
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves of one step: from where, to where, and how many grains each cell will hold.
pub(crate) struct Moves<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    /// Grains that make a cell full.
    pub(crate) capacity: u32,
    /// Those who want to change their cell, in rising order of rows.
    pub(crate) movers: &'a [Mover<V>],
    /// `[row]`.
    pub(crate) ids: &'a [u32],
    /// `[row]`: the cell each grain goes to.
    pub(crate) targets: &'a mut [u32],
    /// The grains counted by these cells; kept up to date.
    pub(crate) counts: &'a mut CountingSort,
    pub(crate) ranks: PhaseStreams,
}

/// A grain whose move is rejected: it stays where it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rejected {
    /// Its place among the movers.
    pub(crate) mover: u32,
    /// The cell it wanted to enter.
    wanted: u32,
}

/// A rejected mover that bids for a face cell; the lower rank has precedence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Bid {
    cell: u32,
    rank: u64,
    id: u32,
    mover: u32,
}

impl<V: Vector> Moves<'_, V> {
    /// The thesis' rule: a cell is open to any number when below capacity before the moves.
    pub(crate) fn reject_at_full_cells(&mut self) -> Vec<Rejected> {
        let occupancy = occupancy_before(self.movers, self.targets, self.counts, self.grid.number_of_cells());
        let refused = |mover: &u32| {
            let wanted = self.targets[self.movers[*mover as usize].row as usize];
            wanted != REMOVED && occupancy[wanted as usize] >= self.capacity
        };
        let refused = (0..self.movers.len() as u32).filter(refused).collect();
        self.turned_back(refused)
    }

    /// The strict rule: the least set of rejections that leaves no cell above its capacity. In rising order of rows.
    pub(crate) fn reject_surplus(&mut self) -> Vec<Rejected> {
        let above = self.counts.cells_above(self.capacity);
        if above.is_empty() {
            return Vec::new();
        }
        let Moves { movers, capacity, ids, ranks, .. } = *self;
        let wanted = Wanted { movers, targets: self.targets, ids, capacity, ranks };
        let losers = wanted.losers(self.counts, self.grid.number_of_cells(), &above);
        self.turned_back(losers)
    }

    /// These `movers` are rejected: they stay in their cells.
    fn turned_back(&mut self, movers: Vec<u32>) -> Vec<Rejected> {
        let rejected = movers.into_iter().map(|mover| {
            let Mover { row, source, .. } = self.movers[mover as usize];
            let wanted = self.targets[row as usize];
            self.send(row, source);
            Rejected { mover, wanted }
        });
        rejected.collect()
    }

    /// Sends a grain elsewhere.
    pub(crate) fn send(&mut self, row: u32, target: u32) {
        let before = std::mem::replace(&mut self.targets[row as usize], target);
        self.counts.recount(row as usize, before, target);
    }

    /// Lets rejected diagonal movers take the part of their move along `axis`, where the
    /// face neighbour has room; winners by the same ranking. Returns these movers, in rising order; they
    /// are no longer among the rejected.
    pub(crate) fn slide(&mut self, axis: usize, rejected: &mut Vec<Rejected>) -> Vec<u32> {
        let room = |cell: u32| self.capacity.saturating_sub(self.counts.total(cell)) as usize;
        let bid = |&Rejected { mover, wanted }: &Rejected| {
            let Mover { row, source, .. } = self.movers[mover as usize];
            let cell = face_cell(self.grid, axis, source, wanted).filter(|&cell| room(cell) > 0)?;
            let id = self.ids[row as usize];
            Some(Bid { cell, rank: self.ranks.hash(u64::from(id)), id, mover })
        };
        let mut bids: Vec<Bid> = rejected.iter().filter_map(bid).collect();
        bids.sort_unstable();
        let mut winners: Vec<(u32, u32)> = Vec::new();
        for contest in bids.chunk_by(|a, b| a.cell == b.cell) {
            let admitted = contest.iter().take(room(contest[0].cell));
            winners.extend(admitted.map(|bid| (bid.mover, bid.cell)));
        }
        winners.sort_unstable();
        for &(mover, cell) in &winners {
            self.send(self.movers[mover as usize].row, cell);
        }
        let mut others = winners.iter().peekable();
        rejected.retain(|rejected| others.next_if(|(mover, _)| *mover == rejected.mover).is_none());
        winners.into_iter().map(|(mover, _)| mover).collect()
    }
}

/// Grains in each cell before the moves of `movers` to their `targets` `[row]`, which `counts` has counted, `[cell]`.
pub(crate) fn occupancy_before<V: Vector>(
    movers: &[Mover<V>],
    targets: &[u32],
    counts: &CountingSort,
    number_of_cells: usize,
) -> Vec<u32> {
    let mut occupancy: Vec<u32> = (0..number_of_cells as u32).map(|cell| counts.total(cell)).collect();
    for mover in movers {
        occupancy[mover.source as usize] += 1;
    }
    for mover in movers {
        let target = targets[mover.row as usize];
        if target != REMOVED {
            occupancy[target as usize] -= 1;
        }
    }
    occupancy
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

    /// Rows that the strict rule rejects, of grains that are in `sources` when they want to go to `targets` on a line of
    /// `cells`; and how many grains each cell holds in the end.
    fn rejected(cells: u32, capacity: u32, sources: &[u32], targets: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let size = DVec2::new(f64::from(cells), 1.0);
        let grid = Grid::new(DVec2::ZERO, size, &[cells, 1], &[false, false]);
        let movers: Vec<Mover<DVec2>> = (0..sources.len())
            .filter(|&row| sources[row] != targets[row])
            .map(|row| Mover {
                row: row as u32,
                source: sources[row],
                position: DVec2::ZERO,
                velocity: DVec2::ZERO,
            })
            .collect();
        let ids: Vec<u32> = (0..sources.len() as u32).collect();
        let (mut targets, mut counts) = (targets.to_vec(), CountingSort::default());
        counts.count(&targets, cells as usize);
        let mut moves = Moves {
            grid: &grid,
            capacity,
            movers: &movers,
            ids: &ids,
            targets: &mut targets,
            counts: &mut counts,
            ranks: ranks(),
        };
        let rejected = moves.reject_surplus().iter().map(|r| movers[r.mover as usize].row).collect();
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
            plan in proptest::collection::vec((0_u32..12, 0_u32..12), 0..60),
            capacity in 1_u32..7,
        ) {
            // Cells far apart stand in different words of a set.
            let (sources, targets): (Vec<u32>, Vec<u32>) = plan.into_iter().map(|(from, to)| (6 * from, 6 * to)).unzip();
            let (rejected, held) = rejected(72, capacity, &sources, &targets);
            prop_assert_eq!(&rejected, &by_sweeps(72, capacity, &sources, &targets));
            for cell in 0..72_u32 {
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
