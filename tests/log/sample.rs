//! A small log with every kind of message, and what should be read back from it. `examples/sample_log.rs` writes it for
//! readers in other languages.

use std::path::Path;

use glam::DVec2;
use grainflow::engine::EngineState;
use grainflow::matter::clock::Clock;
use grainflow::matter::columns::Columns;
use grainflow::matter::gas::Gas;
use grainflow::matter::grain::Grain;
use grainflow::matter::grid::Grid;
use grainflow::observe::field::{Field, Quantity, field};
use grainflow::observe::measure::{Column, Dimension, Profile};
use grainflow::record::contents::{RunLog, Walls};
use grainflow::record::frame::frame;
use grainflow::record::state::SavedState;
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};

/// Recordings of the sample.
pub(crate) const RECORDINGS: usize = 6;

/// A column by the powers of its unit.
pub(crate) fn column(name: &str, mass: i8, length: i8, time: i8) -> Column {
    Column { name: name.to_owned(), unit: Dimension { mass, length, time } }
}

/// What stands at its beginning.
pub(crate) fn header() -> LogHeader {
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

/// The state of so many grains at a time.
pub(crate) fn state(count: u32, time: f64) -> SavedState<'static, DVec2> {
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
pub(crate) fn write_sample(path: &Path) -> RunLog {
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

/// Density and velocity of the sample's grains.
fn fields(grains: Columns<DVec2>, time: f64) -> Vec<Field> {
    let grid = Grid::new(DVec2::ZERO, DVec2::new(40.0, 20.0), &[2, 2], &[true, false]);
    let grain = Grain { diameter: 1.0, mass: 1.0 };
    let gas = Gas::restored(grid, grain, grains, Clock::restored(time, 0.0), 300);
    [Quantity::Density, Quantity::Velocity].map(|quantity| field(quantity, &gas, &[])).to_vec()
}
