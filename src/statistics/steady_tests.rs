//! What errors and the test for steadiness are worth, measured on series of which everything is known.

use super::series::{Kind, Series};
use super::student;
use super::{SteadyEstimate, Trend};

fn of_values(values: &[f64]) -> SteadyEstimate {
    let pairs: Vec<[f64; 2]> = values.iter().map(|value| [*value, 1.0]).collect();
    SteadyEstimate::ratio(&pairs).unwrap()
}

/// Shares of `series` series of `count` values whose true mean, zero, lies inside the intervals of 68.27 and 95.45 %.
fn inside(kind: Kind, count: usize, series: u64, seed: u64) -> [f64; 2] {
    let mut hits = [0.0; 2];
    for k in 0..series {
        let estimate = of_values(&Series::new(seed + k, kind).take(count));
        let (Some(error), Some(freedom)) = (estimate.standard_error, estimate.freedom) else {
            hits.iter_mut().for_each(|hit| *hit += 1.0);
            continue;
        };
        let outside = student::two_sided(estimate.value.abs() / error, freedom);
        hits[0] += f64::from(u8::from(outside > 0.3173));
        hits[1] += f64::from(u8::from(outside > 0.0455));
    }
    hits.map(|hit| hit / series as f64)
}

/// Kinds and lengths whose errors have to hold: correlation times of 0.3 to 100 values, at least 20 of them in a series.
const REMEMBERING: [(Kind, usize); 14] = [
    (Kind::White, 20),
    (Kind::White, 200),
    (Kind::White, 2000),
    (Kind::Remembering(0.3), 200),
    (Kind::Remembering(1.0), 200),
    (Kind::Remembering(3.0), 200),
    (Kind::Remembering(3.0), 2000),
    (Kind::Remembering(10.0), 400),
    (Kind::Remembering(10.0), 2000),
    (Kind::Remembering(30.0), 2000),
    (Kind::Remembering(100.0), 4000),
    (Kind::Noisy(3.0), 400),
    (Kind::Noisy(10.0), 1000),
    (Kind::Noisy(30.0), 2000),
];

/// Asserts that intervals hold, pooled over all kinds; and that none of them is far off.
fn intervals_hold(series: u64, seed: u64) {
    let shares: Vec<[f64; 2]> =
        REMEMBERING.iter().map(|(kind, count)| inside(*kind, *count, series, seed)).collect();
    for ((kind, count), share) in REMEMBERING.iter().zip(&shares) {
        // A share of n series scatters by √(p(1 − p)/n).
        let scatter = |p: f64| 3.0 * (p * (1.0 - p) / series as f64).sqrt();
        assert!((share[0] - 0.6827).abs() < 0.08 + scatter(0.68), "{kind:?} of {count}: {share:?}");
        assert!((share[1] - 0.9545).abs() < 0.03 + scatter(0.95), "{kind:?} of {count}: {share:?}");
    }
    let pooled = [0, 1].map(|k| shares.iter().map(|share| share[k]).sum::<f64>() / shares.len() as f64);
    assert!((pooled[0] - 0.68).abs() < 0.05 && (pooled[1] - 0.95).abs() < 0.025, "{pooled:?}");
}

#[test]
fn true_means_lie_inside_their_intervals_as_often_as_these_say() {
    intervals_hold(100, 10_000);
}

#[test]
#[ignore = "half a minute: cargo test --release --lib -- --ignored true_means_of_many_series"]
fn true_means_of_many_series_lie_inside_their_intervals() {
    intervals_hold(2000, 50_000);
}

#[test]
fn a_memory_as_long_as_the_series_leaves_no_small_error() {
    // The mean of a series of half a correlation time is off by nearly its standard deviation.
    let is_misleading = |seed: &u64| {
        let estimate = of_values(&Series::new(*seed, Kind::Remembering(800.0)).take(400));
        let stated = estimate.standard_error.zip(estimate.freedom);
        let is_off = stated
            .is_some_and(|(error, freedom)| student::two_sided(estimate.value.abs() / error, freedom) < 1e-2);
        is_off && estimate.trend == Some(Trend::Steady)
    };
    let misleading = (0..200).filter(is_misleading).count();
    assert!(misleading <= 20, "{misleading} of 200");
}

/// A change by so many of its own standard errors on top of noise of variance 1: by a straight line, or at one place.
fn changed(seed: u64, count: usize, errors: f64, place: Option<f64>) -> Vec<f64> {
    let values = Series::new(seed, Kind::White).take(count);
    let n = count as f64;
    let shift = |k: usize| match place {
        // Var of the slope is 12/n³, of the difference of two means 1/(n p (1 − p)).
        None => errors * (12.0 / n).sqrt() * k as f64 / n,
        Some(place) if k as f64 >= place * n => errors / (n * place * (1.0 - place)).sqrt(),
        Some(_) => 0.0,
    };
    values.iter().enumerate().map(|(k, x)| x + shift(k)).collect()
}

