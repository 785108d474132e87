use super::*;
use crate::engine::report::Totals;
use crate::matter::grain::Grain;
use crate::observe::testing::{assert_resumes, figure_of, random_positions, setting_of, show};
use crate::statistics::average;
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_4;

/// A square of side 10 with so many grains in each quarter.
fn quarters(counts: [usize; 4]) -> Gas<DVec2> {
    let corner = |k: usize| DVec2::new(2.0 + 5.0 * (k % 2) as f64, 2.0 + 5.0 * (k / 2) as f64);
    let positions: Vec<DVec2> = (0..4).flat_map(|k| vec![corner(k); counts[k]]).collect();
    let velocities = vec![DVec2::ZERO; positions.len()];
    setting_of(DVec2::splat(10.0), [3, 3, 1]).gas(0.0, positions, velocities)
}

#[test]
fn four_regions_by_hand() {
    let state = (quarters([50, 10, 80, 20]), Totals::default());
    // A grain is π/4 of 25. Quantiles at 4 q of the order 10, 20, 50, 80, whose middles are ½ … 3½; variance 1000, mean 40.
    let share = FRAC_PI_4 / 25.0;
    let expected = [10.0, 10.0, 15.0, 35.0, 65.0, 80.0, 80.0].map(|content| content * share);
    let found = show(&mut DensityDistribution::new(), &state);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    assert!((found[7] - 25.0).abs() < 1e-13);
    let median = figure_of(&mut DensityDistribution::new(), &[state], 0.0, "volume_fraction_q50").0;
    assert!((median.unwrap() - expected[3]).abs() < 1e-14);
    // One grain moved, and other quantiles see it.
    let moved = show(&mut DensityDistribution::new(), &(quarters([51, 10, 80, 19]), Totals::default()));
    assert!((moved[3] - expected[3]).abs() < 1e-14 && (moved[2] - expected[2]).abs() > 0.1 * share);
}

#[test]
fn equal_regions_share_a_middle() {
    let found = show(&mut DensityDistribution::new(), &(quarters([20, 10, 110, 20]), Totals::default()));
    // 10 in the middle ½, 20 twice in 2, 110 in 3½: a quarter is at 1, a half at 2, three quarters at 3.
    for (found, content) in found[2..5].iter().zip([10.0 + 10.0 / 3.0, 20.0, 80.0]) {
        assert!((found - content * FRAC_PI_4 / 25.0).abs() < 1e-14, "{found} {content}");
    }
}

#[test]
fn bins_hold_four_whole_numbers_each() {
    let regions = Regions::of(&quarters([3, 4, 7, 146])).unwrap();
    let [middles, density, errors] = &regions.distribution()[..] else { panic!("three columns") };
    let share = FRAC_PI_4 / 25.0;
    assert_eq!(middles.len(), 37);
    assert!((middles[1] - 5.5 * share).abs() < 1e-15);
    // Three in bin 0, four and seven in bin 1, 146 in bin 36.
    let of = [0, 1, 36].map(|bin| density[bin] * BIN * share);
    assert!((of[0] - 0.25).abs() < 1e-14 && (of[1] - 0.5).abs() < 1e-14 && (of[2] - 0.25).abs() < 1e-14);
    // √(2 · (1 − 1/2))/4 of bin 1.
    assert!((errors[1] * BIN * share - 0.25).abs() < 1e-14);
}

/// Variance of random grains over Poisson's: mean and error of 400 gases.
fn variance<V: Vector>(size: V, grains: usize, species: &[Grain]) -> (f64, f64) {
    let bed = setting_of(size, [2, 2, 2]);
    let replicas: Vec<f64> = (0..400)
        .map(|k| {
            let mut gas = bed.gas(0.0, random_positions(k, grains, size), vec![V::ZERO; grains]);
            gas.species = species.to_vec();
            let kinds = species.len().max(1);
            gas.parts_mut().2.species =
                (!species.is_empty()).then(|| (0..grains).map(|row| (row % kinds) as u8).collect());
            figures(Regions::of(&gas).as_ref())[QUANTILES.len()]
        })
        .collect();
    let found = average(&replicas).unwrap();
    (found.value, found.standard_error.unwrap())
}

#[test]
fn independent_grains_have_the_variance_of_poisson() {
    let species = [Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 3.0, mass: 1.0 }];
    for (value, error) in [
        variance(DVec2::new(30.0, 20.0), 2000, &[]),
        variance(DVec3::new(9.0, 10.0, 11.0), 3000, &[]),
        variance(DVec2::new(30.0, 20.0), 2000, &species),
    ] {
        assert!((value - 1.0).abs() < 4.0 * error && error < 0.012, "{value} ± {error}");
    }
    // As many grains in pairs at the same place: twice the variance.
    let positions: Vec<DVec2> = random_positions(5, 1000, DVec2::new(30.0, 20.0));
    let pairs: Vec<DVec2> = positions.iter().flat_map(|&p| [p, p]).collect();
    let gas = setting_of(DVec2::new(30.0, 20.0), [2, 2, 1]).gas(0.0, pairs, vec![DVec2::ZERO; 2000]);
    assert!(figures(Regions::of(&gas).as_ref())[QUANTILES.len()] > 1.3);
}

#[test]
fn regions_hold_forty_grains() {
    assert_eq!(partition(DVec2::new(30.0, 20.0), 6 * 40), [3, 2, 1]);
    assert_eq!(partition(DVec3::splat(10.0), 27 * 40), [3, 3, 3]);
    // A film one thick is not cut across; 20 × 20 regions of 40 beside each other.
    assert_eq!(partition(DVec3::new(100.0, 100.0, 1.0), 400 * 40), [20, 20, 1]);
    // A pipe is cut along alone.
    assert_eq!(partition(DVec3::new(1.0, 900.0, 2.0), 90 * 40), [1, 90, 1]);
    assert_eq!(partition(DVec3::splat(10.0), 1), [1, 1, 1]);
}

#[test]
fn few_grains_or_none() {
    let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
    let empty = (bed.gas(0.0, vec![], vec![]), Totals::default());
    assert!(show(&mut DensityDistribution::new(), &empty).iter().all(|x| x.is_nan()));
    let one = (bed.gas(0.0, vec![DVec3::ONE], vec![DVec3::X]), Totals::default());
    let found = show(&mut DensityDistribution::new(), &one);
    // A single region: its volume fraction at every quantile, and no variance.
    assert!((found[3] - DVec3::UNIT_SPHERE_VOLUME / 64.0).abs() < 1e-15 && found[7].is_nan());
}

#[test]
fn a_run_resumes() {
    let bed = setting_of(DVec2::splat(8.0), [2, 2, 1]);
    assert_resumes(|| Box::new(DensityDistribution::new()), &bed.random_states(20, 500));
}
