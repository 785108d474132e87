//! The gas as others see it: copies of all grains at one time. The grains themselves are not touched.

use rayon::prelude::*;

use super::body::NONE;
use super::world::World;
use crate::engine::EngineError;
use crate::matter::clock::Clock;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::grid::Grid;
use crate::matter::scatter::Labels;
use crate::matter::sort::REMOVED;
use crate::space::Vector;

/// Grains that a thread looks at, at a time.
const SPAN: usize = 4096;

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
        let grid = gas.grid();
        space.cells.resize(self.bodies.len(), REMOVED);
        let lost =
            space.cells.par_iter_mut().zip(0..self.bodies.len()).with_min_len(SPAN).map(|(cell, row)| {
                if self.plans[row].cell == NONE {
                    *cell = REMOVED;
                    return None;
                }
                let (position, velocity) = self.seen(row, now, grid);
                *cell = grid.cell_of(position);
                (!(position.is_finite() && velocity.is_finite())).then_some(row)
            });
        // The first one, whoever finds it.
        if let Some(row) = lost.flatten().min() {
            return Err(self.not_finite(row, space.cells[row], now));
        }
        let labels = Labels { spins: self.spins.as_deref(), species: self.species.as_deref() };
        gas.refill(space, labels, |grid, row| {
            let (position, velocity) = self.seen(row, now, grid);
            (position, velocity, self.ids[row])
        });
        Ok(())
    }

    /// Position in the box and velocity of the grain in `row`, `now` after the origin of time.
    #[inline]
    fn seen(&self, row: usize, now: f64, grid: &Grid<V>) -> (V, V) {
        let body = &self.bodies[row];
        let mut position = body.position_at(now, self.laws.gravity);
        for axis in 0..V::DIMENSION {
            grid.wrap(&mut position, axis);
        }
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
