//! Logs come back as they were written, and damage to them is never silent.
#![expect(clippy::unwrap_used, reason = "functions that tests call stop the test like the tests themselves")]

mod log_fields;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use grainflow::engine::EngineState;
use grainflow::matter::columns::Columns;
use grainflow::observe::field::Quantity;
use grainflow::observe::measure::{Column, Dimension, Profile};
use grainflow::record::contents::{Frame, RunLog, Walls};
use grainflow::record::error::LogError;
use grainflow::record::frame::frame;
use grainflow::record::reader::{last_state, read_log, read_states};
use grainflow::record::recover::recover;
use grainflow::record::state::SavedState;
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::space::Vector;
use log_fields::fields;
use proptest::prelude::*;

const RECORDINGS: usize = 6;

fn column(name: &str, mass: i8, length: i8, time: i8) -> Column {
    Column { name: name.to_owned(), unit: Dimension { mass, length, time } }
}

fn header() -> LogHeader {
    let sides = [["periodic", "periodic"], ["wall", "open"], ["", ""]];
    let metadata = [("version", "0.1.0"), ("seed", "7"), ("engine", "hsmc"), ("unit.length", "m")];
    LogHeader {
        metadata: metadata.map(|(key, value)| (key.to_owned(), value.to_owned())).into(),
        scenario: "title = \"Sample\"\ndimension = 2\n".to_owned(),
        columns: vec![
            column("time", 0, 0, 1),
            column("kinetic_energy", 1, 2, -2),
            column("collisions_per_particle", 0, 0, 0),
        ],
        walls: Some(Walls {
            lower: [0.0; 3],
            upper: [40.0, 20.0, 0.0],
            sides: sides.map(|axis| axis.map(str::to_owned)),
        }),
        earlier: Vec::new(),
        fields: (vec![Quantity::Density, Quantity::Velocity], 2),
        start: 0.0,
        time_scale: time_scale(0.5, 0.1),
    }
}

fn grains(count: u32, time: f64) -> Columns<DVec2> {
    let mut columns = Columns::default();
    for id in 0..count {
        let place = f64::from(id);
        columns.positions.push(DVec2::new((place * 0.37 + time).rem_euclid(40.0), (place * 0.61) % 20.0));
        columns.velocities.push(DVec2::new(place.sin(), place.cos()));
        columns.ids.push(id);
    }
    columns
}

fn profile(name: &str, time: f64) -> Profile {
    Profile {
        name: name.to_owned(),
        time,
        columns: vec![column("y", 0, 1, 0), column("velocity_x", 0, 1, -1)],
        values: vec![vec![0.5, 1.5, 2.5], vec![-0.0, time, f64::INFINITY]],
    }
}

fn state(count: u32, time: f64) -> SavedState<'static, DVec2> {
    SavedState {
        time,
        compensation: -0.0,
        columns: std::borrow::Cow::Owned(grains(count, time)),
        next_id: count,
        engine: EngineState { step: 12, largest_speed: 1.0, collision_rate: -1.0, ..Default::default() },
        last_poured: -1.0,
        samples: vec![1, 0, 3],
        memories: vec![("energy".to_owned(), vec![0.1, -0.0]), ("none".to_owned(), Vec::new())],
        ..Default::default()
    }
}

/// Writes the sample log; what should be read back.
fn write_sample(path: &Path) -> RunLog {
    let header = header();
    let mut log = LogWriter::create(path, &header).unwrap();
    let mut expected = RunLog {
        scenario: header.scenario.clone(),
        columns: header.columns.clone(),
        walls: header.walls.clone(),
        ..Default::default()
    };
    for index in 0..RECORDINGS {
        let time = 0.1 * index as f64;
        let row = vec![time, 100.0 - time, 2.0 * time];
        let hash = format!("{index:064x}");
        // The first recording is of an empty box, as where grains are poured in.
        let picture = frame(time, &grains(if index == 0 { 0 } else { 300 }, time), Some(250));
        let profiles = [profile("velocity-profile", time)];
        // Not every recording has a frame or fields.
        let picture = (index != 3).then_some(picture);
        let fields = if index % 2 == 1 { fields(grains(300, time), time) } else { Vec::new() };
        let recording = Recording {
            values: &row,
            state_hash: &hash,
            grains: if index == 0 { 0 } else { 300 },
            profiles: &profiles,
            frame: picture.as_ref(),
            fields: &fields,
        };
        log.recording(&recording).unwrap();
        if index % 3 == 2 {
            log.state(&state(300, time)).unwrap();
        }
        expected.series.push(row);
        expected.state_hashes.push(hash);
        expected.profiles.extend(profiles);
        expected.frames.extend(picture);
        expected.fields.extend(fields);
    }
    let last = profile("spectrum", 0.5);
    log.profile(&last).unwrap();
    expected.profiles.push(last);
    log.finish().unwrap();
    expected.metadata = header.metadata;
    expected.metadata.insert("format".to_owned(), "1".to_owned());
    let digest = expected.scenario.bytes().collect::<Vec<_>>();
    let digest = <sha2::Sha256 as sha2::Digest>::digest(digest);
    let digest = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    expected.metadata.insert("scenario_sha256".to_owned(), digest);
    expected.metadata.insert("time_scale".to_owned(), "1000000000".to_owned());
    expected
}

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

/// The log that readers in other languages are tried on.
#[test]
fn a_sample_for_other_readers() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sample.mcap");
    write_sample(&path);
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

/// Any bits of a float, NaNs with payloads and −0 among them.
fn any_bits() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        Just(-0.0),
        Just(f64::from_bits(0x7ff4_dead_beef_0001)),
        Just(f64::from_bits(0xfff8_0000_0000_0042)),
    ]
}