/// The kinds of series that the test has to tell apart, and whether they are steady; `part` in [0, 1) chooses among those of a
/// kind.
fn of_kind(kind: usize, seed: u64, part: f64) -> (Vec<f64>, bool) {
    let count = [200, 400, 1000][(seed % 3) as usize];
    let n = count as f64;
    let series = |kind: Kind| Series::new(seed, kind).take(count);
    match kind {
        0 => (changed(seed, count, 5.0 + 5.0 * part, None), false),
        1 => (changed(seed, count, 5.0 + 5.0 * part, Some(0.2 + 0.6 * (part * 7.0).fract())), false),
        2 => (series(Kind::Remembering(n * (0.5 + 1.5 * part))), false),
        3 => (series(Kind::Oscillating(10.0 + 40.0 * part)), true),
        4 => (series(Kind::White), true),
        _ => (series(Kind::Remembering(n / (50.0 + 350.0 * part))), true),
    }
}

const KINDS: [&str; 6] = ["drift", "jump", "wandering", "oscillation", "white", "correlated"];

/// Shares of series of each kind that are classified correctly.
fn told_right(series: u64, seed: u64) -> [f64; 6] {
    std::array::from_fn(|kind| {
        let right = (0..series).filter(|k| {
            let (values, is_steady) = of_kind(kind, seed + k, *k as f64 / series as f64);
            (of_values(&values).trend == Some(Trend::Steady)) == is_steady
        });
        right.count() as f64 / series as f64
    })
}

#[test]
fn two_hundred_series_of_each_kind_are_told_right() {
    for (kind, share) in KINDS.iter().zip(told_right(200, 900_000)) {
        assert!(share >= 0.95, "{kind}: {share}");
    }
}

#[test]
#[ignore = "half a minute: cargo test --release --lib -- --ignored many_series_of_each_kind"]
fn many_series_of_each_kind_are_told_right() {
    let shares = told_right(4000, 7_000_000);
    for (kind, share) in KINDS.iter().zip(shares) {
        assert!(share >= 0.95, "{kind}: {share}");
    }
    // Of independent values no more than two in a thousand: a run has twenty figures.
    assert!(shares[4] >= 0.998, "{shares:?}");
}

#[test]
fn drifts_have_a_direction() {
    assert_eq!(of_values(&changed(1, 400, 12.0, None)).trend, Some(Trend::Rising));
    assert_eq!(of_values(&changed(2, 400, -12.0, None)).trend, Some(Trend::Falling));
    assert_eq!(of_values(&changed(3, 400, -12.0, Some(0.3))).trend, Some(Trend::Falling));
    assert_eq!(of_values(&changed(4, 11, 0.0, None)).trend, None);
    assert_eq!(of_values(&[2.5; 40]).trend, Some(Trend::Steady));
}

#[test]
fn the_errors_of_a_rate_and_of_its_inverse_fit() {
    let noise = Series::new(5, Kind::Remembering(2.0)).take(300);
    let other = Series::new(6, Kind::White).take(300);
    let pairs: Vec<[f64; 2]> = noise.iter().zip(&other).map(|(a, b)| [1.5 + a, 0.7 + 0.1 * b]).collect();
    let inverse: Vec<[f64; 2]> = pairs.iter().map(|[a, b]| [*b, *a]).collect();
    let (rate, inverse) = (SteadyEstimate::ratio(&pairs).unwrap(), SteadyEstimate::ratio(&inverse).unwrap());
    let share = |estimate: SteadyEstimate| estimate.standard_error.unwrap() / estimate.value;
    assert!((rate.value * inverse.value - 1.0).abs() < 1e-12);
    assert!((share(rate) / share(inverse) - 1.0).abs() < 1e-9, "{rate:?} {inverse:?}");
    assert!((rate.freedom.unwrap() / inverse.freedom.unwrap() - 1.0).abs() < 1e-6);
}

#[test]
fn a_ratio_without_a_denominator_is_none() {
    assert_eq!(SteadyEstimate::ratio(&[]), None);
    assert_eq!(SteadyEstimate::ratio(&[[1.0, 0.0]]), None);
    let one = SteadyEstimate::ratio(&[[3.0, 2.0]]).unwrap();
    assert_eq!((one.value, one.standard_error, one.freedom, one.trend), (1.5, None, None, None));
}

#[test]
fn few_values_show_large_drifts_and_seldom_others() {
    for count in [12, 16, 24] {
        let trend = |seed: u64, errors: f64| of_values(&changed(seed, count, errors, None)).trend;
        let alarms = (0..2000).filter(|seed| trend(*seed, 0.0) != Some(Trend::Steady)).count();
        assert!(alarms <= 12, "{alarms} of 2000 series of {count} values");
        let found = (0..200).filter(|seed| trend(3000 + seed, 20.0) == Some(Trend::Rising)).count();
        assert!(found >= 190, "{found} of 200 series of {count} values");
    }
}
