//! Errors of means over few replicas: the scatter at a place, made better known by its neighbours.

use super::memory::correlation_time;
use crate::statistics::{mean, standard_deviation};

/// Degrees of freedom that neighbours are to give together: the limit is then within a fifth of that of a known error.
pub(super) const FREEDOM: f64 = 30.0;
/// Powers of its own level with which a quantity may scatter: not at all, as counts do, as energies do.
const POWERS: [f64; 3] = [0.0, 0.5, 1.0];

/// What is known of the scatter along a curve.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scatter {
    /// Standard error of the mean over replicas at each place.
    pub(super) errors: Vec<f64>,
    /// Degrees of freedom of each of these errors.
    pub(super) freedom: f64,
    /// Integrated autocorrelation time along the curve, in places.
    pub(super) correlation: f64,
}

/// `rest` `[replica][place]` is what is left without the mean over replicas, `level` the size of the quantity at each
/// place.
///
/// The variance at a place is the mean over a window of places about it, after division by that power of the level
/// (0, 1/2 or 1) that makes it most even. Places 2t apart count as independent, t the integrated autocorrelation time
/// of what is left: a window of w places has (n − 1) w/(2t) degrees of freedom. It is as narrow as 30 of them allow,
/// and never more than half of the curve. `None` where nothing scatters.
pub(super) fn of_noise(rest: &[Vec<f64>], level: &[f64]) -> Option<Scatter> {
    let (replicas, places) = (rest.len() as f64, level.len());
    let variances: Vec<f64> =
        (0..places).map(|k| rest.iter().map(|row| row[k] * row[k]).sum::<f64>() / (replicas - 1.0)).collect();
    let scale = scale(&variances, level);
    let even: Vec<Vec<f64>> =
        rest.iter().map(|row| row.iter().zip(&scale).map(|(value, scale)| value / scale).collect()).collect();
    let correlation = correlation_time(&even)?;
    let wanted = FREEDOM * 2.0 * correlation / (replicas - 1.0);
    let width =
        if replicas - 1.0 >= FREEDOM { 1 } else { (wanted.ceil() as usize).clamp(1, (places / 2).max(1)) };
    let stretches = (width as f64 / (2.0 * correlation)).max(1.0);
    // Less than one stretch tells no more than its middle.
    let width = if stretches > 1.0 { width } else { 1 };
    let errors = (0..places).map(|k| {
        let window = window(k, width, places);
        let count = window.len() as f64;
        let variance = window.map(|j| variances[j] / (scale[j] * scale[j])).sum::<f64>() / count;
        scale[k] * (variance / replicas).sqrt()
    });
    Some(Scatter { errors: errors.collect(), freedom: (replicas - 1.0) * stretches, correlation })
}

/// `width` of `places` about `k`, shifted inwards at the ends.
pub(super) fn window(k: usize, width: usize, places: usize) -> std::ops::Range<usize> {
    let first = k.saturating_sub(width / 2).min(places - width.min(places));
    first..(first + width).min(places)
}

/// The power of the level with which scatter goes, at each place.
fn scale(variances: &[f64], level: &[f64]) -> Vec<f64> {
    let powers = |power: f64| level.iter().map(move |level| level.powf(power));
    if !level.iter().all(|level| *level > 0.0 && level.is_finite()) {
        return vec![1.0; level.len()];
    }
    let unevenness = |power: f64| {
        let logarithms = variances.iter().zip(powers(power)).filter(|(variance, _)| **variance > 0.0);
        let logarithms: Vec<f64> =
            logarithms.map(|(variance, scale)| (variance / (scale * scale)).ln()).collect();
        standard_deviation(&logarithms).unwrap_or(0.0)
    };
    let best = POWERS.into_iter().min_by(|a, b| unevenness(*a).total_cmp(&unevenness(*b))).unwrap_or(0.0);
    let centre = mean(level).unwrap_or(1.0).powf(best);
    powers(best).map(|scale| scale / centre).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};

    /// Errors of four replicas whose scatter at each of 60 places is `sigma`, in units of the true ones: mean square.
    fn calibration(level: impl Fn(f64) -> f64, sigma: impl Fn(f64) -> f64) -> [f64; 60] {
        let mut random = Streams::new(1).at(0, Phase::Collisions).stream(0);
        let (mut squares, trials) = ([0.0; 60], 300);
        let levels: Vec<f64> = (0..60).map(|k| level(f64::from(k))).collect();
        for _ in 0..trials {
            let mut rows: Vec<Vec<f64>> =
                (0..4).map(|_| (0..60).map(|k| sigma(f64::from(k)) * random.gaussian()).collect()).collect();
            for k in 0..60 {
                let centre = rows.iter().map(|row| row[k]).sum::<f64>() / 4.0;
                rows.iter_mut().for_each(|row| row[k] -= centre);
            }
            let scatter = of_noise(&rows, &levels).unwrap();
            assert!(scatter.freedom > 12.0 && scatter.freedom < 36.0, "{}", scatter.freedom);
            for (k, error) in scatter.errors.iter().enumerate() {
                squares[k] += error * error * 4.0 / sigma(k as f64).powi(2) / f64::from(trials);
            }
        }
        squares
    }

    #[test]
    fn errors_are_right_where_scatter_is_even_or_goes_with_the_level() {
        let spectrum = |k: f64| 1.0 / (1.0 + k).powi(2);
        for squares in [
            calibration(|_| 1.0, |_| 3.0),
            calibration(spectrum, |k| 0.1 * spectrum(k)),
            calibration(spectrum, |k| 0.1 * spectrum(k).sqrt()),
        ] {
            // A mean of 300 squares with thirty degrees of freedom each: 1.5 %.
            assert!(squares.iter().all(|square| (square - 1.0).abs() < 0.07), "{squares:?}");
        }
    }

    #[test]
    fn neighbours_that_are_the_same_tell_nothing_new() {
        let rows: Vec<Vec<f64>> = [-1.5, -0.5, 0.5, 1.5].map(|value| vec![value; 40]).to_vec();
        let scatter = of_noise(&rows, &[1.0; 40]).unwrap();
        assert_eq!(scatter.freedom, 3.0);
        assert!(scatter.errors.iter().all(|error| (error - (5.0_f64 / 12.0).sqrt()).abs() < 1e-12));
        assert_eq!(of_noise(&[vec![0.0; 5], vec![0.0; 5]], &[1.0; 5]), None);
    }

    #[test]
    fn windows_stay_inside() {
        assert_eq!((window(0, 5, 9), window(4, 5, 9), window(8, 5, 9)), (0..5, 2..7, 4..9));
        assert_eq!(window(3, 1, 9), 3..4);
    }
}
