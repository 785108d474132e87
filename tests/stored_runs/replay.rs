//! `grainflow replay`: what comes out is what the run has written.

use std::fs;

use super::{Place, code, error, text};

/// Pair correlations of a table, without its header: `[line][column]`.
fn numbers(table: &str) -> Vec<Vec<f64>> {
    let line = |line: &str| line.split(',').map(|word| word.parse().unwrap_or(f64::NAN)).collect();
    table.lines().skip(1).map(line).collect()
}

#[test]
fn a_replay_prints_the_series_to_the_last_digit() {
    let place = Place::with_run(&[]);
    let series = place.read("run/series.csv");
    assert_eq!(place.obeyed(&["replay", "run"]), series);
    assert_eq!(place.obeyed(&["replay", "run/log.mcap"]), series);
    place.obeyed(&["replay", "run", "--series", "again.csv", "--profiles", "profiles"]);
    assert_eq!(place.read("again.csv"), series);
    let mut profiles = 0;
    for entry in fs::read_dir(place.path("run/profiles")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert_eq!(place.read(&format!("profiles/{name}")), place.read(&format!("run/profiles/{name}")));
        profiles += 1;
    }
    assert_eq!(fs::read_dir(place.path("profiles")).unwrap().count(), profiles);
    assert!(profiles > 1);
}

#[test]
fn a_part_has_the_lines_of_its_span() {
    let place = Place::with_run(&[]);
    let series = place.read("run/series.csv");
    let lines: Vec<&str> = series.lines().collect();
    let time = |line: usize| lines[line].split(',').next().unwrap();
    let printed = place.obeyed(&["replay", "run", "--from", time(2), "--to", time(6), "--every", "2"]);
    assert_eq!(printed.lines().collect::<Vec<_>>(), [lines[0], lines[2], lines[4], lines[6]]);
    let narrow = place.obeyed(&["replay", "run", "--measures", "energy"]);
    let header = narrow.lines().next().unwrap();
    assert!(header.starts_with("time [") && header.contains("kinetic_energy"), "{header}");
    assert!(header.len() < lines[0].len() && narrow.lines().count() == lines.len());
}

#[test]
fn a_measure_that_the_run_did_not_take_is_computed_as_the_run_would_have() {
    let taken =
        Place::with_run(&["record.measures=[\"energy\",\"pair-correlation\"]", "record.points=\"all\""]);
    let place = Place::with_run(&["record.points=\"all\""]);
    let ask = ["replay", "run", "--measures", "pair-correlation"];
    let from_log = taken.obeyed(&ask);
    let stored = numbers(&taken.read("run/profiles/pair-correlation.csv"));
    assert!(from_log.starts_with("# pair-correlation\n") && from_log.contains("# pair-correlation-mean\n"));
    let output = place.grainflow(&ask);
    assert_eq!(code(&output), 0, "{}", error(&output));
    assert!(error(&output).contains("pair-correlation computed from 4 saved states"), "{}", error(&output));
    // The last state is the last recording: the same grains give the same numbers.
    place.obeyed(&[&ask[..], &["--profiles", "computed"]].concat());
    let computed = numbers(&place.read("computed/pair-correlation.csv"));
    let bins = stored.iter().filter(|line| line[0] == stored[0][0]).count();
    let end = |lines: &[Vec<f64>]| lines[lines.len() - bins..].to_vec();
    let bits = |lines: Vec<Vec<f64>>| -> Vec<u64> { lines.concat().iter().map(|x| x.to_bits()).collect() };
    assert_eq!(bits(end(&stored)), bits(end(&computed)));
    // Frames have single precision: some pairs change their bin, and no more.
    let output = place.grainflow(&[&ask[..], &["--source", "frames", "--profiles", "frames"]].concat());
    assert!(error(&output).contains("from 8 frames, at single precision"), "{}", error(&output));
    let frames = numbers(&place.read("frames/pair-correlation.csv"));
    assert_eq!(frames.len(), stored.len());
    for (a, b) in end(&stored).iter().zip(end(&frames)) {
        assert!((a[2] - b[2]).abs() < 0.2, "{a:?} {b:?}");
    }
}

