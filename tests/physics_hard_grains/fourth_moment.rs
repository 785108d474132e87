//! The fourth moment of velocities in the homogeneous cooling state.

use glam::{DVec2, DVec3};
use grainflow::law::kinetic_theory::sonine_c_star;
use grainflow::matter::gas::Gas;
use grainflow::observe::moments::mean_velocity;
use grainflow::space::Vector;

use crate::claim::{Claim, replicas};
use crate::trial::{Space, Trial, periodic};

/// So few grains that the box is too small for shear modes and clusters.
const GRAINS: u32 = 2000;
const VOLUME_FRACTION: f64 = 0.01;
/// Collisions per particle over which a₂ is averaged.
const WINDOW: [u32; 2] = [5, 25];

/// a₂ = D/(D + 2) ⟨v⁴⟩/⟨v²⟩² − 1. With energy and momentum given, Maxwellian velocities of a finite number of
/// grains are points of a sphere in D (N − 1) dimensions, and show −2/(D N) in place of 0: that is taken out.
fn sonine_coefficient<V: Vector>(gas: &Gas<V>) -> f64 {
    let mean = mean_velocity(gas);
    let (mut second, mut fourth) = (0.0, 0.0);
    for &velocity in gas.velocities() {
        let square = (velocity - mean).length_squared();
        second += square;
        fourth += square * square;
    }
    let (d, grains) = (V::DIMENSION as f64, gas.len() as f64);
    d / (d + 2.0) * grains * fourth / (second * second) - 1.0 + 2.0 / (d * grains)
}

/// a₂ averaged over the window.
fn mean_coefficient<V: Space>(restitution: f64, seed: u64) -> f64 {
    let mut trial = Trial::<V>::equilibrated(&periodic::<V>(GRAINS, VOLUME_FRACTION, restitution), seed, 2.0);
    let mut sum = 0.0;
    for tau in WINDOW[0]..WINDOW[1] {
        trial.advance_to(f64::from(tau));
        sum += sonine_coefficient(&trial.gas);
    }
    sum / f64::from(WINDOW[1] - WINDOW[0])
}

/// 1 + a₂ within `tolerance` of 1 + c*/2.
///
/// The law is one of first order, and itself off: at r = 0.9 in 2D, where c*/2 = −0.0269, a gas without space (dsmc,
/// one cell, 240 times 2000 grains) has −0.0293 ± 0.0005, exact dynamics −0.0291 ± 0.0004 (400 times 2000 grains)
/// and −0.0280 ± 0.0004 (60 times 8000).
fn check<V: Space>(restitution: f64, number: u64, tolerance: f64) {
    let theory = 0.5 * sonine_c_star::<V>(restitution);
    let found = replicas(number, |seed| 1.0 + mean_coefficient::<V>(restitution, seed));
    let mean = found.iter().sum::<f64>() / found.len() as f64 - 1.0;
    let name = format!("{}D r = {restitution}", V::DIMENSION);
    println!("{name}: a₂ = {mean:.5}, theory {theory:.5}");
    Claim { theory: 1.0 + theory, tolerance }.check(&format!("1 + a₂, {name}"), &found);
}

#[test]
fn velocities_have_their_fourth_moment() {
    check::<DVec2>(0.9, 80, 0.008);
    check::<DVec3>(0.9, 80, 0.008);
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn velocities_have_their_fourth_moment_closely() {
    for restitution in [0.9, 0.7] {
        check::<DVec2>(restitution, 400, 0.005);
        check::<DVec3>(restitution, 400, 0.005);
    }
}
