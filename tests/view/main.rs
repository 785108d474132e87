//! Logs in the browser: frames by the index, who is let in, what becomes of bad requests, the page as a file.
#![expect(clippy::unwrap_used, reason = "functions that tests call stop the test like the tests themselves")]

mod index;
mod server;
#[path = "../signal/mod.rs"]
mod signal;
mod site;

use std::path::{Path, PathBuf};

use glam::DVec2;
use grainflow::matter::columns::Columns;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::contents::Walls;
use grainflow::record::frame::frame;
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::view::{Response, Site, ViewedLog};

const RECORDINGS: usize = 12;
const GRAINS: u32 = 150;
const PORT: u16 = 4000;

fn header() -> LogHeader {
    let sides = [["periodic", "periodic"], ["wall", "open"], ["", ""]];
    let column =
        |name: &str, time| Column { name: name.to_owned(), unit: Dimension { time, ..Dimension::default() } };
    LogHeader {
        metadata: [("version", "0.1.0"), ("engine", "hsmc")]
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .into(),
        scenario: "title = \"</script><b>Sample\"\ndimension = 2\n".to_owned(),
        columns: vec![column("time", 1), column("kinetic_energy", 0), column("collisions_per_particle", 0)],
        walls: Some(Walls {
            lower: [0.0; 3],
            upper: [40.0, 20.0, 0.0],
            sides: sides.map(|axis| axis.map(str::to_owned)),
        }),
        start: 0.0,
        time_scale: time_scale(1.2, 0.1),
        ..LogHeader::default()
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

/// Writes a log of `recordings` with `points` of the grains in a frame; the first one is of an empty box.
fn write_log(path: &Path, recordings: usize, points: Option<usize>) {
    let mut log = LogWriter::create(path, &header()).unwrap();
    for index in 0..recordings {
        let time = 0.1 * index as f64;
        let picture = frame(time, &grains(if index == 0 { 0 } else { GRAINS }, time), points);
        let row = [time, 100.0 - time, 2.0 * time];
        let hash = format!("{index:064x}");
        log.recording(&Recording {
            values: &row,
            state_hash: &hash,
            grains: picture.grains,
            profiles: &[],
            frame: Some(&picture),
            fields: &[],
        })
        .unwrap();
    }
    log.finish().unwrap();
}

/// A folder with a log.
fn sample(points: Option<usize>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    write_log(&path, RECORDINGS, points);
    (folder, path)
}

/// A site of the log at `path`, and its token.
fn site(path: &Path) -> (Site, String) {
    let site = Site::new(vec![ViewedLog::open(path).unwrap()], PORT).unwrap();
    let token = site.address().split_once("token=").unwrap().1.to_owned();
    (site, token)
}

fn get(target: &str, host: &str) -> Vec<u8> {
    format!("GET {target} HTTP/1.1\r\nHost: {host}\r\n\r\n").into_bytes()
}

fn text(response: &Response) -> String {
    String::from_utf8_lossy(&response.body).into_owned()
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn float(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}
