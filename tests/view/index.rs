//! Any frame by the index.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use glam::DVec2;
use grainflow::matter::columns::Columns;
use grainflow::record::error::LogError;
use grainflow::record::frame::frame;
use grainflow::record::index::LogIndex;
use grainflow::record::reader::read_log;
use grainflow::record::recover::recover;
use grainflow::record::writer::{LogWriter, Recording};
use grainflow::view::{Site, ViewedLog};
use proptest::prelude::*;

use super::{PORT, RECORDINGS, get, header, sample};

/// Asserts that the index of the log at `path` gives what reading all of it gives.
fn assert_same(path: &Path) -> LogIndex {
    let (whole, index) = (read_log(path).unwrap(), LogIndex::open(path).unwrap());
    assert_eq!((index.frames(), index.recordings()), (whole.frames.len(), whole.series.len()));
    // Backwards: no frame needs those before it.
    for number in (0..whole.frames.len()).rev() {
        let moment = index.moment(number).unwrap().unwrap();
        assert_eq!(moment.frame, whole.frames[number]);
        assert_eq!(moment.row, whole.series[index.recording_of(number).unwrap()]);
        assert!((index.frame_time(number).unwrap() - moment.frame.time).abs() < 1e-8);
    }
    for (number, row) in whole.series.iter().enumerate() {
        assert_eq!(index.row(number).unwrap().as_ref(), Some(row));
    }
    assert_eq!(index.moment(whole.frames.len()).unwrap(), None);
    let head = index.head();
    assert_eq!((&head.metadata, &head.scenario), (&whole.metadata, &whole.scenario));
    assert_eq!((&head.columns, &head.walls), (&whole.columns, &whole.walls));
    assert_eq!(head.cut_off.is_some(), whole.cut_off.is_some());
    index
}

#[test]
fn frames_by_the_index_are_those_of_the_whole_log() {
    for points in [None, Some(100)] {
        let (_folder, path) = sample(points);
        let index = assert_same(&path);
        assert!(!index.was_made());
    }
}

#[test]
fn a_log_that_is_cut_off_is_shown_as_far_as_it_goes() {
    let (folder, path) = sample(None);
    let bytes = fs::read(&path).unwrap();
    let short = folder.path().join("short.mcap");
    for length in (0..bytes.len()).step_by(997).chain([bytes.len() - 1]) {
        fs::write(&short, &bytes[..length]).unwrap();
        if read_log(&short).is_err() {
            assert!(LogIndex::open(&short).is_err(), "{length}");
            continue;
        }
        let index = assert_same(&short);
        assert!(index.was_made());
        let sentence = index.head().cut_off.clone().unwrap();
        assert!(sentence.contains(&format!("cut off after {length} bytes")), "{sentence}");
    }
}

#[test]
fn wrong_bytes_are_found_out_where_they_are_looked_at() {
    let (folder, path) = sample(None);
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    fs::write(&path, &bytes).unwrap();
    let index = LogIndex::open(&path).unwrap();
    let moments: Vec<_> = (0..RECORDINGS).map(|number| index.moment(number)).collect();
    let bad = moments.iter().filter(|moment| matches!(moment, Err(LogError::Damaged { .. }))).count();
    assert_eq!((bad, moments.iter().filter(|moment| moment.is_ok()).count()), (1, RECORDINGS - 1));
    // What is sound in it has an index again, with one frame less.
    let clean = folder.path().join("clean.mcap");
    recover(&path, &clean).unwrap();
    assert_eq!(assert_same(&clean).frames(), RECORDINGS - 1);
}

#[test]
fn other_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    assert!(matches!(LogIndex::open(&path), Err(LogError::Read { .. })));
    fs::write(&path, "").unwrap();
    assert!(matches!(LogIndex::open(&path), Err(LogError::Empty { .. })));
    fs::write(&path, "no log at all").unwrap();
    assert!(matches!(LogIndex::open(&path), Err(LogError::NotMcap { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_damage_stops_the_index(place in 0.0..1.0_f64, byte: u8, length in 0.0..1.3_f64) {
        let (_folder, path) = sample(None);
        let mut bytes = fs::read(&path).unwrap();
        let at = (place * (bytes.len() - 1) as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((length * bytes.len() as f64) as usize);
        fs::write(&path, &bytes).unwrap();
        if let Ok(index) = LogIndex::open(&path) {
            for number in 0..index.frames() {
                let _ = index.moment(number);
            }
        }
    }
}

/// As many `recordings`, of 20 000 grains anywhere at any speed.
fn write_noise(log: &mut LogWriter, recordings: u64) {
    let points = 20_000_u64;
    // A linear congruential generator: any bits will do.
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for index in 0..recordings {
        let time = 1e-3 * index as f64;
        let mut columns = Columns::default();
        for id in 0..points {
            columns.positions.push(DVec2::new(40.0 * random(), 20.0 * random()));
            columns.velocities.push(DVec2::new(random(), random()));
            columns.ids.push(id as u32);
        }
        let picture = frame(time, &columns, None);
        let row = [time, random(), time];
        log.recording(&Recording {
            values: &row,
            state_hash: &format!("{index:064x}"),
            grains: picture.grains,
            profiles: &[],
            frame: Some(&picture),
            fields: &[],
        })
        .unwrap();
    }
}

/// Two gigabytes of frames that no compression makes smaller; as many frames as `GRAINFLOW_FRAMES` says.
#[test]
#[ignore = "writes 2 GB; cargo test --release --test view -- --ignored --nocapture"]
fn a_large_log_is_opened_and_scrubbed_in_less_than_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    let recordings: u64 = std::env::var("GRAINFLOW_FRAMES").map_or(6000, |frames| frames.parse().unwrap());
    write_noise(&mut log, recordings);
    log.finish().unwrap();
    let length = fs::metadata(&path).unwrap().len();
    let begun = Instant::now();
    let log = ViewedLog::open(&path).unwrap();
    assert!(!log.index().was_made(), "the whole file was read");
    println!(
        "{:.2} GB, {recordings} frames: opened in {:.3} s",
        length as f64 * 1e-9,
        begun.elapsed().as_secs_f64()
    );
    let site = Site::new(vec![log], PORT).unwrap();
    let token = site.address().split_once("token=").unwrap().1.to_owned();
    let mut longest = Duration::ZERO;
    for colour in ["speed", "density", "clusters"] {
        let mut slowest = Duration::ZERO;
        for number in (0..40).map(|k| k * 1571 % recordings) {
            let begun = Instant::now();
            let query = format!("/frame?token={token}&number={number}&colour={colour}");
            assert_eq!(site.respond(&get(&query, "127.0.0.1:4000")).status, 200);
            slowest = slowest.max(begun.elapsed());
        }
        println!("slowest of 40 frames here and there, coloured by {colour}: {:.3} s", slowest.as_secs_f64());
        longest = longest.max(slowest);
    }
    // At its full length it has the machine to itself.
    assert!(recordings < 6000 || longest < Duration::from_secs(1));
    fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(length - 1000).unwrap();
    let begun = Instant::now();
    assert!(LogIndex::open(&path).unwrap().was_made());
    println!("cut off: read once in {:.1} s", begun.elapsed().as_secs_f64());
}
