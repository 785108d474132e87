//! Errors of differences that accumulate: a curve that is the sum of what chance adds from recording to recording.
//!
//! The energy of a gas that cools is such a curve. Its logarithm falls by the sum of what single collisions take, and the
//! fluctuation of each stays for good: after τ collisions per particle ln E has the variance 2γ²τ/N while the gas is
//! homogeneous, whatever τ. Such a curve never has a scatter about which it settles, but its growth over distinct
//! stretches is nearly independent, and the error of a sum of independent terms follows from their scatter.

use super::memory::correlation_time;
use super::scatter::{FREEDOM, window};

/// Independent stretches of growth that one run must hold before their scatter says anything.
const LEAST_STRETCHES: f64 = 20.0;
/// Degrees of freedom that replicas must give together; fewer are no better than the replicas themselves.
const LEAST_FREEDOM: f64 = 10.0;
/// Stretches whose growth is looked at are this share of the clock long, or longer.
const APART: f64 = 0.009_999;
/// What a gas keeps of its beginning changes its rate for as long as it runs, and no run by itself shows that. Among 20 pairs
/// of seeds of homogeneous cooling, ln E of event-driven dynamics has 1.9 times the variance that its growth in
/// distinct stretches says at τ = 20, that of HSMC 1.0 times at τ = 20 and 2.7 times at τ = 50; variances are taken as twice as
/// large.
const KEPT: f64 = 2.0;
/// Parameters of the rate at which two curves of one run part: it is linear in the clock.
const RATE: f64 = 2.0;

/// What is known of a curve that accumulates chance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Walk {
    /// Standard error at each place.
    pub(super) errors: Vec<f64>,
    /// Degrees of freedom of each.
    pub(super) freedom: f64,
    /// Integrated autocorrelation time of the growth, in units of the clock.
    pub(super) correlation: f64,
}

/// `rest` `[replica][place]` is what is left without the mean over replicas; all begin alike, `clock` rises.
///
/// The variance that a unit of the clock adds is that of the growth between neighbouring places, times 2t for its
/// integrated autocorrelation time t, as a mean over a window of places that is as narrow as 30 degrees of freedom
/// allow. The variance at a place is the sum of what was added up to there, doubled: see [`KEPT`].
pub(super) fn of_replicas(rest: &[Vec<f64>], clock: &[f64]) -> Option<Walk> {
    let knots = knots(clock);
    let rest: Vec<Vec<f64>> = rest.iter().map(|row| growth(&at(row, &knots))).collect();
    let replicas = rest.len() as f64;
    let walk = Growth { rest, gaps: growth(&at(clock, &knots)) }.walk(|_| replicas - 1.0)?;
    let errors = between(&walk.errors, &knots, clock).iter().map(|error| error / replicas.sqrt()).collect();
    (walk.freedom >= LEAST_FREEDOM).then_some(Walk { errors, ..walk })
}

/// The difference of two single runs that begin alike: its growth is taken about a rate that is linear in `clock`, so
/// that a lasting difference counts as such and not as scatter. `None` with less than 20 independent stretches.
pub(super) fn of_one(values: &[f64], clock: &[f64]) -> Option<Walk> {
    let (places, knots) = (clock, knots(clock));
    let (values, clock) = (at(values, &knots), at(clock, &knots));
    let (steps, gaps) = (growth(&values), growth(&clock));
    let middles: Vec<f64> = clock.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let rest = about_a_linear_rate(&steps, &gaps, &middles)?;
    let count = steps.len() as f64;
    let kept = |stretches: f64| (1.0 - RATE / stretches).max(0.0);
    let growth = Growth { rest: vec![rest], gaps };
    if count / (2.0 * growth.correlation()?) < LEAST_STRETCHES {
        return None;
    }
    let walk = growth.walk(kept)?;
    Some(Walk { errors: between(&walk.errors, &knots, places), ..walk })
}

/// Places at least a hundredth of the whole clock apart, with the first and the last.
fn knots(clock: &[f64]) -> Vec<usize> {
    let last = clock.len().saturating_sub(1);
    let apart = (clock.last().copied().unwrap_or(0.0) - clock.first().copied().unwrap_or(0.0)) * APART;
    let mut knots: Vec<usize> = Vec::new();
    for (k, time) in clock.iter().enumerate() {
        if knots.last().is_none_or(|before| time - clock[*before] >= apart) {
            knots.push(k);
        }
    }
    if knots.last().is_some_and(|knot| *knot != last) {
        // The rest of the clock joins the stretch before it.
        if knots.len() > 1 {
            knots.pop();
        }
        knots.push(last);
    }
    knots
}

fn at(values: &[f64], knots: &[usize]) -> Vec<f64> {
    knots.iter().map(|k| values[*k]).collect()
}

