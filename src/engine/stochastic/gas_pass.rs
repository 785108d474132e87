//! The step of the gas engines, DSMC and CBA: collide a cell, move its grains, one pass over memory.

use super::Step;
use super::blocks::{Block, blocks};
use super::cell_pairs::{Displaced, PairCollisions};
use super::enskog::EnskogFactors;
use super::flight::Flights;
use super::laws::{Laws, Room};
use super::parallel;
use super::tally::Tally;
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
    fn block(&self, block: Block<'_, V>, offsets: &[u32]) -> Tally<V> {
        let mut tally = Tally::default();
        for cell in block.cells.clone() {
            let rows = block.rows(cell, offsets);
            if rows.is_empty() {
                continue;
            }
            let positions = &mut block.positions[rows.clone()];
            let velocities = &mut block.velocities[rows.clone()];
            let factor = self.enskog.of(cell, rows.len());
            self.collisions.collide(cell, factor, velocities, &mut tally, |displaced, _| {
                self.displace(displaced, positions)
            });
            let ids = &block.ids[rows.clone()];
            self.advect(positions, velocities, ids, &mut block.targets[rows], &mut tally);
        }
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

    #[inline(always)]
    fn advect(
        &self,
        positions: &mut [V],
        velocities: &mut [V],
        ids: &[u32],
        targets: &mut [u32],
        tally: &mut Tally<V>,
    ) {
        for row in 0..ids.len() {
            let flight =
                self.flights.fly(positions[row], velocities[row], ids[row], &mut tally.counts.wall_momentum);
            positions[row] = flight.position;
            velocities[row] = flight.velocity;
            tally.note_velocity(flight.velocity);
            targets[row] = if flight.left {
                tally.counts.removed += 1;
                REMOVED
            } else {
                self.flights.cell_of(flight.position)
            };
        }
    }
}
