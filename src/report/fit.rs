//! Straight lines and planes through points.

/// y = intercept + slope·x through points by least squares; `None` for fewer than two different x.
pub(super) fn line(points: &[[f64; 2]]) -> Option<Line> {
    let count = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let variance: f64 = points.iter().map(|p| (p[0] - x) * (p[0] - x)).sum();
    let covariance: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let slope = covariance / variance;
    slope.is_finite().then_some(Line { intercept: y - slope * x, slope })
}

/// A straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Value at 0.
    pub intercept: f64,
    /// Rise per unit.
    pub slope: f64,
}

impl Line {
    /// Its value at `x`.
    pub(super) fn at(self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}

/// The two numbers a, b for which a·u + b·w is nearest to y, over rows `[u, w, y]`; `None` when they are not determined.
pub(super) fn two_terms(rows: &[[f64; 3]]) -> Option<[f64; 2]> {
    let sum = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let (uu, uw, ww, uy, wy) = (sum(0, 0), sum(0, 1), sum(1, 1), sum(0, 2), sum(1, 2));
    let determinant = uu * ww - uw * uw;
    let is_determined = determinant > 1e-12 * uu * ww;
    is_determined.then(|| [(uy * ww - wy * uw) / determinant, (wy * uu - uy * uw) / determinant])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_sums_are_found() {
        let found = line(&[[1.0, 3.0], [2.0, 5.0], [4.0, 9.0]]).unwrap();
        assert!((found.slope - 2.0).abs() < 1e-12 && (found.at(0.0) - 1.0).abs() < 1e-12);
        assert_eq!(line(&[[1.0, 2.0]]), None);
        let rows: Vec<[f64; 3]> = (1..9)
            .map(|k| {
                let u = f64::from(k);
                [u, u.ln(), 3.0 * u - 0.5 * u.ln()]
            })
            .collect();
        let [a, b] = two_terms(&rows).unwrap();
        assert!((a - 3.0).abs() < 1e-9 && (b + 0.5).abs() < 1e-9);
    }
}