/// Errors at all places of `clock` from those at `knots`: between these the variance grows evenly.
fn between(errors: &[f64], knots: &[usize], clock: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; clock.len()];
    for (pair, ends) in knots.windows(2).zip(errors.windows(2)) {
        for k in pair[0]..=pair[1] {
            let share = (clock[k] - clock[pair[0]]) / (clock[pair[1]] - clock[pair[0]]);
            let [a, b] = [ends[0] * ends[0], ends[1] * ends[1]];
            all[k] = (a + share * (b - a)).sqrt();
        }
    }
    all
}

fn growth(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// `steps` without the rate a + b·middle that fits them best, each weighed by what it is known to: its gap.
fn about_a_linear_rate(steps: &[f64], gaps: &[f64], middles: &[f64]) -> Option<Vec<f64>> {
    let whole: f64 = gaps.iter().sum();
    let centre = middles.iter().zip(gaps).map(|(middle, gap)| middle * gap).sum::<f64>() / whole;
    let level = steps.iter().sum::<f64>() / whole;
    let arms = || middles.iter().map(|middle| middle - centre);
    let square: f64 = arms().zip(gaps).map(|(arm, gap)| arm * arm * gap).sum();
    if !(whole > 0.0 && square > 0.0) {
        return None;
    }
    let slope = arms().zip(steps).map(|(arm, step)| arm * step).sum::<f64>() / square;
    Some(arms().zip(steps).zip(gaps).map(|((arm, step), gap)| step - (level + slope * arm) * gap).collect())
}

/// What was added from place to place, without its mean.
struct Growth {
    /// `[replica][gap]`.
    rest: Vec<Vec<f64>>,
    /// Of the clock.
    gaps: Vec<f64>,
}

impl Growth {
    /// Integrated autocorrelation time in gaps, of what is added per root of the clock: that has the same scatter
    /// everywhere.
    fn correlation(&self) -> Option<f64> {
        let even = |row: &Vec<f64>| row.iter().zip(&self.gaps).map(|(step, gap)| step / gap.sqrt()).collect();
        let even: Vec<Vec<f64>> = self.rest.iter().map(even).collect();
        correlation_time(&even)
    }

    /// `each`: degrees of freedom per independent stretch, of so many stretches.
    fn walk(&self, each: impl Fn(f64) -> f64) -> Option<Walk> {
        let count = self.gaps.len();
        if count < 2 || !self.gaps.iter().all(|gap| *gap > 0.0) {
            return None;
        }
        let correlation = self.correlation()?;
        let each = each(count as f64 / (2.0 * correlation));
        let width = ((FREEDOM * 2.0 * correlation / each).ceil() as usize).clamp(1, count);
        let (mut freedom, mut variance) = (f64::INFINITY, 0.0);
        let mut errors = vec![0.0];
        for k in 0..count {
            let window = window(k, width, count);
            let gaps = &self.gaps[window.clone()];
            let span: f64 = gaps.iter().sum();
            // Long gaps weigh more: so many alike would tell as much.
            let alike = span * span / gaps.iter().map(|gap| gap * gap).sum::<f64>();
            freedom = freedom.min(each * alike / (2.0 * correlation));
            let squares: f64 =
                self.rest.iter().flat_map(|row| &row[window.clone()]).map(|step| step * step).sum();
            variance += KEPT * squares / (each * span) * 2.0 * correlation * self.gaps[k];
            errors.push(variance.sqrt());
        }
        let correlation = correlation * self.gaps.iter().sum::<f64>() / count as f64;
        Some(Walk { errors, freedom, correlation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_are_a_hundredth_apart_and_hold_both_ends() {
        let even: Vec<f64> = (0..=50).map(f64::from).collect();
        assert_eq!(knots(&even), (0..=50).collect::<Vec<usize>>());
        let powers: Vec<f64> = (0..60).map(|k| 1.2_f64.powi(k) - 1.0).collect();
        let found = knots(&powers);
        assert_eq!((found[0], found[found.len() - 1]), (0, 59));
        let shortest =
            found.windows(2).map(|pair| powers[pair[1]] - powers[pair[0]]).fold(f64::INFINITY, f64::min);
        assert!(shortest >= APART * powers[59] && found.len() > 20, "{found:?}");
        // Where the variance grows evenly at knots it does so everywhere.
        let errors: Vec<f64> = found.iter().map(|k| powers[*k].sqrt()).collect();
        let all = between(&errors, &found, &powers);
        assert!(
            all.iter()
                .zip(&powers)
                .all(|(error, time)| (error - time.sqrt()).abs() < 1e-9 * time.sqrt() + 1e-12)
        );
    }
}
