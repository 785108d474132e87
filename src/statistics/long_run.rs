//! The variance of the mean of correlated values, from an autoregressive model.
//!
//! A stationary series of n values has a mean of variance f/n, where f = Σ_k γ_k is the sum of its autocovariances: its
//! spectrum at frequency zero. The model x_t = Σ φ_k x_{t−k} + noise of variance s² has f = s²/(1 − Σ φ)². Its coefficients
//! are those of Burg (1975), its order is the one of the least AICc (Hurvich and Tsai 1989). Among the estimators that
//! Thompson (2010, arXiv:1011.0175) compared, autoregressive models gave the best errors of short series.
//!
//! A mean that is subtracted makes Σ φ too small by (1 + 3 Σ φ)/n (Marriott and Pope 1954, for one coefficient), which is
//! corrected. The variance of ln f is 2/n for s² and 4 var(Σ φ)/(1 − Σ φ)², with var(Σ φ) = s² 1ᵀΓ⁻¹1/n, Γ the matrix of
//! autocovariances (Brockwell and Davis 1991, section 8.10).

/// The most coefficients of a model.
const MOST: usize = 8;
/// Values for each coefficient.
const VALUES_PER_COEFFICIENT: usize = 8;

/// The spectrum of a series at frequency zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LongRun {
    /// f: n times the variance of the mean of n values.
    pub(super) variance: f64,
    /// Degrees of freedom of f: 2 over the variance of ln f, as of a χ² variable.
    pub(super) freedom: f64,
    /// φ.
    coefficients: Vec<f64>,
}

/// A model of some order.
#[derive(Clone, Debug)]
struct Model {
    coefficients: Vec<f64>,
    /// Σ φ.
    sum: f64,
    /// s², still with n in the denominator.
    noise: f64,
    /// 1ᵀΓ⁻¹1.
    spread: f64,
}

impl LongRun {
    /// Of `values` less the `fitted` numbers (a mean, a trend) that were taken from them; `None` where too few values are left or
    /// none of them varies.
    pub(super) fn of(values: &[f64], fitted: usize) -> Option<Self> {
        let (count, lost) = (values.len() as f64, fitted as f64);
        let variance = values.iter().map(|x| x * x).sum::<f64>() / count;
        if values.len() <= fitted || !(variance > 0.0 && variance.is_finite()) {
            return None;
        }
        let model = best_model(values, variance);
        let order = model.coefficients.len() as f64;
        let noise = model.noise * count / (count - order - lost);
        let bias = if order > 0.0 { lost * (1.0 + 3.0 * model.sum) / count } else { 0.0 };
        // No series shows a memory that is longer than itself.
        let gap = (1.0 - model.sum - bias.max(0.0)).max(1.0 / count);
        let slopes = 4.0 * model.noise * model.spread / (count * gap * gap);
        Some(LongRun {
            variance: noise / (gap * gap),
            freedom: 2.0 / (2.0 / (count - lost) + slopes),
            coefficients: model.coefficients,
        })
    }

    /// The model's spectrum at frequency zero over the largest one at `frequencies`, in cycles per value.
    pub(super) fn dominance(&self, frequencies: impl Iterator<Item = f64>) -> f64 {
        let largest = frequencies.map(|frequency| self.spectrum(frequency)).fold(0.0, f64::max);
        self.spectrum(0.0) / largest
    }

    /// The model's spectrum over s².
    fn spectrum(&self, frequency: f64) -> f64 {
        let (mut real, mut imaginary) = (1.0, 0.0);
        for (k, phi) in self.coefficients.iter().enumerate() {
            let angle = std::f64::consts::TAU * frequency * (k + 1) as f64;
            real -= phi * libm::cos(angle);
            imaginary += phi * libm::sin(angle);
        }
        1.0 / (real * real + imaginary * imaginary)
    }
}

/// Burg's recursion, up to the order with the least AICc.
fn best_model(values: &[f64], variance: f64) -> Model {
    let count = values.len();
    let most = MOST.min(count / VALUES_PER_COEFFICIENT);
    let (mut ahead, mut behind) = (values.to_vec(), values.to_vec());
    let mut model = Model { coefficients: Vec::new(), sum: 0.0, noise: variance, spread: 0.0 };
    let mut best = model.clone();
    for order in 1..=most {
        let Some(reflection) = reflect(&mut ahead, &mut behind, order, variance) else { break };
        model = model.longer(reflection);
        if criterion(count, &model) < criterion(count, &best) {
            best = model.clone();
        }
    }
    best
}

