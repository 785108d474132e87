//! How often grains of a mixture collide, and how far they get, against kinetic theory of mixtures.

use grainflow::engine::{Horizon, NoLaps};
use grainflow::law::kinetic_theory::collision_frequency;
use grainflow::law::mixture::Mixture;
use grainflow::observe::moments::mean_speed;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;
use grainflow::statistics::average;

/// What contact values miss of a fluid mixture, and what the number of grains adds, relative.
const BIAS: f64 = 0.01;

/// Collision frequency and mean free path of an elastic gas at T = 1, after 20 collisions per particle.
fn measured<V: Vector>(scenario: &Scenario<V>) -> [f64; 2] {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    let mut path = 0.0;
    while simulation.end_reason().is_none() {
        let (time, speed) = (simulation.gas().time(), mean_speed(simulation.gas()));
        let collisions = simulation.gas().len() as u64 / 2;
        simulation.advance(&mut NoLaps, Horizon { collisions, ..Horizon::NONE }).unwrap();
        path += 0.5 * (speed + mean_speed(simulation.gas())) * (simulation.gas().time() - time);
    }
    let collisions = simulation.totals().collisions_per_particle;
    [collisions / simulation.gas().time(), path / collisions]
}

/// Frequency and path of seeds beside those of theory.
fn compare<V: Vector>(scenarios: &[Scenario<V>]) {
    let first = &scenarios[0];
    let mixture = Mixture::new(first.constituents(), first.size.product());
    let theory = [mixture.collision_frequency::<V>(1.0), mixture.mean_free_path::<V>()];
    let nu = first.volume_fraction();
    let all: Vec<[f64; 2]> = scenarios.iter().map(measured).collect();
    for (k, theory) in theory.into_iter().enumerate() {
        let values: Vec<f64> = all.iter().map(|one| one[k]).collect();
        let found = average(&values).unwrap();
        let error = found.standard_error.unwrap();
        println!("{}D ν = {nu:.3}: {:.4} ± {error:.4}, theory {theory:.4}", V::DIMENSION, found.value);
        assert!(error < 0.005 * theory, "{error}");
        assert!((found.value - theory).abs() < BIAS * theory + 3.0 * error, "{} not {theory}", found.value);
    }
    // Grains of mean volume and mass, which would be the same to a reader in a hurry, are told apart.
    let alike = collision_frequency::<V>(first.mean_grain(), nu, 1.0, V::contact_correlation(nu));
    assert!((alike / theory[0] - 1.0).abs() > 5.0 * BIAS, "{alike}");
}

/// Species of these diameters and masses, halves of the grains, in a box of `size`.
fn text(size: &str, dimension: usize, volume_fraction: f64, seed: u64) -> String {
    format!(
        "dimension = {dimension}\nseed = {seed}\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = {size}\n\
         [particles]\nvolume_fraction = {volume_fraction}\nrestitution = 1.0\n\
         [[particles.species]]\ndiameter = 1.0\nmass = 1.0\nshare = 0.5\n\
         [[particles.species]]\ndiameter = 2.0\nmass = 8.0\nshare = 0.5\n\
         [initial]\nvelocities = {{ maxwell = 1.0 }}\nequilibrate = 20.0\n[run]\ncollisions_per_particle = 60.0\n"
    )
}

fn read(text: &str) -> AnyScenario {
    parse("mixture", text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn disks_of_two_sizes_and_masses_collide_as_kinetic_theory_says() {
    for volume_fraction in [0.1, 0.4] {
        let seeds = (1..=5).map(|seed| match read(&text("[50.0, 50.0]", 2, volume_fraction, seed)) {
            AnyScenario::Two(scenario) => scenario,
            AnyScenario::Three(_) => panic!("the scenario is flat"),
        });
        compare(&seeds.collect::<Vec<_>>());
    }
}

#[test]
fn spheres_of_two_sizes_and_masses_collide_as_kinetic_theory_says() {
    for volume_fraction in [0.05, 0.3] {
        let seeds = (1..=5).map(|seed| match read(&text("[16.0, 16.0, 16.0]", 3, volume_fraction, seed)) {
            AnyScenario::Three(scenario) => scenario,
            AnyScenario::Two(_) => panic!("the scenario is deep"),
        });
        compare(&seeds.collect::<Vec<_>>());
    }
}
