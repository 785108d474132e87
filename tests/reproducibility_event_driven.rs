//! Event-driven runs through the library: the same bits with and without anybody looking, for any recording, and
//! from any saved state.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::state_hash::state_hash;
use grainflow::record::reader::{read_log, read_states};
use grainflow::run::{Outcome, run};
use grainflow::scenario::initial;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;

macro_rules! in_its_space {
    ($any:expr, $scenario:ident => $body:expr) => {
        match $any {
            AnyScenario::Two($scenario) => $body,
            AnyScenario::Three($scenario) => $body,
        }
    };
}

const HEAD: &str = "seed = 5\n[engine]\nkind = \"event-driven\"\n";
const MAXWELL: &str = "[initial]\nvelocities = { maxwell = 1.0 }\n";

/// Name and text of small scenarios: gases in cells and lists, a cure, walls, and a heap that is poured.
fn smalls() -> Vec<(&'static str, String)> {
    let gas = |dimension: u32, size: &str, fraction: f64, more: &str| {
        format!(
            "dimension = {dimension}\n{HEAD}{more}[domain]\nsize = {size}\n[particles]\nvolume_fraction = {fraction}\n\
             restitution = 0.85\n{MAXWELL}[run]\ntime = 3.0\n"
        )
    };
    let driven = |boundary: &str, more: &str| {
        format!(
            "dimension = 2\ngravity = [0.0, -1.0]\n{HEAD}[engine.event_driven]\n\
             collapse = {{ contact_time = 5e-3 }}\n[domain]\nsize = [40.0, 80.0]\n[boundary]\n{boundary}\
             [particles]\ncount = 150\nrestitution = 0.85\n{MAXWELL}{more}[run]\ntime = 6.0\n"
        )
    };
    let turned = "[engine.event_driven]\ncollapse = { rotation = 5 }\n";
    let lists = "[engine.event_driven]\nstructure = \"neighbour-lists\"\n";
    let poured = "[source]\ncount = 60\nrate = 6.0\nheight = 15.0\nwidth = 20.0\nvelocity = [0.0, -3.0]\n";
    vec![
        ("cells", gas(2, "[40.0, 40.0]", 0.3, "")),
        ("lists", gas(2, "[30.0, 30.0]", 0.5, lists)),
        ("turned", gas(3, "[12.0, 12.0, 12.0]", 0.25, turned)),
        (
            "shaken",
            driven(
                "x.lower = { wall = \"statistical\", reversal_probability = 0.3 }\nx.upper = { wall = \"smooth\" }\n\
                 y.lower = { wall = \"vibrating\", amplitude = 0.4, frequency = 0.9 }\ny.upper = \"open\"\n",
                "",
            ),
        ),
        ("heap", driven("x = \"open\"\ny.lower = { wall = \"rough\" }\ny.upper = \"open\"\n", poured)),
    ]
}

fn scenario(small: &(&'static str, String), sets: &[&str]) -> AnyScenario {
    let sets = sets.iter().map(ToString::to_string).collect();
    parse(small.0, &small.1, &Overrides { sets, ..Default::default() })
        .unwrap_or_else(|error| panic!("{}: {error}\n{}", small.0, small.1))
}

fn run_into(folder: &Path, scenario: &AnyScenario) -> Outcome {
    run(scenario, folder, false, &AtomicBool::new(false), &mut |_| {}).unwrap()
}

fn end_of<V: Vector>(simulation: &Simulation<'_, V>) -> (String, u64, u64, u64) {
    let totals = simulation.totals();
    (state_hash(simulation.gas()), totals.counts.collisions, totals.counts.removed, totals.poured)
}

/// The end of a simulation of which nobody asks anything.
fn simulate<V: Vector>(scenario: &Scenario<V>) -> (String, u64, u64, u64) {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    end_of(&simulation)
}

fn resume<V: Vector>(scenario: &Scenario<V>, log: &Path, state: usize) -> (String, u64, u64, u64) {
    let saved = read_states::<V>(log).unwrap().swap_remove(state);
    let mut simulation = Simulation::resume(scenario, saved).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    end_of(&simulation)
}

#[test]
fn recordings_and_restarts_change_no_bits() {
    let place = tempfile::tempdir().unwrap();
    for small in smalls() {
        let expected = in_its_space!(&scenario(&small, &[]), scenario => simulate(scenario));
        assert!(expected.1 > 150, "{}: {expected:?}", small.0);
        assert_eq!(expected.3 > 20, small.0 == "heap", "{}: {expected:?}", small.0);
        for frames in ["0", "7", "50"] {
            let fields = "record.fields=[\"density\", \"collisions\", \"attempts\"]";
            let scenario = scenario(&small, &[&format!("record.frames={frames}"), "record.states=3", fields]);
            let outcome = run_into(&place.path().join(small.0).join(frames), &scenario);
            let hash = outcome.summary["state_hash"].as_str().unwrap();
            assert_eq!(hash, expected.0, "{} with {frames} frames", small.0);
            let log = outcome.folder.join("log.mcap");
            // Exact dynamics draws no candidates; of its collisions none is missed.
            let fields = read_log(&log).unwrap().fields;
            let collisions = fields.iter().filter(|field| field.name == "collisions");
            let counted: f64 = collisions.flat_map(|field| &field.values[0]).map(|&one| f64::from(one)).sum();
            assert_eq!(counted, outcome.summary["collisions"].as_f64().unwrap(), "{}", small.0);
            assert!(fields.iter().all(|field| field.name != "attempts"));
            for state in [0, 1, 2] {
                let end = in_its_space!(&scenario, scenario => resume(scenario, &log, state));
                assert_eq!(end, expected, "{} with {frames} frames from state {state}", small.0);
            }
        }
    }
}

/// Recordings at the same times show the same states, however many others there are.
#[test]
fn recordings_show_the_same_run() {
    let place = tempfile::tempdir().unwrap();
    for small in smalls() {
        let recorded = |frames: &str| {
            let scenario = scenario(&small, &[&format!("record.frames={frames}")]);
            let outcome = run_into(&place.path().join(small.0).join(frames), &scenario);
            let log = read_log(&outcome.folder.join("log.mcap")).unwrap();
            let times: Vec<u64> = log.series.iter().map(|row| row[0].to_bits()).collect();
            times.into_iter().zip(log.state_hashes).collect::<Vec<_>>()
        };
        let (often, rarely) = (recorded("48"), recorded("6"));
        let shared = rarely.iter().filter(|recording| often.contains(recording)).count();
        let times = rarely.iter().filter(|(time, _)| often.iter().any(|(other, _)| other == time)).count();
        assert!(times >= 5, "{}: {times}", small.0);
        assert_eq!(shared, times, "{}", small.0);
    }
}
