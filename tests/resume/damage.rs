//! Logs that are cut off or damaged: what is left is a prefix or says what it lacks.

use std::fs;

use grainflow::record::contents::RunLog;
use grainflow::record::history::History;
use grainflow::record::reader::read_log;
use grainflow::record::recover::recover;
use grainflow::run::resume::Resumption;
use grainflow::run::verify::{Verdict, VerifyError};

use super::gas;
use super::logs::{Place, bits, chunks, log_bytes, resume, run_into, verified, verify};

/// Whether `part` is what `whole` begins with.
fn is_prefix(part: &RunLog, whole: &RunLog) -> bool {
    part.scenario == whole.scenario
        && bits(&whole.series).starts_with(&bits(&part.series))
        && whole.state_hashes.starts_with(&part.state_hashes)
        && whole.frames.starts_with(&part.frames)
        && profiles(whole).starts_with(&profiles(part))
}

/// Name, time and numbers of every profile.
fn profiles(log: &RunLog) -> Vec<(&str, u64, Vec<Vec<u64>>)> {
    let profiles = log.profiles.iter();
    profiles.map(|one| (one.name.as_str(), one.time.to_bits(), bits(&one.values))).collect()
}

#[test]
fn wherever_a_log_is_cut_off_its_contents_are_a_prefix() {
    const KILOBYTE: usize = 1024;
    let place = Place::new();
    let scenario = gas("hsmc").with(&["record.frames=40", "record.measures=[\"energy\", \"pressure\"]"]);
    let whole = run_into(&place.path("whole"), &scenario);
    let (bytes, log) = (log_bytes(&whole), read_log(&whole.folder.join("log.mcap")).unwrap());
    let cut = place.path("cut.mcap");
    let (mut read, mut resumed) = (0, 0);
    for length in (0..bytes.len()).step_by(KILOBYTE) {
        fs::write(&cut, &bytes[..length]).unwrap();
        match read_log(&cut) {
            Ok(part) => {
                assert!(is_prefix(&part, &log), "{length}");
                assert!(part.cut_off.as_ref().unwrap().contains("is cut off after"), "{length}");
                read += 1;
            }
            Err(error) => assert!(length < 2 * KILOBYTE, "{length}: {error}"),
        }
        if length % (40 * KILOBYTE) == 0 && read > 0 {
            let (extent, cut_off) = verified(&cut);
            assert!(cut_off.is_some() && extent.hashes <= 41);
            let resumption = Resumption::open(&cut, &[]).unwrap();
            assert!(resumption.cut_off().is_some());
            let outcome = resume(&cut, &[], &place.path(&format!("resumed-{length}")));
            assert!(log_bytes(&outcome) == bytes, "{length}");
            resumed += 1;
        }
    }
    assert!(read > 100 && resumed > 2, "{read}, {resumed} of {}", bytes.len());
    fs::write(&cut, b"").unwrap();
    assert!(read_log(&cut).unwrap_err().to_string().contains("is empty"));
}

#[test]
fn a_log_without_a_state_begins_again() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("dsmc").with(&[]));
    let bytes = log_bytes(&whole);
    let killed = place.path("killed.mcap");
    fs::write(&killed, &bytes[..chunks(&bytes)[2].end]).unwrap();
    assert_eq!(Resumption::open(&killed, &[]).unwrap().time(), None);
    let again = resume(&killed, &[], &place.path("again"));
    assert!(log_bytes(&again) == bytes);
    assert!(again.summary["resumed_at"].is_null());
}

#[test]
fn what_is_whole_is_not_recovered() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("dsmc").with(&[]));
    let clean = place.path("clean.mcap");
    assert_eq!(recover(&whole.folder.join("log.mcap"), &clean).unwrap(), None);
    assert!(!clean.exists());
}

#[test]
fn a_recovered_log_without_a_hole_is_as_good_as_the_old_one() {
    let place = Place::new();
    let short = run_into(&place.path("short"), &gas("hsmc").with(&[]));
    let further = resume(&short.folder, &["run.collisions_per_particle=8"], &place.path("further"));
    let bytes = log_bytes(&further);
    let (killed, clean) = (place.path("killed.mcap"), place.path("clean.mcap"));
    fs::write(&killed, &bytes[..bytes.len() * 8 / 10]).unwrap();
    let recovery = recover(&killed, &clean).unwrap().unwrap();
    assert!(recovery.cut_off && recovery.damaged_parts == 0 && recovery.lost.is_empty(), "{recovery:?}");
    assert_eq!(recovery.whole_until, None);
    // Both scenarios are still there.
    let (old, new) = (History::read(&killed).unwrap(), History::read(&clean).unwrap());
    assert_eq!((&old.scenario, &old.earlier), (&new.scenario, &new.earlier));
    assert!(new.cut_off.is_none() && !new.has_holes && new.earlier.len() == 1);
    let (extent, cut_off) = verified(&clean);
    assert!(cut_off.is_none() && extent == verified(&killed).0);
    assert!(log_bytes(&resume(&clean, &[], &place.path("end"))) == bytes);
}

#[test]
fn beyond_a_hole_nothing_is_verified() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("hsmc").with(&["record.states=2"]));
    let mut bytes = log_bytes(&whole);
    let chunk = chunks(&bytes)[13].clone();
    bytes[chunk.end - 20] ^= 4;
    let (damaged, clean) = (place.path("damaged.mcap"), place.path("clean.mcap"));
    fs::write(&damaged, &bytes).unwrap();
    let said = read_log(&damaged).unwrap_err().to_string();
    assert!(said.contains("is damaged near byte") && said.contains("`grainflow recover`"), "{said}");
    let recovery = recover(&damaged, &clean).unwrap().unwrap();
    assert_eq!((recovery.damaged_parts, recovery.cut_off), (1, false));
    assert_eq!(recovery.lost["/measures"], 1);
    let log = read_log(&clean).unwrap();
    let original = read_log(&whole.folder.join("log.mcap")).unwrap();
    assert_eq!(log.series.len(), original.series.len() - 1);
    let lost = original.state_hashes.iter().position(|hash| !log.state_hashes.contains(hash)).unwrap();
    let before = recovery.whole_until.unwrap();
    assert!((before - original.series[lost - 1][0]).abs() < 1e-8, "{before}");
    match verify(&clean) {
        Err(error @ VerifyError::Hole { .. }) => {
            let said = error.to_string();
            assert!(said.contains(&format!("message {lost} of /measures is missing")), "{said}");
            assert!(said.contains(&format!("({lost} hashes")), "{said}");
        }
        other => panic!("{other:?}"),
    }
    // From its last state it goes on to the same end, and stays a log with a hole.
    let end = resume(&clean, &[], &place.path("end"));
    assert_eq!(end.summary["state_hash"], whole.summary["state_hash"]);
    assert!(History::read(&end.folder.join("log.mcap")).unwrap().has_holes);
    assert!(!matches!(verify(&end.folder), Ok(Verdict::Identical(..))));
}
