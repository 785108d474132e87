//! Runs that cannot go on: what they leave, and how they go on with another cure.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use grainflow::record::history::History;
use grainflow::record::reader::{last_state, read_log, read_states};
use grainflow::record::summary::{failure, summary_in};
use grainflow::run::resume::Resumption;
use grainflow::run::{Outcome, RunError, run};
use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, load};
use grainflow::simulation::SimulationError;

use super::logs::{Place, log_bytes, resume, verified};
use super::smaller;

fn heap(engine: &str, sets: &[&str]) -> AnyScenario {
    let sets = [&smaller("heap")[..5], sets].concat();
    let sets = sets.iter().map(ToString::to_string).collect();
    load("heap", &Overrides { sets, engine: Some(engine.to_owned()), seed: None }).unwrap()
}

/// Inelastic collapse, grains that become too fast for a fixed step while others are poured, a step that is too long at once.
fn doomed() -> [(&'static str, AnyScenario); 3] {
    let fixed = ["engine.time_step={ fixed = 0.45 }", "record.measures=[\"energy\", \"flow\", \"heap\"]"];
    let at_once =
        ["engine.time_step={ fixed = 0.35 }", "particles.count=100", "initial.velocities={ maxwell = 9.0 }"];
    [
        ("collapse", heap("event-driven", &[])),
        ("too long", heap("hsmc", &fixed)),
        ("too long at t = 0", heap("cba", &at_once)),
    ]
}

/// Why a run could not go on, and when its last state was.
fn why(result: Result<Outcome, RunError>) -> (SimulationError, Option<f64>) {
    match result.unwrap_err() {
        RunError::Simulation { source, state, .. } => (source, state),
        other => panic!("{other}"),
    }
}

/// The files of a run folder that do not depend on the clock.
fn tables(folder: &Path) -> Vec<String> {
    let text = |path: &Path| fs::read_to_string(path).unwrap();
    let mut tables = vec![text(&folder.join("series.csv"))];
    for profile in fs::read_dir(folder.join("profiles")).into_iter().flatten() {
        tables.push(text(&profile.unwrap().path()));
    }
    tables
}

#[test]
fn a_run_that_failed_leaves_all_its_files_and_fails_again_in_the_same_way() {
    for (reason, scenario) in doomed() {
        let (place, stop) = (Place::new(), AtomicBool::new(false));
        let (whole, mut last) = (place.path("whole"), 0.0);
        let first = why(run(&scenario, &whole, false, &stop, &mut |status| last = status.time));
        assert!(first.0.to_string().contains(reason), "{}", first.0);
        let log = whole.join("log.mcap");
        let (extent, cut_off) = verified(&log);
        assert!(extent.states > 0 && cut_off.is_none(), "{extent:?}");
        // Nothing is lost up to the step that failed.
        let state = last_state::<glam::DVec2>(&log).unwrap().unwrap();
        assert_eq!((Some(state.time), state.time), (first.1, last), "{reason}");
        assert!(state.columns.positions.iter().all(|position| position.is_finite()));
        let summary = summary_in(&whole).unwrap().unwrap();
        assert!(failure(&summary).unwrap().starts_with(&first.0.to_string()), "{summary:?}");
        assert_eq!((&summary["end_reason"], &summary["interrupted"]), (&"failed".into(), &false.into()));
        assert_eq!((summary["simulated_time"].as_f64(), &summary["resumed_at"]), (first.1, &().into()));
        assert_eq!(summary["kinetic_energy_final"].as_f64().map(f64::is_finite), Some(true));
        let recorded = read_log(&log).unwrap();
        assert_eq!(recorded.series.last().unwrap()[0], state.time, "the last recording is of the end");
        assert_eq!(summary["state_hash"], *recorded.state_hashes.last().unwrap());
        let page = fs::read_to_string(whole.join("report.html")).unwrap();
        let words = "<b>This run failed after t = ";
        assert!(page.contains(words) && page.find(words) < page.find("<section>"), "{reason}");
        let again = Resumption::open(&log, &[]).unwrap();
        let again = why(again.run(&place.path("again"), false, &stop, &mut |_| {}));
        assert_eq!(again, first);
        assert!(fs::read(&log).unwrap() == fs::read(place.path("again/log.mcap")).unwrap());
        assert_eq!(tables(&whole), tables(&place.path("again")));
    }
}

/// Sets of a cure, each of which another one follows.
const CURES: [&str; 3] = [
    "engine.event_driven.collapse={ elastic_below = 0.1 }",
    "engine.event_driven.collapse={ elastic_below = 0.1, contact_time = 0.01 }",
    "engine.event_driven.collapse={ elastic_below = 0.2, rotation = 5.0 }",
];

#[test]
fn a_collapsed_run_goes_on_with_a_cure_that_its_log_knows_of() {
    let more: [&[&str]; 2] =
        [&[], &["particles.tangential_restitution=0.5", "engine.event_driven.structure=\"neighbour-lists\""]];
    for (sets, cure) in more.into_iter().flat_map(|sets| CURES.map(|cure| (sets, cure))) {
        let (place, stop) = (Place::new(), AtomicBool::new(false));
        let scenario = heap("event-driven", sets);
        let (_, at) = why(run(&scenario, &place.path("first"), false, &stop, &mut |_| {}));
        let on = resume(&place.path("first"), &[cure, "record.states=12"], &place.path("on"));
        assert_eq!(on.summary["resumed_at"].as_f64(), at);
        assert!(on.summary["simulated_time"].as_f64() > at && failure(&on.summary).is_none(), "{cure}");
        let log = on.folder.join("log.mcap");
        let history = History::read(&log).unwrap();
        assert!(history.earlier.len() == 1 && history.earlier[0].changes.starts_with(cure));
        assert!(
            history.scenario.contains("elastic_below")
                && !history.earlier[0].scenario.contains("elastic_below")
        );
        let (extent, _) = verified(&log);
        assert_eq!(
            (extent.parts, extent.states),
            (2, read_states::<glam::DVec2>(&log).unwrap().len() as u64)
        );
        // The same again, from the state with which the cure came and from a later one, and from there with yet another one.
        let bytes = log_bytes(&on);
        let killed = place.path("killed.mcap");
        let mut ends: Vec<f64> = Vec::new();
        for percent in [90, 97] {
            fs::write(&killed, &bytes[..bytes.len() * percent / 100]).unwrap();
            ends.push(last_state::<glam::DVec2>(&killed).unwrap().unwrap().time);
            let again = resume(&killed, &[], &place.path(&format!("again-{percent}")));
            assert!(log_bytes(&again) == bytes, "{cure} from {ends:?}");
        }
        assert!(Some(ends[0]) >= at && ends[1] > ends[0], "{at:?} {ends:?}");
        for (k, other) in CURES.iter().enumerate().filter(|(_, other)| **other != cure) {
            let third = resume(&killed, &[other], &place.path(&format!("third-{k}")));
            assert_eq!(verified(&third.folder).0.parts, 3);
        }
    }
}
