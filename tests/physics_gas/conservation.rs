//! What no step may change: momentum and the number of grains; and energy, which may only fall.

use glam::{DVec2, DVec3};
use grainflow::observe::moments::{kinetic_energy, momentum, momentum_scale};
use grainflow::space::Vector;

use crate::bed::{Bed, Kind, Plan};

/// Rounding that is allowed, relative.
const ROUNDING: f64 = 1e-12;
const STEPS: u32 = 10_000;

/// A periodic gas keeps its momentum over all steps and never gains energy.
fn check_periodic<V: Vector>(plan: Plan) -> Bed<V> {
    let mut bed = Bed::<V>::new(plan, 3);
    let (start, scale) = (momentum(&bed.gas), momentum_scale(&bed.gas));
    let mut worst: f64 = 0.0;
    check_energy(&mut bed, STEPS, |bed| {
        worst = worst.max((momentum(&bed.gas) - start).length() / scale);
    });
    println!("{:?} {}D: momentum drifts by {worst:.1e}", plan.kind, V::DIMENSION);
    assert!(worst <= ROUNDING, "{plan:?}: momentum drifts by {worst}");
    bed
}

/// No step adds energy or loses a grain.
fn check_energy<V: Vector>(bed: &mut Bed<V>, steps: u32, mut watch: impl FnMut(&Bed<V>)) {
    let grains = bed.gas.len();
    let mut ids: Vec<u32> = bed.gas.ids().to_vec();
    let mut before = kinetic_energy(&bed.gas);
    for step in 0..steps {
        bed.step();
        let after = kinetic_energy(&bed.gas);
        assert!(
            after <= before * (1.0 + ROUNDING),
            "{:?}: energy grows from {before} to {after} in step {step}",
            bed.plan
        );
        assert_eq!(bed.gas.len(), grains);
        before = after;
        watch(bed);
    }
    ids.sort_unstable();
    let mut left = bed.gas.ids().to_vec();
    left.sort_unstable();
    assert_eq!(ids, left);
}

/// A gas so dense that cells are full, collide and give heat back.
fn crowded<V: Vector>() -> Plan {
    let (volume_fraction, cells, grains_per_cell) =
        if V::DIMENSION == 2 { (0.7, 10, 5.0) } else { (0.5, 6, 10.0) };
    let plan = Plan::new(Kind::Hsmc, volume_fraction, cells, grains_per_cell).with_restitution(0.999);
    Plan { cell_restitution: 0.5, ..plan }
}

fn gas<V: Vector>(kind: Kind) -> Plan {
    let (cells, grains_per_cell) = if V::DIMENSION == 2 { (7, 12.0) } else { (4, 9.0) };
    Plan::new(kind, 0.2, cells, grains_per_cell).with_restitution(0.99)
}

#[test]
fn dsmc_keeps_momentum_and_gains_no_energy() {
    check_periodic::<DVec2>(gas::<DVec2>(Kind::Dsmc));
    check_periodic::<DVec3>(gas::<DVec3>(Kind::Dsmc));
}

#[test]
fn cba_keeps_momentum_and_gains_no_energy() {
    check_periodic::<DVec2>(gas::<DVec2>(Kind::Cba));
    check_periodic::<DVec3>(gas::<DVec3>(Kind::Cba));
}

#[test]
fn crowded_hsmc_keeps_momentum_and_gains_no_energy() {
    assert!(check_periodic::<DVec2>(crowded::<DVec2>()).totals.counts.cell_collisions > 10_000);
    assert!(check_periodic::<DVec3>(crowded::<DVec3>()).totals.counts.cell_collisions > 10_000);
}

#[test]
fn resting_walls_add_no_energy() {
    for kind in [Kind::Dsmc, Kind::Cba, Kind::Hsmc] {
        for restitution in [1.0, 0.8] {
            let (flat, deep) = match kind {
                Kind::Hsmc => (crowded::<DVec2>(), crowded::<DVec3>()),
                _ => (gas::<DVec2>(kind), gas::<DVec3>(kind)),
            };
            let with_walls = |plan| Plan { walls: Some(restitution), ..plan };
            check_energy(&mut Bed::<DVec2>::new(with_walls(flat), 5), 1000, |_| ());
            check_energy(&mut Bed::<DVec3>::new(with_walls(deep), 5), 1000, |_| ());
        }
    }
}

/// Elastic grains lose nothing, so that all energy that cell collisions take has to come back as heat.
fn check_heat<V: Vector>() {
    let mut bed = Bed::<V>::new(Plan { restitution: 1.0, ..crowded::<V>() }, 4);
    let start = kinetic_energy(&bed.gas);
    for _ in 0..2000 {
        bed.step();
    }
    assert!(bed.totals.counts.cell_collisions > 10_000);
    let drift = kinetic_energy(&bed.gas) / start - 1.0;
    assert!(drift.abs() <= ROUNDING, "{}D: energy drifts by {drift}", V::DIMENSION);
}

#[test]
fn all_heat_of_cell_collisions_returns() {
    check_heat::<DVec2>();
    check_heat::<DVec3>();
}
