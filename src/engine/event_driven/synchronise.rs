//! The gas as others see it: copies of all grains at one time. The grains themselves are not touched.

use super::body::NONE;
use super::world::World;
use crate::engine::EngineError;
use crate::matter::clock::Clock;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::grid::Grid;
use crate::matter::sort::REMOVED;
use crate::space::Vector;

impl<V: Vector> World<V> {
    /// Writes all grains to `gas` as they are at `time`, or now.
    pub(super) fn synchronise(
        &self,
        gas: &mut Gas<V>,
        time: Option<f64>,
        space: &mut SortSpace<V>,
    ) -> Result<(), EngineError> {
        let now = time.map_or(self.now, |time| self.since_origin(time));
        gas.clock = match time {
            Some(time) => Clock::restored(time, 0.0),
            None => {
                let mut clock = self.origin;
                clock.advance(now);
                clock
            }
        };
        space.cells.clear();
        for (row, plan) in self.plans.iter().enumerate() {
            if plan.cell == NONE {
                space.cells.push(REMOVED);
                continue;
            }
            let (position, velocity) = self.seen(row, now, gas.grid());
            let cell = gas.grid().cell_of(position);
            if !(position.is_finite() && velocity.is_finite()) {
                return Err(self.not_finite(row, cell, now));
            }
            space.cells.push(cell);
        }
        gas.refill(space, |grid, row| {
            let (position, velocity) = self.seen(row, now, grid);
            (position, velocity, self.ids[row])
        });
        gas.refill_labels(space, self.spins.as_deref(), self.species.as_deref());
        Ok(())
    }

    /// Position in the box and velocity of the grain in `row`, `now` after the origin of time.
    fn seen(&self, row: usize, now: f64, grid: &Grid<V>) -> (V, V) {
        let body = &self.bodies[row];
        let mut position = body.position_at(now, self.laws.gravity);
        (0..V::DIMENSION).for_each(|axis| grid.wrap(&mut position, axis));
        (position, body.velocity_at(now, self.laws.gravity))
    }

    fn not_finite(&self, row: usize, cell: u32, now: f64) -> EngineError {
        EngineError::NotFinite {
            id: self.ids[row],
            cell,
            step: 0,
            seed: self.laws.seed,
            time: self.origin.time() + now,
        }
    }
}
