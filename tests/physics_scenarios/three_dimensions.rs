//! Spheres: a bed that settles and a heap that is poured.

use glam::DVec3;
use grainflow::observe::moments::kinetic_energy;
use grainflow::statistics::mean;

use super::trial::{advance_until, agrees, for_each, scenario_in_space, start};

/// Sixteen hundred spheres fall into a box; 9 fill a cell.
const BED: &str = r#"
title = "Bed of spheres"
dimension = 3
gravity = [0.0, 0.0, -1.0]
[engine]
kind = "hsmc"
cell_size = 2.0
time_step = { fixed = 0.05 }
[engine.hsmc]
maximum_volume_fraction = 0.64
cell_restitution = { at_least = 0.9 }
sweeps = 6
[domain]
size = [16.0, 16.0, 32.0]
[boundary]
x.lower = { wall = "smooth" }
x.upper = { wall = "smooth" }
y.lower = { wall = "smooth" }
y.upper = { wall = "smooth" }
z.lower = { wall = "smooth" }
z.upper = { wall = "smooth" }
[particles]
count = 1600
diameter = 1.0
mass = 1.0
restitution = 0.9
[initial]
positions = "random"
velocities = "rest"
[run]
time = 200.0
"#;

/// Spheres poured onto a rough table.
const HEAP: &str = r#"
title = "Heap of spheres"
dimension = 3
gravity = [0.0, 0.0, -1.0]
[engine]
kind = "hsmc"
cell_size = 2.0
time_step = { fixed = 0.1 }
[engine.hsmc]
maximum_volume_fraction = 0.64
cell_restitution = { at_least = 0.9 }
sweeps = 6
[domain]
size = [40.0, 40.0, 40.0]
[boundary]
x = "open"
y = "open"
z.lower = { wall = "rough" }
z.upper = "open"
[particles]
count = 0
diameter = 1.0
mass = 1.0
restitution = 0.6
[source]
count = 2000
rate = 2.0
position = [20.0, 20.0]
width = 1.0
height = 10.0
velocity = [0.0, 0.0, 0.0]
[run]
rest = 200.0
"#;

/// Where the grains of a run end, and their kinetic energy per grain.
fn end(text: &str, seed: u64) -> (Vec<DVec3>, f64) {
    let scenario = scenario_in_space(text, seed);
    let mut simulation = start(&scenario);
    let at_start = simulation.gas().largest_occupancy();
    let bound = simulation.capacity().map_or(u32::MAX, |capacity| capacity.max(at_start));
    advance_until(&mut simulation, |simulation| {
        assert!(simulation.gas().largest_occupancy() <= bound);
        false
    });
    let gas = simulation.gas();
    (gas.positions().to_vec(), kinetic_energy(gas) / gas.len() as f64)
}

fn mean_of(positions: &[DVec3], value: impl Fn(DVec3) -> f64) -> f64 {
    positions.iter().map(|&position| value(position)).sum::<f64>() / positions.len() as f64
}

/// 64 columns of cells hold 25 spheres each, 9 to a cell: 1.84 when every grain lies on the floor of its
/// cell (9 at 0, 9 at 2, 7 at 4); in a random packing (0.64) the bed is 5.1 high and its centre at 2.6.
#[test]
fn a_bed_of_spheres_stands_and_rests() {
    let beds = for_each(&[1, 2, 3, 4], |&seed| {
        let (positions, energy) = end(BED, seed);
        (mean_of(&positions, |p| p.z), energy)
    });
    println!("centre of mass and energy: {beds:?}");
    assert!(beds.iter().all(|&(height, _)| (1.84..=2.6).contains(&height)));
    assert!(beds.iter().all(|&(_, energy)| energy < 1e-4));
    // Points end on the floor.
    let (sunk, _) = end(&BED.replace("kind = \"hsmc\"", "kind = \"dsmc\""), 1);
    assert!(mean_of(&sunk, |p| p.z) < 1.0);
}

/// Width along x and y alike, the middle under the spout, more than one layer of cells; points make none of it.
#[test]
#[ignore = "full length: cargo test --release --test physics_scenarios -- --ignored"]
fn a_heap_of_spheres_is_round_and_rests() {
    let points = HEAP.replace("kind = \"hsmc\"", "kind = \"dsmc\"");
    let (sunk, _) = end(&points, 1);
    assert!(!is_piled(&sunk));
    let heaps = for_each(&[1, 2, 3, 4, 5, 6], |&seed| end(HEAP, seed));
    let mut lopsidedness = Vec::new();
    for (positions, energy) in &heaps {
        let (x, y) = (mean_of(positions, |p| p.x), mean_of(positions, |p| p.y));
        let width = |axis: usize, middle: f64| mean_of(positions, |p| (p[axis] - middle).powi(2)).sqrt();
        println!("{} grains at ({x:.2}, {y:.2}), energy {energy:.1e}", positions.len());
        assert!(is_piled(positions));
        assert!((x - 20.0).abs() < 1.0 && (y - 20.0).abs() < 1.0);
        lopsidedness.push(width(0, x) / width(1, y) - 1.0);
    }
    let energies: Vec<f64> = heaps.iter().map(|(_, energy)| *energy).collect();
    assert!(mean(&energies).unwrap() < 1e-2);
    println!("width along x over that along y, less 1: {lopsidedness:.3?}");
    assert!(agrees(&lopsidedness, 0.0, 0.01));
}

/// A puddle that is one cell deep has its centre of mass below 1.
fn is_piled(positions: &[DVec3]) -> bool {
    let height = mean_of(positions, |p| p.z);
    println!("centre of mass {height:.2}");
    height > 1.2
}
