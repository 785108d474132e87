//! Runs that do not come to their end.

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use super::place::{Place, code, error, text};
use super::signal::send;
use super::stage::{GAS, is_judged};

/// So dissipative that exact dynamics collapses without a cure.
const COLLAPSING: [&str; 4] = ["--set", "particles.restitution=0.1", "--set", "run.time=100"];

#[test]
fn a_collapse_is_told_of_its_engine_and_the_others_are_shown() {
    let place = Place::with(&[("gas.toml", GAS)]);
    let arguments = ["compare", "gas.toml", "--engines", "event-driven,hsmc,dsmc", "--replicas", "2"];
    let output = place.grainflow(&[&arguments[..], &COLLAPSING].concat());
    assert_eq!(code(&output), 1, "{}", error(&output));
    let said = text(&output);
    assert_eq!(said.matches("inelastic collapse at t = ").count(), 2, "{said}");
    assert!(is_judged(&said, "dsmc", "hsmc"), "{said}");
    let page = fs::read_to_string(place.path("out/gas-compare/comparison.html")).unwrap();
    assert!(page.contains("class=\"warning\">event-driven: ") && page.contains("inelastic collapse"));
    // What was recorded before is kept, and so is a way to look at it again.
    let log = place.log("out/gas-compare/event-driven-1");
    assert!(!log.series.is_empty() && log.cut_off.is_none());
    assert!(place.path("out/gas-compare/event-driven-1.toml").exists());
    let summary = fs::read_to_string(place.path("out/gas-compare/event-driven-1/summary.json")).unwrap();
    assert!(summary.contains("\"end_reason\": \"failed\""), "{summary}");
    // With a cure it holds.
    let cure = ["--set", "engine.event_driven.collapse.contact_time=1e-3", "--set", "run.time=2", "--force"];
    let output = place.grainflow(&[&arguments[..], &COLLAPSING, &cure].concat());
    assert_eq!(code(&output), 0, "{}", error(&output));
    assert!(is_judged(&text(&output), "hsmc", "event-driven"), "{}", text(&output));
}

#[test]
fn nothing_that_ends_is_nothing_to_compare() {
    let place = Place::with(&[("gas.toml", GAS)]);
    // A step that is too long for the first grain that comes along.
    let steps = ["--set", "engine.time_step.fixed=15", "--engines", "hsmc,cba"];
    let output = place.grainflow(&[&["compare", "gas.toml", "--replicas", "1"], &steps[..]].concat());
    assert!([1, 2].contains(&code(&output)), "{}", error(&output));
    assert!(error(&output).contains("fixed"), "{}", error(&output));
    assert!(!place.path("out/gas-compare/comparison.html").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_what_has_come_to_its_end() {
    let place = Place::with(&[("gas.toml", GAS)]);
    // The second engine would take very long.
    let arguments = [
        "compare",
        "gas.toml",
        "--engines",
        "event-driven,hsmc",
        "--replicas",
        "2",
        "--set",
        "run={ steps = 9000000000, collisions_per_particle = 3.0 }",
        "--set",
        "particles.restitution=1.0",
    ];
    let endless = ["--set", "engine.time_step.fixed=1e-9"];
    let mut command = place.command(&[&arguments[..], &endless].concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let log = place.path("out/gas-compare/hsmc-1/log.mcap");
    let since = Instant::now();
    while fs::metadata(&log).map_or(0, |log| log.len()) < 500 {
        assert!(since.elapsed() < Duration::from_secs(60), "the second run does not begin");
        std::thread::sleep(Duration::from_millis(20));
    }
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 130, "{}", error(&output));
    assert_eq!(place.summary("out/gas-compare/hsmc-1")["interrupted"], true);
    assert!(!place.path("out/gas-compare/event-driven-2").exists(), "the second replica was not begun");
    let page = fs::read_to_string(place.path("out/gas-compare/comparison.html")).unwrap();
    assert!(page.contains("hsmc: ") && page.contains("interrupted"));
}
