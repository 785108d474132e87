//! What the figures of a summary are: which belong to the physics, which count the work of an engine, their units,
//! and whether the run was long enough for them.

use super::evidence::Evidence;
use super::setup::Setup;
use crate::comparison::unit_of as unit_of_figure;
use crate::number::number;
use crate::scenario::trust;
use crate::simulation::figures as keys;

/// Figures that are told beside another one.
const DETAILS: [&str; 3] = ["heap_slope_left", "heap_slope_right", "velocity_profile_r_squared"];

/// Known figures in the order of their weight, and whether each is a mean over the second half of the run.
const KNOWN: [(&str, bool); 20] = [
    ("heap_slope", false),
    ("heap_height", false),
    ("velocity_profile_slope", true),
    ("contrast_over_poisson", true),
    ("density_contrast", true),
    ("spectrum_slope", false),
    ("flow_velocity", true),
    ("flow_rate", true),
    ("wall_shear_stress", true),
    ("wall_normal_stress", true),
    ("centre_of_mass_height", false),
    ("centre_of_mass_mean_height", true),
    ("compressibility_factor", true),
    ("pressure", true),
    ("collision_frequency", true),
    ("mean_free_time", true),
    ("mean_free_path", true),
    ("impact_c", true),
    ("rotational_energy", false),
    ("granular_temperature", false),
];

/// What is driven forgets its start in no fewer collisions per particle than these; asked where a run has no tested trend.
const FEWEST_COLLISIONS: f64 = 20.0;
/// A gas whose temperature changes by a larger factor over the second half is not steady; asked where a run has no tested
/// trend.
const STEADY_TEMPERATURES: f64 = 1.2;

/// Figures of the physics that have a value and a meaning in this run, the most telling first.
pub(super) fn of_the_physics<'a>(evidence: &Evidence<'a>) -> Vec<&'a str> {
    let rank = |name: &str| KNOWN.iter().position(|known| known.0 == name).unwrap_or(KNOWN.len());
    let names = evidence.summary.keys().map(String::as_str);
    let mut names: Vec<&str> = names
        .filter(|name| !keys::is_of_every_run(name) && !DETAILS.contains(name))
        .filter(|name| !keys::is_attribute(name))
        .filter(|name| evidence.figure(name).is_some() && has_meaning(evidence, name))
        .collect();
    names.sort_by_key(|name| rank(name));
    names
}

/// Counters that apply to this run, with their values.
pub(super) fn counters(evidence: &Evidence<'_>) -> Vec<(&'static str, f64)> {
    let counted = keys::counters().filter_map(|name| Some((name, evidence.figure(name)?)));
    // Nothing leaves a closed box.
    counted
        .filter(|(name, value)| *name != "removed" || *value > 0.0 || evidence.setup.has_open_side)
        .collect()
}

/// The unit of a figure, from the series where that has it.
pub(super) fn unit_of(evidence: &Evidence<'_>, name: &str) -> String {
    if let Some((_, column)) = evidence.column(name) {
        return evidence.setup.unit(column.unit);
    }
    evidence.setup.unit(unit_of_figure(name, evidence.setup.dimension))
}

/// Whether a figure says what its name says.
pub(super) fn has_meaning(evidence: &Evidence<'_>, name: &str) -> bool {
    match name {
        // The mean of something that falls by decades is a number without a use.
        "pressure" | "collision_frequency" | "mean_free_time" if evidence.trend(name).is_none() => {
            is_temperature_steady(evidence)
        }
        _ if is_stress_on_untouched_floor(evidence.setup, name) => false,
        // The mean over a floor that carries the weight and a ceiling that does not is about half of it.
        "wall_normal_stress" => !presses_one_of_two_walls(evidence),
        _ => true,
    }
}

/// Whether a mean over the second half stands for more than itself.
pub(super) fn is_steady(evidence: &Evidence<'_>, name: &str) -> bool {
    let is_mean = KNOWN.iter().find(|known| known.0 == name).is_none_or(|known| known.1);
    is_mean
        && has_meaning(evidence, name)
        && evidence.unsteady(name).is_none()
        && doubt(evidence, name).is_none()
}

