//! The program as scripts and people meet it: exit codes, files, texts.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod place;
mod signal;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use grainflow::record::reader::{last_state, read_log};
use grainflow::scenario::builtin;
use grainflow::simulation::figures::{ATTRIBUTES, KEYS, Kind};
use place::{Place, code, error, text};
use serde_json::{Map, Value};
use signal::send;

/// A gas that is done in no time.
const QUICK: [&str; 6] =
    ["run", "cooling", "--set", "particles.count=300", "--set", "run.collisions_per_particle=3"];

impl Place {
    /// The run of [`QUICK`] with more options.
    fn quick(&self, more: &[&str]) -> Output {
        self.grainflow(&[&QUICK, more].concat())
    }

    /// Asserts that `arguments` are refused as wrong input; returns what was said.
    fn refused(&self, arguments: &[&str]) -> String {
        let output = self.grainflow(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", error(&output));
        assert_eq!(text(&output), "", "{arguments:?}");
        error(&output)
    }
}

fn summary(folder: &Path) -> Map<String, Value> {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

/// Every key of the table stands in `summary` and is of its kind; every other one is a figure with an error or the error itself.
fn agrees_with_its_table(summary: &Map<String, Value>) {
    for (key, kind) in KEYS {
        let value = summary.get(key).unwrap_or_else(|| panic!("{key}"));
        match kind {
            // Of a run that did not fail.
            Kind::Text if key == "failure" => assert!(value.is_null(), "{key}: {value}"),
            Kind::Text => assert!(value.is_string() || value.is_boolean(), "{key}: {value}"),
            Kind::Number | Kind::Counter => assert!(value.is_number() || value.is_null(), "{key}: {value}"),
            Kind::Cost => assert!(value.as_f64().is_none_or(|cost| cost >= 0.0), "{key}: {value}"),
        }
    }
    for key in summary.keys().filter(|key| KEYS.iter().all(|(known, _)| known != key)) {
        let endings = ATTRIBUTES.iter().find_map(|ending| key.strip_suffix(ending));
        let name = endings.unwrap_or(key);
        assert!(summary.contains_key(&format!("{name}_standard_error")), "{key} is in no table");
    }
}

#[test]
fn a_run_folder_is_complete() {
    let place = Place::new();
    let output = place.quick(&[]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    let folder = place.path("out/cooling-hsmc");
    for file in ["log.mcap", "series.csv", "profiles/density-profile.csv", "summary.json", "report.html"] {
        assert!(fs::metadata(folder.join(file)).unwrap().len() > 100, "{file}");
    }
    let summary = summary(&folder);
    agrees_with_its_table(&summary);
    assert!(summary["pressure"].is_f64());
    assert_eq!(
        (summary["end_reason"].as_str(), summary["events"].is_null()),
        (Some("collisions_per_particle"), true)
    );
    assert_eq!(
        (summary["interrupted"].as_bool(), summary["scenario"].as_str()),
        (Some(false), Some("cooling"))
    );
    assert!(summary.values().all(|value| !value.is_object() && !value.is_array()), "flat");
    let log = read_log(&folder.join("log.mcap")).unwrap();
    assert_eq!(log.state_hashes.last().unwrap(), summary["state_hash"].as_str().unwrap());
    assert!(fs::read_to_string(folder.join("report.html")).unwrap().starts_with("<!DOCTYPE html>"));
    let said = text(&output);
    assert!(
        said.lines().any(|line| line.starts_with("  pressure ") && line.contains(" mass/time^2")),
        "{said}"
    );
    assert!(
        said.contains("cooling with hsmc: ended by its limit")
            && said.contains("out/cooling-hsmc/report.html")
    );
}

#[test]
fn the_series_is_that_of_the_log() {
    let place = Place::new();
    assert_eq!(
        code(&place.quick(&["--out", "run", "--set", "record.frames=7", "--set", "record.spacing=even"])),
        0
    );
    let table = fs::read_to_string(place.path("run/series.csv")).unwrap();
    let log = read_log(&place.path("run/log.mcap")).unwrap();
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header.len(), log.columns.len());
    for (name, column) in header.iter().zip(&log.columns) {
        let (name, unit) = name.split_once(' ').unwrap();
        assert_eq!(name, column.name);
        assert!(unit.starts_with('[') && unit.ends_with(']') && unit.len() > 2, "{unit}");
    }
    assert_eq!(header[0], "time [time]");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|value| value.parse().unwrap_or(f64::NAN)).collect()).collect();
    let bits = |rows: &[Vec<f64>]| -> Vec<Vec<u64>> {
        rows.iter().map(|row| row.iter().map(|value| value.to_bits()).collect()).collect()
    };
    assert!(rows.len() >= 7);
    assert_eq!(bits(&rows), bits(&log.series));
}

