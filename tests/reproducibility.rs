//! The contract: the same bits for any number of threads, with and without anybody looking, for any
//! limit and any recording, and after a restart.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod small_scenarios;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use grainflow::engine::cell_counts::CellCount;
use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::gas::Gas;
use grainflow::matter::state_hash::state_hash;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::contents::RunLog;
use grainflow::record::reader::{last_state, read_log, read_states};
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter};
use grainflow::run::{Outcome, run};
use grainflow::scenario::initial;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::simulation::{Simulation, assembly};
use grainflow::space::Vector;
use small_scenarios::{ENGINES, Small, driven, gas, heap, pipe, shaken_box, shear};

/// Runs `$body` with the scenario in its own space.
macro_rules! in_its_space {
    ($any:expr, $scenario:ident => $body:expr) => {
        match $any {
            AnyScenario::Two($scenario) => $body,
            AnyScenario::Three($scenario) => $body,
        }
    };
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn start<V: Vector>(scenario: &Scenario<V>) -> Simulation<'_, V> {
    let gas = initial::build(scenario, None).unwrap();
    Simulation::start(scenario, gas, &mut NoLaps).unwrap()
}

/// Asks every measure for its values and profiles.
fn look<V: Vector>(simulation: &mut Simulation<'_, V>) -> Vec<u64> {
    let (measures, snapshot) = simulation.observation();
    let mut bits = Vec::new();
    for measure in measures {
        bits.extend(measure.values(&snapshot).into_iter().map(f64::to_bits));
        for profile in measure.profiles(&snapshot) {
            bits.extend(profile.values.into_iter().flatten().map(f64::to_bits));
        }
    }
    bits
}

/// What a run came to: its state, and what was counted on the way.
#[derive(Debug, PartialEq)]
struct End {
    state_hash: String,
    collisions: u64,
    cell_collisions: u64,
    rejected_moves: u64,
    removed: u64,
    poured: u64,
    wall_momentum: String,
}

fn end_of<V: Vector>(simulation: &Simulation<'_, V>) -> End {
    let totals = simulation.totals();
    End {
        state_hash: state_hash(simulation.gas()),
        collisions: totals.counts.collisions,
        cell_collisions: totals.counts.cell_collisions,
        rejected_moves: totals.counts.rejected_moves,
        removed: totals.counts.removed,
        poured: totals.poured,
        // The shortest decimal that reads back the same: equal text is equal bits.
        wall_momentum: format!("{:?}", totals.counts.wall_momentum),
    }
}

/// The end of a simulation whose measures are asked every step, or never.
fn simulate(scenario: &AnyScenario, looking: bool) -> End {
    in_its_space!(scenario, scenario => {
        let mut simulation = start(scenario);
        while simulation.end_reason().is_none() {
            simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
            if looking {
                look(&mut simulation);
            }
        }
        end_of(&simulation)
    })
}