/// Whether full cells keep grains away from the floor that carries them.
pub(super) fn is_floor_untouched(setup: &Setup) -> bool {
    setup.engine == "hsmc" && setup.has_floor()
}

/// Whether a constant force presses grains onto one of two opposite walls.
fn presses_one_of_two_walls(evidence: &Evidence<'_>) -> bool {
    let pulls = |axis: usize| evidence.setup.gravity.get(axis).is_some_and(|g| *g != 0.0);
    let is_wall =
        |axis: char, side: &str| evidence.summary.contains_key(&format!("wall_normal_stress_{axis}_{side}"));
    let axes = ['x', 'y', 'z'].into_iter().enumerate();
    axes.filter(|(axis, _)| pulls(*axis)).any(|(_, axis)| is_wall(axis, "lower") && is_wall(axis, "upper"))
}

/// Whether this is the normal stress on the floor.
fn is_stress_on_the_floor(setup: &Setup, name: &str) -> bool {
    let Some(axis) = setup.gravity_axis() else { return name == "wall_normal_stress" };
    let side = if setup.gravity[axis] < 0.0 { "lower" } else { "upper" };
    name == "wall_normal_stress" || name == format!("wall_normal_stress_{}_{side}", ["x", "y", "z"][axis])
}

/// Whether `name` is the stress on a floor that full cells keep grains away from.
pub(super) fn is_stress_on_untouched_floor(setup: &Setup, name: &str) -> bool {
    is_floor_untouched(setup) && is_stress_on_the_floor(setup, name)
}

/// Whether the temperature keeps its size over the second half of the run.
fn is_temperature_steady(evidence: &Evidence<'_>) -> bool {
    let late: Vec<f64> = match evidence.column("temperature") {
        Some((column, _)) => second_half(&evidence.series(0, column)).iter().map(|p| p[1]).collect(),
        None => ["kinetic_energy_initial", "kinetic_energy_final"]
            .iter()
            .filter_map(|name| evidence.figure(name))
            .collect(),
    };
    let most = late.iter().copied().fold(0.0, f64::max);
    let least = late.iter().copied().fold(f64::INFINITY, f64::min);
    most <= STEADY_TEMPERATURES * least
}

/// Points after the middle of their times.
fn second_half(points: &[[f64; 2]]) -> &[[f64; 2]] {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return points;
    };
    let middle = 0.5 * (first[0] + last[0]);
    &points[points.partition_point(|p| p[0] < middle)..]
}

/// Why the number of a figure should be taken with care, in words; `None` when nothing speaks against it. That its series is
/// not steady is said in place of the number.
pub(super) fn doubt(evidence: &Evidence<'_>, name: &str) -> Option<String> {
    if !KNOWN.iter().any(|known| known.0 == name && known.1) {
        return None;
    }
    if name == "velocity_profile_slope"
        && let Some(share) = evidence.figure("velocity_profile_r_squared").filter(|share| *share < 0.9)
    {
        return Some(format!("the profile is no straight line: R² = {}", number(share, 2)));
    }
    if evidence.standard_error(name).is_none() {
        return Some("the run is too short for a standard error".to_owned());
    }
    let collisions = evidence.figure("collisions_per_particle").unwrap_or(0.0);
    let is_short = !evidence.setup.is_undriven() && collisions < FEWEST_COLLISIONS;
    (evidence.trend(name).is_none() && is_short)
        .then(|| format!("too short to be steady: {} collisions per particle", number(collisions, 2)))
}

/// What is known against the engine of this run where it concerns a figure, in a few words.
pub(super) fn known_faults(evidence: &Evidence<'_>, name: &str) -> Vec<String> {
    let Some(known) = &evidence.setup.known else { return Vec::new() };
    let doubts = trust::doubts(&known.scenario).into_iter();
    doubts.filter(|doubt| doubt.concerns(name)).map(|doubt| format!("known fault: {}", doubt.brief)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_half_goes_by_time() {
        let points: Vec<[f64; 2]> = (0..11).map(|k| [2f64.powi(k), 0.0]).collect();
        assert_eq!(second_half(&points).len(), 1);
    }
}
