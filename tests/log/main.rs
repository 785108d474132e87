//! Logs come back as they were written, and damage to them is never silent.
#![expect(clippy::unwrap_used, reason = "functions that tests call stop the test like the tests themselves")]

mod fields;
mod sample;
mod states;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use grainflow::record::contents::{Frame, RunLog};
use grainflow::record::error::LogError;
use grainflow::record::reader::{last_state, read_log, read_states};
use grainflow::record::recover::recover;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use sample::{RECORDINGS, column, header, state, write_sample};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn sample() -> (tempfile::TempDir, PathBuf, RunLog) {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let expected = write_sample(&path);
    (folder, path, expected)
}

#[test]
fn a_log_comes_back_as_it_was_written() {
    let (_folder, path, expected) = sample();
    assert_eq!(read_log(&path).unwrap(), expected);
    let states = read_states::<DVec2>(&path).unwrap();
    assert_eq!(states, [state(300, 0.2), state(300, 0.5)]);
    assert_eq!(last_state::<DVec2>(&path).unwrap().as_ref(), states.last());
    assert!(matches!(read_states::<DVec3>(&path), Err(LogError::Dimension { found: 2, wanted: 3, .. })));
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let (_one, first, _) = sample();
    let (_two, second, _) = sample();
    assert_eq!(std::fs::read(first).unwrap(), std::fs::read(second).unwrap());
}

#[test]
fn a_log_without_recordings_is_whole() {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let header = LogHeader { walls: None, ..header() };
    LogWriter::create(&path, &header).unwrap().finish().unwrap();
    let log = read_log(&path).unwrap();
    assert_eq!((log.series.len(), log.columns, log.cut_off), (0, header.columns, None));
    assert_eq!(last_state::<DVec2>(&path).unwrap(), None);
}

#[test]
fn an_interrupted_run_keeps_what_it_recorded() {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    let picture = Frame::default();
    let recording = Recording {
        values: &[0.0, 1.0, 2.0],
        state_hash: "",
        grains: 0,
        profiles: &[],
        frame: Some(&picture),
        fields: &[],
    };
    log.recording(&recording).unwrap();
    log.state(&state(10, 0.0)).unwrap();
    // What is given is written without being asked for, but a little later.
    log.flush().unwrap();
    std::mem::forget(log);
    let read = read_log(&path).unwrap();
    assert_eq!(read.series.len(), 1);
    assert!(read.cut_off.unwrap().contains("what was complete before is there"));
    assert_eq!(last_state(&path).unwrap(), Some(state(10, 0.0)));
}

#[test]
fn wherever_a_log_is_cut_off_the_rest_is_told_from_the_whole() {
    let (folder, path, expected) = sample();
    let bytes = std::fs::read(&path).unwrap();
    let cut = folder.path().join("cut.mcap");
    let mut most = 0;
    for length in (0..bytes.len()).step_by(131).chain(bytes.len() - 40..bytes.len()) {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        let _ = last_state::<DVec2>(&cut);
        match read_log(&cut) {
            Ok(log) => {
                assert!(log.cut_off.is_some(), "at {length} of {} bytes", bytes.len());
                assert!(log.series.len() >= most, "at {length} bytes");
                most = log.series.len();
                assert_eq!(log.series, expected.series[..most]);
                assert_eq!(log.frames, expected.frames[..log.frames.len()]);
                assert_eq!(log.fields, expected.fields[..log.fields.len()]);
            }
            Err(LogError::Empty { .. }) => assert_eq!(length, 0),
            Err(LogError::NotMcap { .. }) => assert!(length < 8),
            Err(LogError::NoHeader { .. }) => assert!(most == 0),
            Err(other) => panic!("at {length} bytes: {other}"),
        }
    }
    assert_eq!(most, RECORDINGS);
}

#[test]
fn one_wrong_bit_is_found() {
    let (folder, path, _) = sample();
    let bytes = std::fs::read(&path).unwrap();
    let spoiled = folder.path().join("spoiled.mcap");
    // The first and last kilobytes hold every kind of record beside chunks.
    let ends = (0..1500).step_by(3).chain((bytes.len() - 1500..bytes.len()).step_by(3));
    for (turn, place) in ends.chain((1500..bytes.len() - 1500).step_by(151)).enumerate() {
        let mut wrong = bytes.clone();
        wrong[place] ^= 1 << (turn % 8);
        std::fs::write(&spoiled, &wrong).unwrap();
        let _ = last_state::<DVec2>(&spoiled);
        if let Ok(log) = read_log(&spoiled) {
            assert!(log.cut_off.is_some(), "bit {} of byte {place} of {}", turn % 8, bytes.len());
        }
    }
}

