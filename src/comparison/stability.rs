//! Whether a cooling gas stays homogeneous, and whether hard grains may collapse: remarks from kinetic theory.

use crate::law::kinetic_theory::{cluster_threshold, collapse_restitution, optical_depth, shear_threshold};
use crate::number::plain;
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// Shear modes, clusters and collapse of a homogeneous gas of constant `restitution` below 1, a sentence each.
pub(super) fn remarks<V: Vector>(scenario: &Scenario<V>, restitution: f64) -> [String; 3] {
    let place = Place::of(scenario, restitution);
    [
        place.wave("shear modes", "λ_sh", shear_threshold::<V>, "4.75", "the gas begins to shear by itself"),
        place.wave(
            "clusters",
            "λ_cl",
            cluster_threshold::<V>,
            "4.72",
            "the gas is expected to cluster and to leave Haff’s law, which does not tell after how long",
        ),
        collapse(scenario, restitution),
    ]
}

/// What decides which waves grow.
#[derive(Clone, Copy, Debug)]
struct Place {
    volume_fraction: f64,
    /// Longest side, in diameters.
    side: f64,
    /// 1 − r².
    dissipation: f64,
}

impl Place {
    fn of<V: Vector>(scenario: &Scenario<V>, restitution: f64) -> Self {
        let longest = scenario.size.components().into_iter().fold(0.0, f64::max);
        Place {
            volume_fraction: scenario.volume_fraction(),
            side: longest / scenario.grain.diameter,
            dissipation: 1.0 - restitution * restitution,
        }
    }

    /// The box beside the length from which on a wave of 1 − r² = `threshold` of its optical depth grows.
    fn wave(
        &self,
        name: &str,
        symbol: &str,
        threshold: fn(f64) -> f64,
        equation: &str,
        then: &str,
    ) -> String {
        let bound = threshold(optical_depth(self.volume_fraction, self.side, 1.0));
        // Thresholds fall with the square of the length.
        let length = self.side * (bound / self.dissipation).sqrt();
        let (side, length) = (plain(self.side, 3), plain(length, 3));
        let (relation, outcome) = if self.dissipation > bound {
            ("longer", format!("{then}, as 1 − r² = {} exceeds", plain(self.dissipation, 3)))
        } else {
            (
                "not longer",
                format!("none are expected, as 1 − r² = {} does not exceed", plain(self.dissipation, 3)),
            )
        };
        format!(
            "Theory, {name}: the box of {side} d is {relation} than {length} d, above which they grow; {outcome} {symbol} = {} \
             of this box (Miller 2004, {equation}, a dilute gas).",
            plain(bound, 3)
        )
    }
}

fn collapse<V: Vector>(scenario: &Scenario<V>, restitution: f64) -> String {
    let cube = scenario.size.product().powf(1.0 / V::DIMENSION as f64);
    let depth = optical_depth(scenario.volume_fraction(), cube, scenario.grain.diameter);
    let bound = collapse_restitution(depth);
    let (relation, outcome) = if restitution < bound {
        ("below", "hard grains may collapse, and an event-driven run needs a cure")
    } else {
        ("not below", "inelastic collapse is not expected")
    };
    format!(
        "Theory, inelastic collapse: r = {restitution} is {relation} r_ic = {}: {outcome} (Miller 2004, 4.8).",
        plain(bound, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, load};

    fn told(sets: &[&str], restitution: f64) -> [String; 3] {
        let sets = sets.iter().map(ToString::to_string).collect();
        match load("clustering", &Overrides { sets, ..Overrides::default() }).unwrap() {
            AnyScenario::Two(scenario) => remarks(&scenario, restitution),
            AnyScenario::Three(_) => panic!("flat"),
        }
    }

    #[test]
    fn a_large_gas_clusters_above_the_length_of_theory() {
        let [shear, clusters, collapse] = told(&[], 0.8);
        // L = d/ν √(A π³/(1 − r²)) with A = 1/4 and 1: 18.6 and 37.1 diameters.
        assert!(shear.contains("the box of 560 d is longer than 18.6 d"), "{shear}");
        assert!(
            clusters.contains("is longer than 37.1 d") && clusters.contains("λ_cl = 0.00158"),
            "{clusters}"
        );
        assert!(collapse.contains("r = 0.8 is below r_ic = 0.978"), "{collapse}");
    }

    #[test]
    fn a_small_or_elastic_one_does_not() {
        // Between the two thresholds of a box of 30 d: 0.138 and 0.551.
        let small = ["domain.size=[30.0, 30.0]", "particles.count=286"];
        let [shear, clusters, _] = told(&small, 0.8);
        assert!(shear.contains("is longer than") && clusters.contains("is not longer than"), "{clusters}");
        let [_, clusters, collapse] = told(&[], 0.9999);
        assert!(clusters.contains("none are expected"), "{clusters}");
        assert!(collapse.contains("is not below"), "{collapse}");
    }
}
