//! The step of the gas engines, DSMC and CBA: collide a cell, move its grains, one pass over memory.

use super::Step;
use super::blocks::{Block, parts, rows_of, with_counts};
use super::cell_pairs::{Displaced, PairCollisions};
use super::flight::Flights;
use super::laws::{Laws, Room};
use super::parallel;
use super::tally::{Speeds, Tally};
use crate::engine::cell_counts::CellCount;
use crate::law::restitution::Restitution;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::sort::Counter;
use crate::space::Vector;

/// The parts of a gas step.
struct GasPass<'a, V: Vector, R: Restitution> {
    collisions: PairCollisions<'a, V, R>,
    room: Room<V>,
    flights: Flights<'a, V, R>,
}

/// Collides and moves all grains; `space.cells` tells where each one goes. `cell_counts` `[cell]` are kept up where there
/// are any.
pub(crate) fn collide_and_move<V: Vector, R: Restitution>(
    laws: &Laws<V, R>,
    gas: &mut Gas<V>,
    space: &mut SortSpace<V>,
    step: Step,
    cell_counts: &mut [CellCount],
) -> Tally<V> {
    let (grid, offsets, columns) = gas.parts_mut();
    let pass = GasPass {
        collisions: PairCollisions::new(laws, grid, offsets, step),
        room: Room::at(grid, &laws.boundary, step.start),
        flights: Flights::new(laws, grid, step),
    };
    let parts = with_counts(parts(offsets, columns, &mut space.cells), cell_counts);
    let counters = space.sort.begin(rows_of(&parts), grid.number_of_cells());
    let tallies = parallel::each(parts.into_iter().zip(counters), |(part, mut counter)| {
        part.blocks.into_iter().map(|block| pass.block(block, offsets, &mut counter)).collect::<Vec<_>>()
    });
    Tally::total(tallies.into_iter().flatten())
}

impl<V: Vector, R: Restitution> GasPass<'_, V, R> {
    fn block(&self, mut block: Block<'_, V>, offsets: &[u32], counter: &mut Counter<'_>) -> Tally<V> {
        let mut tally = Tally::default();
        self.collisions.collide(&mut block, offsets, &mut tally, |displaced, positions| {
            self.displace(displaced, positions)
        });
        self.advect(&mut block, &mut tally, counter);
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
    fn advect(&self, block: &mut Block<'_, V>, tally: &mut Tally<V>, counter: &mut Counter<'_>) {
        let rows = block.ids.len();
        let (positions, velocities) = (&mut block.positions[..rows], &mut block.velocities[..rows]);
        let targets = &mut block.targets[..rows];
        let mut speeds = Speeds::default();
        for row in 0..rows {
            let (position, velocity) = self.flights.free(positions[row], velocities[row]);
            if self.flights.is_free(position) {
                (positions[row], velocities[row]) = (position, velocity);
                let target = self.flights.cell_inside(position);
                targets[row] = target;
                counter.add(target);
                // Not read back from the column, whose store would still be on its way.
                speeds.note(velocity);
            } else {
                let grain = (&mut positions[row], &mut velocities[row], block.ids[row]);
                targets[row] = self.flights.meet_the_edge(grain, &mut tally.counts);
                counter.add(targets[row]);
                speeds.note(velocities[row]);
            }
        }
        tally.speeds.add(&speeds);
    }
}
