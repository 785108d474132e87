//! How far a difference may lie from zero by chance, when its error is itself an estimate.
//!
//! Student's t: its two-sided tail beyond t with n degrees of freedom is I_x(n/2, 1/2) with x = n/(n + t²), I the
//! regularised incomplete beta function (Abramowitz and Stegun 1964, 26.7.1 and 26.5.8).

/// Two-sided probability of a normal variable beyond three standard deviations.
pub const THREE_SIGMA: f64 = 0.002_699_796_063_260_19;

/// Steps of a bisection: the bounds are then neighbours.
const HALVINGS: usize = 200;

/// Standard errors beyond which one of `places` independent values lies by chance with `probability`, where the error
/// has `freedom` degrees of freedom.
///
/// Each place gets the share 1 − (1 − p)^(1/places) of p. For normal values of any correlation the whole is then at
/// most p (Šidák 1967, J. Am. Stat. Assoc. 62, 626).
pub fn threshold(probability: f64, freedom: f64, places: usize) -> f64 {
    let share = -(-probability).ln_1p() / places.max(1) as f64;
    let probability = -(-share).exp_m1();
    let (mut lower, mut upper) = (0.0_f64, 1.0_f64);
    while two_sided(upper, freedom) > probability {
        upper *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (lower + upper);
        match two_sided(middle, freedom) > probability {
            true => lower = middle,
            false => upper = middle,
        }
    }
    upper
}

/// Probability that |t| is larger than `t`.
pub fn two_sided(t: f64, freedom: f64) -> f64 {
    incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5)
}

/// I_x(a, b) by its continued fraction.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    let logarithm = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * x.ln() + b * (-x).ln_1p();
    let front = logarithm.exp();
    // The fraction converges fast on this side of the mean.
    match x < (a + 1.0) / (a + b + 2.0) {
        true => front * fraction(x, a, b) / a,
        false => 1.0 - front * fraction(1.0 - x, b, a) / b,
    }
}

/// The continued fraction of I_x(a, b), by the method of Lentz.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    let away_from_zero = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let (mut c, mut result) = (1.0, d);
    for k in 1..1000 {
        let m = f64::from(k);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + term * d);
            c = away_from_zero(1.0 + term / c);
            factor = c * d;
            result *= factor;
        }
        if (factor - 1.0_f64).abs() < 1e-15 {
            break;
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_that_have_closed_forms() {
        // One degree of freedom: 1 − (2/π) arctan t; two: 1 − t/√(2 + t²).
        for t in [0.1, 1.0, 3.0, 200.0] {
            let one = 1.0 - std::f64::consts::FRAC_2_PI * f64::atan(t);
            let two = 1.0 - t / f64::sqrt(2.0 + t * t);
            assert!((two_sided(t, 1.0) - one).abs() < 1e-13, "{t}");
            assert!((two_sided(t, 2.0) - two).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn tails_that_stand_in_tables() {
        // Abramowitz and Stegun 1964, table 26.10: t beyond which 1 % lies on both sides together.
        for (freedom, t) in [(3.0, 5.841), (5.0, 4.032), (10.0, 3.169), (30.0, 2.750)] {
            assert!((two_sided(t, freedom) / 0.01 - 1.0).abs() < 1e-3, "{freedom}");
            assert!((threshold(0.01, freedom, 1) - t).abs() < 6e-4, "{freedom}");
        }
    }

    #[test]
    fn three_standard_errors_when_the_error_is_known() {
        assert!((threshold(THREE_SIGMA, 1e9, 1) - 3.0).abs() < 1e-5);
        // With two replicas: tan(π/2 (1 − p)).
        let one = (std::f64::consts::FRAC_PI_2 * (1.0 - THREE_SIGMA)).tan();
        assert!((threshold(THREE_SIGMA, 1.0, 1) / one - 1.0).abs() < 1e-9);
        assert!(threshold(THREE_SIGMA, 1e9, 50) > 4.0 && threshold(THREE_SIGMA, 1e9, 50) < 4.1);
    }
}
