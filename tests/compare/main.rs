//! `grainflow compare` as people and scripts meet it: files, exit codes, texts, bits.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod chance;
mod endings;
mod logs;
#[path = "../place/mod.rs"]
mod place;
mod refusals;
#[path = "../signal/mod.rs"]
mod signal;
mod stage;

use std::fs;
use std::path::Path;

use serde_json::Value;

use place::{Place, code, error, text};
use stage::{GAS, HEAP, is_judged};

/// Every file of the folder of a run.
const RUN: [&str; 4] = ["log.mcap", "series.csv", "summary.json", "report.html"];
/// Asserts that `folder` holds the files of a comparison, each with what it begins with.
pub(crate) fn assert_written(folder: &Path) {
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert!(read("comparison.html").starts_with("<!DOCTYPE html>"));
    let found: Value = serde_json::from_str(&read("comparison.json")).unwrap();
    assert_eq!(found["scenario"], "gas");
    let engines: Vec<&str> =
        found["contestants"].as_array().unwrap().iter().map(|one| one["engine"].as_str().unwrap()).collect();
    assert!(engines.contains(&"hsmc") && engines.contains(&"event-driven"), "{engines:?}");
    // The gas of these tests cools, in a box of 20 d.
    assert!(found["remarks"].to_string().contains("the box of 20 d"), "{}", found["remarks"]);
    assert!(read("comparison.csv").starts_with("kind,name,time,place,contestant,value,standard_error,"));
}

#[test]
fn every_engine_runs_from_the_same_initial_states() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let output =
        place.grainflow(&["compare", "gas.toml", "--engines", "hsmc,cba,event-driven", "--replicas", "2"]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    let folder = place.path("out/gas-compare");
    assert_written(&folder);
    let first = |run: &str| place.log(&format!("out/gas-compare/{run}")).state_hashes.remove(0);
    for engine in ["hsmc", "cba", "event-driven"] {
        for replica in [1, 2] {
            let run = format!("{engine}-{replica}");
            RUN.iter().for_each(|file| assert!(folder.join(&run).join(file).exists(), "{run}/{file}"));
            let log = place.log(&format!("out/gas-compare/{run}"));
            assert_eq!((log.metadata["scenario"].as_str(), log.metadata["engine"].as_str()), ("gas", engine));
            // By identity and bit: the same grains, whatever cells they stand in.
            assert_eq!(first(&run), first(&format!("initial-{replica}")), "{run}");
            let energy =
                place.summary(&format!("out/gas-compare/{run}"))["kinetic_energy_initial"].as_f64().unwrap();
            let grains = log.frames[0].grains as f64;
            // D/2 N T, up to the rounding of sums in another order.
            assert!((energy / grains - 1.0).abs() < 1e-12, "{run}: {energy}");
        }
    }
    assert_ne!(first("initial-1"), first("initial-2"));
    let said = text(&output);
    assert!(is_judged(&said, "hsmc", "event-driven") && is_judged(&said, "cba", "event-driven"), "{said}");
    assert!(said.contains("s advancing") && said.contains("out/gas-compare/comparison.html"), "{said}");
    let page = fs::read_to_string(folder.join("comparison.html")).unwrap();
    assert!(page.contains("<h1>A small gas</h1>") && page.contains("What they cost"));
}

#[test]
fn a_poured_heap_in_three_dimensions_is_compared() {
    let place = Place::with(&[("heap.toml", HEAP)]);
    let output = place.grainflow(&["compare", "heap.toml", "--replicas", "2", "--out", "heaps"]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    for run in ["hsmc-1", "hsmc-2", "event-driven-1", "event-driven-2"] {
        let summary = place.summary(&format!("heaps/{run}"));
        assert_eq!(
            (summary["poured"].as_u64(), summary["end_reason"].as_str()),
            (Some(20), Some("rest")),
            "{run}"
        );
    }
    assert!(fs::read_to_string(place.path("heaps/comparison.html")).unwrap().contains("of spheres"));
}

#[test]
fn every_run_can_be_repeated_by_hand_from_anywhere() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let output =
        place.grainflow(&["compare", "gas.toml", "--replicas", "1", "--out", "a/b", "--set", "run.time=1"]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    for (from, scenario) in [(".", "a/b/hsmc-1.toml"), ("a", "b/event-driven-1.toml"), ("a/b", "hsmc-1.toml")]
    {
        let mut command = place.command(&["run", scenario, "--quiet", "--force", "--out", "../again"]);
        let output = command.current_dir(place.path(from)).output().unwrap();
        assert_eq!(code(&output), 0, "{}", error(&output));
        let again = place.path(from).join("../again");
        let run = format!("a/b/{}", scenario.rsplit('/').next().unwrap().trim_end_matches(".toml"));
        assert_eq!(stage::summary(&again)["state_hash"], place.summary(&run)["state_hash"], "{scenario}");
    }
}

#[test]
fn jobs_and_threads_change_no_bit() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let hashes = |options: &[&str], out: &str| -> Vec<(String, Vec<String>)> {
        let arguments = ["compare", "gas.toml", "--replicas", "3", "--out", out, "--set", "run.time=1"];
        let output = place.grainflow(&[&arguments, options].concat());
        assert_eq!(code(&output), 0, "{}", error(&output));
        let runs =
            ["hsmc", "event-driven"].iter().flat_map(|engine| (1..=3).map(move |k| format!("{engine}-{k}")));
        runs.map(|run| (run.clone(), place.log(&format!("{out}/{run}")).state_hashes)).collect()
    };
    let one = hashes(&["--threads", "1"], "one");
    assert_eq!(hashes(&["--threads", "3"], "three"), one);
    assert_eq!(hashes(&["--threads", "4", "--jobs", "2"], "jobs"), one);
    assert_eq!(hashes(&["--jobs", "7"], "many"), one);
    // Nothing is said of costs where runs share the machine.
    let page = |out: &str| fs::read_to_string(place.path(out).join("comparison.html")).unwrap();
    assert!(page("one").contains("What they cost") && !page("jobs").contains("What they cost"));
}

#[test]
fn measures_can_be_chosen() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let arguments =
        ["compare", "gas.toml", "--replicas", "2", "--measures", "energy,pressure", "--set", "run.time=1"];
    let output = place.grainflow(&arguments);
    assert_eq!(code(&output), 0, "{}", error(&output));
    let log = place.log("out/gas-compare/hsmc-1");
    let names: Vec<&str> = log.columns.iter().map(|column| column.name.as_str()).collect();
    assert!(names.contains(&"temperature") && names.contains(&"pressure"), "{names:?}");
    assert!(log.profiles.is_empty());
}
