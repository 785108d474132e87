//! Means of stretches that are meant to be steady, with their errors and whether they are.
//!
//! Every such figure is a ratio R = Σ a / Σ b over consecutive intervals: of a value times the time that it stands for, over
//! that time; of one running total over another one. Its error is that of the mean of the linear residuals
//! (a − R b)/⟨b⟩ (Cochran 1977, section 6.4), which remember each other as the gas does. It follows that the relative errors of
//! R and 1/R agree.

use super::long_run::LongRun;
use super::steadiness;
use super::{Estimate, Trend};

/// Consecutive residuals are added up to at most so many.
pub(super) const PARTS: usize = 64;
/// Residuals below this share of what they are made of are its rounding.
const ROUNDING: f64 = 1e-12;
/// With fewer degrees of freedom an error says nothing.
const LEAST_FREEDOM: f64 = 1.0;

/// A mean over a stretch of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyEstimate {
    /// The best value.
    pub value: f64,
    /// Its standard error; `None` where too few independent values were seen.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of the standard error.
    pub freedom: Option<f64>,
    /// Whether the stretch is steady; `None` where that cannot be told.
    pub trend: Option<Trend>,
}

impl From<Estimate> for SteadyEstimate {
    fn from(Estimate { value, standard_error }: Estimate) -> Self {
        SteadyEstimate { value, standard_error, freedom: None, trend: None }
    }
}

impl SteadyEstimate {
    /// Σ a / Σ b of consecutive pairs (a, b); `None` where that is no number.
    pub fn ratio(pairs: &[[f64; 2]]) -> Option<Self> {
        let sum = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>();
        let (total, other) = (sum(0), sum(1));
        let value = total / other;
        if !value.is_finite() {
            return None;
        }
        let mean = other / pairs.len() as f64;
        let residuals: Vec<f64> = pairs.iter().map(|[a, b]| (a - value * b) / mean).collect();
        let scale = pairs.iter().map(|[a, b]| (a.abs() + (value * b).abs()) / mean.abs()).fold(0.0, f64::max);
        Some(Self::of_residuals(value, &residuals, scale))
    }

    /// `value` with the error of the mean of consecutive `residuals`, which add up to zero; they are made of numbers as large as
    /// `scale`.
    pub fn of_residuals(value: f64, residuals: &[f64], scale: f64) -> Self {
        let parts = in_parts(residuals);
        if parts.len() < 2 {
            return SteadyEstimate { value, standard_error: None, freedom: None, trend: None };
        }
        let is_tested = parts.len() >= steadiness::FEWEST;
        if parts.iter().all(|part| part.abs() <= ROUNDING * scale) {
            let square = parts.iter().map(|x| x * x).sum::<f64>();
            let freedom = parts.len() as f64 - 1.0;
            let error = (square / freedom / parts.len() as f64).sqrt();
            let trend = is_tested.then_some(Trend::Steady);
            return SteadyEstimate { value, standard_error: Some(error), freedom: Some(freedom), trend };
        }
        let known = LongRun::of(&parts, 1).filter(|found| found.freedom >= LEAST_FREEDOM);
        SteadyEstimate {
            value,
            standard_error: known.as_ref().map(|found| (found.variance / parts.len() as f64).sqrt()),
            freedom: known.map(|found| found.freedom),
            trend: steadiness::trend(&parts),
        }
    }
}

/// Consecutive residuals added up to at most [`PARTS`], scaled so that their mean stays.
fn in_parts(residuals: &[f64]) -> Vec<f64> {
    let count = residuals.len();
    let parts = PARTS.min(count);
    let scale = parts as f64 / count.max(1) as f64;
    let part = |k: usize| residuals[k * count / parts..(k + 1) * count / parts].iter().sum::<f64>();
    (0..parts).map(|k| part(k) * scale).collect()
}
