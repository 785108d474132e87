//! When a run ends.

use super::pouring::Pouring;
use super::schedule::{Due, first_time};
use crate::engine::Horizon;
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

    /// The first limit that is reached, if any. Exactly reached: fixed steps that add up to a limit but for rounding are followed
    /// by one more, and the final state of a run is that of its last step.
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
        let rest = self.run.rest.map(|rest| self.end_of_rest(rest, time, pouring));
        let shares = [
            share(time, self.run.time),
            share(totals.steps as f64, self.run.steps.map(|steps| steps as f64)),
            share(totals.collisions_per_particle, self.run.collisions_per_particle),
            share(time, rest),
        ];
        shares.into_iter().fold(0.0, f64::max).min(1.0)
    }

    /// When a rest of that length will be over, as far as `time` can tell [time].
    fn end_of_rest<V: Vector>(&self, rest: f64, time: f64, pouring: Option<&Pouring<V>>) -> f64 {
        let last_poured = self.last_pour(pouring);
        let waiting = pouring.is_some_and(|pouring| !pouring.is_done());
        // A source that is held up moves the end: its share of the run is then not yet done.
        if waiting { last_poured.max(time) + rest } else { last_poured + rest }
    }

    /// When the last grain was poured, or will be if nothing blocks the source [time].
    fn last_pour<V: Vector>(&self, pouring: Option<&Pouring<V>>) -> f64 {
        pouring.map_or(0.0, Pouring::last_poured).max(self.pouring_time)
    }

    /// Where something that is `due` comes at the latest.
    pub fn horizon<V: Vector>(
        &self,
        due: Due,
        gas: &Gas<V>,
        totals: &Totals<V>,
        pouring: Option<&Pouring<V>>,
    ) -> Horizon {
        match due {
            Due::Never => Horizon::NONE,
            Due::Time(time) => Horizon { time, ..Horizon::NONE },
            Due::Progress(place) => {
                let reach = |limit: f64| {
                    totals.collisions_until(gas.len(), place * limit, |done| done / limit >= place)
                };
                Horizon {
                    time: self.time_of(place, gas.time(), pouring),
                    collisions: self.run.collisions_per_particle.map_or(u64::MAX, reach),
                }
            }
        }
    }

    /// Where the run ends at the latest.
    pub fn end<V: Vector>(&self, gas: &Gas<V>, totals: &Totals<V>, pouring: Option<&Pouring<V>>) -> Horizon {
        let rested = self.run.rest.filter(|_| pouring.is_none_or(Pouring::is_done));
        let end_of_rest = rested.map(|rest| pouring.map_or(0.0, Pouring::last_poured) + rest);
        let reach = |limit: f64| totals.collisions_until(gas.len(), limit, |done| done >= limit);
        Horizon {
            time: self.run.time.unwrap_or(f64::INFINITY).min(end_of_rest.unwrap_or(f64::INFINITY)),
            collisions: self.run.collisions_per_particle.map_or(u64::MAX, reach),
        }
    }

    /// When time alone brings the progress to `place` [time].
    fn time_of<V: Vector>(&self, place: f64, now: f64, pouring: Option<&Pouring<V>>) -> f64 {
        let reach = |limit: f64| first_time(place * limit, |time| time / limit >= place);
        let by_time = self.run.time.map_or(f64::INFINITY, reach);
        let by_rest = self.run.rest.map_or(f64::INFINITY, |rest| {
            if pouring.is_none_or(Pouring::is_done) {
                return reach(self.end_of_rest(rest, now, pouring));
            }
            let waiting = self.time_while_waiting(place, rest, pouring);
            // The grain that comes now may be the last one, and from then on the end is known.
            let poured = reach(self.end_of_rest(rest, now, pouring));
            let comes_now = pouring.is_some_and(|pouring| pouring.next_time() <= Some(now));
            if comes_now && poured > now { poured.min(waiting) } else { waiting }
        });
        by_time.min(by_rest)
    }

    /// When the progress by rest comes to `place` if the source waits until then [time].
    fn time_while_waiting<V: Vector>(&self, place: f64, rest: f64, pouring: Option<&Pouring<V>>) -> f64 {
        let last_pour = self.last_pour(pouring);
        let estimate = match place * (last_pour + rest) {
            planned if planned <= last_pour => planned,
            _ if place < 1.0 => last_pour.max(place * rest / (1.0 - place)),
            _ => f64::INFINITY,
        };
        first_time(estimate, |time| time / self.end_of_rest(rest, time, pouring) >= place)
    }
}
