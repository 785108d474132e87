//! How often grains collide that lie on each other, in exact dynamics with a cure of collapse.
//!
//! What lies under gravity carries what lies above it by collisions alone. Each hands over about m v, v the speed with which
//! grains bounce where they lie, so that a grain with the weight of B grains on it collides k g B/v times per time. Measured
//! in beds at rest, v the speed of the cure from 0.1 to 0.5 √(g d), r = 0.6 and 0.9: k = 6.7 … 11 in 2D (3 to 30 layers),
//! 11 … 14 in 3D (9 layers). Above a floor that vibrates at speeds up to V grains move at about √(V √(g d)): with that for v
//! k = 6 … 30 was measured (3D, 9 layers, V = 0.3 to 13 √(g d), r = 0.9 and 0.6; more for the lower r).

use super::{Estimate, resting_time};
use crate::engine::event_driven::rules::Cure;
use crate::scenario::cost;
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// k, at least and at most, in a plane and in space.
const COLLISIONS_UNDER_LOAD: [(f64, f64); 2] = [(6.5, 11.0), (11.0, 14.0)];
/// k of a bed above a vibrating floor, v being √(V √(g d)), at least and at most.
const COLLISIONS_WHEN_SHAKEN: (f64, f64) = (6.0, 30.0);
/// Matter that flows down a slope is heated, and collides less often than at rest, by up to this factor.
const HEATED_BY_FLOW: f64 = 5.0;
/// Slope of a heap, for its height.
const SLOPE: f64 = 0.3;
/// Mean of N times the load over the pouring, in those at its end: that of (t/T)^{3/2}.
const MEAN_OVER_THE_POURING: f64 = 0.4;

/// Collisions of pairs until the first limit where grains come to lie; `None` where nothing but an unknown cure is given.
pub(super) fn collisions<V: Vector>(scenario: &Scenario<V>) -> Option<Estimate> {
    let grains = cost::final_grains(scenario);
    let frequency = frequency(scenario, grains)?;
    let number = |frequency: f64| {
        let by_time = effective_time(scenario).map(|time| frequency * time);
        let limits = [by_time, scenario.run.collisions_per_particle];
        limits.into_iter().flatten().reduce(f64::min).map(|per_grain| 0.5 * grains * per_grain)
    };
    let (least, most) = frequency;
    // Between walls a packing may have next to no gaps: 20 disks side by side on 20 d collide ten times as often.
    let is_narrow = scenario.boundary.walls().count() > 2;
    Some(Estimate { least: number(least)?, most: number(most)?, open: is_narrow })
}

/// Collisions per grain and time when all `grains` lie, at least and at most [1/time].
fn frequency<V: Vector>(scenario: &Scenario<V>, grains: f64) -> Option<(f64, f64)> {
    let cure = scenario.engine.event_driven.cure;
    let diameter = scenario.largest_diameter();
    let tried = Cure::at_rest(scenario.gravity.length(), diameter);
    let slow = cure.elastic_below.or(tried.elastic_below.filter(|_| cure == Cure::default()))?;
    let axis = (0..V::DIMENSION).find(|&axis| cost::settles_along(scenario, axis))?;
    let fall = (scenario.gravity.length() * diameter).sqrt();
    let shaken = (scenario.boundary.largest_wall_speed() * fall).sqrt();
    let speed = slow.max(shaken);
    let load = scenario.gravity[axis].abs() * load(scenario, axis, grains) / speed;
    let is_tilted = (0..V::DIMENSION).any(|other| other != axis && scenario.gravity[other] != 0.0);
    let (least, most) =
        if shaken > 0.0 { COLLISIONS_WHEN_SHAKEN } else { COLLISIONS_UNDER_LOAD[V::DIMENSION - 2] };
    Some((least * load / if is_tilted { HEATED_BY_FLOW } else { 1.0 }, most * load))
}

/// Weight that a grain carries on an average, in grains: half of what stands on the floor per grain's width, or that of a heap.
fn load<V: Vector>(scenario: &Scenario<V>, axis: usize, grains: f64) -> f64 {
    let diameter = scenario.mean_grain().diameter;
    let floor = scenario.size.product() / scenario.size[axis] / diameter.powi(V::DIMENSION as i32 - 1);
    let bed = 0.5 * grains / floor;
    // What is poured onto one place lies higher than it would spread, until it meets walls.
    if scenario.source.is_none() {
        return bed;
    }
    // A cone of height h and slope s has the volume B_{D−1} (h/s)^{D−1} h/D, B_{D−1} that of the ball of radius 1 below it: 2 on a
    // line, π in a plane. A grain in it carries h/(D + 1) on an average.
    let dimension = V::DIMENSION as f64;
    let volume = grains * V::UNIT_SPHERE_VOLUME / V::RANDOM_CLOSE_PACKING;
    let unit = V::cross_section(1.0) / dimension / SLOPE.powi(V::DIMENSION as i32 - 1);
    bed.max((volume / unit).powf(1.0 / dimension) / (dimension + 1.0))
}

