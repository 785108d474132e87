//! Whether a series is steady: the test behind `<figure>_steady`.
//!
//! The series is first cut into at most [`PARTS`](super::steady::PARTS) means of consecutive values. It is not steady where one of
//! these is true:
//!
//! * *drift*: the slope of the straight line through it differs from zero, by Student's t, at [`SLOPE`];
//! * *jump*: for one of 25 places between an eighth and seven eighths of the series, the means before and after it differ at [`JUMP`];
//! * *wandering*: the spectrum of its autoregressive model at frequency zero is [`DOMINANCE`] times larger than anywhere from
//!   [`FAST`] cycles per series on; or the mean power of its first four cosine modes is [`LOW_POWER`] times larger than that of
//!   modes 16 to 40. A series that forgets in half its length has ratios of 50 and more, one of fifty correlation times 2 to 4, and an
//!   oscillation of ten periods or more less than one.
//!
//! The errors of slope and jump are those of what remains when slope or jump is taken away (a drift would otherwise hide
//! behind the scatter that it makes), and never smaller than those of independent values. Levels are so strict because a run has
//! some twenty figures.

use super::Trend;
use super::long_run::LongRun;
use super::student;

/// Probability that the slope of a steady series of independent values is taken for a drift.
const SLOPE: f64 = 7e-4;
/// Probability that the difference at one place of such a series is taken for a jump.
const JUMP: f64 = 1e-4;
/// Spectrum at zero over that from [`FAST`] on: beyond this, a series wanders.
const DOMINANCE: f64 = 7.0;
/// Cycles per series of what is fast.
const FAST: usize = 8;
/// Power of the lowest modes over that of high ones: beyond this, a series wanders.
const LOW_POWER: f64 = 16.0;
/// The lowest cosine modes; mode j has j/2 cycles in the series.
const LOWEST: std::ops::RangeInclusive<usize> = 1..=4;
/// High cosine modes.
const HIGH: std::ops::RangeInclusive<usize> = 16..=40;
/// Fewer values are not tested.
pub(super) const FEWEST: usize = 12;
/// In fewer values slow and fast are not told apart, and wandering is not looked for.
const FEWEST_THAT_WANDER: usize = 32;
/// Jumps are looked for at these thirty-seconds of the series.
const PLACES: std::ops::RangeInclusive<usize> = 4..=28;

/// What `values` at even distances do as a whole; `None` where they are too few to tell.
pub(super) fn trend(values: &[f64]) -> Option<Trend> {
    if values.len() < FEWEST {
        return None;
    }
    let centre = values.iter().sum::<f64>() / values.len() as f64;
    let deviations: Vec<f64> = values.iter().map(|x| x - centre).collect();
    let count = deviations.len();
    let slope = change(&deviations, &line(count));
    let jumps = PLACES.map(|place| change(&deviations, &step(count, place * count / 32)));
    let found = slope.filter(|slope| slope.probability < SLOPE);
    let jumped = jumps.flatten().filter(|jump| jump.probability < JUMP);
    let change = found.into_iter().chain(jumped).min_by(|a, b| a.probability.total_cmp(&b.probability));
    Some(match change {
        Some(change) if change.amount > 0.0 => Trend::Rising,
        Some(_) => Trend::Falling,
        None if count >= FEWEST_THAT_WANDER && wanders(&deviations) => Trend::Wandering,
        None => Trend::Steady,
    })
}

/// How much of a pattern there is in a series.
#[derive(Clone, Copy, Debug)]
struct Change {
    amount: f64,
    /// Of so much or more by chance.
    probability: f64,
}

/// The share of `pattern`, of zero mean and unit length, in `deviations`; `None` where these do not vary.
fn change(deviations: &[f64], pattern: &[f64]) -> Option<Change> {
    let amount: f64 = deviations.iter().zip(pattern).map(|(x, p)| x * p).sum();
    let rest: Vec<f64> = deviations.iter().zip(pattern).map(|(x, p)| x - amount * p).collect();
    let freedom = deviations.len() as f64 - 2.0;
    let independent = rest.iter().map(|x| x * x).sum::<f64>() / freedom;
    let (variance, freedom) = match LongRun::of(&rest, 2) {
        Some(long_run) if long_run.variance > independent => (long_run.variance, long_run.freedom),
        _ => (independent, freedom),
    };
    if amount == 0.0 {
        return None;
    }
    let t = amount.abs() / variance.sqrt();
    let probability = if t.is_finite() { student::two_sided(t, freedom) } else { 0.0 };
    Some(Change { amount, probability })
}

/// A straight line of zero mean and unit length.
fn line(count: usize) -> Vec<f64> {
    unit((0..count).map(|k| k as f64 - 0.5 * (count as f64 - 1.0)).collect())
}

/// A step up at `place`, of zero mean and unit length.
fn step(count: usize, place: usize) -> Vec<f64> {
    let (before, after) = (place as f64, (count - place) as f64);
    unit((0..count).map(|k| if k < place { -after } else { before }).collect())
}

fn unit(mut pattern: Vec<f64>) -> Vec<f64> {
    let length = pattern.iter().map(|x| x * x).sum::<f64>().sqrt();
    pattern.iter_mut().for_each(|x| *x /= length);
    pattern
}

/// Whether nearly all that `deviations` do is slow.
fn wanders(deviations: &[f64]) -> bool {
    let count = deviations.len();
    let fast = (FAST..=count / 2).map(|k| k as f64 / count as f64);
    let dominates = LongRun::of(deviations, 1).is_some_and(|found| found.dominance(fast) > DOMINANCE);
    let high = *HIGH.start()..=(*HIGH.end()).min(count - 1);
    dominates || mean_power(deviations, LOWEST) > LOW_POWER * mean_power(deviations, high)
}

/// Mean square of the amplitudes of cosine modes.
fn mean_power(deviations: &[f64], modes: std::ops::RangeInclusive<usize>) -> f64 {
    let count = deviations.len() as f64;
    let power = |mode: usize| {
        let phase = |k: usize| std::f64::consts::PI * mode as f64 * (k as f64 + 0.5) / count;
        let amplitude: f64 = deviations.iter().enumerate().map(|(k, x)| x * libm::cos(phase(k))).sum();
        amplitude * amplitude
    };
    let powers: Vec<f64> = modes.map(power).collect();
    powers.iter().sum::<f64>() / powers.len() as f64
}
