//! The rule by which a measured number is held against a law.

use grainflow::statistics::average;
use rayon::prelude::*;

/// Fewest replicas from which a standard error is taken.
const FEWEST_REPLICAS: usize = 4;

/// Standard errors beyond the tolerance that a mean may be off.
const STANDARD_ERRORS: f64 = 3.0;

/// A law's value and how far an engine may be from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim {
    /// What theory says.
    pub(crate) theory: f64,
    /// Bound on the bias, relative to theory.
    pub(crate) tolerance: f64,
}

/// Mean of replicas and its standard error, both relative to theory.
#[derive(Clone, Copy, Debug)]
struct Measured {
    ratio: f64,
    error: f64,
}

impl Claim {
    /// Holds `replicas` against the law.
    ///
    /// * |mean − theory| ≤ tolerance + 3 standard errors;
    /// * the standard error is at most half the tolerance;
    /// * power: the law spoiled by twice the tolerance, up or down, is rejected by the same rule.
    ///
    /// # Panics
    /// When one of these fails; `subject` names the claim.
    pub(crate) fn check(self, subject: &str, replicas: &[f64]) {
        assert!(replicas.len() >= FEWEST_REPLICAS, "{subject}: {} replicas", replicas.len());
        let measured = self.measure(replicas);
        let Measured { ratio, error } = measured;
        println!("{subject}: {ratio:.4} ± {error:.4} of theory, tolerance {}", self.tolerance);
        assert!(
            error <= 0.5 * self.tolerance,
            "{subject}: the standard error {error} exceeds half the tolerance {}",
            self.tolerance
        );
        assert!(
            self.accepts(measured, 1.0),
            "{subject}: {ratio} ± {error} of theory, tolerance {}",
            self.tolerance
        );
        for spoiled in [1.0 - 2.0 * self.tolerance, 1.0 + 2.0 * self.tolerance] {
            assert!(
                !self.accepts(measured, spoiled),
                "{subject}: no power, {ratio} ± {error} of theory agrees with {spoiled} of theory as well"
            );
        }
    }

    fn measure(self, replicas: &[f64]) -> Measured {
        let ratios: Vec<f64> = replicas.iter().map(|value| value / self.theory).collect();
        let estimate = average(&ratios).expect("there are replicas");
        let error = estimate.standard_error.expect("there are several replicas");
        assert!(estimate.value.is_finite() && error.is_finite());
        Measured { ratio: estimate.value, error }
    }

    /// Whether the rule accepts a law whose value is `law` times theory.
    fn accepts(self, measured: Measured, law: f64) -> bool {
        (measured.ratio - law).abs() <= self.tolerance + STANDARD_ERRORS * measured.error
    }
}

/// `measure(seed)` for `count` seeds, in their order.
pub(crate) fn replicas(count: u64, measure: impl Fn(u64) -> f64 + Send + Sync) -> Vec<f64> {
    (1..=count).into_par_iter().map(measure).collect()
}

const UNIT: Claim = Claim { theory: 2.0, tolerance: 0.1 };

#[test]
fn a_law_within_the_tolerance_is_accepted() {
    UNIT.check("two", &[2.09, 2.11, 2.10, 2.10]);
}

#[test]
#[should_panic(expected = "of theory, tolerance 0.1")]
fn a_law_beyond_the_tolerance_is_rejected() {
    UNIT.check("two", &[2.29, 2.31, 2.30, 2.30]);
}

#[test]
#[should_panic(expected = "exceeds half the tolerance")]
fn scattered_replicas_are_refused() {
    UNIT.check("two", &[1.5, 2.5, 2.4, 1.6]);
}

#[test]
#[should_panic(expected = "no power")]
fn replicas_that_fit_a_spoiled_law_too_are_refused() {
    UNIT.check("two", &[2.0, 2.2, 2.3, 2.2]);
}

#[test]
#[should_panic(expected = "3 replicas")]
fn three_replicas_are_too_few() {
    UNIT.check("two", &[2.0, 2.0, 2.0]);
}