/// The state after the engine alone has made all steps, with no simulation around it.
fn by_engine_alone(scenario: &AnyScenario) -> String {
    in_its_space!(scenario, scenario => {
        let mut gas = initial::build(scenario, None).unwrap();
        let mut engine =
            assembly::engine(scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
        for _ in 0..scenario.run.steps.unwrap() {
            engine.step(&mut gas, Horizon::NONE, &mut NoLaps).unwrap();
        }
        state_hash(&gas)
    })
}

fn run_into(folder: &Path, scenario: &AnyScenario) -> Outcome {
    run(scenario, folder, false, &AtomicBool::new(false), &mut |_| {}).unwrap()
}

fn hash_of(outcome: &Outcome) -> &str {
    outcome.summary["state_hash"].as_str().unwrap()
}

/// One thread, two and seven; with measures that look and without; through `run` with a recording
/// at both ends only and with fifty.
fn assert_same_bits(small: &Small) -> End {
    let scenario = small.with(&[]);
    let expected = with_threads(1, || simulate(&scenario, false));
    for (threads, looking) in [(2, true), (7, false)] {
        let end = with_threads(threads, || simulate(&scenario, looking));
        assert_eq!(end, expected, "{} with {threads} threads, looking: {looking}", small.name);
    }
    let place = tempfile::tempdir().unwrap();
    for (threads, frames) in [(2, "0"), (1, "50")] {
        let scenario = small.with(&[&format!("record.frames={frames}")]);
        let outcome = with_threads(threads, || run_into(&place.path().join(frames), &scenario));
        assert_eq!(hash_of(&outcome), expected.state_hash, "{} with {frames} frames", small.name);
    }
    expected
}

#[test]
fn gases_give_the_same_bits_for_any_threads_and_any_looks() {
    for dimension in [2, 3] {
        for engine in ENGINES {
            for dense in [true, false] {
                let small = gas(dimension, engine, dense);
                let end = assert_same_bits(&small);
                assert!(end.collisions > 1000, "{}: {end:?}", small.name);
                assert_eq!(by_engine_alone(&small.with(&[])), end.state_hash, "{}", small.name);
                // What makes the order of work matter has to happen, or nothing is tested.
                let crowded = engine == "hsmc" && dense;
                assert_eq!(end.cell_collisions > 100, crowded, "{}: {end:?}", small.name);
                assert_eq!(end.rejected_moves > 100, crowded, "{}: {end:?}", small.name);
            }
        }
    }
}

#[test]
fn driven_matter_gives_the_same_bits_for_any_threads_and_any_looks() {
    for dimension in [2, 3] {
        for engine in ENGINES {
            for small in driven(dimension, engine) {
                let end = assert_same_bits(&small);
                if small.name.starts_with("heap") {
                    assert!(end.poured > 50 && end.removed > 10, "{}: {end:?}", small.name);
                }
            }
        }
    }
}

/// Steps between two looks.
const LOOKS: u64 = 4;

/// The end, the looks after step `saved_at`, and the figures; without an interruption, or with one at
/// which the state goes through a log and a new simulation.
fn with_restart(scenario: &AnyScenario, saved_at: u64, log: Option<&Path>) -> (End, Vec<Vec<u64>>, String) {
    in_its_space!(scenario, scenario => {
        let mut simulation = start(scenario);
        let mut looks = Vec::new();
        while simulation.end_reason().is_none() {
            simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
            let steps = simulation.totals().steps;
            if steps.is_multiple_of(LOOKS) {
                let look = look(&mut simulation);
                looks.extend((steps > saved_at).then_some(look));
            }
            if let Some(log) = log && steps == saved_at {
                simulation = through_log(&simulation, log);
            }
        }
        let (measures, snapshot) = simulation.observation();
        let figures: Vec<_> = measures.iter().map(|measure| measure.conclusion(&snapshot, 0.0)).collect();
        let figures = format!("{figures:?}");
        (end_of(&simulation), looks, figures)
    })
}

fn through_log<'s, V: Vector>(simulation: &Simulation<'s, V>, log: &Path) -> Simulation<'s, V> {
    let time = Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } };
    let time_scale = time_scale(f64::INFINITY, 0.0);
    let header = LogHeader { columns: vec![time], time_scale, ..LogHeader::default() };
    let mut writer = LogWriter::create(log, &header).unwrap();
    let saved = simulation.saved_state(3, 1);
    writer.state(&saved).unwrap();
    writer.finish().unwrap();
    let read = last_state::<V>(log).unwrap().unwrap();
    assert_eq!(read, saved);
    Simulation::resume(simulation.scenario(), read).unwrap()
}

#[test]
fn a_restart_changes_neither_bits_nor_measures() {
    let place = tempfile::tempdir().unwrap();
    for dimension in [2, 3] {
        for engine in ENGINES {
            let gases = [true, false].map(|dense| gas(dimension, engine, dense));
            for small in driven(dimension, engine).into_iter().chain(gases) {
                let scenario = small.with(&[]);
                let through = with_restart(&scenario, 25, None);
                let log = place.path().join(&small.name);
                let restarted = with_threads(3, || with_restart(&scenario, 25, Some(&log)));
                assert_eq!(restarted.0, through.0, "{}", small.name);
                assert_eq!(restarted.1, through.1, "{}", small.name);
                assert_eq!(restarted.2, through.2, "{}", small.name);
            }
        }
    }
}

