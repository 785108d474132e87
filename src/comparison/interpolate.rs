//! The value of a curve between its points; never beyond its ends.

use crate::statistics::{blocks, mean};

/// How a quantity goes from point to point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Path {
    /// y is linear in x.
    Straight,
    /// ln y is linear in x, or in ln x where the spacing grows by decades: exact for exponentials, or for powers.
    Logarithmic,
}

/// Gaps of a curve whose longest is this many times its shortest have grown with x.
const GROWN: f64 = 10.0;

/// A curve with rising x.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sampled {
    /// Strictly rising.
    pub(super) x: Vec<f64>,
    /// NaN where it is not defined.
    pub(super) y: Vec<f64>,
    /// Standard errors of y that the run states; empty where it states none.
    pub(super) errors: Vec<f64>,
}

impl Sampled {
    /// The points in their order, without those that do not advance in x.
    pub(super) fn new(points: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut curve = Sampled::default();
        for (x, y) in points {
            if x.is_finite() && curve.x.last().is_none_or(|last| x > *last) {
                curve.x.push(x);
                curve.y.push(if y.is_finite() { y } else { f64::NAN });
            }
        }
        curve
    }

    /// Whether it has a value anywhere.
    pub(super) fn has_values(&self) -> bool {
        self.y.iter().any(|y| y.is_finite())
    }

    /// Whether all of its values are above zero.
    pub(super) fn is_positive(&self) -> bool {
        self.has_values() && self.y.iter().all(|y| y.is_nan() || *y > 0.0)
    }

    /// The first and the last x with a value.
    pub(super) fn range(&self) -> Option<[f64; 2]> {
        let known = || self.x.iter().zip(&self.y).filter(|(_, y)| y.is_finite()).map(|(x, _)| *x);
        Some([known().next()?, known().next_back()?])
    }

    /// The largest over the smallest of the means of ten parts of it, which single values cannot sway.
    pub(super) fn span(&self) -> f64 {
        let known: Vec<f64> = self.y.iter().copied().filter(|y| y.is_finite()).collect();
        let means = || blocks(known.len()).filter_map(|block| mean(&known[block]));
        means().fold(0.0, f64::max) / means().fold(f64::INFINITY, f64::min)
    }

    /// Whether its last value is below `share` of its first.
    pub(super) fn falls_below(&self, share: f64) -> bool {
        let known = || self.y.iter().filter(|y| y.is_finite());
        known().next().zip(known().next_back()).is_some_and(|(first, last)| *last < share * first)
    }

    /// Its errors at `places`, straight between its points; empty where it has none.
    pub(super) fn errors_at(&self, places: &[f64]) -> Vec<f64> {
        if self.errors.is_empty() {
            return Vec::new();
        }
        let errors = Sampled { x: self.x.clone(), y: self.errors.clone(), errors: Vec::new() };
        errors.at(places, Path::Straight)
    }

    /// Whether times lie like powers of a number.
    fn is_spaced_by_decades(&self) -> bool {
        let gaps = || self.x.windows(2).map(|pair| pair[1] - pair[0]);
        let shortest = gaps().fold(f64::INFINITY, f64::min);
        gaps().fold(0.0, f64::max) > GROWN * shortest && self.x.first().is_some_and(|x| *x >= 0.0)
    }

    /// Its values at `places`; NaN beyond its ends and beside a gap.
    pub(super) fn at(&self, places: &[f64], path: Path) -> Vec<f64> {
        let by_decades = path == Path::Logarithmic && self.is_spaced_by_decades();
        places.iter().map(|place| self.value(*place, path, by_decades)).collect()
    }

    fn value(&self, place: f64, path: Path, by_decades: bool) -> f64 {
        let above = self.x.partition_point(|x| *x < place);
        if self.x.get(above) == Some(&place) {
            return self.y[above];
        }
        if above == 0 || above == self.x.len() {
            return f64::NAN;
        }
        let ([x0, x1], [y0, y1]) = ([self.x[above - 1], self.x[above]], [self.y[above - 1], self.y[above]]);
        let share = match by_decades && x0 > 0.0 {
            true => (place / x0).ln() / (x1 / x0).ln(),
            false => (place - x0) / (x1 - x0),
        };
        match path == Path::Logarithmic && y0 > 0.0 && y1 > 0.0 {
            true => y0 * (share * (y1 / y0).ln()).exp(),
            false => y0 + share * (y1 - y0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_exact_between_even_points_and_powers_between_decades() {
        let even = Sampled::new((0..20).map(|k| (f64::from(k), (-0.7 * f64::from(k)).exp())));
        let decades = Sampled::new((0..20).map(|k| {
            let x = 2.0_f64.powi(k);
            (x, x.powi(-2))
        }));
        for place in [1.3, 7.77, 18.9] {
            let between = even.at(&[place], Path::Logarithmic)[0];
            assert!((between / (-0.7 * place).exp() - 1.0).abs() < 1e-13);
            let between = decades.at(&[place], Path::Logarithmic)[0];
            assert!((between * place * place - 1.0).abs() < 1e-13);
        }
        // A straight line through the same points is far off.
        assert!(even.at(&[1.5], Path::Straight)[0] > 1.04 * (-1.05_f64).exp());
    }

    #[test]
    fn nothing_is_said_beyond_the_ends_or_beside_a_gap() {
        let curve =
            Sampled::new([(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0), (2.0, 9.0), (3.0, 5.0)].into_iter());
        let values = curve.at(&[-0.1, 0.0, 0.5, 1.5, 2.0, 2.5, 3.1], Path::Straight);
        let known: Vec<Option<f64>> = values.iter().map(|y| Some(*y).filter(|y| y.is_finite())).collect();
        assert_eq!(known, [None, Some(1.0), None, None, Some(3.0), Some(4.0), None]);
        assert!(Sampled::default().at(&[0.0], Path::Straight)[0].is_nan());
    }
}
