//! The step of the gas engines, DSMC and CBA: collide a cell, move its grains, one pass over memory.

use super::Step;
use super::blocks::{Block, blocks};
use super::cell_pairs::{Displaced, PairCollisions};
use super::enskog::EnskogFactors;
use super::flight::Flights;
use super::laws::{Laws, Room};
use super::parallel;
use super::tally::{Speeds, Tally};
use crate::engine::report::Counts;
use crate::law::restitution::Restitution;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::sort::REMOVED;
use crate::random::Phase;
use crate::space::Vector;

/// The parts of a gas step.
struct GasPass<'a, V: Vector, R: Restitution> {
    collisions: PairCollisions<R>,
    enskog: EnskogFactors<'a, V>,
    room: Room<V>,
    flights: Flights<'a, V, R>,
}

/// Collides and moves all grains; `space.cells` tells where each one goes.
pub(crate) fn collide_and_move<V: Vector, R: Restitution>(
    laws: &Laws<V, R>,
    gas: &mut Gas<V>,
    space: &mut SortSpace<V>,
    step: Step,
) -> Tally<V> {
    let (grid, offsets, columns) = gas.parts_mut();
    let pass = GasPass {
        collisions: PairCollisions::new(laws, grid.cell_volume(), step, Phase::Collisions),
        enskog: EnskogFactors::new(laws.dense, grid, offsets, laws.grain.diameter),
        room: Room::at(grid, &laws.boundary, step.start),
        flights: Flights::new(laws, grid, step),
    };
    let grains = columns.len();
    let blocks = blocks(offsets, columns, &mut space.cells);
    Tally::total(parallel::map(grains, blocks, |block| pass.block(block, offsets)))
}

impl<V: Vector, R: Restitution> GasPass<'_, V, R> {
    fn block(&self, mut block: Block<'_, V>, offsets: &[u32]) -> Tally<V> {
        let mut tally = Tally::default();
        for cell in block.cells.clone() {
            let rows = block.rows(cell, offsets);
            if rows.is_empty() {
                continue;
            }
            let positions = &mut block.positions[rows.clone()];
            let velocities = &mut block.velocities[rows];
            let factor = self.enskog.of(cell, velocities.len());
            self.collisions.collide(cell, factor, velocities, &mut tally, |displaced, _| {
                self.displace(displaced, positions)
            });
        }
        self.advect(&mut block, &mut tally);
        tally
    }

    /// Displaces both partners, or none where a wall is in the way.
    #[inline(always)]
    fn displace(&self, displaced: Displaced<V>, positions: &mut [V]) -> bool {
        let (i, j) = displaced.pair;
        let (first, second) = (positions[i] + displaced.shift, positions[j] - displaced.shift);
        let possible = self.room.holds(first) && self.room.holds(second);
        if possible {
            (positions[i], positions[j]) = (first, second);
        }
        possible
    }

    /// Moves all grains of the block.
    fn advect(&self, block: &mut Block<'_, V>, tally: &mut Tally<V>) {
        let rows = block.ids.len();
        let (positions, velocities) = (&mut block.positions[..rows], &mut block.velocities[..rows]);
        let targets = &mut block.targets[..rows];
        let mut speeds = Speeds::default();
        for row in 0..rows {
            let (position, velocity) = self.flights.free(positions[row], velocities[row]);
            if self.flights.is_free(position) {
                (positions[row], velocities[row]) = (position, velocity);
                targets[row] = self.flights.cell_of(position);
                // Not read back from the column, whose store would still be on its way.
                speeds.note(velocity);
            } else {
                let grain = (&mut positions[row], &mut velocities[row], block.ids[row]);
                targets[row] = self.meet_the_edge(grain, &mut tally.counts);
                speeds.note(velocities[row]);
            }
        }
        tally.speeds.add(&speeds);
    }

    /// Moves one grain that comes near an edge; returns the cell it goes to.
    #[cold]
    #[inline(never)]
    fn meet_the_edge(&self, (position, velocity, id): (&mut V, &mut V, u32), counts: &mut Counts<V>) -> u32 {
        let flight = self.flights.fly_to_the_edge(*position, *velocity, id, &mut counts.wall_momentum);
        (*position, *velocity) = (flight.position, flight.velocity);
        if flight.left {
            counts.removed += 1;
            return REMOVED;
        }
        self.flights.cell_of(flight.position)
    }
}
