//! Whether inelastic collapse may end an event-driven run.

use super::bound::{rounded, shown};
use super::cost;
use super::estimate;
use super::model::{Cure, Scenario};
use crate::engine::event_driven::rules::resting_speed;
use crate::law::kinetic_theory::{collapse_restitution, optical_depth};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::space::Vector;

/// A contact time that leaves a gas as it is, in mean times between collisions of a grain.
const SHORT_IN_A_GAS: f64 = 1e-4;
/// A speed that has ended in collapse, in those of [`resting_speed`]: 0.1 √(g d) in place of 0.3.
const HAS_COLLAPSED: f64 = 0.34;
/// A speed of a cure that leaves a gas between moving walls as it is, in speeds of the walls.
const SLOW_BESIDE_WALLS: f64 = 1e-4;

/// What to say of a run without a cure that collapse is likely to end.
pub(super) fn warning<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    if !scenario.engine.kind.is_event_driven() {
        return None;
    }
    if is_cured(scenario) {
        return too_slow(scenario);
    }
    let (reason, remedy) = danger(scenario)?;
    Some(format!(
        "inelastic collapse may end the run: {reason}; engine.event_driven.collapse = {} prevents it",
        written(remedy)
    ))
}

/// What to say of a speed with which runs under gravity have collapsed.
fn too_slow<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let tried = resting_speed(scenario.gravity.length(), scenario.largest_diameter());
    let speed = scenario.engine.event_driven.cure.elastic_below?;
    (cost::settles(scenario) && speed < HAS_COLLAPSED * tried).then(|| {
        format!(
            "engine.event_driven.collapse.elastic_below = {} may be too low under gravity: an inclined chute ended in collapse with \
             {}, in units of √(g d), and ran to its end with twice as much; {} has been tried on chutes, beds and heaps",
            shown(speed),
            0.1,
            one_digit(tried)
        )
    })
}

/// Whether the scenario has a cure that helps. A contact time is none for grains that lie on each other: they collide all the time.
pub(super) fn is_cured<V: Vector>(scenario: &Scenario<V>) -> bool {
    let cure = scenario.engine.event_driven.cure;
    cure != Cure::default() && (cure.contact_time.is_none() || !cost::settles(scenario))
}

/// The cure that an event-driven run of `scenario` needs beside what it has; `None` where it needs none.
pub(super) fn needed<V: Vector>(scenario: &Scenario<V>) -> Option<Cure> {
    if is_cured(scenario) { None } else { danger(scenario).map(|(_, cure)| cure) }
}

/// Why an event-driven run without a cure is likely to collapse, and the cure for that.
fn danger<V: Vector>(scenario: &Scenario<V>) -> Option<(String, Cure)> {
    // A law that makes slow collisions elastic is a cure in itself.
    let RestitutionLaw::Constant(Constant(restitution)) = scenario.restitution else { return None };
    if restitution < 1.0 && cost::settles(scenario) {
        let reason = "grains that come to rest under gravity collide without end".to_owned();
        let speed = resting_speed(scenario.gravity.length(), scenario.largest_diameter());
        return Some((reason, Cure { elastic_below: Some(speed), ..Cure::default() }));
    }
    let bound = critical_restitution::<V>(cost::final_grains(scenario), scenario);
    let reason = || {
        format!(
            "r = {} is below {}, where a gas of this size and density can collapse",
            rounded(restitution),
            rounded(bound)
        )
    };
    (restitution < bound).then(|| (reason(), of_a_gas(scenario)))
}

/// A cure that leaves a gas as it is.
fn of_a_gas<V: Vector>(scenario: &Scenario<V>) -> Cure {
    let wall_speed = scenario.boundary.largest_wall_speed();
    if wall_speed > 0.0 {
        return Cure { elastic_below: Some(SLOW_BESIDE_WALLS * wall_speed), ..Cure::default() };
    }
    match estimate::rates(scenario) {
        Some(rates) => {
            Cure { contact_time: Some(SHORT_IN_A_GAS / rates.collision_frequency), ..Cure::default() }
        }
        None => Cure { rotation: Some(5.0_f64.to_radians()), ..Cure::default() },
    }
}

