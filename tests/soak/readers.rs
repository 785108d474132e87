//! Everything that opens a log, on one that may be wounded: each says whether it took it.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

use glam::{DVec2, DVec3};
use grainflow::export::{Format, Request, export};
use grainflow::record::history::History;
use grainflow::record::reader::{last_state, read_log};
use grainflow::record::recover::recover;
use grainflow::replay::compute::{Basis, compute};
use grainflow::replay::selection::Selection;
use grainflow::replay::tables::tables_of;
use grainflow::report::render;
use grainflow::run::Status;
use grainflow::run::resume::Resumption;
use grainflow::run::verify::verify;
use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, parse};
use grainflow::view::ViewedLog;

use super::hostile::is_small;
use super::requests::Door;

/// Looks at a run before it is stopped.
const LOOKS: u32 = 12;

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

/// A run that goes on for a few steps, to its own end or beyond.
pub(crate) fn resumed(log: &Path, choice: usize) -> bool {
    let Some(engine) = engine_of_small(log) else { return false };
    let longer = if engine == "event-driven" { "run.time=2.0" } else { "run.steps=9" };
    let sets: Vec<String> = if choice.is_multiple_of(4) { Vec::new() } else { vec![longer.to_owned()] };
    let Ok(resumption) = Resumption::open(log, &sets) else { return false };
    let (stop, folder) = (AtomicBool::new(false), log.with_file_name("resumed"));
    let outcome = resumption.run(&folder, true, &stop, &mut stopper(&stop));
    let _ = fs::remove_dir_all(&folder);
    outcome.is_ok()
}

/// A run that is made once more, for its first steps.
pub(crate) fn verified(log: &Path) -> bool {
    let stop = AtomicBool::new(false);
    engine_of_small(log).is_some() && verify(log, &stop, &mut stopper(&stop)).is_ok()
}

/// Stops a run after a few looks.
fn stopper(stop: &AtomicBool) -> impl FnMut(&Status) + Send {
    let mut looks = 0;
    move |_| {
        looks += 1;
        stop.store(looks > LOOKS, Relaxed);
    }
}

/// The engine of the log, if all its scenarios begin within a moment.
fn engine_of_small(log: &Path) -> Option<String> {
    let history = History::read(log).ok()?;
    let earlier = history.earlier.iter().map(|part| part.scenario.as_str());
    let are_small = earlier.chain([history.scenario.as_str()]).all(|text| {
        match parse("fire", text, &Overrides::default()) {
            Ok(AnyScenario::Two(scenario)) => is_small(&scenario),
            Ok(AnyScenario::Three(scenario)) => is_small(&scenario),
            Err(_) => true,
        }
    });
    are_small.then(|| history.value("engine").to_owned())
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
