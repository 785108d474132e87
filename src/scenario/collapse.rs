//! Whether inelastic collapse may end an event-driven run.

use super::bound::rounded;
use super::cost;
use super::estimate;
use super::model::{Cure, Scenario};
use crate::law::kinetic_theory::{collapse_restitution, optical_depth};
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::space::Vector;

/// A contact time that leaves a gas as it is, in mean times between collisions of a grain.
const SHORT_IN_A_GAS: f64 = 1e-4;
/// A speed below which grains that come to lie may bounce without loss, in units of √(|g| d). A contact time is no
/// cure there: grains that lie collide all the time, and whatever falls on them would come off without loss.
const SLOW_AT_REST: f64 = 0.05;

/// What to say of a run without a cure that collapse is likely to end.
pub(super) fn warning<V: Vector>(scenario: &Scenario<V>) -> Option<String> {
    let rules = scenario.engine.event_driven;
    // A contact time is no cure for grains that lie on each other.
    let is_cured =
        rules.cure != Cure::default() && (rules.cure.contact_time.is_none() || !cost::settles(scenario));
    if !scenario.engine.kind.is_event_driven() || is_cured {
        return None;
    }
    // A law that makes slow collisions elastic is a cure in itself.
    let RestitutionLaw::Constant(Constant(restitution)) = scenario.restitution else { return None };
    let bound = critical_restitution::<V>(cost::final_grains(scenario), scenario);
    let (reason, remedy) = if restitution < 1.0 && cost::settles(scenario) {
        let speed = SLOW_AT_REST * (scenario.grain.diameter * scenario.gravity.length()).sqrt();
        let reason = "grains that come to rest under gravity collide without end".to_owned();
        (reason, format!("{{ elastic_below = {speed:.0e} }}"))
    } else if restitution < bound {
        let reason = format!(
            "r = {} is below {}, where a gas of this size and density can collapse",
            rounded(restitution),
            rounded(bound)
        );
        let time = estimate::rates(scenario).map(|rates| SHORT_IN_A_GAS / rates.collision_frequency);
        (
            reason,
            time.map_or("{ rotation = 5 }".to_owned(), |time| format!("{{ contact_time = {time:.0e} }}")),
        )
    } else {
        return None;
    };
    Some(format!(
        "inelastic collapse may end the run: {reason}; engine.event_driven.collapse = {remedy} prevents it"
    ))
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
        assert!(warned("heap", &[]).contains("elastic_below = 5e-2"), "{}", warned("heap", &[]));
        assert_eq!(warned("heap", &["engine.event_driven.collapse={rotation=5}"]), "");
        let law = "particles.restitution={law='velocity-dependent',r0=0.9,v0=1}";
        assert_eq!(warned("heap", &[law]), "");
        assert_eq!(warned("heap", &["particles.restitution=1"]), "");
    }
}
