//! A cooling gas follows Haff's law per collision, and leaves it.

use glam::{DVec2, DVec3};
use grainflow::law::kinetic_theory::{cooling_per_collision, sonine_c_star};

use crate::claim::Claim;
use crate::trial::{Space, Trial, periodic};

const RESTITUTION: f64 = 0.9;
const VOLUME_FRACTION: f64 = 0.25;
/// Elastic collisions per particle before cooling begins.
const EQUILIBRATION: f64 = 10.0;

/// T at `taus` collisions per particle over T₀ exp(−2γ₀ (1 + c*/8) τ).
fn ratios<V: Space>(count: u32, taus: &[f64], seed: u64) -> Vec<f64> {
    let text = periodic::<V>(count, VOLUME_FRACTION, RESTITUTION);
    let mut trial = Trial::<V>::equilibrated(&text, seed, EQUILIBRATION);
    let rate = 2.0 * cooling_per_collision::<V>(RESTITUTION) * (1.0 + sonine_c_star::<V>(RESTITUTION) / 8.0);
    let mut ratio = |&tau: &f64| {
        trial.advance_to(tau);
        trial.temperature() * (rate * trial.totals.collisions_per_particle).exp()
    };
    let ratios: Vec<f64> = taus.iter().map(&mut ratio).collect();
    assert_eq!(trial.invalid_states(), 0);
    println!("{}D N = {count}, seed {seed}: T/Haff at {taus:?} {ratios:.4?}", V::DIMENSION);
    ratios
}

/// Within 1 % at every τ of `taus`; the mean of four seeds. What they come to at `late`.
fn check<V: Space>(count: u32, taus: &[f64], late: f64) -> Vec<f64> {
    let all = [taus, &[late]].concat();
    let runs: Vec<Vec<f64>> = (1..=4).map(|seed| ratios::<V>(count, &all, seed)).collect();
    for (k, tau) in taus.iter().enumerate() {
        let found: Vec<f64> = runs.iter().map(|run| run[k]).collect();
        let subject = format!("T/Haff at τ = {tau}, {}D N = {count}", V::DIMENSION);
        Claim { theory: 1.0, tolerance: 0.01 }.check(&subject, &found);
    }
    runs.iter().map(|run| run[taus.len()]).collect()
}

#[test]
fn a_small_gas_cools_as_haff_says_and_leaves_his_law() {
    let late = check::<DVec2>(10_000, &[1.0, 3.0, 5.0], 20.0);
    assert!(late.iter().all(|&ratio| ratio > 1.03), "{late:?}");
    check::<DVec3>(10_000, &[2.0, 5.0], 8.0);
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn a_gas_cools_as_haff_says_and_leaves_his_law() {
    let late = check::<DVec2>(100_000, &[1.0, 2.0, 3.0, 4.0, 5.0], 20.0);
    assert!(late.iter().all(|&ratio| ratio > 1.03), "{late:?}");
    check::<DVec3>(100_000, &[1.0, 2.0, 4.0, 6.0, 7.0, 8.0], 10.0);
}

/// Fifty collisions per particle into the cooling, no two grains ever overlap.
fn check_states<V: Space>(count: u32) {
    let mut trial = Trial::<V>::equilibrated(&periodic::<V>(count, VOLUME_FRACTION, RESTITUTION), 5, 1.0);
    for k in 1..=10 {
        trial.advance_to(5.0 * f64::from(k));
        assert_eq!(trial.invalid_states(), 0, "{}D at τ = {}", V::DIMENSION, 5 * k);
    }
}

#[test]
fn no_state_of_a_small_cooling_gas_is_invalid() {
    check_states::<DVec2>(10_000);
    check_states::<DVec3>(10_000);
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn no_state_of_a_cooling_gas_is_invalid() {
    check_states::<DVec2>(100_000);
    check_states::<DVec3>(100_000);
}
