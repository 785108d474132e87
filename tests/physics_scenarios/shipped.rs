//! Every scenario that comes with the program runs, and keeps what it must keep.

use grainflow::scenario::builtin;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::space::Vector;

use super::trial::{advance_until, any_scenario, figures, for_each, start};

/// Shorter versions: enough grains and steps to fill cells where the scenario does.
fn shorter(name: &str) -> &'static [&'static str] {
    match name {
        "heap" | "heap-full" => &["source.count=200", "source.rate=2.0", "run.rest=20.0"],
        "clustering" => {
            &["domain.size=[100.0, 100.0]", "particles.count=3183", "run.collisions_per_particle=20.0"]
        }
        "correlations" => {
            &["domain.size=[250.0, 250.0]", "particles.count=3979", "run.collisions_per_particle=20.0"]
        }
        "cooling" | "hard-spheres" => &["run.collisions_per_particle=10.0", "initial.equilibrate=2.0"],
        "simic-cooling" => &["run.collisions_per_particle=10.0"],
        "pipe" => &["run.time=40.0"],
        "sedimentation" => &["run.time=0.5"],
        "shear" => &["run.collisions_per_particle=20.0"],
        other => panic!("how short may {other} be?"),
    }
}

/// Figures that a scenario exists for; one that is not finite is not among the figures. A heap that
/// sinks into the floor has no flanks: slopes are for `heap.rs`.
fn what_it_shows(name: &str) -> &'static [&'static str] {
    match name {
        "heap" | "heap-full" => &["heap_height", "centre_of_mass_height", "kinetic_energy_final"],
        "simic-cooling" => &["temperature", "wall_normal_stress"],
        "clustering" | "correlations" | "cooling" | "hard-spheres" => {
            &["compressibility_factor", "temperature", "momentum_drift"]
        }
        "pipe" => &["contrast_over_poisson", "flow_rate", "flow_velocity", "spectrum_slope"],
        "sedimentation" => &["centre_of_mass_height", "kinetic_energy_final"],
        "shear" => &["velocity_profile_slope", "velocity_profile_r_squared", "wall_shear_stress"],
        other => panic!("what is {other} for?"),
    }
}

/// Runs a scenario with an engine and looks at every step.
fn inspect<V: Vector>(scenario: &Scenario<V>, label: &str) {
    let mut simulation = start(scenario);
    let capacity = simulation.capacity();
    // No cell may ever hold more than fit or than it began with; without a capacity any number is right.
    let at_start = simulation.gas().largest_occupancy();
    let bound = capacity.map_or(u32::MAX, |capacity| capacity.max(at_start));
    advance_until(&mut simulation, |simulation| {
        let most = simulation.gas().largest_occupancy();
        assert!(most <= bound, "{label}: {most} grains in a cell at t = {}", simulation.gas().time());
        false
    });
    assert!(simulation.end_reason().is_some() && simulation.totals().steps > 50, "{label}");
    let figures = figures(&mut simulation);
    for &name in what_it_shows(&scenario.name) {
        assert!(figures.get(name).is_some_and(|value| value.is_finite()), "{label}: {name} in {figures:?}");
    }
}

#[test]
fn every_scenario_runs_with_every_engine_and_no_cell_overflows() {
    let names: Vec<&str> = builtin::list().iter().map(|(name, _)| *name).collect();
    for_each(&names, |name| {
        for engine in ["dsmc", "cba", "hsmc"] {
            let choice = format!("engine.kind={engine}");
            let mut sets = vec![choice.as_str()];
            sets.extend(shorter(name));
            let label = format!("{name} with {engine}");
            match any_scenario(name, 1, &sets) {
                AnyScenario::Two(scenario) => inspect(&scenario, &label),
                AnyScenario::Three(scenario) => inspect(&scenario, &label),
            }
        }
    });
}

/// The bound is one that can be broken: with the thesis' rules cells do overflow.
#[test]
fn the_thesis_lets_cells_overflow() {
    let sets = ["engine.hsmc.admission=thesis", "engine.hsmc.displacement=thesis", "run.time=0.5"];
    let AnyScenario::Two(scenario) = any_scenario("sedimentation", 1, &sets) else {
        panic!("sedimentation is in the plane")
    };
    let mut simulation = start(&scenario);
    let bound = simulation.capacity().unwrap().max(simulation.gas().largest_occupancy());
    let mut most = 0;
    advance_until(&mut simulation, |simulation| {
        most = most.max(simulation.gas().largest_occupancy());
        false
    });
    println!("thesis: {most} grains in a cell for {bound}");
    assert!(most > bound);
}
