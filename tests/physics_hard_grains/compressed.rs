//! Dense states for every engine.

use std::time::Instant;

use glam::{DVec2, DVec3};
use grainflow::engine::{Horizon, NoLaps};
use grainflow::scenario::initial;
use grainflow::simulation::Simulation;

use crate::trial::{Space, Trial, periodic, scenario};

fn compressed<V: Space>(count: u32, volume_fraction: f64) -> String {
    let text = periodic::<V>(count, volume_fraction, 1.0);
    text.replace("[initial]\n", "[initial]\npositions = \"compressed\"\n")
}

/// No grain overlaps another one, and hsmc runs from there.
fn check<V: Space>(count: u32, volume_fraction: f64) {
    let text = compressed::<V>(count, volume_fraction);
    let start = Instant::now();
    let mut trial = Trial::<V>::new(&text, 1);
    println!("{}D N = {count} ν = {volume_fraction}: {:.2} s", V::DIMENSION, start.elapsed().as_secs_f64());
    assert_eq!((trial.gas.len(), trial.invalid_states()), (count as usize, 0));
    let found = trial.gas.len() as f64 * trial.gas.grain.volume::<V>() / trial.scenario.size.product();
    assert!((found / volume_fraction - 1.0).abs() < 1e-12, "ν = {found}");
    trial.advance_to(1.0);
    assert_eq!(trial.invalid_states(), 0);
    let stochastic = scenario::<V>(&text.replace("event-driven", "hsmc"), 1);
    let gas = initial::build(&stochastic, None).unwrap();
    assert_eq!(trial.scenario.count as usize, gas.len());
    let mut simulation = Simulation::start(&stochastic, gas, &mut NoLaps).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    assert!(simulation.totals().counts.collisions > 0);
    assert!((simulation.gas().len(), simulation.invalid_states()) == (count as usize, None));
}

#[test]
fn disks_are_compressed_to_eight_tenths() {
    check::<DVec2>(2000, 0.80);
}

#[test]
fn spheres_are_compressed_to_six_tenths() {
    check::<DVec3>(3000, 0.60);
}

#[test]
fn what_jams_is_said_to_jam() {
    let scenario = scenario::<DVec3>(&compressed::<DVec3>(300, 0.70), 1);
    let error = initial::build(&scenario, None).expect_err("random close packing is looser").to_string();
    println!("{error}");
    assert!(error.contains("the grains jam at a diameter of 0.9") && error.contains("while they grow to 1"));
}
