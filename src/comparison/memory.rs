//! Errors from one run: how long a series remembers, and what blocks of it are then worth.

use crate::statistics::{blocks, mean, straight_line};

/// Independent stretches that a series must hold before its scatter says how well its blocks are known. A walk about its
/// straight line seems to hold about nine; of 15 000 none seemed to hold 40.
const LEAST_STRETCHES: f64 = 40.0;
/// The sum of autocorrelations ends where it is this many correlation times long (Sokal 1997, 3).
const WINDOW: f64 = 5.0;

/// A series cut into blocks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Blocked {
    /// For each value the mean of its block.
    pub(super) values: Vec<f64>,
    /// For each value the standard error of that mean.
    pub(super) errors: Vec<f64>,
    /// The mean of the whole, and its standard error.
    pub(super) whole: [f64; 2],
    /// Blocks.
    pub(super) blocks: usize,
    /// Degrees of freedom of the errors.
    pub(super) freedom: f64,
    /// Integrated autocorrelation time, in places: values this far apart, twice, count as independent.
    pub(super) correlation: f64,
}

/// `series`, evenly spaced, as means of blocks. Its scatter is that about its straight line, σ², with the integrated
/// autocorrelation time t of what is left; the mean of L places then has the error σ √(2t/L), with n/(2t) − 2 degrees
/// of freedom. `None` where the series holds less than 40 stretches of 2t, t the largest
/// of the partial sums: a curve that bends, or that walks without
/// ever forgetting, looks like that, and one run does not tell which.
pub(super) fn blocked(series: &[f64]) -> Option<Blocked> {
    let places: Vec<f64> = (0..series.len()).map(|k| k as f64).collect();
    let line = straight_line(&places, series)?;
    let rest: Vec<f64> =
        places.iter().zip(series).map(|(x, y)| y - line.intercept - line.slope * x).collect();
    let Memory { time: correlation, longest } = memory(std::slice::from_ref(&rest))?;
    if series.len() as f64 / (2.0 * longest) < LEAST_STRETCHES {
        return None;
    }
    let stretches = series.len() as f64 / (2.0 * correlation);
    let squares: f64 = rest.iter().map(|r| r * r).sum();
    // The line and the memory take away from the scatter what two stretches have.
    let variance = squares / series.len() as f64 * stretches / (stretches - 2.0);
    let mut blocked = Blocked {
        values: Vec::with_capacity(series.len()),
        errors: Vec::with_capacity(series.len()),
        whole: [mean(series)?, (variance / stretches).sqrt()],
        blocks: 0,
        freedom: stretches - 2.0,
        correlation,
    };
    for block in blocks(series.len()) {
        let length = block.len();
        let centre = mean(&series[block])?;
        let error = (variance * (2.0 * correlation / length as f64).min(1.0)).sqrt();
        blocked.values.extend(std::iter::repeat_n(centre, length));
        blocked.errors.extend(std::iter::repeat_n(error, length));
        blocked.blocks += 1;
    }
    Some(blocked)
}

/// 1/2 + Σ ρ(k) of all `rows` together, each of which has the mean 0 and the same length; at least 1/2; `None` where
/// nothing varies.
pub(super) fn correlation_time(rows: &[Vec<f64>]) -> Option<f64> {
    Some(memory(rows)?.time)
}

/// The largest partial sum of 1/2 + Σ ρ(k) of `series` about its mean, in places.
pub(super) fn longest_memory(series: &[f64]) -> Option<f64> {
    let centre = mean(series)?;
    Some(memory(&[series.iter().map(|value| value - centre).collect()])?.longest)
}

/// What a sum of autocorrelations comes to.
struct Memory {
    /// At its end.
    time: f64,
    /// Before its end: what was added about a fitted line is taken away again by longer lags, be there memory or not.
    longest: f64,
}

fn memory(rows: &[Vec<f64>]) -> Option<Memory> {
    let product =
        |lag: usize| rows.iter().flat_map(|row| row.iter().zip(&row[lag..])).map(|(a, b)| a * b).sum::<f64>();
    let length = rows.iter().map(Vec::len).min().filter(|length| *length > 0)?;
    let variance = product(0);
    if !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let (mut time, mut longest) = (0.5_f64, 0.5_f64);
    for lag in 1..length {
        time += product(lag) / variance;
        longest = longest.max(time);
        if lag as f64 >= WINDOW * time {
            break;
        }
    }
    Some(Memory { time: time.max(0.5), longest })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};

    /// Values of which each keeps the share `memory` of the one before; variance 1.
    fn noise(seed: u64, length: usize, memory: f64) -> Vec<f64> {
        let mut random = Streams::new(seed).at(0, Phase::Collisions).stream(0);
        let mut value = random.gaussian();
        let kick = (1.0 - memory * memory).sqrt();
        (0..length)
            .map(|_| {
                value = memory * value + kick * random.gaussian();
                value
            })
            .collect()
    }

    #[test]
    fn blocks_of_noise_with_memory_cover_the_truth() {
        // t = 1/2 (1 + 0.6)/(1 − 0.6) = 2; in units of their errors, block means scatter by 1. Memory across the ends
        // of a block of 100 makes the true error 1.6 % smaller; the estimate of t is low by about 2(2t + 1)/n.
        let (runs, length) = (200, 1000);
        let (mut squares, mut count) = (0.0, 0.0);
        for seed in 0..runs {
            let blocked = blocked(&noise(seed, length, 0.6)).expect("a long series");
            for k in (0..length).step_by(length / blocked.blocks) {
                squares += (blocked.values[k] / blocked.errors[k]).powi(2);
                count += 1.0;
            }
        }
        let ratio: f64 = squares / count;
        assert!((ratio - 1.0).abs() < 0.06 + 4.0 * (2.0_f64 / count).sqrt(), "{ratio}");
    }

    #[test]
    fn nothing_is_pretended_of_a_walk_or_a_bend() {
        let mut sum = 0.0;
        let walk: Vec<f64> = noise(3, 1000, 0.0)
            .iter()
            .map(|step| {
                sum += step;
                sum
            })
            .collect();
        assert_eq!(blocked(&walk), None);
        assert!(correlation_time(&[walk]).is_some_and(|time| time > 50.0));
        let bend: Vec<f64> =
            noise(4, 200, 0.0).iter().enumerate().map(|(k, y)| y + (k as f64 / 30.0).powi(2)).collect();
        assert_eq!(blocked(&bend), None);
        assert_eq!(blocked(&[1.0; 50]), None);
        assert_eq!(blocked(&[]), None);
    }
}