/// A cure as it stands in a scenario.
pub(super) fn written(cure: Cure) -> String {
    let speed = cure.elastic_below.map(|speed| format!("elastic_below = {}", one_digit(speed)));
    let time = cure.contact_time.map(|time| format!("contact_time = {}", one_digit(time)));
    let angle = cure.rotation.map(|angle| format!("rotation = {}", rounded(angle.to_degrees())));
    let parts: Vec<String> = [speed, time, angle].into_iter().flatten().collect();
    format!("{{ {} }}", parts.join(", "))
}

/// A value of which one digit is known.
fn one_digit(value: f64) -> String {
    if (1e-3..1e3).contains(&value) {
        let text = format!("{value:.0e}");
        return text.parse::<f64>().map_or(text, |rounded| format!("{rounded}"));
    }
    format!("{value:.0e}")
}

/// The restitution below which collapse can happen in a cube of these grains.
fn critical_restitution<V: Vector>(grains: f64, scenario: &Scenario<V>) -> f64 {
    let volume_fraction = super::check::volume_fraction_of(scenario, grains);
    if volume_fraction <= 0.0 {
        return 0.0;
    }
    let side = (grains * V::UNIT_SPHERE_VOLUME / volume_fraction).powf(1.0 / V::DIMENSION as f64);
    collapse_restitution(optical_depth(volume_fraction, side, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, check::check, load};

    fn scenario(name: &str, sets: &[&str]) -> AnyScenario {
        let sets = sets.iter().map(ToString::to_string).collect();
        let engine = Some("event-driven".to_owned());
        load(name, &Overrides { sets, engine, seed: None }).unwrap_or_else(|error| panic!("{error}"))
    }

    fn warned(name: &str, sets: &[&str]) -> String {
        check(&scenario(name, sets)).warnings.join("\n")
    }

    #[test]
    fn the_optical_depth_is_that_of_the_book() {
        let AnyScenario::Two(cooling) = scenario("cooling", &[]) else { panic!("flat") };
        // l = √(10⁴ · 0.25 π/4) = 44.31: 1 − π/l = 0.929 to first order.
        let depth = (1e4 * 0.25 * std::f64::consts::FRAC_PI_4).sqrt();
        let exact = (std::f64::consts::FRAC_PI_4 * (1.0 - 1.0 / depth)).tan().powi(2);
        let found = critical_restitution(1e4, &cooling);
        assert!((found - exact).abs() < 1e-12, "{found}");
        assert!((found - (1.0 - std::f64::consts::PI / depth)).abs() < 3e-3);
        assert_eq!(critical_restitution(0.0, &cooling), 0.0);
    }

    #[test]
    fn runs_that_may_collapse_say_which_key_helps() {
        let warning = warned("cooling", &[]);
        assert!(warning.contains("r = 0.9 is below 0.93"), "{warning}");
        assert!(warning.contains("engine.event_driven.collapse = { contact_time = 6e-5 }"), "{warning}");
        assert_eq!(warned("cooling", &["particles.restitution=0.95"]), "");
        let warning = warned("sedimentation", &[]);
        assert!(warning.contains("come to rest under gravity"), "{warning}");
        assert!(warned("heap", &[]).contains("elastic_below = 0.3"), "{}", warned("heap", &[]));
        assert_eq!(warned("heap", &["engine.event_driven.collapse={rotation=5}"]), "");
        let law = "particles.restitution={law='velocity-dependent',r0=0.9,v0=1}";
        assert_eq!(warned("heap", &[law]), "");
        assert_eq!(warned("heap", &["particles.restitution=1"]), "");
    }

    #[test]
    fn a_speed_with_which_runs_have_collapsed_is_said() {
        let with = |speed: &str| warned("heap", &[&format!("engine.event_driven.collapse={{elastic_below={speed}}}")]);
        assert!(with("0.1").contains("elastic_below = 0.1 may be too low"), "{}", with("0.1"));
        assert!(with("0.1").contains("0.3 has been tried"), "{}", with("0.1"));
        assert_eq!(with("0.2"), "");
        // Driven gases have no weight to carry.
        assert_eq!(warned("shear", &["engine.event_driven.collapse={elastic_below=1e-4}"]), "");
    }
}
