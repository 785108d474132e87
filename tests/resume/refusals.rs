//! Logs that cannot be verified or resumed, each with a message of its own.

use std::fs;
use std::path::Path;

use glam::DVec2;
use grainflow::record::reader::{last_state, read_log};
use grainflow::record::state::SavedState;
use grainflow::record::writer::{LogHeader, LogWriter};
use grainflow::run::resume::Resumption;
use grainflow::run::verify::Verdict;

use super::gas;
use super::logs::{Place, log_bytes, rewritten, run_into, verify, without_chunk};

/// The log of a small run, and what is said of it after it was made wrong.
struct Trial {
    place: Place,
    bytes: Vec<u8>,
}

impl Trial {
    fn new() -> Self {
        let place = Place::new();
        let bytes = log_bytes(&run_into(&place.path("run"), &gas("hsmc").with(&[])));
        Trial { place, bytes }
    }

    fn written(&self, bytes: &[u8]) -> std::path::PathBuf {
        let path = self.place.path("wrong.mcap");
        fs::write(&path, bytes).unwrap();
        path
    }

    /// The message and whether it is a difference, rather than a refusal.
    fn said(&self, bytes: &[u8]) -> (String, bool) {
        match verify(&self.written(bytes)) {
            Ok(Verdict::Different(_, difference)) => (difference, true),
            Ok(other) => panic!("{other:?}"),
            Err(error) => (error.to_string(), false),
        }
    }

    fn refused_to_resume(&self, bytes: &[u8], sets: &[&str]) -> String {
        let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
        Resumption::open(&self.written(bytes), &sets).unwrap_err().to_string()
    }
}

fn assert_says((said, is_difference): (String, bool), differs: bool, words: &str) {
    assert!(said.contains(words) && is_difference == differs, "{is_difference}: {said}");
}

#[test]
fn what_does_not_hold_is_told_apart() {
    let trial = Trial::new();
    let same = |text: String| text;
    // A copy with the same contents is fine, however its chunks lie.
    let copy = rewritten(&trial.bytes, |_| {}, same);
    assert!(matches!(verify(&trial.written(&copy)).unwrap(), Verdict::Identical(..)));
    // One bit.
    let mut flipped = trial.bytes.clone();
    let middle = flipped.len() / 2;
    flipped[middle] ^= 1;
    assert_says(trial.said(&flipped), false, "is damaged near byte");
    // A missing chunk: the index is there or not.
    assert_says(trial.said(&without_chunk(&trial.bytes, 4)), false, "is not whole: message");
    let unfinished = &trial.bytes[..trial.bytes.len() * 9 / 10];
    let start = super::logs::chunks(&trial.bytes)[4].clone();
    let cut = [&unfinished[..start.start], &unfinished[start.end..]].concat();
    assert_says(trial.said(&cut), false, "a part was taken out of the file");
    // Another scenario: its text alone, and everything that says so.
    let swapped =
        rewritten(&trial.bytes, |_| {}, |text| text.replace("restitution = 0.9", "restitution = 0.8"));
    assert_says(trial.said(&swapped), true, "the scenario in the log is another one than it was begun with");
    let forged = rewritten(
        &trial.bytes,
        |metadata| drop(metadata.remove("scenario_sha256")),
        |text| text.replace("restitution = 0.9", "restitution = 0.8"),
    );
    assert_says(trial.said(&forged), true, "where the re-run has no step end");
    // Another seed.
    let seed = rewritten(&trial.bytes, |_| {}, |text| text.replace("seed = 3", "seed = 4"));
    assert_says(trial.said(&seed), true, "the log was made with seed 3, and the scenario in it says 4");
    let forged = rewritten(
        &trial.bytes,
        |metadata| {
            metadata.remove("scenario_sha256");
            metadata.insert("seed".to_owned(), "4".to_owned());
        },
        |text| text.replace("seed = 3", "seed = 4"),
    );
    assert_says(trial.said(&forged), true, "at t = 0.0, grain 0: position x is");
    assert_says(trial.said(&forged), true, "the scenario or its seed is not that of the run");
    // Other bits by another version.
    let older = |metadata: &mut std::collections::BTreeMap<String, String>| {
        metadata.insert("numerics".to_owned(), "1".to_owned());
        metadata.insert("version".to_owned(), "0.0.7".to_owned());
    };
    assert_says(trial.said(&rewritten(&trial.bytes, older, same)), false, "verify it with grainflow 0.0.7");
    let newer = |metadata: &mut std::collections::BTreeMap<String, String>| {
        metadata.insert("format".to_owned(), "9".to_owned());
        metadata.insert("version".to_owned(), "9.8.7".to_owned());
    };
    assert_says(
        trial.said(&rewritten(&trial.bytes, newer, same)),
        false,
        "the version that wrote it (9.8.7)",
    );
    assert_says(trial.said(&[]), false, "is empty");
}

/// Logs of formats before this one, and of this one before some things were written, are read.
#[test]
fn older_logs_are_verified_and_resumed() {
    let trial = Trial::new();
    let old = rewritten(
        &trial.bytes,
        |metadata| {
            metadata.remove("scenario_sha256");
            metadata.insert("format".to_owned(), "0".to_owned());
        },
        |text| text,
    );
    assert!(matches!(verify(&trial.written(&old)).unwrap(), Verdict::Identical(..)));
    assert!(Resumption::open(&trial.written(&old), &[]).unwrap().time().is_some());
}

