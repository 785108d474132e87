//! How fast grains are, and how long a step may be: as far as a scenario alone tells.

use super::initial::stated_temperature;
use super::model::{EngineKind, Scenario, TimeStep};
use super::reader::Section;
use crate::space::Vector;

/// The speed that something certainly has when the run begins: a wall, a poured grain, or the
/// fastest of grains whose mean square is stated [length/time].
pub(super) fn certain_speed<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let poured = scenario.source.as_ref().map_or(0.0, |source| source.velocity.length());
    let driven = scenario.boundary.largest_wall_speed().max(poured);
    if scenario.count == 0 { driven } else { driven.max(thermal_speed(scenario)) }
}

/// The largest speed to be expected when the run begins: the Maxwellian's tail [length/time].
pub(super) fn starting_speed<V: Vector>(scenario: &Scenario<V>) -> f64 {
    if scenario.count == 0 {
        return certain_speed(scenario);
    }
    let tail = (2.0 * f64::from(scenario.count.max(2)).ln() / V::DIMENSION as f64).sqrt().max(1.0);
    certain_speed(scenario).max(thermal_speed(scenario) * tail)
}

/// √⟨v²⟩ = √(D T/m).
fn thermal_speed<V: Vector>(scenario: &Scenario<V>) -> f64 {
    (V::DIMENSION as f64 * stated_temperature(scenario) / scenario.mean_mass()).sqrt()
}

/// The largest speed to be expected once grains have fallen freely: through the box where some are
/// there at the start, from the spout where all are poured, but no longer than the run lasts [length/time].
pub(super) fn falling_speed<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let height = |axis: usize| match &scenario.source {
        Some(source) if scenario.count == 0 => source.height.min(scenario.size[axis]),
        _ => scenario.size[axis],
    };
    let gained: f64 =
        (0..V::DIMENSION).map(|axis| 2.0 * scenario.gravity[axis].abs() * height(axis)).sum::<f64>().sqrt();
    let most = scenario.run.time.map_or(f64::INFINITY, |time| scenario.gravity.length() * time);
    starting_speed(scenario).hypot(gained.min(most))
}

/// Whether gravity pulls along an axis without an end, where nothing but walls and collisions stops a fall.
pub(super) fn falls_for_ever<V: Vector>(scenario: &Scenario<V>) -> bool {
    (0..V::DIMENSION).any(|axis| scenario.gravity[axis] != 0.0 && scenario.boundary.is_periodic(axis))
}

/// Whether a jump over a cell makes a difference.
fn jumps_matter<V: Vector>(scenario: &Scenario<V>) -> bool {
    let has_sides = !scenario.boundary.is_fully_periodic();
    scenario.engine.kind == EngineKind::Hsmc || scenario.gravity != V::ZERO || has_sides
}

/// The longest step that is allowed while the largest speed is `speed` [time]:
/// the allowed share of min(L/v, √(2L/|g|)) where a jump over a cell matters, any where it does not.
pub(super) fn longest_step<V: Vector>(scenario: &Scenario<V>, speed: f64) -> f64 {
    if !jumps_matter(scenario) {
        return f64::INFINITY;
    }
    let gravity = scenario.gravity.length();
    let side = scenario.grid().shortest_side();
    let falling = if gravity > 0.0 { (2.0 * side / gravity).sqrt() } else { f64::INFINITY };
    scenario.engine.time_step.largest_crossing() * (side / speed).min(falling)
}

/// Notes a fixed step that is too long from the first step on.
pub(super) fn check_fixed_step<V: Vector>(root: &Section<'_>, scenario: &Scenario<V>) -> Option<()> {
    let TimeStep::Fixed(step) = scenario.engine.time_step else { return Some(()) };
    if scenario.engine.kind.is_event_driven() {
        return Some(());
    }
    let mistake = if step > longest_step(scenario, certain_speed(scenario)) {
        let side = scenario.grid().shortest_side();
        let most = rounded_down(longest_step(scenario, starting_speed(scenario)));
        format!(
            "{step} is too long from the start: with cells of {} a fixed step lasts at most as long as the smaller of L/v and \
             √(2L/|g|); give at most {most}",
            super::bound::rounded(side)
        )
    } else {
        // Where the crossing of a cell is no bound, the number of collisions is.
        let rates = super::estimate::rates(scenario).filter(|_| !jumps_matter(scenario));
        let Some(rates) = rates else { return Some(()) };
        let collisions = step * rates.collision_frequency;
        if collisions <= TimeStep::MOST_COLLISIONS {
            return Some(());
        }
        format!(
            "{step} is too long from the start: a grain would collide {} times in it, and {} times is the most; give at most \
             {}",
            super::bound::rounded(collisions),
            TimeStep::MOST_COLLISIONS,
            rounded_down(TimeStep::MOST_COLLISIONS / rates.collision_frequency)
        )
    };
    root.mistake("engine.time_step.fixed", mistake);
    None
}

