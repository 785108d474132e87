//! Who may enter a cell: advection with full-cell rejection (Müller 2001, section 2.3.2).
//!
//! The strict rule lets all movers go, credits departures, and then rejects surplus arrivals until
//! no cell is above its capacity. Arrivals are ranked by a hash of identity and step. The
//! accepted ones are always a prefix of that ranking and only ever become fewer, so every
//! order of work reaches the same set: the result depends on no order of cells or threads.

use super::contests::Wanted;
use crate::law::piecewise::PiecewiseLinear;
use crate::matter::grid::Grid;
use crate::matter::sort::{CountingSort, REMOVED};
use crate::random::PhaseStreams;
use crate::space::Vector;

/// The moves of one step: from where, to where, and how many grains each cell will hold.
pub(crate) struct Moves<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    /// Grains that make a cell full.
    pub(crate) capacity: u32,
    /// Where the rows of each cell begin, `[cell + 1]`; grains may have been displaced into other cells since.
    pub(crate) offsets: &'a [u32],
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rejected {
    pub(crate) row: u32,
    /// The cell it is in.
    source: u32,
    /// The cell it wanted to enter.
    wanted: u32,
}

/// A rejected mover that bids for a face cell; the lower rank has precedence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Bid {
    cell: u32,
    rank: u64,
    id: u32,
    row: u32,
}