#[test]
fn an_old_run_stays_unless_a_new_one_is_complete() {
    let place = Place::new();
    assert_eq!(code(&place.quick(&["--out", "run"])), 0);
    let old = summary(&place.path("run"));
    let output = place.quick(&["--out", "run", "--seed", "2"]);
    assert_eq!(code(&output), 2);
    assert!(error(&output).contains("run already holds something") && error(&output).contains("--force"));
    assert_eq!(summary(&place.path("run")), old);
    // A failure under --force leaves the old run.
    let failing = place.quick(&["--out", "run", "--force", "--set", "engine.time_step.fixed=15"]);
    assert_eq!(code(&failing), 1);
    assert_eq!(fs::read_dir(place.path("")).unwrap().count(), 1);
    assert_eq!(summary(&place.path("run")), old);
    assert_eq!(code(&place.quick(&["--out", "run", "--force", "--seed", "2"])), 0);
    assert_eq!(summary(&place.path("run"))["seed"], 2);
    assert_ne!(summary(&place.path("run"))["state_hash"], old["state_hash"]);
    // An empty folder is nobody's run.
    fs::create_dir(place.path("empty")).unwrap();
    assert_eq!(code(&place.quick(&["--out", "empty"])), 0);
}

/// A limit on the size of files stands in for a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_at_once_and_leaves_a_log() {
    let place = Place::new();
    let limited = "trap '' XFSZ; ulimit -f 800; exec \"$0\" \"$@\"";
    let endless =
        ["--set", "run={time=5000}", "--set", "record={every=0.01}", "--set", "particles.count=3000"];
    let output = Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_grainflow"), "run", "cooling", "--quiet", "--out", "run"])
        .args(endless)
        .current_dir(place.path(""))
        .output()
        .unwrap();
    assert_eq!(code(&output), 1, "{}", error(&output));
    let said = error(&output);
    assert!(said.contains("cannot write to the log run/log.mcap: File too large"), "{said}");
    let log = read_log(&place.path("run/log.mcap")).unwrap();
    assert!(log.series.len() > 3 && log.cut_off.is_some(), "{}", log.series.len());
    assert!(!place.path("run/summary.json").exists());
}

#[test]
fn mistakes_on_the_command_line_are_told_with_a_remedy() {
    let place = Place::new();
    let said = place.refused(&["run", "sheer"]);
    assert!(said.contains("neither a file nor a built-in scenario; did you mean `shear`?"), "{said}");
    let said = place.refused(&["run", "shear", "--set", "seed=3", "--set", "particles.restitution=1.5"]);
    assert!(said.contains("--set #2 'particles.restitution=1.5': particles.restitution: "), "{said}");
    let said = place.refused(&["run", "shear", "--set", "particles.restituton=0.5"]);
    assert!(said.contains("did you mean `restitution`?"), "{said}");
    let said = place.refused(&["check", "shear", "--set", "restitution"]);
    assert!(said.contains("has no `=`; write key.path=value"), "{said}");
    let said = place.refused(&["run", "shear", "--engine", "dsmcc"]);
    assert!(said.contains("--engine 'dsmcc'") && said.contains("dsmc"), "{said}");
    let said = place.refused(&["run", "shear", "--engine", "cuba"]);
    assert!(said.contains("dsmc") && said.contains("event-driven"), "{said}");
    assert!(place.refused(&["run", "shear", "--threads", "0"]).contains("--threads"));
    assert!(place.refused(&["run", "shear", "--seed", "-1"]).contains("--seed"));
    assert!(
        place.refused(&["run", "shear", "--seed", "9223372036854775808"]).contains("9223372036854775807")
    );
    assert!(place.refused(&["run"]).contains("SCENARIO"));
    assert!(place.refused(&["walk", "shear"]).contains("walk"));
    assert!(place.refused(&["scenarios", "show", "heep"]).contains("did you mean `heap`?"));
    // All mistakes at once, and nothing was written.
    let said = place.refused(&[
        "run",
        "shear",
        "--set",
        "run.steps=0",
        "--set",
        "particles.mass=-1",
        "--set",
        "engin.kind=cba",
    ]);
    assert_eq!(said.lines().count(), 3, "{said}");
    assert!(!place.path("out").exists());
}

