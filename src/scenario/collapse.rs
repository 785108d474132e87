//! Whether inelastic collapse may end an event-driven run.

use super::bound::rounded;
use super::cost;
use super::estimate;
use super::model::{Cure, Scenario};
use crate::law::kinetic_theory::{collapse_restitution, optical_depth};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::number;
use crate::space::Vector;

/// A contact time that leaves a gas as it is, in mean times between collisions of a grain.
const SHORT_IN_A_GAS: f64 = 1e-4;
/// A speed that has ended in collapse, in those of [`Cure::at_rest`]: 0.1 √(g d) in place of 0.3.
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
        remedy
    ))
}

/// What to say of a speed with which runs under gravity have collapsed.
fn too_slow<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let cure = scenario.engine.event_driven.cure;
    let tried = tried(scenario);
    let (speed, enough) = cure.elastic_below.zip(tried.elastic_below)?;
    (cost::settles(scenario) && cure.contact_time.is_none() && speed < HAS_COLLAPSED * enough).then(|| {
        format!(
            "engine.event_driven.collapse.elastic_below = {} may be too low under gravity: a chute ended in collapse with as little; \
             {tried} has been tried on chutes, beds and heaps",
            number::exact(speed)
        )
    })
}

/// The cure that has been tried on grains at rest.
fn tried<V: Vector>(scenario: &Scenario<V>) -> Cure {
    Cure::at_rest(scenario.gravity.length(), scenario.largest_diameter())
}

/// Whether the scenario has a cure that helps. A contact time alone does not help grains at rest on each other: they collide all the
/// time.
pub(super) fn is_cured<V: Vector>(scenario: &Scenario<V>) -> bool {
    let cure = scenario.engine.event_driven.cure;
    let is_contact_time = cure == Cure { contact_time: cure.contact_time, ..Cure::default() };
    cure != Cure::default() && !(is_contact_time && cost::settles(scenario))
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
        return Some((reason, tried(scenario)));
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
        assert!(
            warned("heap", &[]).contains("{ elastic_below = 0.3, contact_time = 1e-5 }"),
            "{}",
            warned("heap", &[])
        );
        assert_eq!(warned("heap", &["engine.event_driven.collapse={rotation=5}"]), "");
        let law = "particles.restitution={law='velocity-dependent',r0=0.9,v0=1}";
        assert_eq!(warned("heap", &[law]), "");
        assert_eq!(warned("heap", &["particles.restitution=1"]), "");
    }

    #[test]
    fn a_speed_with_which_runs_have_collapsed_is_said() {
        let with = |speed: &str| {
            warned("heap", &[&format!("engine.event_driven.collapse={{elastic_below={speed}}}")])
        };
        assert!(with("0.1").contains("elastic_below = 0.1 may be too low"), "{}", with("0.1"));
        assert!(
            with("0.1").contains("{ elastic_below = 0.3, contact_time = 1e-5 } has been tried"),
            "{}",
            with("0.1")
        );
        assert_eq!(with("0.2"), "");
        // Driven gases have no weight to carry.
        assert_eq!(warned("shear", &["engine.event_driven.collapse={elastic_below=1e-4}"]), "");
    }
}