#[test]
fn what_may_not_change_is_refused() {
    let trial = Trial::new();
    let refused = |sets: &[&str]| trial.refused_to_resume(&trial.bytes, sets);
    for set in ["seed=4", "particles.restitution=0.8", "engine.kind=dsmc", "runs.time=3", "running=1"] {
        let said = refused(&["record.frames=3", set]);
        assert!(said.contains(&format!("--set #2 '{set}': a run that goes on keeps its scenario")), "{said}");
    }
    let said = refused(&["run.collisions_per_particle=2"]);
    assert!(said.contains("where run.collisions_per_particle ends the run; give a later end"), "{said}");
    let said = refused(&["run.time=1000000"]);
    assert!(said.contains("where run.collisions_per_particle ends the run"), "{said}");
    let said = refused(&["record.frames=many"]);
    assert!(said.contains("--set #1 'record.frames=many'") && said.contains("whole number"), "{said}");
    let swapped = rewritten(&trial.bytes, |_| {}, |text| text.replace("0.9", "0.8"));
    assert!(trial.refused_to_resume(&swapped, &[]).contains("is not the one that the log was begun with"));
    let older =
        rewritten(&trial.bytes, |metadata| drop(metadata.insert("numerics".into(), "1".into())), |t| t);
    assert!(trial.refused_to_resume(&older, &[]).contains("resume it with grainflow"));
    assert!(trial.refused_to_resume(&without_chunk(&trial.bytes, 5), &[]).contains("is not whole"));
    assert!(trial.refused_to_resume(b"", &[]).contains("is empty"));
}

/// The log at `path` with one state, that of `spoil`, and nothing else.
fn spoilt_log(log: &Path, path: &Path, spoil: &dyn Fn(&mut SavedState<'static, DVec2>)) {
    let read = read_log(log).unwrap();
    let mut state = last_state::<DVec2>(log).unwrap().unwrap();
    spoil(&mut state);
    let header = LogHeader {
        time_scale: read.metadata["time_scale"].parse().unwrap(),
        metadata: read.metadata,
        scenario: read.scenario,
        columns: read.columns,
        walls: read.walls,
        ..LogHeader::default()
    };
    let mut writer = LogWriter::create(path, &header).unwrap();
    writer.state(&state).unwrap();
    writer.finish().unwrap();
}

type Spoil = &'static dyn Fn(&mut SavedState<'static, DVec2>);

/// All checksums hold: what is wrong are the numbers.
#[test]
fn a_state_that_no_run_has_left_is_refused() {
    let grains: [(&str, Spoil); 7] = [
        ("is there twice", &|state| state.columns.to_mut().ids[0] = state.columns.ids[1]),
        ("is outside the box", &|state| state.columns.to_mut().positions[3].x = -1e9),
        ("its fastest grain moves at", &|state| state.columns.to_mut().velocities[3] *= 50.0),
        ("its fastest grain moves at", &|state| state.largest_speed = Some(1e-3)),
        ("moves at no finite speed", &|state| state.columns.to_mut().velocities[3].y = f64::NAN),
        ("identities were given", &|state| state.next_id += 7),
        ("its clock shows no time", &|state| state.time = f64::INFINITY),
    ];
    let events: [(&str, Spoil); 4] = [
        ("", &|state| state.engine.words.clear()),
        ("", &|state| state.engine.numbers.truncate(9)),
        // Rows, identities and cells along the axes.
        ("", &|state| state.engine.words[1] += 1),
        ("", &|state| state.engine.words[2] = u32::MAX),
    ];
    for (engine, spoils) in
        [("hsmc", &grains[..]), ("event-driven", &grains[..]), ("event-driven", &events[..])]
    {
        let place = Place::new();
        let log = run_into(&place.path("run"), &gas(engine).with(&[])).folder.join("log.mcap");
        let wrong = place.path("wrong.mcap");
        // Older logs say nothing of the fastest grain, which may outrun the speed that sets the step.
        let old: Spoil = &|state| {
            state.largest_speed = None;
            state.engine.largest_speed *= 0.5;
        };
        for whole in [&|_: &mut SavedState<'static, DVec2>| {}, old] {
            spoilt_log(&log, &wrong, whole);
            let taken = Resumption::open(&wrong, &["run.collisions_per_particle=9".to_owned()]);
            assert!(taken.is_ok(), "{engine}: {taken:?}");
        }
        for (k, (words, spoil)) in spoils.iter().enumerate() {
            spoilt_log(&log, &wrong, spoil);
            let refused = Resumption::open(&wrong, &["run.collisions_per_particle=9".to_owned()]).err();
            let said = refused.unwrap_or_else(|| panic!("{engine} {k}: {words}")).to_string();
            assert!(said.contains("wrong.mcap") && said.contains(words), "{engine} {k}: {said}");
            assert!(said.contains("copy the log again"), "{engine} {k}: {said}");
        }
    }
}
