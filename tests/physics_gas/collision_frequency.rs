//! How often grains of an elastic gas collide.

use glam::DVec3;
use grainflow::law::kinetic_theory::collision_frequency;
use grainflow::space::Vector;

use crate::bed::{Bed, GRAIN, Kind, Plan};
use crate::claim::{Claim, replicas};

/// Collisions per particle and time of about 10⁴ grains.
fn frequency(kind: Kind, volume_fraction: f64, cells: u32, grains_per_cell: f64, seed: u64) -> f64 {
    let plan = Plan::new(kind, volume_fraction, cells, grains_per_cell);
    let mut bed = Bed::<DVec3>::equilibrated(plan, seed, 10.0);
    bed.advance_to(20.0);
    bed.totals.collisions_per_particle / bed.gas.time()
}

fn check(kind: Kind, volume_fraction: f64, cells: u32, grains_per_cell: f64) {
    let factor = if kind == Kind::Dsmc { 1.0 } else { DVec3::contact_correlation(volume_fraction) };
    let theory = collision_frequency::<DVec3>(GRAIN, volume_fraction, 1.0, factor);
    let frequencies = replicas(6, |seed| frequency(kind, volume_fraction, cells, grains_per_cell, seed));
    let subject =
        format!("collision frequency, {kind:?} 3D ν = {volume_fraction}, {grains_per_cell} per cell");
    Claim { theory, tolerance: 0.01 }.check(&subject, &frequencies);
}

#[test]
fn elastic_spheres_collide_as_often_as_theory_says() {
    check(Kind::Cba, 0.02, 8, 20.0);
    check(Kind::Cba, 0.1, 8, 20.0);
    check(Kind::Dsmc, 0.1, 8, 20.0);
}

/// With three grains in a cell most collisions make one of them faster than all were before: the bound on
/// relative speeds has to grow within the step, and with it the candidates that are left.
#[test]
fn few_grains_per_cell_collide_as_often() {
    check(Kind::Dsmc, 0.1, 15, 3.0);
}
