//! What exact dynamics would take in place of a stochastic engine, and with which cure of collapse.

use super::collapse;
use super::cost;
use super::estimate::Estimate;
use super::model::{Cure, EngineKind, RunLimits, Scenario};
use crate::space::Vector;

/// Up to so many grains exact dynamics is worth a thought whatever the engine.
const MOST_GRAINS: f64 = 1e5;
/// Exact dynamics takes about as long where it takes at most so many times as long.
const ABOUT_AS_LONG: f64 = 3.0;

/// A wait that a better result is worth whatever the engine takes [s].
const WORTH_THE_WAIT: f64 = 600.0;

/// Exact dynamics in place of the engine of a scenario.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proposal {
    /// The cure that it needs beside what the scenario has.
    pub(super) cure: Option<Cure>,
    /// Seconds on one core.
    pub(super) seconds: Estimate,
    /// Whether that is about as long as the engine of the scenario takes.
    pub(super) is_as_fast: bool,
}

impl Proposal {
    /// Whether to take it where the engine is known to be wrong.
    pub(super) fn is_worth_it(&self) -> bool {
        self.is_as_fast || self.seconds.most <= WORTH_THE_WAIT
    }

    /// The options of the command line.
    pub(super) fn options(&self) -> String {
        let cure = self.cure.map(|cure| format!(" --set 'engine.event_driven.collapse={cure}'"));
        format!("--engine event-driven{}", cure.unwrap_or_default())
    }
}

/// Exact dynamics for `scenario`, where it can run that and does not run it anyway.
pub(super) fn proposal<V: Vector>(scenario: &Scenario<V>) -> Option<Proposal> {
    let RunLimits { time, collisions_per_particle, rest, .. } = scenario.run;
    let ends = time.is_some() || collisions_per_particle.is_some() || rest.is_some();
    let grains = cost::final_grains(scenario);
    let fits = scenario.volume_fraction() < V::RANDOM_CLOSE_PACKING && grains <= MOST_GRAINS;
    if scenario.engine.kind.is_event_driven() || !ends || !fits || scenario.initial.positions.is_log() {
        return None;
    }
    let mut exact = scenario.clone();
    exact.engine.kind = EngineKind::EventDriven;
    let cure = collapse::needed(&exact);
    if let Some(cure) = cure {
        exact.engine.event_driven.cure = cure;
    }
    let seconds = cost::seconds(&exact)?;
    let usual = cost::seconds(scenario)?;
    let is_as_fast = seconds.most <= ABOUT_AS_LONG * usual.most.max(1.0);
    Some(Proposal { cure, seconds, is_as_fast })
}
