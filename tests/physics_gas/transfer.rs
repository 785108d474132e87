//! What a displaced inelastic collision carries: 2r with the thesis' displacement, 1 + r with the corrected one.

use glam::{DVec2, DVec3};
use grainflow::engine::stochastic::rules::Transfer;
use grainflow::random::{Phase, Streams};
use grainflow::space::Vector;

use crate::bed::{Bed, Kind, Plan};
use crate::claim::{Claim, replicas};

const RESTITUTION: f64 = 0.5;
const VOLUME_FRACTION: f64 = 0.1;
const STEPS: u64 = 250;

/// Σ p·s/(D N T t 2^{D−2} ν g) of a gas whose velocities are drawn anew before every step.
///
/// During a step of 0.02 collisions per particle T falls by 0.02·λ/D, at most 0.8 %; on average by half of that.
fn share<V: Vector>(transfer: Transfer, cells: u32, seed: u64) -> f64 {
    let elastic = Plan { pace: 0.02, ..Plan::new(Kind::Cba, VOLUME_FRACTION, cells, 40.0) };
    let plan = Plan { transfer, ..elastic.with_restitution(RESTITUTION) };
    let mut bed = Bed::<V>::equilibrated(plan, seed, 10.0);
    for step in 0..STEPS {
        bed.draw_velocities(&mut Streams::new(seed).at(step + 1, Phase::InitialVelocities).stream(0));
        bed.step();
    }
    let density =
        f64::from(1 << (V::DIMENSION - 2)) * VOLUME_FRACTION * V::contact_correlation(VOLUME_FRACTION);
    let thermal = V::DIMENSION as f64 * bed.gas.len() as f64 * bed.gas.time();
    bed.totals.counts.carried_momentum / (thermal * density)
}

fn check<V: Vector>(cells: u32) {
    for (transfer, theory) in
        [(Transfer::MomentumChange, 2.0 * RESTITUTION), (Transfer::Corrected, 1.0 + RESTITUTION)]
    {
        let shares = replicas(6, |seed| share::<V>(transfer, cells, seed));
        Claim { theory, tolerance: 0.02 }
            .check(&format!("inelastic transfer, {transfer:?} {}D", V::DIMENSION), &shares);
    }
}

#[test]
fn displacements_of_disks_carry_their_share() {
    check::<DVec2>(20);
}

#[test]
fn displacements_of_spheres_carry_their_share() {
    check::<DVec3>(8);
}