#[test]
fn check_tells_what_every_built_in_scenario_means() {
    let place = Place::new();
    for (name, _) in builtin::list() {
        let output = place.grainflow(&["check", name]);
        assert_eq!((code(&output), error(&output)), (0, String::new()), "{name}");
        let said = text(&output);
        for fact in ["engine", "grains", "volume fraction", "cells", "grains per cell", "memory", "log"] {
            assert!(said.lines().any(|line| line.starts_with(fact)), "{name}: {fact}\n{said}");
        }
        let engine = said.lines().find_map(|line| line.strip_prefix("engine")).unwrap_or_default().trim();
        let pace = if engine == "event-driven" { "expected collisions" } else { "first time step" };
        assert!(said.contains(pace), "{name}: {said}");
        let of_hsmc = said.contains("capacity of a cell") && said.contains("cells that start above it");
        assert_eq!(of_hsmc, engine == "hsmc", "{name}: {said}");
        assert!(!said.contains("NaN") && !said.contains("inf "), "{name}: {said}");
    }
    assert!(text(&place.grainflow(&["check", "cooling"])).contains("Haff time t₀"));
    assert!(!place.path("out").exists(), "it runs nothing");
}

#[test]
fn built_in_scenarios_are_listed_and_shown() {
    let place = Place::new();
    let list = text(&place.grainflow(&["scenarios"]));
    for fault in [
        "hsmc makes heaps too steep",
        "lets beds sink",
        "the stress of a driven flow",
        "once the gas clusters",
    ] {
        assert!(list.contains(fault), "{fault}: {list}");
    }
    for (name, about) in builtin::list() {
        assert!(list.contains(name) && list.contains(about));
        let shown = place.grainflow(&["scenarios", "show", name]);
        assert_eq!(text(&shown), builtin::text(name).unwrap());
    }
    // What is shown runs as a file, under the name of the file.
    fs::write(place.path("mine.toml"), builtin::text("cooling").unwrap()).unwrap();
    let mut arguments =
        QUICK.map(|argument| if argument == "cooling" { "mine.toml" } else { argument }).to_vec();
    arguments.push("--quiet");
    assert_eq!(code(&place.grainflow(&arguments)), 0);
    assert_eq!(summary(&place.path("out/mine-hsmc"))["scenario"], "mine");
}

#[test]
fn quiet_is_silent_and_plain_output_has_no_colours() {
    let place = Place::new();
    let output = place.quick(&["--quiet"]);
    assert_eq!((code(&output), text(&output), error(&output)), (0, String::new(), String::new()));
    let coloured = |output: &Output| text(output).contains('\u{1b}') || error(output).contains('\u{1b}');
    for arguments in [vec!["run", "--nonsense"], vec!["--help"], vec!["run", "sheer"]] {
        let output = place.command(&arguments).env("NO_COLOR", "1").output().unwrap();
        assert!(!coloured(&output), "{arguments:?}");
    }
    assert!(!coloured(&place.quick(&["--force"])));
}