/// Runs of more steps than a measure takes samples: which ones it has taken is part of the state. The step
/// after the restart is one without a sample.
#[test]
fn a_restart_keeps_the_times_of_samples() {
    let place = tempfile::tempdir().unwrap();
    for small in [shear(2, "hsmc"), pipe(2, "cba"), pipe(3, "hsmc"), shaken_box(2, "dsmc")] {
        let scenario = small.with(&["particles.count=150", "run.steps=1000"]);
        let through = with_restart(&scenario, 500, None);
        let restarted = with_restart(&scenario, 500, Some(&place.path().join(&small.name)));
        assert_eq!(restarted, through, "{}", small.name);
    }
}

/// Goes on from `state` to the end of the run.
fn resumed_end<V: Vector>(scenario: &Scenario<V>, log: &Path, state: usize) -> (End, Vec<(String, String)>) {
    let saved = read_states::<V>(log).unwrap().swap_remove(state);
    let mut simulation = Simulation::resume(scenario, saved).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let from = simulation.steady_from();
    let (measures, snapshot) = simulation.observation();
    let figures = measures
        .iter()
        .flat_map(|measure| measure.conclusion(&snapshot, from).1)
        .map(|figure| {
            let value = figure.value.filter(|value| value.is_finite());
            (figure.name, serde_json::json!(value).to_string())
        })
        .collect();
    (end_of(&simulation), figures)
}

#[test]
fn every_state_in_the_log_of_a_run_leads_to_the_same_end_and_figures() {
    let place = tempfile::tempdir().unwrap();
    let smalls = [2, 3].map(|dimension| {
        let mut smalls = driven(dimension, "hsmc");
        smalls.extend([gas(dimension, "cba", true), gas(dimension, "dsmc", false)]);
        smalls
    });
    for small in smalls.iter().flatten() {
        let scenario = small.with(&["record.states=3", "record.frames=10"]);
        let outcome = run_into(&place.path().join(&small.name), &scenario);
        let log = outcome.folder.join("log.mcap");
        for state in [0, 2, 3] {
            let (end, figures) =
                with_threads(2, || in_its_space!(&scenario, scenario => resumed_end(scenario, &log, state)));
            assert_eq!(end.state_hash, hash_of(&outcome), "{} from state {state}", small.name);
            assert_eq!(end.collisions, outcome.summary["collisions"], "{} from state {state}", small.name);
            assert!(!figures.is_empty());
            for (name, value) in figures {
                // The summary's own entry stands before a figure of the same name.
                if outcome.summary.contains_key(&format!("{name}_standard_error")) {
                    assert_eq!(outcome.summary[&name].to_string(), value, "{}: {name}", small.name);
                }
            }
        }
    }
}

/// Everything that an engine counts in cells adds up to what it counts in all.
fn assert_cells_count_everything<V: Vector>(scenario: &Scenario<V>) {
    let mut simulation = start(scenario);
    while simulation.end_reason().is_none() {
        let before = simulation.gas().clone();
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
        if simulation.totals().steps == 1 {
            assert_bounds(&before, simulation.cell_counts());
        }
    }
    let (counts, totals) = (simulation.cell_counts(), &simulation.totals().counts);
    assert_eq!(counts.iter().map(|count| count.collisions).sum::<u64>(), totals.collisions);
    assert_eq!(counts.iter().map(|count| count.attempts).sum::<u64>(), totals.candidates);
    assert!(totals.collisions > 100 && totals.candidates > totals.collisions);
}

/// The bound of the first step is the diagonal of the box that holds the velocities of a cell.
fn assert_bounds<V: Vector>(gas: &Gas<V>, counts: &[CellCount]) {
    for (cell, count) in counts.iter().enumerate() {
        let velocities = &gas.velocities()[gas.rows(cell as u32)];
        let extent = |axis: usize| {
            let components = velocities.iter().map(|velocity| velocity[axis]);
            components.clone().fold(f64::MIN, f64::max) - components.fold(f64::MAX, f64::min)
        };
        let diagonal = V::from_fn(extent).length();
        let expected = if velocities.len() < 2 { 0.0 } else { diagonal };
        assert!((count.bound - expected).abs() <= 1e-12 * expected, "{} and {expected}", count.bound);
    }
}

/// What fields in a log have counted up to `time`.
fn counted(log: &RunLog, name: &str, time: f64) -> f64 {
    let fields = log.fields.iter().filter(|field| field.name == name && field.time <= time);
    fields.flat_map(|field| field.values.iter().flatten()).map(|&count| f64::from(count)).sum()
}

