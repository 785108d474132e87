//! Several engines from the same initial states, side by side.
//!
//! Each replica begins with a state of its own, made once by event-driven dynamics and written as a log,
//! `initial-1/log.mcap`. Every engine then runs the scenario from exactly these grains. Each of these runs is an ordinary
//! one of the scenario `hsmc-1.toml` beside its folder `hsmc-1`, and can be repeated by `grainflow run`.

mod gather;
mod plan;
mod runs;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

use crate::comparison::model::Comparison;
use crate::comparison::{LogsError, assemble, csv, json, read, theory};
use crate::placing::write_whole;
use crate::record::error::LogError;
use crate::report::render_comparison;
use crate::run::RunError;
use crate::run::folder::{FolderError, RunFolder};
use crate::scenario::ScenarioError;
pub use plan::{Plan, PlanError, USUAL_REPLICAS, Wish};
use runs::{Ending, Runs};
pub use runs::{Listener, Moment};

/// Why there is no comparison.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A run cannot be begun or written.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A scenario is not what it was when it was planned.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Logs do not belong together.
    #[error(transparent)]
    Logs(#[from] LogsError),
    /// A log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A file cannot be written.
    #[error("cannot write {}: {source}; the runs before it are kept", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The system gives no threads.
    #[error("cannot start the threads of --jobs: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// No run came to its end.
    #[error("no run came to its end, so there is nothing to compare; what there is stands in {}{}", folder.display(), listed(failures))]
    Nothing {
        /// Where the runs are.
        folder: PathBuf,
        /// Why, for each run that failed.
        failures: Vec<String>,
        /// Whether somebody stopped them.
        interrupted: bool,
    },
}

impl CompareError {
    /// Whether the input is at fault, rather than a run.
    pub fn is_bad_input(&self) -> bool {
        match self {
            CompareError::Folder(error) => error.is_bad_input(),
            CompareError::Scenario(_) | CompareError::Logs(_) | CompareError::Log(_) => true,
            CompareError::Run(error) => error.is_bad_input(),
            _ => false,
        }
    }
}

/// How runs are made.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// The folder.
    pub out: &'a Path,
    /// Whether it may replace what is there, once it is complete.
    pub force: bool,
    /// Replicas side by side; above 1 nothing is said of costs.
    pub jobs: usize,
}

/// What a comparison leaves.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The folder with everything in it.
    pub folder: PathBuf,
    /// What was found.
    pub comparison: Comparison,
    /// Whether somebody stopped the runs before their end.
    pub interrupted: bool,
}

/// Runs `plan` until its end, or until `stop` turns true; runs that had come to their end by then are compared.
pub fn compare(
    plan: &Plan,
    options: Options<'_>,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Outcome, CompareError> {
    let folder = RunFolder::claim(options.out, options.force)?;
    let jobs = options.jobs.clamp(1, plan.replicas() as usize);
    let runs = Runs { plan, folder: folder.path(), jobs, stop, tell, done: AtomicUsize::new(0) };
    let made = match runs.all() {
        Ok(made) => made,
        Err(error) => {
            // Where the first initial state could not be made, nothing was written.
            folder.abandon();
            return Err(error);
        }
    };
    let interrupted = stop.load(SeqCst);
    if !made.iter().any(|run| matches!(run.ending, Ending::Complete(_))) {
        let failures =
            made.iter().filter_map(|run| Some(format!("{}, {}", run.folder, run.failure()?))).collect();
        return Err(CompareError::Nothing { folder: folder.path().to_owned(), failures, interrupted });
    }
    let mut comparison = gather::of_runs(plan, &made, folder.path(), jobs == 1)?;
    theory::add(&mut comparison);
    write_files(folder.path(), &comparison)?;
    Ok(Outcome { folder: folder.settle()?, comparison, interrupted })
}

/// Compares stored runs, each named by its log or its folder, into `out`.
pub fn compare_logs(logs: &[PathBuf], out: &Path, force: bool) -> Result<Outcome, CompareError> {
    let (head, entries) = read(logs)?;
    let mut comparison = assemble(head, entries);
    theory::add(&mut comparison);
    comparison.remarks.push("Where theory is shown, it is that of the first log’s scenario.".to_owned());
    let folder = RunFolder::claim(out, force)?;
    write_files(folder.path(), &comparison)?;
    Ok(Outcome { folder: folder.settle()?, comparison, interrupted: false })
}

/// `comparison.json`, `comparison.csv`, `comparison.html`.
fn write_files(folder: &Path, comparison: &Comparison) -> Result<(), CompareError> {
    write_text(&folder.join("comparison.json"), &json::text(comparison))?;
    write_text(&folder.join("comparison.csv"), &csv::text(comparison))?;
    write_text(&folder.join("comparison.html"), &render_comparison(comparison))
}

fn write_text(path: &Path, text: &str) -> Result<(), CompareError> {
    write_whole(path, text.as_bytes()).map_err(|source| CompareError::Write { path: path.to_owned(), source })
}

fn listed(lines: &[String]) -> String {
    lines.iter().map(|line| format!("\n{line}")).collect()
}