#[test]
fn a_step_that_is_too_long_ends_the_run_with_one_that_would_do() {
    let place = Place::new();
    let long = ["--set", "engine.time_step.fixed=15", "--set", "initial.equilibrate=0", "--out", "run"];
    let output = place.quick(&long);
    assert_eq!((code(&output), text(&output)), (1, String::new()));
    let said = error(&output);
    let longest =
        said.split("`engine.time_step.fixed` = ").nth(1).unwrap().split_whitespace().next().unwrap();
    let log = read_log(&place.path("run/log.mcap")).unwrap();
    assert_eq!((log.series.len(), log.cut_off), (1, None));
    assert!(said.contains("run/log.mcap"), "{said}");
    let left = summary(&place.path("run"));
    assert_eq!((&left["end_reason"], &left["interrupted"]), (&"failed".into(), &false.into()));
    assert!(left["failure"].as_str().unwrap().contains("is too long"), "{}", left["failure"]);
    assert!(place.path("run/report.html").exists());
    // The step that would do does, for a start.
    let step = format!("engine.time_step.fixed={longest}");
    let short = ["--out", "second", "--set", &step, "--set", "initial.equilibrate=0", "--set", "run.steps=1"];
    let output = place.quick(&short);
    assert!(code(&output) == 0 && !error(&output).contains("error"), "{}", error(&output));
    // Before there is a log nobody is sent to one, and no folder stays behind.
    let output = place.quick(&["--out", "third", "--set", "engine.time_step.fixed=15"]);
    assert_eq!(code(&output), 1);
    assert!(error(&output).contains("there is no log"), "{}", error(&output));
    assert!(!place.path("third").exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_told() {
    let place = Place::new();
    fs::write(place.path("file"), "text").unwrap();
    let output = place.quick(&["--out", "file"]);
    assert_eq!(code(&output), 2);
    assert!(error(&output).contains("file is a file, not a folder"), "{}", error(&output));
    let output = place.quick(&["--out", "file", "--force"]);
    assert_eq!(code(&output), 2, "a file is nobody's run: --force does not delete it");
    assert_eq!(fs::read_to_string(place.path("file")).unwrap(), "text");
    let output = place.quick(&["--out", "file/run"]);
    assert_eq!(code(&output), 2);
    assert!(error(&output).contains("cannot use file/run as a run folder: "), "{}", error(&output));
    // Whoever may write everywhere is not kept from anything by the mode of a folder.
    fs::create_dir(place.path("locked")).unwrap();
    let mut permissions = fs::metadata(place.path("locked")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(place.path("locked"), permissions).unwrap();
    if fs::write(place.path("locked/probe"), "").is_err() {
        let output = place.quick(&["--out", "locked/run"]);
        assert_eq!(code(&output), 1);
        assert!(error(&output).contains("Permission denied"), "{}", error(&output));
    }
}

/// A run that would take very long, once it has begun to record.
#[cfg(unix)]
fn begun(place: &Place, more: &[&str]) -> std::process::Child {
    let arguments =
        [&["run", "cooling", "--out", "run", "--set", "run.collisions_per_particle=1e9"], more].concat();
    let mut command = place.command(&arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let log = place.path("run/log.mcap");
    let since = Instant::now();
    while fs::metadata(&log).map_or(0, |log| log.len()) < 1000 {
        assert!(since.elapsed() < Duration::from_secs(30), "the run does not begin");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_run_cleanly() {
    for signal in ["-INT", "-TERM"] {
        let place = Place::new();
        let child = begun(&place, &["--set", "particles.count=2000", "--set", "particles.restitution=1.0"]);
        std::thread::sleep(Duration::from_millis(300));
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 130, "{}", error(&output));
        assert!(text(&output).contains("interrupted at t = "), "{}", text(&output));
        let summary = summary(&place.path("run"));
        assert_eq!(summary["interrupted"], true);
        assert_eq!(summary["end_reason"], "interrupted");
        for file in ["series.csv", "report.html", "profiles/density-profile.csv"] {
            assert!(place.path("run").join(file).exists(), "{file}");
        }
        let log = read_log(&place.path("run/log.mcap")).unwrap();
        assert_eq!(log.cut_off, None);
        assert_eq!(log.state_hashes.last().unwrap(), summary["state_hash"].as_str().unwrap());
        let last = last_state::<glam::DVec2>(&place.path("run/log.mcap")).unwrap().unwrap();
        assert!((summary["simulated_time"].as_f64().unwrap() / last.time - 1.0).abs() < 1e-15);
        assert_eq!(last.totals.steps, summary["steps"].as_u64().unwrap());
    }
}

#[test]
fn help_tells_what_works_and_nothing_else() {
    let place = Place::new();
    for verb in [
        "",
        "run",
        "compare",
        "sweep",
        "calibrate",
        "replay",
        "recover",
        "export",
        "view",
        "check",
        "scenarios",
    ] {
        let arguments: Vec<&str> = [verb, "--help"].into_iter().filter(|word| !word.is_empty()).collect();
        let output = place.grainflow(&arguments);
        assert_eq!((code(&output), error(&output)), (0, String::new()));
        let said = text(&output);
        assert!(said.contains("Usage: grainflow"), "{arguments:?}: {said}");
        assert!(said.lines().all(|line| line.chars().count() <= 100), "{said}");
    }
    let run = text(&place.grainflow(&["run", "--help"]));
    let shared = ["--out", "--force", "--engine", "--seed", "--threads", "--set", "--quiet"];
    shared.iter().for_each(|option| assert!(run.contains(option), "{option}"));
    let compare = text(&place.grainflow(&["compare", "--help"]));
    for option in shared.iter().chain(&["--engines", "--replicas", "--jobs", "--measures", "Examples:"]) {
        assert!(compare.contains(option), "{option}");
    }
    assert_eq!(text(&place.grainflow(&["--version"])), format!("grainflow {}\n", env!("CARGO_PKG_VERSION")));
    // The examples of the help are commands that are understood.
    let help = text(&place.grainflow(&["--help"]));
    let examples = help.lines().filter_map(|line| line.trim().strip_prefix("grainflow "));
    let mut tried = 0;
    for example in examples.filter(|example| example.starts_with("run ") && !example.contains("--resume")) {
        let command = example.split("  ").next().unwrap();
        let mut arguments: Vec<&str> = command.split_whitespace().collect();
        arguments[0] = "check";
        assert_eq!(code(&place.grainflow(&arguments)), 0, "{example}");
        tried += 1;
    }
    assert!(tried >= 2, "{help}");
}
