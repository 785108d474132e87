//! Bagnold's shear flow (Müller 2001, section 3.3): a straight profile, and F ∝ v².

use std::collections::BTreeMap;

use glam::DVec2;
use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::gas::Gas;
use grainflow::matter::state_hash::rows_by_identity;
use grainflow::scenario::model::Scenario;
use grainflow::statistics::{mean, standard_error};

use super::trial::{agrees, column, for_each, run, scenario, start};

const SEEDS: [u64; 4] = [1, 2, 3, 4];
const HEIGHT: f64 = 40.0;
const LONG: &str = "run.collisions_per_particle=800";

/// The scenario with the wall velocity difference `speed` and everything else in proportion.
fn flow_at(speed: f64, seed: u64, sets: &[&str]) -> Scenario<DVec2> {
    let walls = wall_sets(speed);
    let temperature = format!("initial.velocities.maxwell={:?}", speed * speed);
    let mut all = vec![walls[0].as_str(), walls[1].as_str(), &temperature];
    all.extend(sets);
    scenario("shear", seed, &all)
}

fn wall_sets(speed: f64) -> [String; 2] {
    let half = 0.5 * speed;
    [
        format!("boundary.y.lower.velocity=[{:?}, 0.0]", -half),
        format!("boundary.y.upper.velocity=[{half:?}, 0.0]"),
    ]
}

fn flows(speed: f64, sets: &[&str]) -> Vec<BTreeMap<String, f64>> {
    for_each(&SEEDS, |&seed| run(&flow_at(speed, seed, sets)))
}

/// Slope 1 in units of v/H and a straight line.
fn is_straight(slopes: &[f64], r_squared: &[f64], tolerance: f64) -> bool {
    let error = standard_error(slopes).unwrap();
    println!("slope {:.4} ± {error:.4}, R² {r_squared:.5?}", mean(slopes).unwrap());
    agrees(slopes, 1.0, tolerance) && r_squared.iter().all(|&r| r > 0.999)
}

/// A gas of few grains lies 2 % below 1: its fluctuations carry momentum too, in two dimensions more than
/// in three, and walls quench them; so the bulk needs less shear than the layers at the walls.
/// [`many_small_grains_make_the_profile_exact`] shows that nothing else is behind it.
#[test]
fn the_profile_is_straight() {
    let runs = flows(1.0, &[LONG]);
    let (slopes, r_squared) =
        (column(&runs, "velocity_profile_slope"), column(&runs, "velocity_profile_r_squared"));
    assert!(is_straight(&slopes, &r_squared, 0.02));
    // Walls that move 5 % too slowly are found out.
    let slow: Vec<f64> = slopes.iter().map(|slope| 0.95 * slope).collect();
    assert!(!is_straight(&slow, &r_squared, 0.02));
}

/// Sixteen times as many grains of a sixteenth of the diameter: the same mean free path and flow, but fluctuations
/// sixteen times weaker. Uniform shear between walls that reverse the velocity in their frame is
/// then an exact solution of the Boltzmann equation, slip and all.
#[test]
fn many_small_grains_make_the_profile_exact() {
    let fine = [
        "engine.kind=dsmc",
        "domain.size=[50.0, 40.0]",
        "particles.diameter=0.0625",
        "particles.volume_fraction=0.00625",
        "run.collisions_per_particle=400",
        "initial.velocities.maxwell=0.07",
        "boundary.y.lower.restitution=1.0",
        "boundary.y.upper.restitution=1.0",
    ];
    let runs = for_each(&SEEDS, |&seed| run(&scenario("shear", seed, &fine)));
    let slopes = column(&runs, "velocity_profile_slope");
    assert!(is_straight(&slopes, &column(&runs, "velocity_profile_r_squared"), 0.005));
    let slow: Vec<f64> = slopes.iter().map(|slope| 0.97 * slope).collect();
    assert!(!is_straight(&slow, &[1.0], 0.005));
}