/// The reflection coefficient of this `order`, and what the longer model leaves of the values in both directions; `None`
/// where nothing is left to be explained.
fn reflect(ahead: &mut [f64], behind: &mut [f64], order: usize, variance: f64) -> Option<f64> {
    let (mut product, mut power) = (0.0, 0.0);
    for t in order..ahead.len() {
        product += ahead[t] * behind[t - 1];
        power += ahead[t] * ahead[t] + behind[t - 1] * behind[t - 1];
    }
    if power <= f64::EPSILON * variance * ahead.len() as f64 {
        return None;
    }
    let reflection = 2.0 * product / power;
    for t in (order..ahead.len()).rev() {
        let (next, last) = (ahead[t], behind[t - 1]);
        ahead[t] = next - reflection * last;
        behind[t] = last - reflection * next;
    }
    Some(reflection)
}

impl Model {
    /// The model with one coefficient more (Levinson 1947, Durbin 1960). 1ᵀΓ⁻¹1 grows by (1 − Σ φ)²/s² of the shorter one:
    /// each value is predicted from those before it.
    fn longer(&self, reflection: f64) -> Self {
        let mirrored = self.coefficients.iter().rev();
        let mut coefficients: Vec<f64> =
            self.coefficients.iter().zip(mirrored).map(|(own, other)| own - reflection * other).collect();
        coefficients.push(reflection);
        let gap = 1.0 - self.sum;
        Model {
            sum: coefficients.iter().sum(),
            coefficients,
            noise: self.noise * (1.0 - reflection * reflection),
            spread: self.spread + gap * gap / self.noise,
        }
    }
}

/// AICc of a model with a mean.
fn criterion(count: usize, model: &Model) -> f64 {
    let (n, k) = (count as f64, model.coefficients.len() as f64 + 1.0);
    n * libm::log(model.noise.max(f64::MIN_POSITIVE)) + 2.0 * k * n / (n - k - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::series::{Kind, Series};

    #[test]
    fn white_noise_has_its_variance_at_every_frequency() {
        let values = Series::new(1, Kind::White).take(4000);
        let of_noise = LongRun::of(&values, 1).unwrap();
        // The error of a variance of 4000 values is √(2/4000); coefficients that are not needed may double it.
        assert!((of_noise.variance - 1.0).abs() < 6.0 * (2.0_f64 / 4000.0).sqrt(), "{}", of_noise.variance);
        assert!(of_noise.freedom > 300.0);
    }

    #[test]
    fn a_remembering_series_has_the_spectrum_of_its_model() {
        // φ = exp(−1/5) and variance 1: f = (1 + φ)/(1 − φ) = 10.03, with n/(1 + 4τ) degrees of freedom.
        let values = Series::new(2, Kind::Remembering(5.0)).take(4000);
        let found = LongRun::of(&values, 1).unwrap();
        let phi = libm::exp(-0.2);
        let expected = (1.0 + phi) / (1.0 - phi);
        assert!((libm::log(found.variance / expected)).abs() < 4.0 * (2.0 / found.freedom).sqrt());
        assert!(found.freedom > 40.0 && found.freedom < 400.0, "{}", found.freedom);
    }

    #[test]
    fn an_oscillation_has_next_to_nothing_at_zero() {
        let values: Vec<f64> = (0..64).map(|k| (0.9 * f64::from(k)).sin()).collect();
        let found = LongRun::of(&values, 1).unwrap();
        assert!(found.variance < 0.05, "{}", found.variance);
        assert!(found.dominance((8..=32).map(|k| f64::from(k) / 64.0)) < 0.01);
    }

    #[test]
    fn nothing_is_said_of_nothing() {
        assert_eq!(LongRun::of(&[], 1), None);
        assert_eq!(LongRun::of(&[1.0], 1), None);
        assert_eq!(LongRun::of(&[0.0; 50], 1), None);
        let of_two = LongRun::of(&[-1.0, 1.0], 1).unwrap();
        assert_eq!((of_two.variance, of_two.freedom), (2.0, 1.0));
    }
}