fn any_vector<V: Vector>() -> impl Strategy<Value = V> {
    [any_bits(), any_bits(), any_bits()].prop_map(|components| V::from_fn(|axis| components[axis]))
}

/// Position, velocity, identity, spin, of which as much is taken as the space has, and species.
type AnyGrain<V> = (V, V, u32, DVec3, u8);

/// Writes `grains` into `columns`, with spins and species if these columns are there.
fn fill<V: Vector>(columns: &mut Columns<V>, grains: Vec<AnyGrain<V>>) {
    for (row, (position, velocity, id, spin, species)) in grains.into_iter().enumerate() {
        columns.insert(row, position, velocity, id);
        if let Some(spins) = &mut columns.spins {
            let components = spin.to_array();
            let width = spins[row].as_ref().len();
            spins[row].as_mut().copy_from_slice(&components[..width]);
        }
        if let Some(all) = &mut columns.species {
            all[row] = species;
        }
    }
}

fn any_state<V: Vector<Spin: AsMut<[f64]>>>() -> impl Strategy<Value = SavedState<'static, V>> {
    let grain = (any_vector::<V>(), any_vector::<V>(), any::<u32>(), any_vector::<DVec3>(), any::<u8>());
    let columns = (prop::collection::vec(grain, 0..20), any::<bool>(), any::<bool>());
    let numbers = (prop::array::uniform7(any_bits()), prop::array::uniform12(any::<u64>()));
    let momentum = prop::array::uniform3([any_vector::<V>(), any_vector::<V>()]);
    let memories = prop::collection::vec(("[a-z-]{0,8}", prop::collection::vec(any_bits(), 0..5)), 0..4);
    (columns, numbers, momentum, prop::collection::vec(any::<u64>(), 0..4), memories).prop_map(
        |((grains, rough, mixed), (floats, counts), momentum, samples, memories)| {
            let mut state = SavedState::<'static, V> { samples, memories, ..Default::default() };
            state.columns.to_mut().spins = rough.then(Vec::new);
            state.columns.to_mut().species = mixed.then(Vec::new);
            fill(state.columns.to_mut(), grains);
            [state.time, state.compensation, state.engine.largest_speed, state.engine.collision_rate, ..] =
                floats;
            [
                ..,
                state.last_poured,
                state.totals.collisions_per_particle,
                state.totals.counts.carried_momentum,
            ] = floats;
            state.next_id = counts[0] as u32;
            let totals = &mut state.totals;
            [
                _,
                state.engine.step,
                state.recordings,
                totals.steps,
                totals.steps_capped,
                totals.poured,
                totals.particle_steps,
                ..,
            ] = counts;
            let counted = &mut totals.counts;
            [
                ..,
                counted.collisions,
                counted.candidates,
                counted.cell_collisions,
                counted.rejected_moves,
                counted.removed,
            ] = counts;
            counted.wall_momentum = momentum;
            state.held_until = floats[2];
            state.engine.numbers = floats.repeat(counts[7] as usize % 5);
            state.engine.words = counts.map(|count| count as u32).repeat(counts[8] as usize % 3);
            state.totals.since.grains = counts[9];
            state.totals.since.collisions = counts[10];
            state.totals.since.collisions_per_particle = floats[3];
            state.totals.events.all = counts[0].max(1);
            state.totals.events.cured = counts[1];
            state.totals.events.impacts[39] = counts[2];
            state
        },
    )
}

/// All numbers of a state as text that tells any two bit patterns apart.
fn bits<V: Vector>(state: &SavedState<'_, V>) -> String {
    let vector = |v: V| (0..V::DIMENSION).map(|axis| v[axis].to_bits()).collect::<Vec<_>>();
    let spin = |spin: &V::Spin| spin.as_ref().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    let columns = &state.columns;
    let memory = |(name, values): &(String, Vec<f64>)| {
        (name.clone(), values.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
    };
    let totals = &state.totals;
    let counts = &totals.counts;
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        [
            state.held_until,
            totals.since.collisions_per_particle,
            state.time,
            state.compensation,
            state.last_poured,
            state.engine.largest_speed,
            state.engine.collision_rate
        ]
        .map(f64::to_bits),
        [totals.collisions_per_particle, counts.carried_momentum].map(f64::to_bits),
        (state.next_id, state.engine.step, state.recordings, &state.samples),
        [totals.steps, totals.steps_capped, totals.poured, totals.particle_steps],
        [counts.collisions, counts.candidates, counts.cell_collisions, counts.rejected_moves, counts.removed],
        counts.wall_momentum.map(|sides| sides.map(vector)),
        columns.positions.iter().chain(&columns.velocities).map(|&v| vector(v)).collect::<Vec<_>>(),
        (&columns.ids, &columns.species),
        columns.spins.as_ref().map(|spins| spins.iter().map(spin).collect::<Vec<_>>()),
        state.memories.iter().map(memory).collect::<Vec<_>>(),
        state.engine.numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>(),
        &state.engine.words,
        (totals.events, totals.since.grains, totals.since.collisions),
    )
}

fn comes_back<V: Vector>(state: &SavedState<'_, V>) {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    log.state(state).unwrap();
    log.finish().unwrap();
    let back = last_state::<V>(&path).unwrap().unwrap();
    assert_eq!(bits(&back), bits(state));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn states_in_2d_come_back_bit_for_bit(state in any_state::<DVec2>()) {
        comes_back(&state);
    }

    #[test]
    fn states_in_3d_come_back_bit_for_bit(state in any_state::<DVec3>()) {
        comes_back(&state);
    }
}
