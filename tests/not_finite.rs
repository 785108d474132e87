//! A state that is not finite stops the run at the step where it appears, and says where.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec2;
use grainflow::engine::{EngineError, Horizon, NoLaps};
use grainflow::matter::columns::Columns;
use grainflow::matter::gas::Gas;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::assembly::engine;

const STEPS_BEFORE: u64 = 3;

fn scenario(engine: &str, boundary: &str) -> Scenario<DVec2> {
    let text = format!(
        "dimension = 2
seed = 23
[engine]
kind = \"{engine}\"
cell_size = 2.0
time_step = {{ fixed = 0.01 }}
[domain]
size = [20.0, 20.0]
[boundary]
y = {boundary}
[particles]
count = 120
restitution = 0.9
[initial]
velocities = {{ maxwell = 1.0 }}
[run]
steps = 10
"
    );
    match parse("spoilt", &text, &Overrides::default()).unwrap() {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => panic!("it says dimension = 2"),
    }
}

/// The error of the step after `spoil` has changed the grain `id`, and the cell that grain was in.
fn error_after(
    scenario: &Scenario<DVec2>,
    id: u32,
    spoil: impl Fn(&mut Columns<DVec2>, usize),
) -> (EngineError, u32) {
    let mut gas: Gas<DVec2> = initial::build(scenario, None).unwrap();
    let mut engine = engine(scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
    for _ in 0..STEPS_BEFORE {
        engine.step(&mut gas, Horizon::NONE, &mut NoLaps).unwrap();
    }
    let row = gas.ids().iter().position(|&other| other == id).unwrap();
    let cell = gas.grid().cell_of(gas.positions()[row]);
    spoil(gas.parts_mut().2, row);
    (engine.step(&mut gas, Horizon::NONE, &mut NoLaps).unwrap_err(), cell)
}

#[test]
fn a_velocity_that_is_no_number_is_named_with_its_grain() {
    for engine in ["dsmc", "cba", "hsmc"] {
        for wrong in [f64::NAN, f64::INFINITY] {
            let scenario =
                scenario(engine, "{ lower = { wall = \"smooth\" }, upper = { wall = \"rough\" } }");
            let (error, home) = error_after(&scenario, 77, |columns, row| columns.velocities[row].x = wrong);
            let EngineError::NotFinite { id, cell, step, seed, time } = error else {
                panic!("{engine}: {error}")
            };
            assert_eq!((step, seed), (STEPS_BEFORE + 1, 23), "{engine}");
            assert!((time - 0.04).abs() < 1e-15);
            // Partners and, in hsmc, neighbouring cells are spoilt in the same step: the first of all is named.
            assert!(engine == "hsmc" || cell == home || id == 77, "{engine}: grain {id} in cell {cell}");
            let said = error.to_string();
            for part in
                [format!("grain {id} in cell {cell}"), "after step 4".to_owned(), "seed 23".to_owned()]
            {
                assert!(said.contains(&part), "{said}");
            }
        }
    }
}

#[test]
fn a_place_that_is_no_number_does_not_heal() {
    let walls = "{ lower = { wall = \"smooth\" }, upper = { wall = \"smooth\" } }";
    for engine in ["dsmc", "cba", "hsmc"] {
        for boundary in ["\"periodic\"", walls, "\"open\""] {
            for wrong in [f64::NAN, f64::INFINITY] {
                let scenario = scenario(engine, boundary);
                let (error, _) = error_after(&scenario, 5, |columns, row| columns.positions[row].y = wrong);
                assert!(
                    matches!(error, EngineError::NotFinite { id: 5, .. }),
                    "{engine}, {boundary}: {error}"
                );
            }
        }
    }
}