/// `value` with three digits, and never more than it was.
pub(super) fn rounded_down(value: f64) -> String {
    let digits = 2 - value.abs().log10().floor() as i32;
    let scale = 10.0_f64.powi(digits);
    super::bound::rounded((value * scale).floor() / scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, load};
    use glam::DVec2;

    fn scenario(name: &str, sets: &[&str]) -> Result<Scenario<DVec2>, String> {
        let sets = sets.iter().map(ToString::to_string).collect();
        match load(name, &Overrides { sets, ..Default::default() }) {
            Ok(AnyScenario::Two(scenario)) => Ok(scenario),
            Ok(AnyScenario::Three(_)) => unreachable!("built-in scenarios are flat"),
            Err(error) => Err(error.to_string()),
        }
    }

    fn refusal(name: &str, sets: &[&str]) -> String {
        scenario(name, sets).map(|_| ()).unwrap_err()
    }

    #[test]
    fn a_step_of_many_collisions_is_refused_where_nothing_else_bounds_it() {
        let free = ["engine.kind=cba", "engine.time_step.fixed=1e6"];
        let said = refusal("cooling", &free);
        assert!(said.contains("a grain would collide") && said.contains("2 times is the most"), "{said}");
        let frequency = 1.787;
        let most: f64 = said.rsplit("give at most ").next().unwrap().trim().parse().unwrap();
        assert!((most * frequency / 2.0 - 1.0).abs() < 0.05, "{said}");
        assert!(scenario("cooling", &["engine.kind=cba", &format!("engine.time_step.fixed={most}")]).is_ok());
    }

    #[test]
    fn a_step_longer_than_a_fall_through_a_cell_is_refused() {
        // √(2 · 2/1) = 2.
        let message = refusal("heap", &["engine.time_step.fixed=2.5"]);
        assert!(message.contains("engine.time_step.fixed: 2.5 is too long from the start"), "{message}");
        assert!(message.ends_with("give at most 2"), "{message}");
        assert!(scenario("heap", &["engine.time_step.fixed=2"]).is_ok());
    }

    #[test]
    fn what_moves_at_the_start_bounds_a_fixed_step() {
        // The spout: 2/4; a wall at 0.5: 2.5/0.5, below it thermal grains.
        let spout = ["source.velocity=[0, -4]", "engine.time_step.fixed=0.52"];
        assert!(refusal("heap", &spout).ends_with("give at most 0.5"));
        let cold = "initial.velocities={maxwell=1e-6}";
        assert!(refusal("shear", &[cold, "engine.time_step.fixed=5.1"]).ends_with("give at most 5"));
        assert!(scenario("shear", &[cold, "engine.time_step.fixed=5"]).is_ok());
        // √⟨v²⟩ = √2: from 2.5/1.414 = 1.77 on it certainly fails, with the tail from 0.64 on.
        let message = refusal("shear", &["engine.time_step.fixed=1.8"]);
        assert!(message.ends_with("give at most 0.64"), "{message}");
        assert!(scenario("shear", &["engine.time_step.fixed=0.8"]).is_ok());
    }

    #[test]
    fn falling_speeds_are_those_of_free_fall() {
        assert!((falling_speed(&scenario("heap", &[]).unwrap()) - 20.0_f64.sqrt()).abs() < 1e-12);
        let box_of_disks = scenario("sedimentation", &[]).unwrap();
        assert!((falling_speed(&box_of_disks) - (2.0 * 9.81 * 0.04_f64).sqrt()).abs() < 1e-12);
        let short = scenario("sedimentation", &["run.time=0.01"]).unwrap();
        assert!((falling_speed(&short) - 0.0981).abs() < 1e-12);
    }

    #[test]
    fn a_number_is_never_rounded_up() {
        let shown = [0.25, 0.099_999, 12.349, 1.0, 6.789e-7].map(rounded_down);
        assert_eq!(shown, ["0.25", "0.0999", "12.3", "1", "6.78e-7"]);
    }
}