/// A restart goes on counting where the last recording of fields had left it.
fn assert_restart_goes_on_counting<V: Vector>(scenario: &Scenario<V>, log: &Path) {
    let state = read_states::<V>(log).unwrap().swap_remove(0);
    let before = counted(&read_log(log).unwrap(), "collisions", state.time);
    let mut simulation = Simulation::resume(scenario, state).unwrap();
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let after: u64 = simulation.cell_counts().iter().map(|count| count.collisions).sum();
    assert_eq!(before + after as f64, simulation.totals().counts.collisions as f64);
}

/// With all fields, seldom or often, a run is the same to the last bit; fields miss no collision.
#[test]
fn fields_change_no_bits_and_miss_nothing() {
    let place = tempfile::tempdir().unwrap();
    for dimension in [2, 3] {
        for small in
            [gas(dimension, "dsmc", false), gas(dimension, "cba", true), gas(dimension, "hsmc", false)]
        {
            let all = "[\"density\", \"velocity\", \"temperature\", \"collisions\", \"attempts\", \"bound\"]";
            let seldom = format!("record.fields={{ names = {all}, every_nth = 3 }}");
            let sets = ["record.frames=10", "record.states=1"];
            let plain = run_into(&place.path().join(&small.name).join("plain"), &small.with(&sets));
            let few = "record.particles={ every_nth = 4, points = 50 }";
            let scenario = small.with(&[&sets[..], &[&seldom, few]].concat());
            let with =
                with_threads(2, || run_into(&place.path().join(&small.name).join("fields"), &scenario));
            let [plain_log, log] =
                [&plain, &with].map(|outcome| read_log(&outcome.folder.join("log.mcap")).unwrap());
            assert_eq!(plain_log.state_hashes, log.state_hashes, "{}", small.name);
            // Recordings 0, 3, 6, 9 and the end.
            assert_eq!((plain_log.fields.len(), log.fields.len()), (0, 6 * 5), "{}", small.name);
            assert_eq!((plain_log.series.len(), log.series.len()), (11, 11), "{}", small.name);
            // Recordings 0, 4, 8 and the end.
            let of = |k: usize| log.series[k][0];
            let times: Vec<f64> = log.frames.iter().map(|frame| frame.time).collect();
            assert_eq!(times, [of(0), of(4), of(8), of(10)], "{}", small.name);
            assert!(log.frames.iter().all(|frame| frame.ids.len() == 50 && frame.grains > 1000));
            assert_eq!(plain_log.frames.len(), 11, "{}", small.name);
            let collisions = with.summary["collisions"].as_f64().unwrap();
            assert_eq!(counted(&log, "collisions", f64::INFINITY), collisions, "{}", small.name);
            let path = with.folder.join("log.mcap");
            in_its_space!(&scenario, scenario => {
                assert_cells_count_everything(scenario);
                assert_restart_goes_on_counting(scenario, &path);
            });
        }
    }
}

/// Times (as bits) and state hashes of all recordings of a run.
fn recorded(small: &Small, sets: &[&str]) -> Vec<(u64, String)> {
    let place = tempfile::tempdir().unwrap();
    let outcome = run_into(&place.path().join("run"), &small.with(sets));
    let log = read_log(&outcome.folder.join("log.mcap")).unwrap();
    let times = log.series.iter().map(|row| row[0].to_bits());
    times.zip(log.state_hashes).collect()
}

#[test]
fn neither_limits_nor_recordings_change_bits() {
    for small in [heap(2, "hsmc"), shear(3, "cba"), gas(2, "hsmc", true), gas(3, "dsmc", false)] {
        let long = recorded(&small, &["run.steps=60", "record.frames=60"]);
        let short = recorded(&small, &["run.steps=17", "record.frames=5"]);
        let rare = recorded(&small, &["run.steps=60", "record.frames=4", "record.states=0"]);
        let last_time = f64::from_bits(long[long.len() - 1].0);
        let in_time = recorded(&small, &[&format!("run.time={}", 0.6 * last_time), "record.frames=8"]);
        assert_eq!(long.len(), 61, "{}", small.name);
        for (name, other) in [("a short", short), ("a rarely recorded", rare), ("a timed", in_time)] {
            assert!(other.len() >= 5, "{}", small.name);
            for recording in &other {
                assert!(long.contains(recording), "{}: {name} run at {:?}", small.name, recording);
            }
        }
    }
}
