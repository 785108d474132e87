//! One event-driven run, watched for impact parameters and for entries into cells.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::CalibrationError;
use super::entries::{Before, Entries};
use super::stages::{Slice, end_of_slice};
use crate::engine::{Horizon, NoLaps};
use crate::matter::gas::Gas;
use crate::run::{Status, initial_gas, status};
use crate::scenario::model::{Scenario, TimeStep};
use crate::simulation::Simulation;
use crate::space::Vector;

/// What one run has shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Replica {
    pub(super) slices: Vec<Slice>,
    pub(super) entries: Entries,
}

/// A run on its way.
struct Watched<'a, V: Vector> {
    simulation: Simulation<'a, V>,
    stop: &'a AtomicBool,
    tell: &'a (dyn Fn(Status) + Sync),
}

/// Runs `exact`, an event-driven scenario, to its end; `stochastic` says which cells and which steps entries are
/// counted for. At the beginning of every slice of collisions one such step is looked at.
pub(super) fn watch<V: Vector>(
    exact: &Scenario<V>,
    stochastic: &Scenario<V>,
    stop: &AtomicBool,
    tell: &(dyn Fn(Status) + Sync),
) -> Result<Replica, CalibrationError> {
    let gas = initial_gas(exact)?;
    let simulation = Simulation::start(exact, gas, &mut NoLaps)?;
    let mut watched = Watched { simulation, stop, tell };
    let grid = stochastic.grid();
    let mut replica = Replica::default();
    while !watched.is_over() {
        let totals = watched.simulation.totals();
        let (from, impacts) = (totals.collisions_per_particle, totals.events.impacts);
        if let Some(step) = step(stochastic, watched.simulation.gas()) {
            let before = Before::of(watched.simulation.gas());
            if watched.advance(step)? {
                before.count(watched.simulation.gas(), &grid, exact.gravity, &mut replica.entries);
            }
        }
        watched.finish_slice(end_of_slice(from))?;
        let totals = watched.simulation.totals();
        let mut slice =
            Slice { stretch: [from, totals.collisions_per_particle], impacts: totals.events.impacts };
        slice.impacts.iter_mut().zip(impacts).for_each(|(now, before)| *now -= before);
        replica.slices.push(slice);
    }
    if stop.load(Relaxed) { Err(CalibrationError::Interrupted) } else { Ok(replica) }
}

impl<V: Vector> Watched<'_, V> {
    fn is_over(&self) -> bool {
        self.simulation.end_reason().is_some() || self.stop.load(Relaxed)
    }

    /// Goes on until `horizon` comes, and says whether it came: the run may end before.
    fn advance(&mut self, horizon: Horizon) -> Result<bool, CalibrationError> {
        let goal = self.simulation.totals().counts.collisions.saturating_add(horizon.collisions);
        loop {
            let collisions = self.simulation.totals().counts.collisions;
            if self.simulation.gas().time() >= horizon.time || collisions >= goal {
                return Ok(true);
            }
            if self.is_over() {
                return Ok(false);
            }
            self.simulation.advance(&mut NoLaps, Horizon { collisions: goal - collisions, ..horizon })?;
            (self.tell)(status(&self.simulation));
        }
    }

    /// Goes on until so many `collisions_per_particle` are reached. Where grains hardly meet the run goes on to its end.
    fn finish_slice(&mut self, collisions_per_particle: f64) -> Result<(), CalibrationError> {
        loop {
            let (totals, grains) = (self.simulation.totals(), self.simulation.gas().len());
            if totals.collisions_per_particle >= collisions_per_particle || self.is_over() {
                return Ok(());
            }
            let goal = collisions_per_particle;
            let collisions = totals.collisions_until(grains, goal, |done| done >= goal);
            self.simulation.advance(&mut NoLaps, Horizon { collisions, ..Horizon::NONE })?;
            (self.tell)(status(&self.simulation));
        }
    }
}

/// Where a step of the stochastic scenario that begins with `gas` would end; `None` where nothing moves.
///
/// An adaptive step keeps the cap ½ min(L/v, √(2L/|g|)), v the largest speed of a grain or wall; collisions per
/// particle are counted, not expected.
fn step<V: Vector>(scenario: &Scenario<V>, gas: &Gas<V>) -> Option<Horizon> {
    let speeds = gas.velocities().iter().map(|velocity| velocity.length());
    let fastest = speeds.fold(scenario.boundary.largest_wall_speed(), f64::max);
    let side = scenario.grid().shortest_side();
    let crossing = (side / fastest).min((2.0 * side / scenario.gravity.length()).sqrt());
    if gas.is_empty() || !crossing.is_finite() {
        return None;
    }
    let plan = scenario.engine.time_step;
    let cap = plan.largest_crossing() * crossing;
    let (duration, collisions) = match plan {
        TimeStep::Fixed(duration) => (duration, u64::MAX),
        TimeStep::Crossing(share) => (cap.min(share * side / fastest), u64::MAX),
        TimeStep::CollisionsPerParticle(number) => {
            (cap, (0.5 * number * gas.len() as f64).round().max(1.0) as u64)
        }
    };
    Some(Horizon { time: gas.time() + duration, collisions })
}
