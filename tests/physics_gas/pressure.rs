//! The collisional pressure of an elastic CBA gas: the equation of state.
//!
//! The bias has two parts, both in inverse proportion to the grains per cell: g of the local density is not g of
//! the mean density (up to +2 % here), and pairs that have collided are displaced out of each other's
//! cell, so that those left are slower relative to each other (−0.4 %, and more at shorter steps).

use glam::{DVec2, DVec3};
use grainflow::law::kinetic_theory::compressibility_factor;
use grainflow::space::Vector;

use crate::bed::{Bed, Kind, Plan};
use crate::claim::{Claim, replicas};

/// Collisions per particle until the density has its own fluctuations, and over which flux is counted.
const EQUILIBRATION: f64 = 20.0;
const WINDOW: f64 = 40.0;

/// Σ p·s/(D N T t), which is PV/NT − 1.
fn collisional_pressure<V: Vector>(plan: Plan, seed: u64) -> f64 {
    let mut bed = Bed::<V>::equilibrated(plan, seed, EQUILIBRATION);
    bed.advance_to(WINDOW);
    let grains = bed.gas.len() as f64;
    bed.totals.counts.carried_momentum / (V::DIMENSION as f64 * grains * bed.temperature() * bed.gas.time())
}

fn check<V: Vector>(volume_fraction: f64, cells: u32, grains_per_cell: f64) {
    let theory = compressibility_factor::<V>(volume_fraction, 1.0) - 1.0;
    let plan = Plan::new(Kind::Cba, volume_fraction, cells, grains_per_cell);
    let pressures = replicas(4, |seed| collisional_pressure::<V>(plan, seed));
    Claim { theory, tolerance: 0.02 }
        .check(&format!("collisional pressure, {}D ν = {volume_fraction}", V::DIMENSION), &pressures);
}

#[test]
fn disks_carry_the_pressure_of_the_equation_of_state() {
    for volume_fraction in [0.1, 0.2, 0.3] {
        check::<DVec2>(volume_fraction, 26, 10.0);
    }
}

#[test]
fn spheres_carry_the_pressure_of_the_equation_of_state() {
    check::<DVec3>(0.1, 9, 10.0);
    check::<DVec3>(0.2, 9, 10.0);
    check::<DVec3>(0.3, 8, 20.0);
}
