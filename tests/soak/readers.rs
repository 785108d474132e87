//! Everything that opens a log, on one that may be wounded: each says whether it took it.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3};
use grainflow::export::{Format, Request, export};
use grainflow::record::reader::{last_state, read_log};
use grainflow::record::recover::recover;
use grainflow::replay::compute::{Basis, compute};
use grainflow::replay::selection::Selection;
use grainflow::replay::tables::tables_of;
use grainflow::report::render;
use grainflow::view::ViewedLog;

use super::requests::Door;

const FORMATS: [Format; 5] = [Format::Lammps, Format::Vtp, Format::Vti, Format::Xyz, Format::Csv];

/// The recordings, and the state to go on from.
pub(crate) fn read(log: &Path) -> bool {
    let read = read_log(log).is_ok();
    let flat = last_state::<DVec2>(log).is_ok();
    let deep = last_state::<DVec3>(log).is_ok();
    read && (flat || deep)
}

/// Recovery. What comes of it holds no damage that checksums find, and as many messages when it is recovered again. It is a
/// log, unless what it was made of is none.
pub(crate) fn recovered(log: &Path) -> bool {
    let (clean, again) = (log.with_file_name("clean.mcap"), log.with_file_name("again.mcap"));
    let _ = (fs::remove_file(&clean), fs::remove_file(&again));
    let Ok(Some(first)) = recover(log, &clean) else { return false };
    let _ = read_log(&clean);
    if let Some(second) = recover(&clean, &again).expect("what was recovered can be read") {
        let whole = second.damaged_parts == 0 && !second.cut_off;
        assert!(whole && second.messages == first.messages, "{first:?}, and then {second:?}");
    }
    true
}

/// Tables, the report, and measures computed from states and from frames.
pub(crate) fn replayed(log: &Path) -> bool {
    let Ok(read) = read_log(log) else { return false };
    let metadata = read.metadata.clone();
    assert!(render(&read, &serde_json::Map::new()).contains("</html>"));
    let tables = tables_of(read, Selection::default());
    let _ = (tables.series_text(&metadata), tables.profile_texts(&metadata));
    let names = ["energy", "clusters", "velocity-distribution"].map(str::to_owned);
    [Basis::States, Basis::Frames]
        .map(|basis| compute(log, &names, Selection::default(), Some(basis)).is_ok())
        .contains(&true)
}

/// An export in the format number `choice`, of frames or of states.
pub(crate) fn exported(log: &Path, choice: usize) -> bool {
    let out = log.with_file_name("exported");
    let request = Request {
        log,
        format: FORMATS[choice % FORMATS.len()],
        out: &out,
        selection: Selection::default(),
        states: choice / FORMATS.len() % 2 == 1,
        cell_size: None,
        force: false,
    };
    let taken = export(&request, &AtomicBool::new(false)).is_ok();
    let _ = fs::remove_file(&out).or_else(|_| fs::remove_dir_all(&out));
    taken
}

/// The viewer: the page, and all that it asks for.
pub(crate) fn viewed(log: &Path) -> bool {
    let Ok(log) = ViewedLog::open(log) else { return false };
    let door = Door::to(log);
    let pages = ["/", "/about", "/series?count=9"];
    let frames = (0..5).map(|number| format!("/frame?number={number}&colour={}", Door::colour(number)));
    let asked: Vec<String> = pages.map(str::to_owned).into_iter().chain(frames).collect();
    asked.iter().filter(|what| door.ask(&Door::request(what)) == 200).count() > pages.len()
}
