//! When a run ends.

use super::pouring::Pouring;
use crate::engine::report::Totals;
use crate::matter::gas::Gas;
use crate::scenario::model::{RunLimits, Scenario};
use crate::space::Vector;

/// Why a run has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndReason {
    /// `run.time` is reached.
    Time,
    /// `run.steps` is reached.
    Steps,
    /// `run.collisions_per_particle` is reached.
    CollisionsPerParticle,
    /// `run.rest` has passed since the last poured grain.
    Rest,
    /// All grains have left, and none will come.
    Empty,
}

impl EndReason {
    /// The word for summaries.
    pub fn name(self) -> &'static str {
        match self {
            EndReason::Time => "time",
            EndReason::Steps => "steps",
            EndReason::CollisionsPerParticle => "collisions_per_particle",
            EndReason::Rest => "rest",
            EndReason::Empty => "empty",
        }
    }
}

/// The limits of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    run: RunLimits,
    /// When the last grain is poured if nothing blocks the source [time].
    pouring_time: f64,
}

impl Limits {
    /// The limits of `scenario`.
    pub fn new<V: Vector>(scenario: &Scenario<V>) -> Self {
        let pouring_time = scenario
            .source
            .as_ref()
            .map_or(0.0, |source| f64::from(source.count.saturating_sub(1)) / source.rate);
        Limits { run: scenario.run, pouring_time }
    }

    /// The first limit that is reached, if any.
    pub fn end_reason<V: Vector>(
        &self,
        gas: &Gas<V>,
        totals: &Totals<V>,
        pouring: Option<&Pouring<V>>,
    ) -> Option<EndReason> {
        let time = gas.time();
        let pouring_done = pouring.is_none_or(Pouring::is_done);
        let rested = |rest: f64| pouring_done && time >= pouring.map_or(0.0, Pouring::last_poured) + rest;
        if self.run.time.is_some_and(|limit| time >= limit) {
            Some(EndReason::Time)
        } else if self.run.steps.is_some_and(|limit| totals.steps >= limit) {
            Some(EndReason::Steps)
        } else if self
            .run
            .collisions_per_particle
            .is_some_and(|limit| totals.collisions_per_particle >= limit)
        {
            Some(EndReason::CollisionsPerParticle)
        } else if self.run.rest.is_some_and(rested) {
            Some(EndReason::Rest)
        } else if gas.is_empty() && pouring_done {
            Some(EndReason::Empty)
        } else {
            None
        }
    }

    /// How much of the run is done, in [0, 1], by the limit that is nearest.
    pub fn progress<V: Vector>(&self, time: f64, totals: &Totals<V>, pouring: Option<&Pouring<V>>) -> f64 {
        let share = |done: f64, limit: Option<f64>| limit.map_or(0.0, |limit| done / limit);
        let last_poured = pouring.map_or(0.0, Pouring::last_poured).max(self.pouring_time);
        let waiting = pouring.is_some_and(|pouring| !pouring.is_done());
        // A source that is held up moves the end: its share of the run is then not yet done.
        let rest =
            self.run.rest.map(|rest| if waiting { last_poured.max(time) + rest } else { last_poured + rest });
        let shares = [
            share(time, self.run.time),
            share(totals.steps as f64, self.run.steps.map(|steps| steps as f64)),
            share(totals.collisions_per_particle, self.run.collisions_per_particle),
            share(time, rest),
        ];
        shares.into_iter().fold(0.0, f64::max).min(1.0)
    }
}
