//! How often grains of an elastic gas collide.

use glam::DVec3;
use grainflow::law::kinetic_theory::collision_frequency;
use grainflow::space::Vector;

use crate::bed::{Bed, GRAIN, Kind, Plan};
use crate::claim::{Claim, replicas};

/// Collisions per particle and time of about 10⁴ grains.
fn frequency(plan: Plan, seed: u64) -> f64 {
    let mut bed = Bed::<DVec3>::equilibrated(plan, seed, 10.0);
    bed.advance_to(20.0);
    bed.totals.collisions_per_particle / bed.gas.time()
}

fn check(plan: Plan) {
    let Plan { kind, volume_fraction, grains_per_cell, pace, .. } = plan;
    let factor = if kind == Kind::Dsmc { 1.0 } else { DVec3::contact_correlation(volume_fraction) };
    let theory = collision_frequency::<DVec3>(GRAIN, volume_fraction, 1.0, factor);
    let frequencies = replicas(6, |seed| frequency(plan, seed));
    let subject = format!(
        "collision frequency, {kind:?} 3D ν = {volume_fraction}, {grains_per_cell} per cell, {pace} per step"
    );
    Claim { theory, tolerance: 0.01 }.check(&subject, &frequencies);
}

#[test]
fn elastic_spheres_collide_as_often_as_theory_says() {
    check(Plan::new(Kind::Cba, 0.02, 8, 20.0));
    check(Plan::new(Kind::Cba, 0.1, 8, 20.0));
    check(Plan::new(Kind::Dsmc, 0.1, 8, 20.0));
}

/// With few grains in a cell and many collisions in a step, collisions often make a grain faster than all were
/// at the start of the step: the bound on relative speeds has to grow, and with it the candidates that are left.
#[test]
fn few_grains_per_cell_collide_as_often() {
    for pace in [0.1, 1.0] {
        check(Plan { pace, ..Plan::new(Kind::Dsmc, 0.1, 15, 3.0) });
    }
}
