//! What a run will cost, roughly: steps, memory, size of the log.

use super::initial::stated_temperature;
use super::model::{EngineKind, RunLimits, Scenario, Spacing, TimeStep};
use crate::law::boundary::WallKind;
use crate::law::kinetic_theory::{collision_frequency, cooling_per_collision, haff_time};
use crate::space::Vector;

/// Grains advanced by one step per second on one core, a cautious figure.
const PARTICLE_STEPS_PER_SECOND: f64 = 1e7;

/// What kinetic theory says about the initial state; `None` where grains are at rest or none are there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Collisions per grain and time [1/time].
    pub(super) collision_frequency: f64,
    /// Haff's time; `None` for elastic grains [time].
    pub(super) haff_time: Option<f64>,
}

/// The Enskog factor that the engine works with.
pub(super) fn contact_correlation<V: Vector>(scenario: &Scenario<V>) -> f64 {
    match scenario.engine.kind {
        EngineKind::Dsmc => 1.0,
        EngineKind::Cba | EngineKind::Hsmc => V::contact_correlation(scenario.volume_fraction()),
    }
}

pub(super) fn rates<V: Vector>(scenario: &Scenario<V>) -> Option<Rates> {
    let temperature = stated_temperature(scenario);
    if temperature == 0.0 || scenario.count < 2 {
        return None;
    }
    let (nu, correlation) = (scenario.volume_fraction(), contact_correlation(scenario));
    let collision_frequency = collision_frequency::<V>(scenario.grain, nu, temperature, correlation);
    let restitution = scenario.restitution.typical();
    let haff_time = (restitution < 1.0).then(|| haff_time::<V>(restitution, collision_frequency));
    Some(Rates { collision_frequency, haff_time })
}

/// The first step [time], as near as it can be told without the grains.
pub(super) fn first_step<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let speed = largest_speed(scenario);
    let cell = scenario.grid().shortest_side();
    let chosen = match scenario.engine.time_step {
        TimeStep::Fixed(step) => return Some(step),
        TimeStep::CollisionsPerParticle(collisions) => {
            rates(scenario).map(|rates| collisions / rates.collision_frequency)
        }
        TimeStep::Crossing(fraction) => (speed > 0.0).then(|| fraction * cell / speed),
    };
    let gravity = scenario.gravity.length();
    let bounded = scenario.engine.kind == EngineKind::Hsmc
        || gravity > 0.0
        || scenario.boundary.walls().next().is_some();
    let crossing = (bounded && speed > 0.0).then(|| 0.5 * cell / speed);
    let fall = (gravity > 0.0).then(|| 0.5 * (2.0 * cell / gravity).sqrt());
    [chosen, crossing, fall].into_iter().flatten().reduce(f64::min)
}

/// The largest speed to be expected of the initial grains, and of the walls [length/time].
fn largest_speed<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let thermal = (stated_temperature(scenario) / scenario.grain.mass).sqrt();
    let tail = (2.0 * f64::from(scenario.count.max(2)).ln()).sqrt();
    (thermal * tail).max(scenario.boundary.largest_wall_speed())
}

/// Steps until the first limit, supposing the first step's length throughout.
pub(super) fn steps<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let RunLimits { time, steps, collisions_per_particle, rest } = scenario.run;
    let step = first_step(scenario)?;
    let rates = rates(scenario);
    let per_step = match scenario.engine.time_step {
        TimeStep::CollisionsPerParticle(collisions) => {
            rates.map(|r| collisions.min(step * r.collision_frequency))
        }
        _ => rates.map(|rates| step * rates.collision_frequency),
    };
    let poured = scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count) / source.rate);
    let by_time = time.map(|time| match (scenario.engine.time_step, per_step, rates) {
        (TimeStep::CollisionsPerParticle(_), Some(per_step), Some(rates)) if cools(scenario) => {
            collisions_until(scenario, time, rates) / per_step
        }
        _ => time / step,
    });
    let by_collisions = collisions_per_particle.and_then(|limit| per_step.map(|per_step| limit / per_step));
    let by_rest = rest.map(|rest| (poured + rest) / step);
    [by_time, steps.map(|steps| steps as f64), by_collisions, by_rest].into_iter().flatten().reduce(f64::min)
}

/// Whether nothing feeds the gas: Haff's law then tells how steps grow.
fn cools<V: Vector>(scenario: &Scenario<V>) -> bool {
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

/// Seconds on one core.
pub(super) fn seconds<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    // While a source pours, half of its grains are there on average.
    let poured = scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count));
    let mean = f64::from(scenario.count) + 0.5 * poured;
    steps(scenario).map(|steps| steps * mean / PARTICLE_STEPS_PER_SECOND)
}

/// Bytes of one grain's full-precision state.
fn grain_bytes<V: Vector>() -> f64 {
    (2 * 8 * V::DIMENSION + 4) as f64
}

fn most_grains<V: Vector>(scenario: &Scenario<V>) -> f64 {
    f64::from(scenario.count) + scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count))
}

/// Memory of the grains, twice over for sorting, and of the cells [bytes].
pub(super) fn memory<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let cells = scenario.grid().number_of_cells() as f64;
    most_grains(scenario) * (2.0 * grain_bytes::<V>() + 24.0) + cells * 160.0
}

/// Size of the log before compression [bytes].
pub(super) fn log_size<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let recordings = match (scenario.record.spacing, scenario.run.time) {
        (Spacing::Frames(frames) | Spacing::LogFrames(frames), _) => f64::from(frames) + 1.0,
        (Spacing::Every(every), Some(time)) => (time / every).ceil() + 1.0,
        (Spacing::Every(every), None) => {
            let step = first_step(scenario).unwrap_or(0.0);
            (steps(scenario).unwrap_or(0.0) * step / every).ceil() + 1.0
        }
        (Spacing::Ends, _) => 2.0,
    };
    let grains = most_grains(scenario);
    let points = scenario.record.points.map_or(grains, |points| f64::from(points).min(grains));
    let states = f64::from(scenario.record.states) + 1.0;
    recordings * (24.0 * points + 4096.0) + states * grains * grain_bytes::<V>()
}
