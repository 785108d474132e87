//! Means with their errors, and straight lines through points: always the same bits for the same numbers.

mod long_run;
#[cfg(test)]
mod series;
mod steadiness;
mod steady;
#[cfg(test)]
#[path = "statistics/steady_tests.rs"]
mod steady_tests;
pub mod student;

use std::ops::Range;

pub use steady::SteadyEstimate;

/// Blocks that a steady stretch of a run is cut into.
pub const BLOCKS: usize = 10;

/// A number and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Its standard error; `None` where there are too few values to tell.
    pub standard_error: Option<f64>,
}

/// What a series of values in time does as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// It fluctuates about its mean.
    Steady,
    /// It rises.
    Rising,
    /// It falls.
    Falling,
    /// It changes as slowly as the series is long, without one direction.
    Wandering,
}

impl Trend {
    /// The word used in summaries and on pages.
    pub fn name(self) -> &'static str {
        match self {
            Trend::Steady => "steady",
            Trend::Rising => "rising",
            Trend::Falling => "falling",
            Trend::Wandering => "wandering",
        }
    }

    /// The trend of that name; `None` where there is none.
    pub fn of_name(name: &str) -> Option<Trend> {
        [Trend::Steady, Trend::Rising, Trend::Falling, Trend::Wandering]
            .into_iter()
            .find(|trend| trend.name() == name)
    }

    /// Whether it is steady.
    pub fn is_steady(self) -> bool {
        self == Trend::Steady
    }
}

/// A straight line y = intercept + slope·x by least squares, every point with the same weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightLine {
    /// Rise of y per x.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// Standard error of the slope from the scatter about the line; `None` for two points.
    pub slope_error: Option<f64>,
    /// Standard error of the intercept from the scatter about the line; `None` for two points.
    pub intercept_error: Option<f64>,
    /// R², the share of the variance of y that the line explains; not a number where y does not vary: there is nothing
    /// to explain.
    pub r_squared: f64,
}

