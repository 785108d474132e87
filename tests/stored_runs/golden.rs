//! Logs that were written when their format was new: they are read for ever, and while the format and the bits of
//! trajectories stay, the program still writes the same.
//!
//! They are made by `cargo run --release --example golden`, which leaves those alone that are there; with `-- --replace` it
//! writes all of the present format again, as a raised `numerics` asks for.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3};
use grainflow::observe::measure::Profile;
use grainflow::record::contents::RunLog;
use grainflow::record::reader::{read_log, read_states};
use grainflow::record::state::SavedState;
use grainflow::run::resume::Resumption;
use grainflow::run::verify::{Verdict, verify};
use grainflow::run::{NUMERICS, run};
use grainflow::scenario::{Overrides, parse};
use grainflow::space::Vector;

use super::mint::{FORMAT, all, folder, place, write};

/// The longest that a golden log may be [bytes].
const MOST_BYTES: u64 = 26_000;

#[test]
fn every_engine_has_its_golden_logs_and_they_are_small() {
    for (engine, dimension) in all() {
        let log = place(engine, dimension);
        let remedy = "cargo run --release --example golden";
        assert!(log.is_file(), "{} is missing: {remedy}", log.display());
        let bytes = fs::metadata(&log).unwrap().len();
        assert!(bytes <= MOST_BYTES, "{}: {bytes} bytes", log.display());
    }
}

#[test]
fn logs_of_every_format_are_read() {
    let mut read = 0;
    for format in fs::read_dir(folder().parent().unwrap()).unwrap() {
        for log in fs::read_dir(format.unwrap().path()).unwrap() {
            let log = log.unwrap().path();
            let contents = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
            assert!(contents.cut_off.is_none() && contents.series.len() > 2, "{}", log.display());
            let states = match contents.metadata["dimension"].as_str() {
                "2" => read_states::<DVec2>(&log).unwrap().len(),
                _ => read_states::<DVec3>(&log).unwrap().len(),
            };
            assert!(states > 0, "{}", log.display());
            read += 1;
        }
    }
    assert!(read >= all().count());
}

/// Logs of this format from before states said how fast their fastest grain is.
#[test]
fn older_logs_are_verified_and_go_on_to_the_end_of_their_run() {
    let work = tempfile::tempdir().unwrap();
    let never = AtomicBool::new(false);
    let older = folder().with_file_name(format!("format-{FORMAT}-older"));
    let mut tried = 0;
    for log in fs::read_dir(older).unwrap() {
        let log = log.unwrap().path();
        let name = log.file_stem().unwrap().to_string_lossy().into_owned();
        let verdict = verify(&log, &never, &mut |_| {}).unwrap_or_else(|error| panic!("{name}: {error}"));
        let Verdict::Identical(extent, None) = verdict else { panic!("{name}: {verdict:?}") };
        assert!(extent.hashes > 0 && extent.states > 0, "{name}: {extent:?}");
        let resumption = Resumption::open(&log, &[]).unwrap_or_else(|error| panic!("{name}: {error}"));
        let on = resumption.run(&work.path().join(format!("{name}-on")), false, &never, &mut |_| {}).unwrap();
        let scenario = read_log(&log).unwrap().scenario;
        let scenario = parse("golden", &scenario, &Overrides::default()).unwrap();
        let whole = run(&scenario, &work.path().join(&name), false, &never, &mut |_| {}).unwrap();
        assert_eq!(on.summary["state_hash"], whole.summary["state_hash"], "{name}");
        tried += 1;
    }
    assert_eq!(tried, 3);
}

#[test]
fn the_present_program_writes_what_the_golden_logs_hold() {
    let work = tempfile::tempdir().unwrap();
    for (engine, dimension) in all() {
        let (golden, now) = (place(engine, dimension), work.path().join("log.mcap"));
        write(engine, dimension, &now);
        compare_logs(&golden, &read_log(&golden).unwrap(), &read_log(&now).unwrap());
        match dimension {
            2 => compare_states::<DVec2>(&golden, &now),
            _ => compare_states::<DVec3>(&golden, &now),
        }
    }
}

/// Whatever the golden log holds has to be there now; what is new beside it may be.
fn compare_logs(path: &Path, golden: &RunLog, now: &RunLog) {
    let name = path.display();
    for (key, value) in golden.metadata.iter().filter(|(key, _)| *key != "version") {
        let hint = "if trajectories were meant to change: cargo run --release --example golden -- --replace";
        assert_eq!(now.metadata.get(key), Some(value), "{name}: {key}; numerics {NUMERICS}; {hint}");
    }
    assert_eq!((&golden.scenario, &golden.walls), (&now.scenario, &now.walls), "{name}");
    assert_eq!(golden.state_hashes, now.state_hashes, "{name}: states at recordings");
    assert_eq!(golden.frames, now.frames, "{name}: frames");
    assert!(golden.frames.len() > 2 && golden.cut_off.is_none(), "{name}");
    for (index, column) in golden.columns.iter().enumerate() {
        let place = now.columns.iter().position(|one| one == column);
        let place = place.unwrap_or_else(|| panic!("{name}: no column {column:?}"));
        let bits = |log: &RunLog, place: usize| -> Vec<u64> {
            log.series.iter().map(|row| row[place].to_bits()).collect()
        };
        assert_eq!(bits(golden, index), bits(now, place), "{name}: {}", column.name);
    }
    let of_now: BTreeMap<(&str, u64), &Profile> = now.profiles.iter().map(|one| (key(one), one)).collect();
    for profile in &golden.profiles {
        let found = of_now.get(&key(profile)).unwrap_or_else(|| panic!("{name}: no {}", profile.name));
        for (column, values) in profile.columns.iter().zip(&profile.values) {
            let place = found.columns.iter().position(|one| one == column).unwrap();
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(values), bits(&found.values[place]), "{name}: {}.{}", profile.name, column.name);
        }
    }
    assert!(!golden.profiles.is_empty(), "{name}");
}

fn key(profile: &Profile) -> (&str, u64) {
    (&profile.name, profile.time.to_bits())
}

fn compare_states<V: Vector>(golden: &Path, now: &Path) {
    let [of_golden, of_now] = [golden, now].map(|path| read_states::<V>(path).unwrap());
    assert_eq!(of_golden.len(), of_now.len(), "{}: states", golden.display());
    assert!(!of_golden.is_empty());
    for (then, now) in of_golden.into_iter().zip(of_now) {
        for (name, memory) in &then.memories {
            let found = now.memories.iter().find(|one| one.0 == *name);
            // As text, so that what is no number equals itself.
            assert_eq!(
                found.map(|one| format!("{:?}", one.1)),
                Some(format!("{memory:?}")),
                "{}: memory of {name}",
                golden.display()
            );
        }
        // Measures that are new have samples and memories of their own; older logs say nothing of the fastest grain.
        let largest_speed = now.largest_speed.filter(|_| then.largest_speed.is_some());
        let now = SavedState { largest_speed, ..now };
        let bare =
            |state: SavedState<'static, V>| SavedState { samples: Vec::new(), memories: Vec::new(), ..state };
        assert_eq!(format!("{:?}", bare(then)), format!("{:?}", bare(now)), "{}", golden.display());
    }
}
