//! Who may enter a cell: advection with full-cell rejection (Müller 2001, section 2.3.2).
//!
//! The strict rule lets all movers go, credits departures, and then rejects surplus arrivals until
//! no cell is above its capacity. Arrivals are ranked by a hash of identity and step. The
//! accepted ones are always a prefix of that ranking and only ever become fewer, so every
//! order of work reaches the same set: the result depends on no order of cells or threads.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::rules::Admission;
use crate::matter::grid::Grid;
use crate::matter::sort::REMOVED;
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves of one step and the room they find. Memory is kept from step to step.
#[derive(Debug, Default)]
pub(crate) struct Moves {
    /// `[cell]`: grains now, before the moves.
    pub(crate) occupancy: Vec<AtomicU32>,
    /// `[row]`: the cell each grain is in now.
    pub(crate) sources: Vec<u32>,
    /// `[cell]`: movers that leave.
    departures: Vec<AtomicU32>,
    /// `[cell]`: movers that come.
    arrivals: Vec<AtomicU32>,
    /// Cells that would overflow if nobody left them; a cell may stand here several times.
    pub(crate) crowded: Vec<u32>,
    /// Arrivals at cells that may become too full, by cell and rank.
    bids: Vec<Bid>,
    /// Rows whose move is rejected.
    rejected: Vec<u32>,
}

/// A mover that wants to enter a contested cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Bid {
    cell: u32,
    rank: u64,
    id: u32,
    row: u32,
}

impl Moves {
    /// Begins a step: everybody is in the cell that `offsets` say, and nobody has moved.
    pub(crate) fn begin(&mut self, offsets: &[u32], rows: usize) {
        let cells = offsets.len() - 1;
        self.occupancy.resize_with(cells, AtomicU32::default);
        self.departures.resize_with(cells, AtomicU32::default);
        self.arrivals.resize_with(cells, AtomicU32::default);
        self.sources.resize(rows, 0);
        self.occupancy
            .par_iter_mut()
            .zip(self.departures.par_iter_mut().zip(&mut self.arrivals))
            .zip(offsets.par_windows(2))
            .with_min_len(4096)
            .for_each(|((occupancy, (departures, arrivals)), ends)| {
                *occupancy.get_mut() = ends[1] - ends[0];
                *departures.get_mut() = 0;
                *arrivals.get_mut() = 0;
            });
    }

    /// Notes that a grain wants to go from `source` to another cell, or out. Returns the grains that
    /// the target would hold if nobody left it: the last arrival at a cell sees them all, so the
    /// cells found crowded do not depend on the order of arrivals.
    #[inline(always)]
    pub(crate) fn announce(&self, source: u32, target: u32) -> u32 {
        self.departures[source as usize].fetch_add(1, Relaxed);
        if target == REMOVED {
            return 0;
        }
        let before = self.arrivals[target as usize].fetch_add(1, Relaxed);
        self.occupancy[target as usize].load(Relaxed) + before + 1
    }

    /// Decides which of the moves to `targets` `[row]` are rejected; their rows, in rising order.
    pub(crate) fn reject(
        &mut self,
        rule: Admission,
        capacity: u32,
        targets: &[u32],
        ids: &[u32],
        ranks: PhaseStreams,
    ) -> &[u32] {
        self.rejected.clear();
        match rule {
            Admission::Strict => self.reject_surplus(capacity, targets, ids, ranks),
            Admission::Thesis => self.reject_at_full_cells(capacity, targets),
        }
        &self.rejected
    }

    /// The thesis' rule: open to any number when below capacity before the moves.
    fn reject_at_full_cells(&mut self, capacity: u32, targets: &[u32]) {
        let (occupancy, sources) = (&self.occupancy, &self.sources);
        let refused = |(row, &target): (usize, &u32)| {
            (target != REMOVED
                && target != sources[row]
                && occupancy[target as usize].load(Relaxed) >= capacity)
                .then_some(row as u32)
        };
        self.rejected.par_extend(targets.par_iter().enumerate().with_min_len(4096).filter_map(refused));
    }

    /// The strict rule: the least set of rejections that leaves no cell above its capacity.
    fn reject_surplus(&mut self, capacity: u32, targets: &[u32], ids: &[u32], ranks: PhaseStreams) {
        let mut queue = self.crowded.clone();
        queue.retain(|&cell| self.after_moves(cell) > capacity);
        if queue.is_empty() {
            return;
        }
        self.collect_bids(capacity, targets, ids, ranks);
        while let Some(cell) = queue.pop() {
            let surplus = self.after_moves(cell).saturating_sub(capacity);
            let accepted = self.count(&self.arrivals, cell);
            let keep = accepted - surplus.min(accepted);
            let first = self.bids.partition_point(|bid| bid.cell < cell);
            for k in keep..accepted {
                let bid = self.bids[first + k as usize];
                self.rejected.push(bid.row);
                let source = self.sources[bid.row as usize];
                *self.departures[source as usize].get_mut() -= 1;
                *self.arrivals[cell as usize].get_mut() -= 1;
                if self.after_moves(source) > capacity && self.count(&self.arrivals, source) > 0 {
                    queue.push(source);
                }
            }
        }
        self.rejected.par_sort_unstable();
    }

