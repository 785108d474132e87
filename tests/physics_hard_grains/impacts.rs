//! Impact parameters: molecular chaos in an elastic gas, grazing collisions in a clustering one.

use glam::{DVec2, DVec3};
use grainflow::engine::report::IMPACT_BINS;

use crate::trial::{Space, Trial, periodic};

type Histogram = [u64; IMPACT_BINS];

/// χ² of `counts` against p ∝ 1/(1 − c b²) for disks and b/(1 − c b²) for spheres.
fn chi_square<V: Space>(counts: &Histogram, c: f64) -> f64 {
    let edge = |bin: usize| V::impact_integral(c, bin as f64 / IMPACT_BINS as f64);
    let number: f64 = counts.iter().map(|&count| count as f64).sum();
    let term = |(bin, &count): (usize, &u64)| {
        let expected = number * (edge(bin + 1) - edge(bin)) / edge(IMPACT_BINS);
        (count as f64 - expected).powi(2) / expected
    };
    counts.iter().enumerate().map(term).sum()
}

/// Molecular chaos passes: χ² of 39 degrees of freedom within five standard deviations. A hint of grazing, c = 0.05,
/// does not.
fn check<V: Space>(count: u32, volume_fraction: f64, collisions: f64) {
    let mut trial = Trial::<V>::equilibrated(&periodic::<V>(count, volume_fraction, 1.0), 3, 10.0);
    trial.advance_to(2.0 * collisions / f64::from(count));
    let counts = &trial.totals.events.impacts;
    assert_eq!(counts.iter().sum::<u64>(), trial.totals.counts.collisions);
    let freedom = (IMPACT_BINS - 1) as f64;
    let most = freedom + 5.0 * (2.0 * freedom).sqrt();
    let [chaos, grazing] = [0.0, 0.05].map(|c| chi_square::<V>(counts, c));
    println!("{}D ν = {volume_fraction}: χ² = {chaos:.1}, at c = 0.05 {grazing:.1}", V::DIMENSION);
    assert!(chaos < most, "χ² = {chaos}");
    assert!(grazing > most, "no power: χ² = {grazing} at c = 0.05");
}

#[test]
fn elastic_grains_meet_at_chaotic_impact_parameters() {
    check::<DVec2>(2000, 0.3, 1e6);
    check::<DVec3>(2000, 0.2, 1e6);
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn dense_elastic_grains_meet_at_chaotic_impact_parameters() {
    check::<DVec2>(4000, 0.6, 2e6);
    check::<DVec3>(4000, 0.45, 2e6);
}

/// Density of |b|/d in the last tenth, in stretches that end at `taus`.
fn grazing(count: u32, taus: &[f64]) -> Vec<f64> {
    let mut trial = Trial::<DVec2>::equilibrated(&periodic::<DVec2>(count, 0.25, 0.8), 7, 10.0);
    let mut before = (0, 0);
    let mut density = |&tau: &f64| {
        trial.advance_to(tau);
        let impacts = trial.totals.events.impacts;
        let last: u64 = impacts[IMPACT_BINS - IMPACT_BINS / 10..].iter().sum();
        let now = (last, trial.totals.counts.collisions);
        let density = 10.0 * (now.0 - before.0) as f64 / (now.1 - before.1) as f64;
        before = now;
        density
    };
    let found: Vec<f64> = taus.iter().map(&mut density).collect();
    println!("N = {count}: p(|b|/d > 0.9) in stretches up to {taus:?}: {found:.4?}");
    found
}

/// As in figure 3.7 of Müller 2001: flat at first but for some per cent, then ever more grazing.
fn grows(found: &[f64]) -> bool {
    (found[0] - 1.0).abs() < 0.07
        && found[1..].is_sorted_by(|early, late| early < late)
        && found[found.len() - 1] > 1.15
}

#[test]
fn a_clustering_gas_comes_to_graze() {
    assert!(grows(&grazing(10_000, &[10.0, 40.0, 80.0, 160.0])));
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn a_large_clustering_gas_comes_to_graze() {
    assert!(grows(&grazing(99_856, &[10.0, 40.0, 80.0, 160.0])));
}
