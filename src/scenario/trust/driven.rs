//! Gases that moving walls drive: what the cells of a stochastic engine do to their stress.

use super::Doubt;
use crate::law::kinetic_theory::{cell_viscosity_factor, mean_free_path};
use crate::scenario::bound::rounded;
use crate::scenario::model::{EngineKind, Scenario};
use crate::scenario::{cost, pace};
use crate::space::Vector;

/// Cells that raise the viscosity by no more than this factor are as good as smaller ones.
const AS_GOOD: f64 = 1.1;
/// Fewest grains of a full cell with which hsmc is sound.
const FEWEST_IN_A_FULL_CELL: f64 = 4.0;

/// The stress of a gas between moving walls.
pub(super) fn stress<V: Vector>(scenario: &Scenario<V>) -> Option<Doubt> {
    let is_driven = scenario.boundary.largest_wall_speed() > 0.0 && !cost::settles(scenario);
    if !is_driven || scenario.count == 0 {
        return None;
    }
    let name = scenario.engine.kind.name();
    let longest = scenario.grid().side().components().into_iter().fold(0.0, f64::max);
    let path = mean_free_path::<V>(scenario.mean_grain(), scenario.volume_fraction());
    let factor = viscosity_factor(scenario, longest);
    Some(Doubt {
        brief: format!(
            "{name} with cells of {} mean free paths makes the stress of a driven flow too high",
            rounded(longest / path)
        ),
        sentence: format!(
            "{name} makes the stress of driven flows too high: cells of {} are {} mean free paths long and multiply the viscosity \
             by {} for their length alone; measured beside exact dynamics were 0.9 to 1.7 times the stress with cells near the \
             mean free path (2D, ν = 0.1) and 2 to 3.5 times with 4 to 9 of them (3D, ν = 0.2); {}",
            rounded(longest),
            rounded(longest / path),
            rounded(factor),
            remedy(scenario, factor)
        ),
        figures: &["wall_shear_stress", "wall_normal_stress", "collision_frequency", "mean_free"],
        is_warning: true,
    })
}

/// By which factor cells of `side` multiply the viscosity.
fn viscosity_factor<V: Vector>(scenario: &Scenario<V>, side: f64) -> f64 {
    let restitution = scenario.restitution.typical();
    let sides = side / scenario.mean_grain().diameter;
    cell_viscosity_factor::<V>(scenario.volume_fraction(), restitution, sides)
}

/// What does better.
fn remedy<V: Vector>(scenario: &Scenario<V>, factor: f64) -> String {
    if factor <= AS_GOOD {
        return "smaller cells would not help".to_owned();
    }
    let diameter = scenario.mean_grain().diameter;
    // F − 1 goes with the square of the side.
    let good = longest_good_side(scenario);
    let full = scenario.engine.hsmc.maximum_volume_fraction * (good / diameter).powi(V::DIMENSION as i32)
        / V::UNIT_SPHERE_VOLUME;
    let is_sound = match scenario.engine.kind {
        EngineKind::Hsmc => full.floor() >= FEWEST_IN_A_FULL_CELL,
        _ => good >= diameter,
    };
    if is_sound {
        format!("engine.cell_size = {} would make that {AS_GOOD}", pace::rounded_down(good))
    } else {
        "no smaller cell that is sound makes that good; take event-driven".to_owned()
    }
}

/// The side of a cell that multiplies the viscosity by [`AS_GOOD`] [length].
fn longest_good_side<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let diameter = scenario.mean_grain().diameter;
    diameter * ((AS_GOOD - 1.0) / (viscosity_factor(scenario, diameter) - 1.0)).sqrt()
}
