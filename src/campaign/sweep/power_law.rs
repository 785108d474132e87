//! y = c xᵏ through points with errors.

use crate::report::PowerLaw;
use crate::statistics::straight_line;

/// A point of a curve: x, y and the standard error of y, if it is known.
pub(super) type Point = ([f64; 2], Option<f64>);

/// The power law through at least three points with positive x and y; `None` where there is none.
///
/// A straight line of log y on log x. Where every y has an error, points weigh 1/σ² with σ = error/y, and the error of
/// the exponent follows from these σ, enlarged by √(χ²/(n − 2)) where the points scatter by more than that; else points
/// weigh alike, and it follows from their scatter.
pub(super) fn power_law(points: &[Point]) -> Option<PowerLaw> {
    if points.len() < 3 || points.iter().any(|([x, y], _)| !(*x > 0.0 && *y > 0.0)) {
        return None;
    }
    let x: Vec<f64> = points.iter().map(|([x, _], _)| x.ln()).collect();
    let y: Vec<f64> = points.iter().map(|([_, y], _)| y.ln()).collect();
    let sigma = |([_, y], error): &Point| error.filter(|error| *error > 0.0).map(|error| error / y);
    let sigmas: Option<Vec<f64>> = points.iter().map(sigma).collect();
    let (slope, intercept, error) = match sigmas {
        Some(sigmas) => weighted_line(&x, &y, &sigmas)?,
        None => {
            let line = straight_line(&x, &y)?;
            (line.slope, line.intercept, line.slope_error?)
        }
    };
    let deviation = |(x, y): (&f64, &f64)| (y - intercept - slope * x).exp_m1().abs();
    let largest_deviation = x.iter().zip(&y).map(deviation).fold(0.0, f64::max);
    Some(PowerLaw {
        exponent: slope,
        standard_error: error,
        prefactor: intercept.exp(),
        largest_deviation,
        points: points.len(),
    })
}

/// Slope, intercept and error of the slope of a straight line through points of known errors.
fn weighted_line(x: &[f64], y: &[f64], sigmas: &[f64]) -> Option<(f64, f64, f64)> {
    let weights: Vec<f64> = sigmas.iter().map(|sigma| 1.0 / (sigma * sigma)).collect();
    let all: f64 = weights.iter().sum();
    let mean = |values: &[f64]| values.iter().zip(&weights).map(|(v, w)| v * w).sum::<f64>() / all;
    let (x_mean, y_mean) = (mean(x), mean(y));
    let points = || x.iter().zip(y).zip(&weights).map(|((x, y), w)| (x - x_mean, y - y_mean, w));
    let xx: f64 = points().map(|(x, _, w)| w * x * x).sum();
    let slope = points().map(|(x, y, w)| w * x * y).sum::<f64>() / xx;
    let chi_squared: f64 = points().map(|(x, y, w)| w * (y - slope * x).powi(2)).sum();
    let excess = (chi_squared / (x.len() - 2) as f64).sqrt().max(1.0);
    let error = excess / xx.sqrt();
    (slope.is_finite() && error.is_finite()).then_some((slope, y_mean - slope * x_mean, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exact_law_is_found_with_the_errors_of_its_points() {
        // Errors of 1 %: σ = 0.01; Σ(ln x − mean)² = 2 ln²10.
        let point = |x: f64| ([x, 3.0 * x * x], Some(0.03 * x * x));
        let law = power_law(&[point(0.1), point(1.0), point(10.0)]).unwrap();
        assert!((law.exponent - 2.0).abs() < 1e-12 && (law.prefactor - 3.0).abs() < 1e-12);
        let expected = 0.01 / (2.0 * 10f64.ln().powi(2)).sqrt();
        assert!((law.standard_error / expected - 1.0).abs() < 1e-9);
        assert!(law.largest_deviation < 1e-12);
    }

    #[test]
    fn scatter_beyond_the_errors_counts() {
        // ln y = residuals e·(1, −2, 1) about slope 0: χ² = 6 e²/σ², one degree of freedom.
        let e: f64 = 0.1;
        let point = |x: f64, residual: f64| ([x, residual.exp()], Some(0.01 * residual.exp()));
        let law = power_law(&[point(0.1, e), point(1.0, -2.0 * e), point(10.0, e)]).unwrap();
        let expected = (6.0 * e * e / (2.0 * 10f64.ln().powi(2))).sqrt();
        assert!(law.exponent.abs() < 1e-12 && (law.standard_error / expected - 1.0).abs() < 1e-9);
        assert!((law.largest_deviation - (1.0 - (-0.2_f64).exp())).abs() < 1e-9);
        // Without errors the scatter alone says the same.
        let bare: Vec<Point> =
            [[0.1, e.exp()], [1.0, (-2.0 * e).exp()], [10.0, e.exp()]].map(|p| (p, None)).to_vec();
        assert!((power_law(&bare).unwrap().standard_error / expected - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_law_is_none() {
        assert_eq!(power_law(&[([1.0, 1.0], None), ([2.0, 2.0], None)]), None);
        assert_eq!(power_law(&[([1.0, 1.0], None), ([2.0, -2.0], None), ([3.0, 1.0], None)]), None);
        assert_eq!(power_law(&[([1.0, 1.0], None), ([1.0, 2.0], None), ([1.0, 1.0], None)]), None);
    }
}
