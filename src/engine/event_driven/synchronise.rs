//! The gas as others see it: copies of all grains at one time. The grains themselves are not touched.

use super::body::NONE;
use super::world::World;
use crate::engine::EngineError;
use crate::matter::clock::Clock;
use crate::matter::gas::{Gas, SortSpace};
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
        let columns = &mut space.spare;
        columns.positions.clear();
        columns.velocities.clear();
        columns.ids.clear();
        space.cells.clear();
        let present = |row: &usize| self.plans[*row].cell != NONE;
        let mut speeds = 0.0;
        for row in (0..self.bodies.len()).filter(present) {
            let body = &self.bodies[row];
            let (mut position, velocity) =
                (body.position_at(now, self.laws.gravity), body.velocity_at(now, self.laws.gravity));
            (0..V::DIMENSION).for_each(|axis| gas.grid().wrap(&mut position, axis));
            speeds += velocity.length_squared() + position.length_squared();
            columns.positions.push(position);
            columns.velocities.push(velocity);
            columns.ids.push(self.ids[row]);
            space.cells.push(gas.grid().cell_of(position));
        }
        let rows = || (0..self.bodies.len()).filter(present);
        columns.spins = self.spins.as_ref().map(|spins| rows().map(|row| spins[row]).collect());
        columns.species = self.species.as_ref().map(|species| rows().map(|row| species[row]).collect());
        if !speeds.is_finite() {
            return Err(self.not_finite(now, space));
        }
        gas.parts_mut().2.match_shape(&space.spare);
        gas.sort_from_spare(space);
        Ok(())
    }

    /// Names the first grain that is not where a number can say.
    fn not_finite(&self, now: f64, space: &SortSpace<V>) -> EngineError {
        let columns = &space.spare;
        let lost =
            |row: &usize| !(columns.positions[*row].is_finite() && columns.velocities[*row].is_finite());
        let row = (0..columns.len()).find(lost).unwrap_or(0);
        EngineError::NotFinite {
            id: columns.ids[row],
            cell: space.cells[row],
            step: 0,
            seed: self.laws.seed,
            time: self.origin.time() + now,
        }
    }
}
