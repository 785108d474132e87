//! Grains that nothing moves against each other, and sources that pour faster than grains get away.

use crate::law::boundary::WallKind;
use crate::law::source::Source;
use crate::scenario::bound::rounded;
use crate::scenario::consistency::fall_alike;
use crate::scenario::model::{EngineKind, InitialVelocities, Scenario};
use crate::scenario::pace::rounded_down;
use crate::space::Vector;

/// With fewer grains than these in the reach of a wall there may be none: a chance of e⁻⁵.
const SURELY_REACHED: f64 = 5.0;
/// Grains that a spout of one diameter lets out side by side.
const SIDE_BY_SIDE: f64 = 1.0;

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
    let (most, reason) = match scenario.engine.kind {
        EngineKind::EventDriven => (
            fastest_of_hard_grains(scenario, source),
            "a grain is put where none is, and the last one has to fall by a diameter before",
        ),
        EngineKind::Hsmc => (
            fastest_into_cells(scenario, source),
            "no grain is put into a full cell, and those in it have to fall out of it before",
        ),
        EngineKind::Dsmc | EngineKind::Cba => return None,
    };
    (source.rate > most).then(|| {
        format!(
            "the source pours {} grains per time, and its spout lets out about {} at most: {reason}; the others wait, so the pouring \
             lasts longer than source.count/source.rate. source.rate = {} or less, a larger source.width or a source.velocity along \
             gravity keep it; {} grains are on their way to a floor {} below the spout at the rate asked for",
            rounded(source.rate),
            rounded(most),
            rounded_down(most),
            rounded(source.in_flight(scenario.gravity, source.height)),
            rounded(source.height)
        )
    })
}

/// Grains per time that leave a spout when each has to be a diameter away before the next one comes in its place.
fn fastest_of_hard_grains<V: Vector>(scenario: &Scenario<V>, source: &Source<V>) -> f64 {
    let diameter = scenario.grain.diameter;
    let beside = (SIDE_BY_SIDE.max(source.width / diameter)).powi(V::DIMENSION as i32 - 1);
    beside / source.time_to_fall(scenario.gravity, diameter)
}

/// Grains per time that pass through the cells below a spout, where grains are slowest, while these are not full.
fn fastest_into_cells<V: Vector>(scenario: &Scenario<V>, source: &Source<V>) -> f64 {
    let side = scenario.grid().side();
    let gravity = scenario.gravity;
    let axis = (0..V::DIMENSION).find(|&axis| gravity[axis] != 0.0).unwrap_or(0);
    let beside: f64 = (0..V::DIMENSION)
        .filter(|&other| other != axis)
        .map(|other| (source.width / side[other]).max(1.0))
        .product();
    let capacity = scenario.capacity().map_or(f64::INFINITY, f64::from);
    // Half of a cell on an average: the spout stands anywhere in its cell.
    beside * capacity / source.time_to_fall(gravity, 0.5 * side[axis])
}
