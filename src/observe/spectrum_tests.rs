use super::*;
use crate::engine::report::Totals;
use crate::observe::testing::{Bed, assert_resumes, figure_of, setting_of};
use crate::random::{Phase, Stream, Streams};
use glam::{DVec2, DVec3};

const SLICES: usize = 40;

/// A pipe in which √(d/g) = 2, so that samples are 0.1 apart.
fn pipe() -> Bed<DVec2> {
    let mut bed = setting_of(DVec2::new(2.0, 2.0 * SLICES as f64), [1, SLICES as u32, 1]);
    bed.setting.gravity = DVec2::new(0.0, -0.25);
    bed
}

/// A spectrum that has seen `series` of each slice, sampled as it wants.
fn of_series(samples: usize, mut series: impl FnMut(usize) -> Vec<u32>) -> Spectrum {
    let mut spectrum = Spectrum::new(&pipe().setting).unwrap();
    spectrum.times = (0..samples).map(|k| 0.1 * k as f64).collect();
    let by_slice: Vec<Vec<u32>> = (0..SLICES).map(&mut series).collect();
    spectrum.counts = (0..samples).flat_map(|k| by_slice.iter().map(move |slice| slice[k])).collect();
    spectrum
}

fn stream(slice: usize) -> Stream {
    Streams::new(5).at(1, Phase::Collisions).stream(slice as u64)
}

fn slope_of(spectrum: &Spectrum) -> Estimate {
    let (frequencies, power) = spectrum.power().unwrap();
    spectrum.slope(&frequencies, &power).unwrap()
}

#[test]
fn a_sine_has_all_its_power_at_its_frequency() {
    // 75 of 100 samples remain, in segments of 37: three turns in each.
    let spectrum = of_series(100, |_| {
        let phase = |k: usize| std::f64::consts::TAU * 3.0 * k as f64 / 37.0;
        (0..100).map(|k| (1e6 * (1.0 + phase(k).cos())).round() as u32).collect()
    });
    let (frequencies, power) = spectrum.power().unwrap();
    assert_eq!((frequencies.len(), power.len()), (18, 18));
    assert!((frequencies[2] - 3.0 / 3.7).abs() < 1e-12);
    // |C_k| = N a/2: P = 2 (a/2)² = a²/2, the variance, with a in volume fraction.
    let amplitude = 1e6 * std::f64::consts::FRAC_PI_4 / 4.0;
    assert!((power[2] / (0.5 * amplitude * amplitude) - 1.0).abs() < 1e-5);
    let rest: f64 = power.iter().enumerate().filter(|(k, _)| *k != 2).map(|(_, p)| p).sum();
    assert!(rest < 1e-9 * power[2], "{rest}");
}

#[test]
fn parseval_counts_the_variance_once() {
    let mut kept = Vec::new();
    let spectrum = of_series(100, |slice| {
        let mut random = stream(slice);
        let series: Vec<u32> = (0..100).map(|_| random.below(1000) as u32).collect();
        kept.push(series.clone());
        series
    });
    let variance = |segment: &[u32]| {
        let values: Vec<f64> = segment.iter().map(|&x| f64::from(x) * spectrum.share).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64
    };
    let expected: f64 =
        kept.iter().map(|series| variance(&series[25..62]) + variance(&series[62..99])).sum::<f64>()
            / (2 * SLICES) as f64;
    let found: f64 = spectrum.power().unwrap().1.iter().sum();
    assert!((found / expected - 1.0).abs() < 1e-12);
}

#[test]
fn a_power_law_gives_its_exponent() {
    let spectrum = Spectrum::new(&pipe().setting).unwrap();
    let frequencies: Vec<f64> = (1..1500).map(|k| f64::from(k) / 300.0).collect();
    // Outside the range, 0.15 … 2.5 per time here, the power does not matter.
    let power: Vec<f64> =
        frequencies.iter().map(|&f| if (0.15..2.5).contains(&f) { f.powf(-1.3) } else { 1.0 }).collect();
    let slope = spectrum.slope(&frequencies, &power).unwrap();
    assert!((slope.value + 1.3).abs() < 1e-12 && slope.standard_error.unwrap() < 1e-12, "{slope:?}");
}

#[test]
fn white_noise_is_flat() {
    let spectrum = of_series(8000, |slice| {
        let mut random = stream(slice);
        (0..8000).map(|_| random.below(1000) as u32).collect()
    });
    let slope = slope_of(&spectrum);
    assert!(slope.value.abs() < 4.0 * slope.standard_error.unwrap(), "{slope:?}");
    assert!(slope.standard_error.unwrap() < 0.02, "{slope:?}");
}

#[test]
fn a_random_walk_falls_with_the_square() {
    let spectrum = of_series(8000, |slice| {
        let mut random = stream(slice);
        let mut place = 1_000_000.0;
        (0..8000)
            .map(|_| {
                place += 100.0 * random.gaussian();
                place as u32
            })
            .collect()
    });
    // A walk in steps of Δt has P ∝ 1/sin²(πfΔt): the slope that this gives in the same bins.
    let (frequencies, _) = spectrum.power().unwrap();
    let exact: Vec<f64> =
        frequencies.iter().map(|f| (std::f64::consts::PI * f * 0.1).sin().powi(-2)).collect();
    let expected = spectrum.slope(&frequencies, &exact).unwrap().value;
    let slope = slope_of(&spectrum);
    assert!((expected + 2.0).abs() < 0.06, "{expected}");
    // The lowest bin holds 12 frequencies of 80 segments: log P scatters by 1/√960 = 0.03 there, the slope by less than 0.01.
    assert!((slope.value - expected).abs() < 0.03, "{slope:?} {expected}");
}

#[test]
fn a_run_too_short_or_too_coarse_has_no_slope() {
    let noise = |samples: usize| {
        of_series(samples, move |slice| {
            let mut random = stream(slice);
            (0..samples).map(|_| random.below(1000) as u32).collect()
        })
    };
    let slope = |spectrum: &Spectrum| {
        let (frequencies, power) = spectrum.power().unwrap();
        spectrum.slope(&frequencies, &power)
    };
    assert_eq!(slope(&noise(100)), None);
    assert!(noise(3).power().is_none());
    let mut coarse = noise(4000);
    assert!(slope(&coarse).is_some());
    coarse.times.iter_mut().for_each(|time| *time *= 3.0);
    assert_eq!(slope(&coarse), None);
}

#[test]
fn it_samples_a_gas() {
    let bed = pipe();
    let mut measure = Spectrum::new(&bed.setting).unwrap();
    assert_eq!(Measure::<DVec2>::cadence(&measure), Cadence::Every(0.1));
    let gas = bed.gas(0.5, vec![DVec2::new(1.0, 5.0), DVec2::new(1.5, 4.5)], vec![DVec2::ZERO; 2]);
    let totals = Totals::default();
    measure.sample(&Snapshot::new(&gas, &totals));
    measure.sample(&Snapshot::new(&gas, &totals));
    assert_eq!((measure.counts.len(), measure.counts[2]), (SLICES, 2));
    let states = [(gas, totals)];
    assert_eq!(figure_of(&mut measure, &states, 0.0, "spectrum_slope"), (None, None));
}

#[test]
fn it_resumes() {
    let mut bed = setting_of(DVec3::new(4.0, 4.0, 20.0), [2, 2, 10]);
    bed.setting.gravity = DVec3::new(0.0, 0.0, 1.0);
    let make = || Box::new(Spectrum::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec3>>;
    assert_resumes(make, &bed.random_states(60, 200));
}
