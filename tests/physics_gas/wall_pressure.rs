//! The pressure that a wall feels, against the equation of state at the density of the bulk.

use glam::DVec2;
use grainflow::law::kinetic_theory::compressibility_factor;
use grainflow::matter::gas::Gas;

use crate::bed::{Bed, GRAIN, Kind, Plan};
use crate::claim::{Claim, replicas};
use grainflow::space::Vector;

/// Nominal volume fraction; 16 cells of 10 grains make a box of 100 diameters.
const VOLUME_FRACTION: f64 = 0.2;
const EQUILIBRATION: f64 = 100.0;
const WINDOW: f64 = 600.0;

/// Grains in the middle half between the walls.
fn grains_in_the_middle(gas: &Gas<DVec2>) -> usize {
    let height = gas.grid().size().y;
    gas.positions().iter().filter(|position| (position.y / height - 0.5).abs() < 0.25).count()
}

/// Pressure at the walls over that of the equation of state in the middle.
fn wall_over_bulk(seed: u64) -> f64 {
    let plan = Plan { walls: Some(1.0), ..Plan::new(Kind::Cba, VOLUME_FRACTION, 16, 10.0) };
    let mut bed = Bed::<DVec2>::equilibrated(plan, seed, EQUILIBRATION);
    let size = bed.gas.grid().size();
    assert!(size.x >= 100.0 && size.y >= 100.0);
    let mut grains_times_time = 0.0;
    while bed.totals.collisions_per_particle < WINDOW {
        let report = bed.step();
        grains_times_time += grains_in_the_middle(&bed.gas) as f64 * report.duration;
    }
    let time = bed.gas.time();
    let [below, above] = bed.totals.counts.wall_momentum[1];
    let at_the_walls = (above.y - below.y) / (2.0 * size.x * time);
    let number_density = grains_times_time / time / (0.5 * size.product());
    let volume_fraction = number_density * GRAIN.volume::<DVec2>();
    println!("ν in the middle: {volume_fraction:.4}");
    at_the_walls
        / (number_density * bed.temperature() * compressibility_factor::<DVec2>(volume_fraction, 1.0))
}

#[test]
fn walls_feel_the_pressure_of_the_bulk() {
    Claim { theory: 1.0, tolerance: 0.03 }.check("wall pressure, CBA 2D", &replicas(6, wall_over_bulk));
}
