//! How often grains of a mixture collide and how far they get, against kinetic theory of mixtures; and how far the temperatures of
//! species part in a mixture that cools.

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

/// Compares frequency and path of seeds with those of theory; by how much, as a share, grains that are all of mean volume and
/// mass would collide more or less often.
fn compare<V: Vector>(scenarios: &[Scenario<V>]) -> f64 {
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
    let alike = collision_frequency::<V>(first.mean_grain(), nu, 1.0, V::contact_correlation(nu));
    (alike / theory[0] - 1.0).abs()
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
    let mut power = 0.0_f64;
    for (size, volume_fraction) in [("[150.0, 150.0]", 0.1), ("[100.0, 100.0]", 0.4)] {
        let seeds = (1..=5).map(|seed| match read(&text(size, 2, volume_fraction, seed)) {
            AnyScenario::Two(scenario) => scenario,
            AnyScenario::Three(_) => panic!("the scenario is flat"),
        });
        power = power.max(compare(&seeds.collect::<Vec<_>>()));
    }
    assert!(power > 5.0 * BIAS, "{power}");
}

#[test]
fn spheres_of_two_sizes_and_masses_collide_as_kinetic_theory_says() {
    let mut power = 0.0_f64;
    for (size, volume_fraction) in [("[50.0, 50.0, 50.0]", 0.05), ("[24.0, 24.0, 24.0]", 0.3)] {
        let seeds = (1..=5).map(|seed| match read(&text(size, 3, volume_fraction, seed)) {
            AnyScenario::Three(scenario) => scenario,
            AnyScenario::Two(_) => panic!("the scenario is deep"),
        });
        power = power.max(compare(&seeds.collect::<Vec<_>>()));
    }
    assert!(power > 5.0 * BIAS, "{power}");
}

/// T₂/T₁ of a mixture of equal numbers of equal spheres of masses 1 and `mass` that cools homogeneously: the one at which both
/// temperatures fall at the same rate (Garzó and Dufty 1999, Maxwellian approximation).
///
/// ζ_i ∝ Σ_j μ_ji √((θ_i + θ_j)/(θ_i θ_j)) (1 + r) (1 − μ_ji (1 + r)/2 (θ_i + θ_j)/θ_j), θ = m/T, μ_ji = m_j/(m_i + m_j).
fn temperature_ratio(mass: f64, restitution: f64) -> f64 {
    let masses = [1.0, mass];
    let rate = |i: usize, ratio: f64| -> f64 {
        let theta = [masses[0], masses[1] / ratio];
        let of_partner = |j: usize| {
            let share = masses[j] / (masses[i] + masses[j]);
            let sum = theta[i] + theta[j];
            share
                * (sum / (theta[i] * theta[j])).sqrt()
                * (1.0 - 0.5 * share * (1.0 + restitution) * sum / theta[j])
        };
        of_partner(0) + of_partner(1)
    };
    let (mut low, mut high) = (0.1_f64, 10.0_f64);
    for _ in 0..100 {
        let ratio = (low * high).sqrt();
        // Where the first species cools faster the second one gets hotter beside it.
        if rate(0, ratio) > rate(1, ratio) { low = ratio } else { high = ratio }
    }
    (low * high).sqrt()
}

/// The column of that name in what `simulation` shows now.
fn column<V: Vector>(simulation: &mut Simulation<'_, V>, name: &str) -> f64 {
    let (measures, snapshot) = simulation.observation();
    let measure = measures.iter_mut().find(|measure| measure.name() == "energy").unwrap();
    let place = measure.columns().iter().position(|column| column.name == name).unwrap();
    measure.values(&snapshot)[place]
}

#[test]
fn heavy_grains_of_a_cooling_mixture_stay_hotter() {
    let ratio = |seed: u64| -> f64 {
        let text = text("[30.0, 30.0, 30.0]", 3, 0.05, seed)
            .replace("restitution = 1.0", "restitution = 0.8")
            .replace("diameter = 2.0", "diameter = 1.0")
            .replace("collisions_per_particle = 60.0", "collisions_per_particle = 20.0");
        let AnyScenario::Three(scenario) = read(&text) else { panic!("the scenario is deep") };
        let gas = initial::build(&scenario, None).unwrap();
        let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
        let mut ratios = Vec::new();
        while simulation.end_reason().is_none() {
            let collisions = simulation.gas().len() as u64;
            simulation.advance(&mut NoLaps, Horizon { collisions, ..Horizon::NONE }).unwrap();
            if simulation.totals().collisions_per_particle > 10.0 {
                ratios.push(column(&mut simulation, "temperature_ratio_species_2"));
            }
        }
        ratios.iter().sum::<f64>() / ratios.len() as f64
    };
    let found = average(&(1..=6).map(ratio).collect::<Vec<_>>()).unwrap();
    let (theory, error) = (temperature_ratio(8.0, 0.8), found.standard_error.unwrap());
    println!("T₂/T₁ = {:.3} ± {error:.3}, theory {theory:.3}", found.value);
    assert!((temperature_ratio(8.0, 0.9999) - 1.0).abs() < 1e-3);
    assert!(error < 0.04, "{error}");
    // Velocities are not quite Maxwellian: theory of the next order changes the ratio by a few per cent.
    assert!((found.value - theory).abs() < 0.05 * theory + 3.0 * error, "{} not {theory}", found.value);
    assert!(theory > 1.5);
}
