//! Sweeps: one run for every value of what is varied, and one table of all of them.
//!
//! A sweep goes on where it stopped: finished runs are kept if scenario, version and numerics match, and the missing
//! ones are made.

mod figures;
mod means;
mod plan;
mod power_law;
mod runs;
mod standing;
mod table;
mod variation;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use serde_json::{Map, Value};

use crate::report::{SweepReport, render_sweep};
use crate::scenario::ScenarioError;
pub use plan::{Plan, Wish};
pub use runs::{Ended, Listener, Row};
use standing::{Standing, standing};

/// Strangers that a refusal names.
const NAMED_STRANGERS: usize = 5;

/// Why a sweep cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The options are wrong.
    #[error("{0}")]
    Wrong(String),
    /// A scenario is.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// There is something else in the folder.
    #[error("{0}")]
    Foreign(String),
    /// The system gives no threads.
    #[error("cannot start the threads: {0}; ask for fewer with --threads")]
    Threads(rayon::ThreadPoolBuildError),
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

impl SweepError {
    /// Whether the input is at fault.
    pub fn is_bad_input(&self) -> bool {
        matches!(self, SweepError::Wrong(_) | SweepError::Scenario(_) | SweepError::Foreign(_))
    }
}

/// How a sweep is made.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// The folder of the sweep.
    pub out: &'a Path,
    /// Whether other runs that stand in the folders of cases are replaced.
    pub force: bool,
    /// Runs side by side, at least 1.
    pub jobs: usize,
    /// Threads that they share; `None` for all.
    pub threads: Option<usize>,
}

/// How a sweep looks from outside while it goes on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment<'a> {
    /// Which case this is about.
    pub case: usize,
    /// The share of it that is done, in [0, 1].
    pub progress: f64,
    /// How it ended, if it did.
    pub ended: Option<&'a Ended>,
    /// Its summary, if it ended.
    pub summary: Option<&'a Map<String, Value>>,
    /// Why it begins although it was finished before, if so: what is missing in its log.
    pub remade: Option<&'a str>,
}

/// What a sweep leaves.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// A row for every case.
    pub rows: Vec<Row>,
    /// Means, curves and fits.
    pub report: SweepReport,
}

/// Makes the runs of `plan` that are missing, or those begun until `stop` turns true, and writes the tables.
pub fn sweep(
    plan: &Plan,
    options: &Options<'_>,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Outcome, SweepError> {
    let out = options.out;
    if out.exists() && !out.is_dir() {
        let message = format!("{} is a file, not a folder; choose a folder with --out", out.display());
        return Err(SweepError::Foreign(message));
    }
    let standings: Vec<Standing> =
        plan.cases.iter().map(|case| standing(&out.join(&case.name), &case.scenario)).collect();
    if !options.force {
        refuse_strangers(plan, out, &standings)?;
    }
    let rows = runs::runs(plan, standings, options, stop, tell)?;
    let report = means::report(plan, &rows);
    std::fs::create_dir_all(out).map_err(|source| SweepError::Write { path: out.to_owned(), source })?;
    runs::write(out, "sweep.csv", &table::table(plan, &rows))?;
    runs::write(out, "sweep.json", &means::json(plan, &rows, &report))?;
    runs::write(out, "sweep.html", &render_sweep(&report))?;
    Ok(Outcome { rows, report })
}

/// Refuses folders of cases that hold something else.
fn refuse_strangers(plan: &Plan, out: &Path, standings: &[Standing]) -> Result<(), SweepError> {
    let strangers: Vec<String> = plan
        .cases
        .iter()
        .zip(standings)
        .filter_map(|(case, standing)| match standing {
            Standing::Foreign(why) => Some(format!("{} {why}", out.join(&case.name).display())),
            _ => None,
        })
        .collect();
    if strangers.is_empty() {
        return Ok(());
    }
    let more = strangers.len().saturating_sub(NAMED_STRANGERS);
    let mut text = strangers[..strangers.len() - more].join("\n");
    if more > 0 {
        text += &format!("\nand {more} more");
    }
    Err(SweepError::Foreign(format!(
        "{text}\nchoose another folder with --out, or replace such runs with --force"
    )))
}
