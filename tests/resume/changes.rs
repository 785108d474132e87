//! Runs that go on to another end, with other records, or without the files that they began with.

use std::fs;

use grainflow::record::history::History;
use grainflow::record::reader::read_log;
use grainflow::scenario::{Overrides, parse};

use super::gas;
use super::logs::{Place, bits, log_bytes, resume, run_into, verified};
use super::small_scenarios::heap;

#[test]
fn a_later_end_leads_to_the_state_of_the_longer_run() {
    for engine in ["dsmc", "hsmc", "event-driven"] {
        let place = Place::new();
        let small = gas(engine);
        let long = run_into(&place.path("long"), &small.with(&["run.collisions_per_particle=9"]));
        let short = run_into(&place.path("short"), &small.with(&[]));
        let further = resume(&short.folder, &["run.collisions_per_particle=9"], &place.path("further"));
        assert_eq!(further.summary["state_hash"], long.summary["state_hash"], "{engine}");
        assert_eq!(further.summary["collisions"], long.summary["collisions"]);
        let log = read_log(&further.folder.join("log.mcap")).unwrap();
        let before = read_log(&short.folder.join("log.mcap")).unwrap();
        assert_eq!(bits(&log.series[..21]), bits(&before.series), "{engine}: what was before is there");
        let (extent, _) = verified(&further.folder);
        assert_eq!((extent.hashes, extent.time), (log.series.len() as u64, log.series.last().unwrap()[0]));
        let history = History::read(&further.folder.join("log.mcap")).unwrap();
        assert_eq!(history.earlier.len(), 1);
        assert_eq!(history.earlier[0].changes, "run.collisions_per_particle=9");
        assert_eq!(history.earlier[0].scenario, before.scenario);
        // From a log that was killed while the old one was copied to it.
        let bytes = log_bytes(&further);
        let early = place.path("early.mcap");
        fs::write(&early, &bytes[..bytes.len() * 35 / 100]).unwrap();
        let early = resume(&early, &[], &place.path("early"));
        assert!(early.summary["resumed_at"].as_f64() < short.summary["simulated_time"].as_f64());
        assert_eq!(early.summary["state_hash"], long.summary["state_hash"], "{engine}");
        verified(&early.folder);
        // And once more, from one that was killed after that.
        let killed = place.path("killed.mcap");
        fs::write(&killed, &bytes[..bytes.len() * 9 / 10]).unwrap();
        let again = resume(&killed, &[], &place.path("again"));
        assert!(log_bytes(&again) == bytes, "{engine}");
        let last = resume(&killed, &["run.collisions_per_particle=10"], &place.path("last"));
        assert_eq!(History::read(&last.folder.join("log.mcap")).unwrap().earlier.len(), 2);
        verified(&last.folder);
    }
}

#[test]
fn other_records_show_the_same_run() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("cba").with(&[]));
    let bytes = log_bytes(&whole);
    let killed = place.path("killed.mcap");
    fs::write(&killed, &bytes[..bytes.len() / 2]).unwrap();
    let sets = ["record.measures=[\"energy\", \"clusters\"]", "record.frames=50", "record.points=10"];
    let other = resume(&killed, &sets, &place.path("other"));
    assert_eq!(other.summary["state_hash"], whole.summary["state_hash"]);
    verified(&other.folder);
    let log = read_log(&other.folder.join("log.mcap")).unwrap();
    let place_of = |name: &str| log.columns.iter().position(|column| column.name == name).unwrap();
    let (energy, clusters) = (place_of("kinetic_energy"), log.columns.len() - 1);
    assert!(log.series.iter().all(|row| row[energy].is_finite()));
    assert!(log.series[0][clusters].is_nan() && log.series.last().unwrap()[clusters].is_finite());
    assert!(log.series.len() > 30, "{}", log.series.len());
    assert!(log.frames[0].ids.len() > 10 && log.frames.last().unwrap().ids.len() == 10);
}

#[test]
fn a_later_end_of_a_poured_heap() {
    let place = Place::new();
    let small = heap(2, "hsmc");
    let long = run_into(&place.path("long"), &small.with(&["run.steps=40"]));
    let short = run_into(&place.path("short"), &small.with(&["run.steps=20"]));
    let further = resume(&short.folder, &["run.steps=40"], &place.path("further"));
    assert_eq!(further.summary["state_hash"], long.summary["state_hash"]);
    verified(&further.folder);
}

#[test]
fn a_log_can_do_without_the_files_that_its_run_began_with() {
    let place = Place::new();
    let first = run_into(&place.path("first"), &gas("event-driven").with(&[]));
    let table = place.path("entry.csv");
    fs::write(&table, "volume_fraction,probability\n0.0,1.0\n0.5,0.9\n0.82,0.0\n").unwrap();
    let table = format!("engine.hsmc.entry_probability={{ table = \"{}\" }}", table.display());
    let log = format!("initial.positions={{ log = \"{}\" }}", first.folder.join("log.mcap").display());
    for (engine, sets) in [("hsmc", vec![log.as_str(), table.as_str()]), ("event-driven", vec![log.as_str()])]
    {
        let small = gas(engine);
        let sets = sets.iter().map(ToString::to_string).collect();
        let scenario = parse("gas", &small.text, &Overrides { sets, ..Default::default() }).unwrap();
        let whole = run_into(&place.path(engine), &scenario);
        let bytes = log_bytes(&whole);
        // Out of sight.
        let hidden =
            [("first", "hidden"), ("entry.csv", "hidden.csv")].map(|(a, b)| (place.path(a), place.path(b)));
        hidden.iter().for_each(|(here, there)| fs::rename(here, there).unwrap());
        verified(&whole.folder);
        for percent in [12, 50] {
            let killed = place.path("killed.mcap");
            fs::write(&killed, &bytes[..bytes.len() * percent / 100]).unwrap();
            let resumed = resume(&killed, &[], &place.path(&format!("{engine}-{percent}")));
            assert!(log_bytes(&resumed) == bytes, "{engine} at {percent} %");
        }
        hidden.iter().for_each(|(here, there)| fs::rename(there, here).unwrap());
    }
}
