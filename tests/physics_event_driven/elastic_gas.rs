//! An elastic gas: what it keeps, and that it runs backwards.

use super::drive::{Drive, STRUCTURES, laws, scattered};
use glam::{DVec2, DVec3};
use grainflow::engine::event_driven::rules::Structure;
use grainflow::space::Vector;

/// Energy and momentum over so many collisions of grains at this spacing.
fn keeps<V: Vector>(per_axis: usize, spacing: f64, structure: Structure, collisions: u64) {
    let laws = laws::<V>(V::from_fn(|_| spacing * per_axis as f64));
    let grains = scattered::<V>(per_axis, spacing, 0.4 * (spacing - 1.0));
    let mut gas = Drive::new(&laws, structure, &grains);
    let momentum = |gas: &Drive<V>| gas.gas.velocities().iter().fold(V::ZERO, |sum, &v| sum + v);
    let (energy, before) = (gas.energy(), momentum(&gas));
    let mut worst = 0.0_f64;
    for _ in 0..10 {
        gas.collide(collisions / 10);
        worst = worst.max((gas.energy() / energy - 1.0).abs());
    }
    let drift = (momentum(&gas) - before).length();
    println!(
        "N = {} D = {} {structure:?}, {collisions} collisions: energy {worst:.1e}, momentum {drift:.1e} of {:.0}",
        gas.gas.len(),
        V::DIMENSION,
        (2.0 * energy * gas.gas.len() as f64).sqrt(),
    );
    assert!(gas.gas.len() >= 10_000);
    assert!(worst <= 1e-12, "{worst}");
    // Each collision rounds two velocities by some 10⁻¹⁶, at random.
    assert!(drift < 1e-15 * (collisions as f64).sqrt().max(1e4), "{drift}");
}

#[test]
fn energy_and_momentum_stay_over_a_million_collisions() {
    keeps::<DVec2>(100, 1.4, Structure::Cells, 1_000_000);
    keeps::<DVec3>(22, 1.2, Structure::NeighbourLists, 1_000_000);
}

#[test]
#[ignore = "minutes: cargo test --release --test physics_event_driven -- --ignored"]
fn energy_and_momentum_stay_over_ten_million_collisions() {
    for structure in STRUCTURES {
        keeps::<DVec2>(100, 1.4, structure, 10_000_000);
        keeps::<DVec3>(22, 1.2, structure, 10_000_000);
    }
}

/// After three collisions per particle all velocities are turned round: each grain returns to where it came from.
fn returns<V: Vector>(per_axis: usize, spacing: f64) {
    for structure in STRUCTURES {
        let laws = laws::<V>(V::from_fn(|_| spacing * per_axis as f64));
        let start = scattered::<V>(per_axis, spacing, 0.3 * (spacing - 1.0));
        let fraction = V::sphere_volume(1.0) / V::from_fn(|_| spacing).product();
        assert!(fraction >= 0.25, "{fraction}");
        let mut gas = Drive::new(&laws, structure, &start);
        let grains = start.len();
        gas.collide(3 * grains as u64 / 2);
        // To where nothing collides at this very moment.
        let turned = gas.gas.time() * (1.0 + 1e-9);
        gas.to(turned);
        let there = gas.counts.collisions;
        let back: Vec<(V, V)> = (0..grains as u32).map(|id| (gas.position(id), -gas.velocity(id))).collect();
        let mut gas = Drive::new(&laws, structure, &back);
        gas.to(turned);
        assert!(gas.counts.collisions.abs_diff(there) <= 1, "{} {there}", gas.counts.collisions);
        let worst = (0..grains as u32)
            .map(|id| {
                let apart = gas.position(id) - start[id as usize].0;
                let side = laws.size[0];
                V::from_fn(|axis| apart[axis] - side * (apart[axis] / side).round()).length()
            })
            .fold(0.0, f64::max);
        println!("back after {there} collisions of {grains} grains (ν = {fraction:.2}): {worst:.1e} d off");
        assert!(worst < 1e-6, "{worst}");
    }
}

#[test]
fn time_runs_backwards() {
    returns::<DVec2>(50, 1.6);
    returns::<DVec3>(13, 1.27);
}
