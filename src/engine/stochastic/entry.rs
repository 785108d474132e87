//! Who gets into a cell by chance, before it is asked who finds room: a mover enters a cell of volume fraction ν with
//! probability p(ν) (Müller 2001, section 2.3.2 and figure 2.1).

use super::admission::occupancy_before;
use super::excluded_volume::take_back_wall_momentum;
use super::flight::Flights;
use super::movers::Mover;
use super::tally::Tally;
use crate::law::piecewise::PiecewiseLinear;
use crate::law::restitution::Restitution;
use crate::matter::columns::Columns;
use crate::matter::gas::SortSpace;
use crate::matter::sort::REMOVED;
use crate::random::PhaseStreams;
use crate::space::Vector;

/// p(ν) for the cells of one grid.
pub(crate) struct Entry<'a> {
    pub(crate) probability: &'a PiecewiseLinear,
    /// ν of a cell that holds one grain.
    pub(crate) grain_share: f64,
    pub(crate) number_of_cells: usize,
    /// A stream for every grain.
    pub(crate) random: PhaseStreams,
}

impl Entry<'_> {
    /// Sends those among `movers` back who are refused, and strikes them off: they stay as if they had never wanted
    /// to go. ν is that of the wanted cell before the moves.
    pub(crate) fn refuse<V: Vector, R: Restitution>(
        &self,
        flights: &Flights<'_, V, R>,
        movers: &mut Vec<Mover<V>>,
        columns: &mut Columns<V>,
        space: &mut SortSpace<V>,
        tally: &mut Tally<V>,
    ) {
        let (targets, counts) = (&mut space.cells, &mut space.sort);
        let occupancy = occupancy_before(movers, targets, counts, self.number_of_cells);
        movers.retain(|mover| {
            let row = mover.row as usize;
            let (id, wanted) = (columns.ids[row], targets[row]);
            if wanted == REMOVED || self.gets_in(id, occupancy[wanted as usize]) {
                return true;
            }
            tally.counts.rejected_moves += 1;
            take_back_wall_momentum(flights, *mover, &columns.ids, tally);
            mover.stay(&mut columns.positions, &mut columns.velocities);
            // A displacement may have carried it out through an open side: there is no place to keep.
            let is_out = flights.is_out(mover.position);
            tally.counts.removed += u64::from(is_out);
            targets[row] = if is_out { REMOVED } else { mover.source };
            counts.recount(row, wanted, targets[row]);
            false
        });
    }

    /// Whether the grain called `id` gets into a cell that holds so many `grains`. It is the first draw of its stream
    /// that decides, and not the hash that names the stream: that one ranks arrivals.
    fn gets_in(&self, id: u32, grains: u32) -> bool {
        let probability = self.probability.at(f64::from(grains) * self.grain_share);
        self.random.stream(u64::from(id)).uniform() < probability
    }
}
