//! Pressure and collision frequency of elastic fluids.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use grainflow::space::Vector;

use crate::claim::{Claim, replicas};
use crate::trial::{Space, Trial, periodic};

/// What an elastic fluid in equilibrium shows.
#[derive(Clone, Copy, Debug)]
struct State {
    /// PV/NT from the momentum that collisions carry.
    compressibility: f64,
    /// The same from the frequency of collisions.
    from_frequency: f64,
}

/// The state of so many grains over so many collisions, after 40 collisions per particle.
fn state<V: Space>(count: u32, volume_fraction: f64, collisions: f64, seed: u64) -> State {
    let mut trial = Trial::<V>::equilibrated(&periodic::<V>(count, volume_fraction, 1.0), seed, 40.0);
    trial.advance_to(2.0 * collisions / f64::from(count));
    let (time, temperature) = (trial.gas.time(), trial.temperature());
    let counts = trial.totals.counts;
    assert_eq!(trial.invalid_states(), 0);
    let grains = f64::from(count);
    // (√π/4) ω d √(m/T) for disks, (√π/6) for spheres.
    let share = PI.sqrt() / (2.0 * V::DIMENSION as f64);
    let frequency = 2.0 * counts.collisions as f64 / (grains * time);
    let carried = counts.carried_momentum / (V::DIMENSION as f64 * grains * temperature * time);
    State { compressibility: 1.0 + carried, from_frequency: 1.0 + share * frequency / temperature.sqrt() }
}

/// Carnahan and Starling's Z.
fn spheres(volume_fraction: f64) -> f64 {
    1.0 + 4.0 * volume_fraction * DVec3::contact_correlation(volume_fraction)
}

/// Henderson's Z with the correction ν³/(128 (1 − ν)⁴) of g.
fn disks(volume_fraction: f64) -> f64 {
    let correction = volume_fraction.powi(3) / (128.0 * (1.0 - volume_fraction).powi(4));
    1.0 + 2.0 * volume_fraction * (DVec2::contact_correlation(volume_fraction) - correction)
}

/// `collisions` in all of `number` replicas of `count` grains.
fn check<V: Space>(
    (number, count): (u64, u32),
    volume_fraction: f64,
    collisions: f64,
    theory: f64,
    tolerance: f64,
) {
    let states = std::sync::Mutex::new(Vec::new());
    let measure = |seed| {
        let state = state::<V>(count, volume_fraction, collisions / number as f64, seed);
        states.lock().unwrap().push(state);
        state.compressibility
    };
    let found = replicas(number, measure);
    let name = format!("{}D ν = {volume_fraction}", V::DIMENSION);
    Claim { theory, tolerance }.check(&format!("PV/NT, {name}"), &found);
    let identity = states.into_inner().unwrap();
    let identity: Vec<f64> =
        identity.iter().map(|state| (state.compressibility - 1.0) / (state.from_frequency - 1.0)).collect();
    Claim { theory: 1.0, tolerance: 0.002 }.check(&format!("Z − 1 from frequency, {name}"), &identity);
}

#[test]
fn fluids_have_their_pressure() {
    check::<DVec3>((8, 2000), 0.4, 2e6, spheres(0.4), 0.008);
    check::<DVec2>((8, 2048), 0.5, 3.2e6, disks(0.5), 0.004);
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn spheres_have_the_pressure_of_carnahan_and_starling() {
    for volume_fraction in [0.1, 0.2, 0.3, 0.4, 0.45] {
        check::<DVec3>((8, 4000), volume_fraction, 3.2e6, spheres(volume_fraction), 0.008);
    }
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn disks_have_the_pressure_of_henderson_corrected() {
    for volume_fraction in [0.1, 0.3, 0.45, 0.6] {
        check::<DVec2>((8, 4000), volume_fraction, 3.2e6, disks(volume_fraction), 0.004);
    }
}