#[test]
fn what_cannot_be_computed_is_told() {
    let place = Place::with_run(&["record.measures=[\"energy\"]", "record.points=50"]);
    let said = |more: &[&str]| place.refused(&[&["replay", "run"], more].concat());
    assert!(said(&["--measures", "pressure"]).contains("`pressure` is made of collisions"));
    assert!(said(&["--measures", "heap"]).contains("`heap` does not apply"));
    assert!(said(&["--measures", "clustres"]).contains("did you mean `clusters`?"));
    assert!(said(&["--measures", "energy,clusters"]).contains("one after the other"));
    assert!(said(&["--measures", "clusters", "--source", "frames"]).contains("50 of 200 grains"));
    assert!(said(&["--measures", "clusters", "--from", "1e9"]).contains("has no frame from t = 1000000000"));
    assert!(said(&["--from", "3", "--to", "2"]).contains("--from 3: lies after --to 2"));
    assert!(said(&["--speed", "2"]).contains("no terminal to play in"));
    assert!(said(&["--speed", "-2"]).contains("has to be above 0"));
    assert!(said(&["--info", "--every", "2"]).contains("cannot be used with"));
    assert!(place.refused(&["replay", "run/series.csv"]).contains("is not an MCAP file"));
}

#[test]
fn info_tells_what_the_log_holds() {
    let place = Place::with_run(&["record.points=50"]);
    let told = place.obeyed(&["replay", "run", "--info"]);
    let value = |name: &str| {
        let line = told.lines().find(|line| line.starts_with(&format!("{name} "))).unwrap();
        line[name.len()..].trim().to_owned()
    };
    assert_eq!(value("engine"), "hsmc");
    assert!(value("recordings").starts_with("8, from t = 0 to "));
    assert_eq!(value("frames"), "8 of up to 200 grains; 8 show up to 50 points");
    assert!(value("saved states").starts_with("4, at t = "));
    assert!(value("channel /measures").starts_with("8 messages, "));
    assert_eq!(value("condition"), "whole, every checksum holds");
    let log = place.path("run/log.mcap");
    let bytes = fs::read(&log).unwrap();
    fs::write(&log, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let told = place.obeyed(&["replay", "run", "--info"]);
    assert!(told.contains("is cut off after"), "{told}");
}

#[test]
fn pictures_and_pages_are_made_again() {
    let place = Place::with_run(&[]);
    place.obeyed(&["replay", "run", "--frames", "pictures", "--width", "200", "--every", "3"]);
    for name in ["frame-000000.png", "frame-000003.png", "frame-000006.png"] {
        assert!(fs::read(place.path("pictures").join(name)).unwrap().starts_with(b"\x89PNG"), "{name}");
    }
    assert_eq!(fs::read_dir(place.path("pictures")).unwrap().count(), 3);
    place.obeyed(&["replay", "run", "--report", "again.html"]);
    assert_eq!(place.read("again.html"), place.read("run/report.html"));
    let said = place.refused(&["replay", "run", "--report", "again.html"]);
    assert!(said.contains("choose another place with --report"), "{said}");
    let output = place.grainflow(&["replay", "run", "--report", "part.html", "--every", "2"]);
    assert!(code(&output) == 0 && error(&output).contains("no figures"), "{}", error(&output));
    let said = place.refused(&["replay", "run", "--frames", "pictures"]);
    assert!(said.contains("choose another place with --frames"), "{said}");
    fs::write(place.path("pictures/thesis.tex"), "").unwrap();
    let said = place.refused(&["replay", "run", "--frames", "pictures", "--force"]);
    assert!(said.contains("no earlier export"), "{said}");
}

#[test]
fn one_who_has_seen_enough_may_close_the_pipe() {
    let place = Place::with_run(&[]);
    let program = assert_cmd::cargo::cargo_bin!("grainflow").display().to_string();
    // The last one begins when the pipe has been closed for long.
    let script = format!("for k in 1 2 3; do '{program}' replay run; echo $? >&2; done | head -c 10");
    let output =
        std::process::Command::new("sh").args(["-c", &script]).current_dir(place.path(".")).output().unwrap();
    assert_eq!((error(&output).as_str(), text(&output).len()), ("0\n0\n0\n", 10));
}
