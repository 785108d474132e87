//! What kinetic theory says about a run: collisions, first step, number of steps.

mod settled;

use super::cost::settles;
use super::initial::stated_temperature;
use super::model::{EngineKind, RunLimits, Scenario, TimeStep};
use super::pace::{falling_speed, falls_for_ever, longest_step, starting_speed};
use crate::law::boundary::WallKind;
use crate::law::kinetic_theory::{self, collision_frequency, cooling_per_collision, haff_time};
use crate::law::mixture::Mixture;
use crate::space::Vector;

/// What a logarithm of the energy falls by until flow is all that is left of it, about.
const FLOW_ALONE: f64 = 28.0;

/// What kinetic theory says about the initial state; `None` where grains are at rest or none are there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Collisions per grain and time [1/time].
    pub(super) collision_frequency: f64,
    /// Haff's time; `None` for elastic grains [time].
    pub(super) haff_time: Option<f64>,
}

/// An estimate between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) least: f64,
    pub(super) most: f64,
    /// Whether `most` may well be exceeded.
    pub(super) open: bool,
}

/// The Enskog factor that the engine works with.
pub(super) fn contact_correlation<V: Vector>(scenario: &Scenario<V>) -> f64 {
    match scenario.engine.kind {
        EngineKind::Dsmc => 1.0,
        EngineKind::Cba | EngineKind::Hsmc | EngineKind::EventDriven => {
            V::contact_correlation(scenario.volume_fraction())
        }
    }
}

/// The species of the start, where there are several.
fn mixture<V: Vector>(scenario: &Scenario<V>) -> Option<Mixture> {
    (!scenario.species.is_empty()).then(|| Mixture::new(scenario.constituents(), scenario.size.product()))
}

/// Mean free path at the start [length]; `None` without grains, and of mixtures too dense for what is known of them.
pub(super) fn mean_free_path<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let path = || match mixture(scenario) {
        Some(mixture) => mixture.mean_free_path::<V>(),
        None => kinetic_theory::mean_free_path::<V>(scenario.grain, scenario.volume_fraction()),
    };
    (scenario.count > 0 && is_within_theory(scenario)).then(path)
}

/// Whether contact values are those of a fluid; of dense gases of one kind the formula is a bound to the right side still.
pub(super) fn is_within_theory<V: Vector>(scenario: &Scenario<V>) -> bool {
    scenario.species.is_empty() || scenario.volume_fraction() < V::FREEZING
}

pub(super) fn rates<V: Vector>(scenario: &Scenario<V>) -> Option<Rates> {
    let temperature = stated_temperature(scenario);
    if temperature == 0.0 || scenario.count < 2 {
        return None;
    }
    let collision_frequency = match mixture(scenario) {
        Some(mixture) => mixture.collision_frequency::<V>(temperature),
        None => {
            let (nu, correlation) = (scenario.volume_fraction(), contact_correlation(scenario));
            collision_frequency::<V>(scenario.grain, nu, temperature, correlation)
        }
    };
    // While all species have one temperature a collision takes (1 − r²) T of the energy, whatever the masses.
    let restitution = scenario.restitution.typical();
    let haff_time = (restitution < 1.0).then(|| haff_time::<V>(restitution, collision_frequency));
    Some(Rates { collision_frequency, haff_time })
}

/// The first step [time], as near as it can be told without the grains.
pub(super) fn first_step<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    step_at(scenario, starting_speed(scenario))
}

/// A step while the largest speed is `speed` [time].
fn step_at<V: Vector>(scenario: &Scenario<V>, speed: f64) -> Option<f64> {
    let chosen = match scenario.engine.time_step {
        TimeStep::Fixed(step) => return Some(step),
        TimeStep::CollisionsPerParticle(collisions) => {
            rates(scenario).map(|rates| collisions / rates.collision_frequency)
        }
        TimeStep::Crossing(fraction) => {
            (speed > 0.0).then(|| fraction * scenario.grid().shortest_side() / speed)
        }
    };
    let longest = longest_step(scenario, speed);
    [chosen, Some(longest)].into_iter().flatten().reduce(f64::min).filter(|step| step.is_finite())
}

/// A step of so many collisions per particle that is capped however the gas cools: what it would last, and what the
/// cap allows [time]. Both go with 1/√T, so that this is told from the start.
pub(super) fn capped_step<V: Vector>(scenario: &Scenario<V>) -> Option<(f64, f64)> {
    let TimeStep::CollisionsPerParticle(collisions) = scenario.engine.time_step else { return None };
    if scenario.engine.kind.is_event_driven() || scenario.gravity != V::ZERO {
        return None;
    }
    let chosen = collisions / rates(scenario)?.collision_frequency;
    let longest = longest_step(scenario, starting_speed(scenario));
    (chosen > longest).then_some((chosen, longest))
}

/// Collisions of an event-driven run until its first limit, those of its equilibration included; `None` for
/// engines with steps, and where grains begin at rest without coming to lie.
pub(super) fn collisions<V: Vector>(scenario: &Scenario<V>) -> Option<Estimate> {
    if !scenario.engine.kind.is_event_driven() {
        return None;
    }
    if settles(scenario) {
        return settled::collisions(scenario);
    }
    let rates = rates(scenario)?;
    let RunLimits { time, collisions_per_particle, .. } = scenario.run;
    let by_time = time.or(resting_time(scenario)).map(|time| match cools(scenario) {
        true => collisions_until(scenario, time, rates),
        false => time * rates.collision_frequency,
    });
    let per_particle = [by_time, collisions_per_particle].into_iter().flatten().reduce(f64::min)?;
    let number = 0.5 * f64::from(scenario.count) * (per_particle + scenario.initial.equilibrate);
    // What drives a gas changes how often grains collide; the number asked for is met all the same.
    let open = by_time.is_some() && !cools(scenario);
    Some(Estimate { least: number, most: number, open })
}