/// F/v² is the same for all pairs (v, F), within four times the 1.5 % by which runs of different seeds differ.
fn is_bagnold(stresses: &[(f64, f64)]) -> bool {
    let reduced: Vec<f64> = stresses.iter().map(|(speed, stress)| stress / (speed * speed)).collect();
    println!("F/v²: {reduced:?}");
    let centre = mean(&reduced).unwrap();
    reduced.iter().all(|f| (f / centre - 1.0).abs() <= 0.06)
}

fn stresses(sets: &[&str]) -> Vec<(f64, f64)> {
    let speeds = [0.1, 1.0, 10.0, 100.0];
    // Other random numbers for each speed: proportional flows with the same ones would be equal anyhow.
    for_each(&speeds, |&speed| {
        let seed = 10 + speed as u64;
        (speed, run(&flow_at(speed, seed, sets))["wall_shear_stress"])
    })
}

#[test]
fn the_stress_grows_as_the_square_of_the_speed() {
    assert!(is_bagnold(&stresses(&[])));
    // A restitution that knows a speed breaks the law.
    let law = "particles.restitution={ law = \"velocity-dependent\", r0 = 0.95, v0 = 0.3 }";
    let walls = ["boundary.y.lower.restitution=0.99", "boundary.y.upper.restitution=0.99"];
    assert!(!is_bagnold(&stresses(&[law, walls[0], walls[1], "run.collisions_per_particle=200"])));
}

/// F·H²/v².
fn reduced_stresses(runs: &[BTreeMap<String, f64>]) -> Vec<f64> {
    column(runs, "wall_shear_stress").iter().map(|stress| stress * HEIGHT * HEIGHT).collect()
}

/// F·H²/v² = 2.12, as Navier–Stokes–Enskog theory says. Layers at the walls, with their jump of velocity, take 2 % of it, and
/// cells of a mean free path add some: 5 % in all.
fn has_the_viscosity(reduced: &[f64]) -> bool {
    println!("F·H²/v²: {reduced:.3?}");
    agrees(reduced, 2.12, 0.05 * 2.12)
}

#[test]
fn the_stress_is_that_of_enskog_theory() {
    let reduced = reduced_stresses(&flows(1.0, &[]));
    assert!(has_the_viscosity(&reduced));
    // A collisional stress that is 15 % too large is found out.
    let larger: Vec<f64> = reduced.iter().map(|stress| 1.15 * stress).collect();
    assert!(!has_the_viscosity(&larger));
    // Collisions at the rate of a dilute gas, or across cells longer than the mean free path.
    assert!(!has_the_viscosity(&reduced_stresses(&flows(1.0, &["engine.kind=dsmc"]))));
    assert!(!has_the_viscosity(&reduced_stresses(&flows(1.0, &["engine.cell_size=8.0"]))));
}

/// Position and velocity of every grain after 300 steps, in the order of their identities.
fn state_after_steps(scenario: &Scenario<DVec2>) -> Vec<(DVec2, DVec2)> {
    let mut simulation = start(scenario);
    for _ in 0..300 {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let gas: &Gas<DVec2> = simulation.gas();
    let grain = |row: u32| (gas.positions()[row as usize], gas.velocities()[row as usize]);
    rows_by_identity(gas).into_iter().map(grain).collect()
}

/// Whether `fast` has the positions of `slow` and `factor` times its velocities, bit for bit.
fn is_the_same_film(slow: &[(DVec2, DVec2)], fast: &[(DVec2, DVec2)], factor: f64) -> bool {
    slow.iter().zip(fast).all(|(slow, fast)| slow.0 == fast.0 && slow.1 * factor == fast.1)
}

/// A power of two changes exponents only: a film of the flow, played faster.
#[test]
fn a_faster_flow_is_the_same_film() {
    for engine in ["dsmc", "cba", "hsmc"] {
        let engine = format!("engine.kind={engine}");
        let state = |speed: f64| state_after_steps(&flow_at(speed, 5, &[&engine]));
        let slow = state(1.0);
        assert!(is_the_same_film(&slow, &state(1024.0), 1024.0), "{engine}");
        assert!(!is_the_same_film(&slow, &state(1000.0), 1000.0), "{engine}");
    }
}
