//! Grains that nothing moves against each other, and sources that pour faster than grains get away.

use crate::law::boundary::WallKind;
use crate::law::source::Source;
use crate::scenario::bound::rounded;
use crate::scenario::consistency::fall_alike;
use crate::scenario::model::{InitialVelocities, Scenario};
use crate::scenario::pace::rounded_down;
use crate::space::Vector;

/// With fewer grains than these in the reach of a wall there may be none: a chance of e⁻⁵.
const SURELY_REACHED: f64 = 5.0;

/// Grains that begin at rest, and that nothing moves against each other.
pub(super) fn dead<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let at_rest = scenario.initial.velocities == InitialVelocities::Rest
        && !scenario.initial.positions.is_log()
        && scenario.source.is_none();
    if !at_rest {
        return None;
    }
    if fall_alike(scenario.gravity, &scenario.boundary) {
        return Some(
            "all grains begin at rest and fall alike along a periodic axis: none ever collides; write \
             initial.velocities = { maxwell = 1.0 }"
                .to_owned(),
        );
    }
    let reached = grains_reached(scenario);
    (scenario.gravity == V::ZERO && reached < SURELY_REACHED).then(|| {
        format!(
            "all grains begin at rest, and about {} of them in the reach of a vibrating wall: where it reaches none, nothing ever \
             moves; give initial.velocities or a larger amplitude",
            rounded(reached)
        )
    })
}

/// Grains that begin where a vibrating wall comes, on an average.
fn grains_reached<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let share = |axis: usize, kind: WallKind<V>| match kind {
        WallKind::Vibrating { amplitude, .. } => amplitude / scenario.size[axis],
        _ => 0.0,
    };
    let shares: f64 = scenario.boundary.walls().map(|(axis, _, wall)| share(axis, wall.kind)).sum();
    f64::from(scenario.count) * shares.min(1.0)
}

/// A source that lets out grains faster than they get away from it.
pub(super) fn pouring<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let source = scenario.source.as_ref()?;
    let most = fastest_of_hard_grains(scenario, source);
    (scenario.engine.kind.is_event_driven() && source.rate > most).then(|| {
        format!(
            "event-driven cannot pour {} grains per time: it puts a grain where none is, and the last one has to fall by a diameter \
             before, so that the spout lets out about {}; the others wait, and the pouring lasts longer than \
             source.count/source.rate. A source.rate of {} or less, a larger source.width, or a source.velocity along gravity keeps it",
            rounded(source.rate),
            rounded(most),
            rounded_down(most)
        )
    })
}

/// Grains per time that leave a spout when each has to be a diameter away before the next one comes in its place.
fn fastest_of_hard_grains<V: Vector>(scenario: &Scenario<V>, source: &Source<V>) -> f64 {
    let diameter = scenario.grain.diameter;
    let beside = (source.width / diameter).max(1.0).powi(V::DIMENSION as i32 - 1);
    beside / source.time_to_fall(scenario.gravity, diameter)
}
