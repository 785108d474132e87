//! Haff's law in time, at a density where the Enskog factor matters.

use glam::{DVec2, DVec3};
use grainflow::law::kinetic_theory::{collision_frequency, haff_time, sonine_cooling_factor};
use grainflow::space::Vector;

use crate::bed::{Bed, GRAIN, Kind, Plan};
use crate::claim::{Claim, replicas};

const RESTITUTION: f64 = 0.9;
const VOLUME_FRACTION: f64 = 0.25;
/// Elastic collisions per particle before cooling begins.
const EQUILIBRATION: f64 = 10.0;

/// t₀ of T = (1 + t/t₀)⁻², from the least-squares slope of T^{−1/2} − 1 through the origin over `duration`.
fn cooling_time<V: Vector>(kind: Kind, cells: u32, duration: f64, seed: u64) -> f64 {
    let plan = Plan::new(kind, VOLUME_FRACTION, cells, 20.0).with_restitution(RESTITUTION);
    let mut bed = Bed::<V>::equilibrated(plan, seed, EQUILIBRATION);
    let (mut products, mut squares) = (0.0, 0.0);
    while bed.gas.time() < duration {
        bed.step();
        let time = bed.gas.time();
        products += time * (bed.temperature().sqrt().recip() - 1.0);
        squares += time * time;
    }
    squares / products
}

/// `factor` is g for the engines of dense gases and 1 for DSMC.
fn check<V: Vector>(kind: Kind, cells: u32) {
    let factor = if kind == Kind::Dsmc { 1.0 } else { V::contact_correlation(VOLUME_FRACTION) };
    let frequency = collision_frequency::<V>(GRAIN, VOLUME_FRACTION, 1.0, factor);
    let theory = haff_time::<V>(RESTITUTION, frequency) / sonine_cooling_factor::<V>(RESTITUTION);
    let times = replicas(6, |seed| cooling_time::<V>(kind, cells, theory, seed));
    Claim { theory, tolerance: 0.04 }.check(&format!("Haff's time, {kind:?} {}D", V::DIMENSION), &times);
}

#[test]
fn cba_cools_in_enskogs_time() {
    check::<DVec2>(Kind::Cba, 30);
    check::<DVec3>(Kind::Cba, 10);
}

#[test]
fn hsmc_cools_in_enskogs_time() {
    check::<DVec2>(Kind::Hsmc, 30);
    check::<DVec3>(Kind::Hsmc, 10);
}

#[test]
fn dsmc_cools_slower_by_the_enskog_factor() {
    check::<DVec2>(Kind::Dsmc, 30);
    check::<DVec3>(Kind::Dsmc, 10);
}