/// The arithmetic mean; `None` of nothing.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Standard deviation with n − 1 in the denominator; `None` for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let centre = mean(values)?;
    let squares: f64 = values.iter().map(|x| (x - centre) * (x - centre)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// The standard error s/√n of the mean of independent values; `None` for fewer than two.
pub fn standard_error(values: &[f64]) -> Option<f64> {
    Some(standard_deviation(values)? / (values.len() as f64).sqrt())
}

/// Mean and standard error of independent values; `None` of nothing.
pub fn average(values: &[f64]) -> Option<Estimate> {
    Some(Estimate { value: mean(values)?, standard_error: standard_error(values) })
}

/// `count` consecutive things cut into [`BLOCKS`] runs whose lengths differ by at most one;
/// fewer things than that make one block each.
pub fn blocks(count: usize) -> impl Iterator<Item = Range<usize>> {
    let parts = BLOCKS.min(count);
    (0..parts).map(move |k| k * count / parts..(k + 1) * count / parts)
}

/// Mean of values that follow each other in time, with the standard error of the means of
/// [`BLOCKS`] blocks (Flyvbjerg and Petersen 1989): right as soon as a block is longer than the memory.
pub fn block_average(values: &[f64]) -> Option<Estimate> {
    let means: Vec<f64> = blocks(values.len()).filter_map(|block| mean(&values[block])).collect();
    Some(Estimate { value: mean(values)?, standard_error: standard_error(&means) })
}

/// The straight line through the points (`x`, `y`); `None` unless there are two different x.
pub fn straight_line(x: &[f64], y: &[f64]) -> Option<StraightLine> {
    assert_eq!(x.len(), y.len(), "a y for every x");
    let (x_mean, y_mean) = (mean(x)?, mean(y)?);
    let points = || x.iter().zip(y).map(|(x, y)| (x - x_mean, y - y_mean));
    let xx: f64 = points().map(|(x, _)| x * x).sum();
    let xy: f64 = points().map(|(x, y)| x * y).sum();
    let yy: f64 = points().map(|(_, y)| y * y).sum();
    // Written so that a NaN among the points also ends here.
    if !(xx > 0.0 && xy.is_finite()) {
        return None;
    }
    let slope = xy / xx;
    let residual: f64 = points().map(|(x, y)| (y - slope * x) * (y - slope * x)).sum();
    let variance = (x.len() > 2).then(|| residual / (x.len() - 2) as f64);
    Some(StraightLine {
        slope,
        intercept: y_mean - slope * x_mean,
        slope_error: variance.map(|s| (s / xx).sqrt()),
        intercept_error: variance.map(|s| (s * (1.0 / x.len() as f64 + x_mean * x_mean / xx)).sqrt()),
        r_squared: if yy > 0.0 { 1.0 - residual / yy } else { f64::NAN },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};

    #[test]
    fn mean_and_error_of_four_numbers() {
        // Deviations −1.5, −0.5, 0.5, 1.5: variance 5/3, error √(5/12).
        let estimate = average(&[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert_eq!(estimate.value, 2.5);
        assert!((estimate.standard_error.unwrap() - (5.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert_eq!(average(&[]), None);
        assert_eq!(average(&[7.0]), Some(Estimate { value: 7.0, standard_error: None }));
    }

    #[test]
    fn a_line_with_known_errors() {
        // y = 1 + 2x with residuals +1, −2, +1 orthogonal to 1 and x.
        let line = straight_line(&[0.0, 1.0, 2.0], &[2.0, 1.0, 6.0]).unwrap();
        assert!((line.slope - 2.0).abs() < 1e-15);
        assert!((line.intercept - 1.0).abs() < 1e-15);
        // Residual variance 6/1, Σ(x − x̄)² = 2.
        assert!((line.slope_error.unwrap() - 3.0_f64.sqrt()).abs() < 1e-14);
        assert!((line.intercept_error.unwrap() - 5.0_f64.sqrt()).abs() < 1e-14);
        // Σ(y − ȳ)² = 1 + 4 + 9 = 14.
        assert!((line.r_squared - 8.0 / 14.0).abs() < 1e-15);
    }

    #[test]
    fn lines_that_do_not_exist() {
        assert_eq!(straight_line(&[1.0, 1.0], &[0.0, 2.0]), None);
        assert_eq!(straight_line(&[1.0], &[0.0]), None);
        assert_eq!(straight_line(&[0.0, 1.0], &[0.0, f64::NAN]), None);
        assert_eq!(straight_line(&[0.0, 1.0], &[3.0, 1.0]).unwrap().slope_error, None);
    }

    #[test]
    fn a_line_through_equal_values_explains_nothing() {
        let flat = straight_line(&[0.0, 1.0, 2.0], &[0.5; 3]).unwrap();
        assert_eq!((flat.slope, flat.intercept), (0.0, 0.5));
        assert!(flat.r_squared.is_nan(), "{}", flat.r_squared);
    }

    #[test]
    fn blocks_cover_everything_once() {
        for count in [0, 1, 9, 10, 11, 99, 400] {
            let cut: Vec<Range<usize>> = blocks(count).collect();
            assert_eq!(cut.len(), count.min(BLOCKS));
            assert_eq!(cut.iter().map(ExactSizeIterator::len).sum::<usize>(), count);
            assert!(cut.windows(2).all(|pair| pair[0].end == pair[1].start));
            let lengths = cut.iter().map(ExactSizeIterator::len);
            assert!(lengths.clone().max().unwrap_or(0) - lengths.min().unwrap_or(0) <= 1);
        }
    }

    #[test]
    fn blocks_see_correlations_that_single_values_hide() {
        // Every value stands twenty times in a row: 400 values hold 20 independent ones.
        let mut random = Streams::new(1).at(0, Phase::Collisions).stream(0);
        let values: Vec<f64> = (0..20).flat_map(|_| [random.gaussian(); 20]).collect();
        let in_blocks = block_average(&values).unwrap();
        let naive = average(&values).unwrap();
        assert!((in_blocks.value - naive.value).abs() < 1e-15);
        let ratio = in_blocks.standard_error.unwrap() / naive.standard_error.unwrap();
        // √20 expected; the spread of an error from ten blocks is 1/√18.
        assert!((ratio / 20.0_f64.sqrt() - 1.0).abs() < 4.0 / 18.0_f64.sqrt(), "{ratio}");
        assert!(ratio > 1.5);
    }
}
