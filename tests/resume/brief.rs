//! Runs of which only some recordings are full.

use std::fs;

use grainflow::record::index::LogIndex;
use grainflow::record::reader::read_log;
use grainflow::run::verify::Verdict;

use super::logs::{Place, log_bytes, resume, rewritten, run_into, verified, verify};
use super::{assert_goes_on, gas};

/// Of 20 recordings and the one at the start.
const SELDOM: [&str; 2] = ["record.full={ every_nth = 4 }", "record.states=3"];
/// The last one would not be full but for being the last.
const ODDLY: [&str; 2] = ["record.full={ every_nth = 7 }", "record.states=3"];

#[test]
fn a_recording_that_is_not_full_has_sums_and_no_hash() {
    let place = Place::new();
    for engine in ["hsmc", "event-driven"] {
        let outcome = run_into(&place.path(engine), &gas(engine).with(&SELDOM));
        let log = read_log(&outcome.folder.join("log.mcap")).unwrap();
        let column = |name: &str| log.columns.iter().position(|column| column.name == name).unwrap();
        let [energy, temperature, about_flow, pressure] =
            ["kinetic_energy", "temperature", "granular_temperature", "pressure"].map(column);
        assert_eq!(log.series.len(), 21, "{engine}");
        for (k, (row, hash)) in log.series.iter().zip(&log.state_hashes).enumerate() {
            let is_full = k % 4 == 0;
            assert_eq!(hash.len(), if is_full { 64 } else { 0 }, "{engine}: {k}");
            assert!(row[energy].is_finite() && row[temperature].is_finite(), "{engine}: {k}");
            assert_eq!(row[about_flow].is_finite(), is_full, "{engine}: {k}");
            // The pressure is that since the last full recording, which the first one lacks.
            assert_eq!(row[pressure].is_finite(), is_full && k > 0, "{engine}: {k}");
        }
        assert_eq!(log.frames.len(), 6, "{engine}");
        assert_eq!(verified(&outcome.folder).0.hashes, 6, "{engine}");
        let index = LogIndex::open(&outcome.folder.join("log.mcap")).unwrap();
        assert!(!index.was_made() && index.frames() == 6, "{engine}");
        assert_eq!((index.recording_of(1), index.recording_of(5)), (Some(4), Some(20)), "{engine}");
        let all = run_into(&place.path(&format!("{engine}-all")), &gas(engine).with(&[]));
        assert_eq!(all.summary["state_hash"], outcome.summary["state_hash"], "{engine}");
        assert_eq!(all.summary["granular_temperature"], outcome.summary["granular_temperature"], "{engine}");
    }
}

#[test]
fn they_are_verified_and_go_on() {
    for engine in ["cba", "hsmc", "event-driven"] {
        assert_goes_on(engine, &gas(engine).with(&SELDOM), &[3, 6]);
        assert_goes_on(engine, &gas(engine).with(&ODDLY), &[3, 6]);
    }
}

#[test]
fn a_later_end_leads_to_the_state_of_the_longer_run() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("hsmc").with(&SELDOM));
    let half = run_into(
        &place.path("half"),
        &gas("hsmc").with(&[&SELDOM[..], &["run.collisions_per_particle=3"]].concat()),
    );
    let longer = resume(&half.folder, &["run.collisions_per_particle=6"], &place.path("longer"));
    assert_eq!(longer.summary["state_hash"], whole.summary["state_hash"]);
    verified(&longer.folder);
}

#[test]
fn what_comes_with_full_recordings_comes_as_seldom_as_it_should() {
    let place = Place::new();
    let sets = ["record.full={ every_nth = 4 }", "record.particles={ every_nth = 5 }"];
    let outcome = run_into(&place.path("seldom"), &gas("hsmc").with(&sets));
    let log = read_log(&outcome.folder.join("log.mcap")).unwrap();
    let times = [0, 8, 16, 20].map(|row| log.series[row][0]);
    assert_eq!(log.frames.iter().map(|frame| frame.time).collect::<Vec<_>>(), times);
    verified(&outcome.folder);
}

#[test]
fn a_hash_that_is_missing_where_the_run_has_one_is_found() {
    let place = Place::new();
    let outcome = run_into(&place.path("seldom"), &gas("hsmc").with(&SELDOM));
    let forged = rewritten(
        &log_bytes(&outcome),
        |metadata| drop(metadata.remove("scenario_sha256")),
        |text| text.replace("every_nth = 4", "every_nth = 2"),
    );
    let path = place.path("forged.mcap");
    fs::write(&path, forged).unwrap();
    let verdict = verify(&path).unwrap();
    let Verdict::Different(extent, said) = verdict else { panic!("{verdict:?}") };
    assert!(extent.hashes == 1 && said.contains("state hash"), "{extent:?}: {said}");
}