#[test]
fn what_is_sound_in_a_damaged_log_is_recovered() {
    let (folder, path, expected) = sample();
    let bytes = std::fs::read(&path).unwrap();
    let spoiled = folder.path().join("spoiled.mcap");
    let clean = folder.path().join("clean.mcap");
    let mut lost = 0;
    for place in (700..bytes.len()).step_by(997) {
        let mut wrong = bytes.clone();
        wrong[place] ^= 1;
        std::fs::write(&spoiled, &wrong).unwrap();
        let _ = std::fs::remove_file(&clean);
        let Ok(recovery) = recover(&spoiled, &clean) else {
            continue;
        };
        let recovery = recovery.expect("one wrong bit is found");
        let log = read_log(&clean).unwrap();
        assert_eq!(
            (&log.columns, &log.scenario, &log.cut_off),
            (&expected.columns, &expected.scenario, &None)
        );
        assert!(log.metadata.contains_key("recovered"));
        assert!(log.series.iter().all(|row| expected.series.contains(row)), "byte {place}");
        assert!(log.frames.iter().all(|frame| expected.frames.contains(frame)), "byte {place}");
        assert!(log.fields.iter().all(|field| expected.fields.contains(field)), "byte {place}");
        assert!(log.series.len() + 1 >= RECORDINGS || recovery.cut_off, "byte {place}: {recovery:?}");
        let states = read_states::<DVec2>(&clean).unwrap();
        assert!(states.iter().all(|found| [state(300, 0.2), state(300, 0.5)].contains(found)));
        lost += u64::from(recovery.damaged_parts > 0);
    }
    assert!(lost > 20, "{lost} damaged chunks");
    std::fs::write(&spoiled, &bytes[..bytes.len() * 2 / 3]).unwrap();
    assert!(matches!(recover(&spoiled, &clean), Err(LogError::Exists { .. })), "never over anything");
    std::fs::remove_file(&clean).unwrap();
    assert!(recover(&spoiled, &clean).unwrap().unwrap().cut_off);
    assert!(read_log(&clean).unwrap().series.len() >= 3);
}

#[test]
fn what_is_no_log_is_refused_by_its_name() {
    let folder = folder();
    let path = folder.path().join("other.mcap");
    let refuse = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_log(&path).unwrap_err().to_string()
    };
    assert!(refuse(b"").contains("is empty"));
    assert!(refuse(b"title = \"Not a log\"").contains("is not an MCAP file"));
    let mut foreign = std::io::Cursor::new(Vec::new());
    mcap::Writer::new(&mut foreign).unwrap().finish().unwrap();
    assert!(refuse(foreign.get_ref()).contains("without the header of a grainflow log"));
    assert!(refuse(foreign.get_ref()).contains("other.mcap"));
    assert!(read_log(Path::new("/nowhere/log.mcap")).unwrap_err().to_string().contains("/nowhere/log.mcap"));
}

#[test]
fn a_newer_format_is_refused_with_both_versions() {
    let folder = folder();
    let path = folder.path().join("newer.mcap");
    let mut newer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    let pairs =
        [("format", "2"), ("version", "9.9.9")].map(|(key, value)| (key.to_owned(), value.to_owned()));
    let metadata: BTreeMap<String, String> = pairs.into();
    newer.write_metadata(&mcap::records::Metadata { name: "grainflow".to_owned(), metadata }).unwrap();
    newer.finish().unwrap();
    std::fs::write(&path, newer.into_inner().into_inner()).unwrap();
    let message = read_log(&path).unwrap_err().to_string();
    assert!(message.contains("format 2") && message.contains("9.9.9"), "{message}");
    assert!(message.contains(env!("CARGO_PKG_VERSION")), "{message}");
}

#[test]
fn what_cannot_be_written_is_said_before_the_run() {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let bad = LogHeader { columns: vec![column("Energy", 0, 0, 0)], ..header() };
    assert!(matches!(LogWriter::create(&path, &bad), Err(LogError::Columns { .. })));
    let nowhere = LogWriter::create(&folder.path().join("no/log.mcap"), &header()).unwrap_err();
    assert!(nowhere.to_string().contains("no/log.mcap"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_stops_the_log() {
    let error = match LogWriter::create(Path::new("/dev/full"), &header()) {
        Ok(log) => log.finish().unwrap_err(),
        Err(error) => error,
    };
    assert!(error.to_string().contains("/dev/full"), "{error}");
}

#[test]
fn large_states_are_written_in_parts() {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    let large = state(600_000, 0.25);
    log.state(&large).unwrap();
    log.finish().unwrap();
    assert!(last_state(&path).unwrap() == Some(large));
}