/// Time that grains would have to lie, all of them, for as many collisions: while they are poured fewer lie, and less high [time].
fn effective_time<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let limits = [scenario.run.time, resting_time(scenario)];
    let duration = limits.into_iter().flatten().reduce(f64::min)?;
    let pouring = scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count) / source.rate);
    Some(if duration < pouring {
        // N and the height of a part: (t/T)^{1 + 1/D} and its mean are near enough.
        MEAN_OVER_THE_POURING * duration * (duration / pouring).powf(1.5)
    } else {
        MEAN_OVER_THE_POURING * pouring + duration - pouring
    })
}

#[cfg(test)]
mod tests {
    use super::super::collisions;
    use crate::scenario::estimate::Estimate;
    use crate::scenario::model::AnyScenario;
    use crate::scenario::parse;

    fn estimate(text: &str) -> Estimate {
        let found =
            match parse("settled", text, &Default::default()).unwrap_or_else(|error| panic!("{error}")) {
                AnyScenario::Two(scenario) => collisions(&scenario),
                AnyScenario::Three(scenario) => collisions(&scenario),
            };
        found.unwrap()
    }

    /// Grains under `gravity` on a floor 100 wide, elastic below `speed`.
    fn bed(gravity: &str, count: u32, restitution: f64, speed: f64, time: f64) -> Estimate {
        estimate(&format!(
            r#"
dimension = 2
gravity = {gravity}
[engine]
kind = "event-driven"
[engine.event_driven]
collapse = {{ elastic_below = {speed:?} }}
[domain]
size = [100.0, 60.0]
[boundary]
y.lower = {{ wall = "rough" }}
y.upper = "open"
[particles]
count = {count}
restitution = {restitution}
[run]
time = {time:?}
"#
        ))
    }

    /// Whether `measured` lies between the bounds, which are no farther apart than by a `factor`.
    fn holds(estimate: Estimate, measured: f64, factor: f64) {
        let Estimate { least, most, .. } = estimate;
        assert!(0.9 * least <= measured && measured <= 1.1 * most, "{measured} beside {estimate:?}");
        assert!(most <= factor * least, "{estimate:?} says next to nothing");
    }

    #[test]
    fn beds_at_rest_collide_as_often_as_measured() {
        // Collisions per grain and time once they lie, of 1000 grains.
        holds(bed("[0.0, -1.0]", 1000, 0.6, 0.3, 60.0), 143.4 * 60.0 * 500.0, 2.0);
        holds(bed("[0.0, -1.0]", 1000, 0.9, 0.1, 60.0), 339.7 * 60.0 * 500.0, 2.0);
        holds(bed("[0.0, -1.0]", 3000, 0.6, 0.3, 60.0), 527.6 * 60.0 * 1500.0, 2.0);
        holds(bed("[0.0, -1.0]", 300, 0.6, 0.3, 60.0), 33.3 * 60.0 * 150.0, 2.0);
    }

    #[test]
    fn a_slope_collides_as_often_as_measured_whether_it_flows_or_not() {
        holds(bed("[0.4226, -0.9063]", 1000, 0.6, 0.3, 500.0), 5.26e6, 9.0);
        holds(bed("[0.2588, -0.9659]", 1000, 0.6, 0.3, 500.0), 2.61e7, 9.0);
    }

    #[test]
    fn a_heap_collides_as_often_as_measured() {
        let text = include_str!("../../../scenarios/heap.toml")
            .replace(
                "kind = \"hsmc\"",
                "kind = \"event-driven\"\nevent_driven.collapse = { elastic_below = 0.1 }",
            )
            .replace("count = 3000", "count = 1000")
            .replace("rest = 400.0", "rest = 100.0");
        holds(estimate(&text), 1.72e8, 2.0);
    }

    #[test]
    fn a_shaken_bed_collides_as_often_as_measured() {
        let shaken = |amplitude: f64, restitution: f64| {
            estimate(&format!(
                r#"
dimension = 3
gravity = [0.0, 0.0, -1.0]
[engine]
kind = "event-driven"
[engine.event_driven]
collapse = {{ elastic_below = 0.3 }}
[domain]
size = [15.0, 15.0, 60.0]
[boundary]
x = {{ lower = {{ wall = "smooth" }}, upper = {{ wall = "smooth" }} }}
y = {{ lower = {{ wall = "smooth" }}, upper = {{ wall = "smooth" }} }}
z.lower = {{ wall = "vibrating", amplitude = {amplitude:?}, frequency = 1.0 }}
z.upper = {{ wall = "smooth" }}
[particles]
count = 2000
restitution = {restitution}
[run]
time = 100
"#
            ))
        };
        for (amplitude, restitution, measured) in [
            (0.05, 0.6, 1.21e7),
            (0.05, 0.9, 6.24e6),
            (0.5, 0.6, 5.26e6),
            (0.5, 0.9, 1.64e6),
            (2.0, 0.6, 3.77e6),
        ] {
            holds(shaken(amplitude, restitution), measured, 5.1);
        }
    }
}
