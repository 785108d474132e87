//! The scenarios of the golden logs, and how they are written. `examples/golden.rs` does it, and tests do it again.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use grainflow::run::run;
use grainflow::scenario::model::EngineKind;
use grainflow::scenario::{Overrides, parse};

/// The newest format; a new one gets a folder of its own, and this one stays.
pub(crate) const FORMAT: &str = "1";
/// When its run is stopped [time]: long before its limit, so that measures have taken few samples.
const END: f64 = 0.5;

/// Where the golden logs of the newest format stand.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("format-{FORMAT}"))
}

/// The golden log of an engine in so many dimensions.
pub(crate) fn place(engine: EngineKind, dimension: usize) -> PathBuf {
    folder().join(format!("{}-{dimension}d.mcap", engine.name()))
}

/// Every engine in two and in three dimensions.
pub(crate) fn all() -> impl Iterator<Item = (EngineKind, usize)> {
    EngineKind::ALL.into_iter().flat_map(|engine| [2, 3].map(|dimension| (engine, dimension)))
}

/// A few grains that fall and are poured between walls: as many kinds of messages as there are.
fn scenario(engine: EngineKind, dimension: usize) -> String {
    let list = |first: f64, last: f64| {
        let numbers = (0..dimension).map(|axis| if axis + 1 == dimension { last } else { first });
        format!("{:?}", numbers.collect::<Vec<f64>>())
    };
    let up = ["y", "z"][dimension - 2];
    let side = if dimension == 2 { "x = \"periodic\"\n" } else { "x = \"periodic\"\ny = \"periodic\"\n" };
    let place = if dimension == 2 { "[8.0]" } else { "[4.0, 4.0]" };
    format!(
        "title = \"Golden\"\ndimension = {dimension}\nseed = 11\ngravity = {}\n\
         [engine]\nkind = \"{}\"\ncell_size = 2.0\ntime_step = {{ fixed = 0.0625 }}\n[domain]\nsize = {}\n\
         [boundary]\n{side}{up}.lower = {{ wall = \"rough\" }}\n{up}.upper = \"open\"\n\
         [particles]\ncount = 12\nrestitution = 0.9\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n\
         [source]\ncount = 3\nrate = 8.0\nposition = {place}\nwidth = 4.0\nheight = 4.0\nvelocity = {}\n\
         [run]\ntime = 10.0\n[record]\nevery = 0.25\nstates = 0\nmeasures = [\"energy\", \"density-profile\"]\n",
        list(0.0, -1.0),
        engine.name(),
        list(if dimension == 2 { 16.0 } else { 8.0 }, 30.0),
        list(0.0, -1.0),
    )
}

/// Writes the log of that scenario to `log` as the program does now.
pub(crate) fn write(engine: EngineKind, dimension: usize, log: &Path) {
    let overrides = Overrides::default();
    let text = scenario(engine, dimension);
    let parsed = parse("golden", &text, &overrides).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let work = tempfile::tempdir().unwrap();
    let run_folder = work.path().join("run");
    let stop = AtomicBool::new(false);
    run(&parsed, &run_folder, false, &stop, &mut |status| stop.store(status.time >= END, Relaxed)).unwrap();
    fs::copy(run_folder.join("log.mcap"), log).unwrap();
}
