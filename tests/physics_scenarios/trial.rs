//! A run of a scenario, with the limits and laws that a test wants.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use grainflow::engine::{Horizon, NoLaps};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, load};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;
use grainflow::statistics::{mean, standard_error};
use rayon::ThreadPoolBuilder;

/// The scenario called `name`, changed by `sets` and with this seed.
pub(crate) fn any_scenario(name: &str, seed: u64, sets: &[&str]) -> AnyScenario {
    let sets = sets.iter().map(ToString::to_string).collect();
    load(name, &Overrides { sets, engine: None, seed: Some(seed) }).unwrap_or_else(|error| panic!("{error}"))
}

/// The same for scenarios in the plane.
pub(crate) fn scenario(name: &str, seed: u64, sets: &[&str]) -> Scenario<DVec2> {
    match any_scenario(name, seed, sets) {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => panic!("{name} has three dimensions"),
    }
}

/// The same for scenarios in space, from their text.
pub(crate) fn scenario_in_space(text: &str, seed: u64) -> Scenario<DVec3> {
    let overrides = Overrides { seed: Some(seed), ..Overrides::default() };
    match grainflow::scenario::parse("made up", text, &overrides).unwrap_or_else(|error| panic!("{error}")) {
        AnyScenario::Three(scenario) => scenario,
        AnyScenario::Two(_) => panic!("made up in a plane"),
    }
}

/// The start of a run.
pub(crate) fn start<V: Vector>(scenario: &Scenario<V>) -> Simulation<'_, V> {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    // The recording with which every run begins: measures remember it.
    let (measures, snapshot) = simulation.observation();
    for measure in measures {
        measure.values(&snapshot);
    }
    simulation
}

/// Advances until `stop` says so, at a limit at the latest.
pub(crate) fn advance_until<V: Vector>(
    simulation: &mut Simulation<'_, V>,
    mut stop: impl FnMut(&Simulation<'_, V>) -> bool,
) {
    while simulation.end_reason().is_none() && !stop(simulation) {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
}

/// The figures of a run up to now; those that it is too short for are left out.
pub(crate) fn figures<V: Vector>(simulation: &mut Simulation<'_, V>) -> BTreeMap<String, f64> {
    let from = simulation.steady_from();
    let (measures, snapshot) = simulation.observation();
    let all = measures.iter().flat_map(|measure| measure.conclusion(&snapshot, from).1);
    all.filter_map(|figure| Some((figure.name, figure.value?))).collect()
}

/// The figures of a whole run.
pub(crate) fn run<V: Vector>(scenario: &Scenario<V>) -> BTreeMap<String, f64> {
    let mut simulation = start(scenario);
    advance_until(&mut simulation, |_| false);
    figures(&mut simulation)
}

/// What `work` gives for every one of `cases`, each in a thread of its own.
pub(crate) fn for_each<C: Sync, T: Send>(cases: &[C], work: impl Fn(&C) -> T + Sync) -> Vec<T> {
    let alone = |case| {
        let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| work(case))
    };
    std::thread::scope(|scope| {
        let runs: Vec<_> = cases.iter().map(|case| scope.spawn(move || alone(case))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    })
}

/// Whether the mean of independent values is `theory` within `tolerance` and three standard errors.
pub(crate) fn agrees(values: &[f64], theory: f64, tolerance: f64) -> bool {
    let (Some(mean), Some(error)) = (mean(values), standard_error(values)) else { return false };
    (mean - theory).abs() <= tolerance + 3.0 * error
}

/// One figure of every run.
pub(crate) fn column(runs: &[BTreeMap<String, f64>], name: &str) -> Vec<f64> {
    runs.iter().map(|run| *run.get(name).unwrap_or_else(|| panic!("no figure {name}"))).collect()
}