    /// Ranks the arrivals at every cell that would overflow if nobody left it.
    fn collect_bids(&mut self, capacity: u32, targets: &[u32], ids: &[u32], ranks: PhaseStreams) {
        self.bids.clear();
        let (occupancy, arrivals, sources) = (&self.occupancy, &self.arrivals, &self.sources);
        let bid = |(row, &target): (usize, &u32)| {
            if target == REMOVED || target == sources[row] {
                return None;
            }
            let crowd = occupancy[target as usize].load(Relaxed) + arrivals[target as usize].load(Relaxed);
            let id = ids[row];
            (crowd > capacity).then(|| Bid {
                cell: target,
                rank: ranks.hash(u64::from(id)),
                id,
                row: row as u32,
            })
        };
        self.bids.par_extend(targets.par_iter().enumerate().with_min_len(4096).filter_map(bid));
        self.bids.par_sort_unstable();
    }

    /// Lets rejected diagonal movers take the part of their move along `axis`, where the
    /// face neighbour has room; winners by the same ranking. Returns their rows, in rising order.
    ///
    /// `targets` still tell where rejected grains wanted to go; winners get the cell they enter
    /// and are no longer among the rejected.
    pub(crate) fn slide<V: Vector>(
        &mut self,
        axis: usize,
        capacity: u32,
        grid: &Grid<V>,
        targets: &mut [u32],
        ids: &[u32],
        ranks: PhaseStreams,
    ) -> Vec<u32> {
        let mut bids: Vec<Bid> = self
            .rejected
            .iter()
            .filter_map(|&row| {
                let id = ids[row as usize];
                let cell = face_cell(grid, axis, self.sources[row as usize], targets[row as usize])?;
                Some(Bid { cell, rank: ranks.hash(u64::from(id)), id, row })
            })
            .collect();
        bids.sort_unstable();
        let mut winners = Vec::new();
        for contest in bids.chunk_by(|a, b| a.cell == b.cell) {
            let room = capacity.saturating_sub(self.after_moves(contest[0].cell)) as usize;
            winners.extend(contest.iter().take(room).copied());
        }
        for winner in &winners {
            let source = self.sources[winner.row as usize];
            *self.departures[source as usize].get_mut() += 1;
            *self.arrivals[winner.cell as usize].get_mut() += 1;
            targets[winner.row as usize] = winner.cell;
        }
        let mut rows: Vec<u32> = winners.iter().map(|winner| winner.row).collect();
        rows.sort_unstable();
        self.rejected.retain(|row| rows.binary_search(row).is_err());
        rows
    }

    /// Rows whose move is rejected for good.
    pub(crate) fn rejected(&self) -> &[u32] {
        &self.rejected
    }

    /// Grains in `cell` if all moves that are still accepted are made.
    fn after_moves(&self, cell: u32) -> u32 {
        self.count(&self.occupancy, cell) + self.count(&self.arrivals, cell)
            - self.count(&self.departures, cell)
    }

    fn count(&self, counts: &[AtomicU32], cell: u32) -> u32 {
        counts[cell as usize].load(Relaxed)
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
    use proptest::prelude::*;

    fn ranks() -> PhaseStreams {
        Streams::new(3).at(5, Phase::Admission)
    }

    /// Grains sorted by source cell on a line of `cells`, and where they want to go.
    fn moves(cells: usize, capacity: u32, sources: &[u32], targets: &[u32]) -> Moves {
        let mut offsets = vec![0; cells + 1];
        for &source in sources {
            offsets[source as usize + 1] += 1;
        }
        for cell in 0..cells {
            offsets[cell + 1] += offsets[cell];
        }
        let mut moves = Moves::default();
        moves.begin(&offsets, sources.len());
        moves.sources.copy_from_slice(sources);
        for (&source, &target) in sources.iter().zip(targets) {
            if source != target && moves.announce(source, target) > capacity {
                moves.crowded.push(target);
            }
        }
        moves
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
            let ids: Vec<u32> = (0..sources.len() as u32).collect();
            let mut moves = moves(12, capacity, &sources, &targets);
            let rejected = moves.reject(Admission::Strict, capacity, &targets, &ids, ranks()).to_vec();
            prop_assert_eq!(&rejected, &by_sweeps(12, capacity, &sources, &targets));
            for cell in 0..12_u32 {
                let before = sources.iter().filter(|&&s| s == cell).count() as u32;
                prop_assert!(moves.after_moves(cell) <= capacity.max(before));
            }
        }
    }

    #[test]
    fn a_swap_between_full_cells_is_admitted() {
        let (sources, targets) = ([0, 0, 1, 1], [1, 0, 0, 1]);
        let mut moves = moves(2, 2, &sources, &targets);
        assert!(moves.reject(Admission::Strict, 2, &targets, &[0, 1, 2, 3], ranks()).is_empty());
    }
}