/// How long a run of so many collisions per particle lasts, by the rates of the start [time].
pub(super) fn time_of_collisions<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let (limit, rates) = (scenario.run.collisions_per_particle?, rates(scenario)?);
    Some(if cools(scenario) { time_until(scenario, limit, rates) } else { limit / rates.collision_frequency })
}

/// Steps until the first limit, `None` for an engine without steps: with the speeds of the start, and with those that gravity gives.
pub(super) fn steps<V: Vector>(scenario: &Scenario<V>) -> Option<Estimate> {
    if scenario.engine.kind.is_event_driven() {
        return None;
    }
    let at_start = steps_at(scenario, starting_speed(scenario))?;
    if scenario.gravity == V::ZERO || matches!(scenario.engine.time_step, TimeStep::Fixed(_)) {
        let open = matches!(scenario.engine.time_step, TimeStep::CollisionsPerParticle(_))
            && flows_in_the_end(scenario);
        return Some(Estimate { least: at_start, most: at_start, open });
    }
    let falling = steps_at(scenario, falling_speed(scenario))?;
    if falls_for_ever(scenario) {
        return Some(Estimate { least: falling, most: falling, open: true });
    }
    // Grains that settle collide more often than those of the start.
    let open = matches!(scenario.engine.time_step, TimeStep::CollisionsPerParticle(_));
    Some(Estimate { least: at_start.min(falling), most: at_start.max(falling), open })
}

/// Whether a gas cools so far that grains which still move together no longer move apart: they collide less and less, and
/// steps are capped by how far they fly.
fn flows_in_the_end<V: Vector>(scenario: &Scenario<V>) -> bool {
    cools(scenario) && cooled(scenario).is_some_and(|cooled| 2.0 * cooled > FLOW_ALONE)
}

/// ln(1 + t/t₀) at the end of a run of a gas that cools, by Haff's law: half of the logarithm by which its energy falls. `None`
/// where nothing is lost.
pub(super) fn cooled<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let RunLimits { time, collisions_per_particle, .. } = scenario.run;
    let rates = rates(scenario)?;
    let haff_time = rates.haff_time?;
    let by_time = time.map(|time| (time / haff_time).ln_1p());
    let by_collisions = collisions_per_particle.map(|limit| limit / (rates.collision_frequency * haff_time));
    [by_time, by_collisions].into_iter().flatten().reduce(f64::min)
}

/// Steps until the first limit while the largest speed is `speed`, or cools down from it.
fn steps_at<V: Vector>(scenario: &Scenario<V>, speed: f64) -> Option<f64> {
    let RunLimits { time, steps, collisions_per_particle, .. } = scenario.run;
    let step = step_at(scenario, speed)?;
    let rates = rates(scenario);
    let per_step = rates.map(|rates| step * rates.collision_frequency);
    let cooling = rates.filter(|_| cools(scenario));
    let fixed = matches!(scenario.engine.time_step, TimeStep::Fixed(_));
    let by_time = time.map(|time| match (cooling, per_step) {
        (Some(rates), Some(per_step)) if !fixed => collisions_until(scenario, time, rates) / per_step,
        _ => time / step,
    });
    let by_collisions = collisions_per_particle.and_then(|limit| match cooling {
        Some(rates) if fixed => Some(time_until(scenario, limit, rates) / step),
        _ => per_step.map(|per_step| limit / per_step),
    });
    let by_rest = resting_time(scenario).map(|time| time / step);
    let limits = [by_time, steps.map(|steps| steps as f64), by_collisions, by_rest];
    limits.into_iter().flatten().reduce(f64::min).map(f64::ceil)
}

/// When `run.rest` is over if nothing blocks the source [time].
pub(super) fn resting_time<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let poured = scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count) / source.rate);
    scenario.run.rest.map(|rest| poured + rest)
}

/// Steps that elastic collisions before t = 0 take.
pub(super) fn steps_before_the_start<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let per_step = first_step(scenario).zip(rates(scenario)).map(|(step, r)| step * r.collision_frequency);
    per_step.map_or(0.0, |per_step| scenario.initial.equilibrate / per_step)
}

/// Whether nothing feeds the gas: Haff's law then tells how steps grow.
pub(super) fn cools<V: Vector>(scenario: &Scenario<V>) -> bool {
    scenario.gravity == V::ZERO
        && scenario.boundary.walls().all(|(_, _, wall)| match wall.kind {
            WallKind::Rough { velocity } => velocity == V::ZERO,
            WallKind::Vibrating { .. } => false,
            WallKind::Smooth | WallKind::Statistical { .. } => true,
        })
}

/// Collisions per particle until `time`: ln(1 + t/t₀)/γ₀.
fn collisions_until<V: Vector>(scenario: &Scenario<V>, time: f64, rates: Rates) -> f64 {
    match rates.haff_time {
        None => time * rates.collision_frequency,
        Some(haff_time) => {
            (time / haff_time).ln_1p() / cooling_per_collision::<V>(scenario.restitution.typical())
        }
    }
}

/// Time until so many collisions per particle: t₀ (exp(γ₀ τ) − 1).
fn time_until<V: Vector>(scenario: &Scenario<V>, collisions: f64, rates: Rates) -> f64 {
    match rates.haff_time {
        None => collisions / rates.collision_frequency,
        Some(haff_time) => {
            haff_time * (collisions * cooling_per_collision::<V>(scenario.restitution.typical())).exp_m1()
        }
    }
}