impl<V: Vector> Moves<'_, V> {
    /// The cell that the grain in `row` comes from.
    pub(crate) fn source(&self, row: u32) -> u32 {
        self.grid.cell_of(self.positions[row as usize])
    }

    /// Grains in each cell before the moves, `[cell]`.
    fn occupancy(&self) -> Vec<u32> {
        let mut occupancy = vec![0_u32; self.grid.number_of_cells()];
        self.positions.iter().for_each(|&position| occupancy[self.grid.cell_of(position) as usize] += 1);
        occupancy
    }

    /// A mover gets into a cell of volume fraction ν with probability p(ν) alone (Müller 2001, figure 2.1), ν that
    /// of the cell before the moves; `grain_share` is the volume fraction of one grain. In rising order of rows.
    pub(crate) fn refuse_by_chance(&mut self, p: &PiecewiseLinear, grain_share: f64) -> Vec<Rejected> {
        let occupancy = self.occupancy();
        let is_refused = |row: u32| {
            let wanted = self.targets[row as usize];
            if wanted == REMOVED || wanted == self.source(row) {
                return false;
            }
            let fraction = f64::from(occupancy[wanted as usize]) * grain_share;
            let id = u64::from(self.ids[row as usize]);
            // The first draw of the stream, and not the hash that names it: that one ranks arrivals.
            self.ranks.stream(id).uniform() >= p.at(fraction)
        };
        let rows: Vec<u32> = (0..self.targets.len() as u32).filter(|&row| is_refused(row)).collect();
        self.turned_back(rows.into_iter())
    }

    /// The thesis' rule: a cell is open to any number when below capacity before the moves.
    pub(crate) fn reject_at_full_cells(&mut self) -> Vec<Rejected> {
        let occupancy = self.occupancy();
        let refused = |row: u32| {
            let wanted = self.targets[row as usize];
            wanted != REMOVED && occupancy[wanted as usize] >= self.capacity && wanted != self.source(row)
        };
        let rows: Vec<u32> = (0..self.targets.len() as u32).filter(|&row| refused(row)).collect();
        self.turned_back(rows.into_iter())
    }

    /// The strict rule: the least set of rejections that leaves no cell above its capacity. In rising order of rows.
    pub(crate) fn reject_surplus(&mut self) -> Vec<Rejected> {
        let above = self.counts.cells_above(self.capacity);
        if above.is_empty() {
            return Vec::new();
        }
        let Moves { grid, capacity, offsets, positions, ids, ranks, .. } = *self;
        let wanted = Wanted { grid, offsets, positions, targets: self.targets, ids, capacity, ranks };
        let losers = wanted.losers(self.counts, &above);
        self.turned_back(losers.iter())
    }

    /// The moves of these rows, in rising order, are rejected: grains stay in their cells.
    fn turned_back(&mut self, rows: impl Iterator<Item = u32>) -> Vec<Rejected> {
        let rejected = rows.map(|row| {
            let (source, wanted) = (self.source(row), self.targets[row as usize]);
            self.send(row, source);
            Rejected { row, source, wanted }
        });
        rejected.collect()
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
        let room = |cell: u32| self.capacity.saturating_sub(self.counts.total(cell)) as usize;
        let bid = |&Rejected { row, source, wanted }: &Rejected| {
            let cell = face_cell(self.grid, axis, source, wanted).filter(|&cell| room(cell) > 0)?;
            let id = self.ids[row as usize];
            Some(Bid { cell, rank: self.ranks.hash(u64::from(id)), id, row })
        };
        let mut bids: Vec<Bid> = rejected.iter().filter_map(bid).collect();
        bids.sort_unstable();
        let mut winners: Vec<(u32, u32)> = Vec::new();
        for contest in bids.chunk_by(|a, b| a.cell == b.cell) {
            let admitted = contest.iter().take(room(contest[0].cell));
            winners.extend(admitted.map(|bid| (bid.row, bid.cell)));
        }
        winners.sort_unstable();
        winners.iter().for_each(|&(row, cell)| self.send(row, cell));
        let mut others = winners.iter().peekable();
        rejected.retain(|rejected| others.next_if(|(row, _)| *row == rejected.row).is_none());
        winners.into_iter().map(|(row, _)| row).collect()
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

    /// Rows that the strict rule rejects, of grains sorted by their `homes` on a line of `cells`, which are in `sources`
    /// when they want to go to `targets`; and how many grains each cell holds in the end.
    fn rejected(
        cells: u32,
        capacity: u32,
        homes: &[u32],
        sources: &[u32],
        targets: &[u32],
    ) -> (Vec<u32>, Vec<u32>) {
        let size = DVec2::new(f64::from(cells), 1.0);
        let grid = Grid::new(DVec2::ZERO, size, &[cells, 1], &[false, false]);
        let positions: Vec<DVec2> = sources.iter().map(|&cell| grid.centre(cell)).collect();
        let offsets: Vec<u32> =
            (0..=cells).map(|cell| homes.partition_point(|&home| home < cell) as u32).collect();
        let ids: Vec<u32> = (0..sources.len() as u32).collect();
        let (mut targets, mut counts) = (targets.to_vec(), CountingSort::default());
        counts.count(&targets, cells as usize);
        let mut moves = Moves {
            grid: &grid,
            capacity,
            offsets: &offsets,
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
            mut plan in proptest::collection::vec((0_u32..12, 0_u32..12, 0_u32..12, any::<bool>()), 0..60),
            capacity in 1_u32..7,
        ) {
            plan.sort_by_key(|&(home, ..)| home);
            // Half of the grains have been displaced; cells far apart stand in different words of a set.
            let homes: Vec<u32> = plan.iter().map(|&(home, ..)| 6 * home).collect();
            let sources: Vec<u32> =
                plan.iter().map(|&(home, other, _, moved)| 6 * if moved { other } else { home }).collect();
            let targets: Vec<u32> = plan.iter().map(|&(.., target, _)| 6 * target).collect();
            let (rejected, held) = rejected(72, capacity, &homes, &sources, &targets);
            prop_assert_eq!(&rejected, &by_sweeps(72, capacity, &sources, &targets));
            for cell in 0..72_u32 {
                let before = sources.iter().filter(|&&s| s == cell).count() as u32;
                prop_assert!(held[cell as usize] <= capacity.max(before));
            }
        }
    }

    #[test]
    fn a_swap_between_full_cells_is_admitted() {
        assert!(rejected(2, 2, &[0, 0, 1, 1], &[0, 0, 1, 1], &[1, 0, 0, 1]).0.is_empty());
    }
}
