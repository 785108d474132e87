//! Makes the runs of a sweep, some side by side.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::{Map, Value};

use super::plan::{Case, Plan};
use super::standing::Standing;
use super::{Moment, Options, SweepError};
use crate::campaign::pools::pools;
use crate::placing::write_whole;
use crate::run::folder::take_away_run;

/// How the run of a case ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ended {
    /// It was there already.
    Kept,
    /// It was made.
    Done,
    /// It failed, and why.
    Failed(String),
    /// Somebody stopped it before its end.
    Interrupted,
    /// The sweep was stopped before it began.
    NotRun,
}

impl Ended {
    /// The word for tables.
    pub fn word(&self) -> &'static str {
        match self {
            Ended::Kept => "kept",
            Ended::Done => "done",
            Ended::Failed(_) => "failed",
            Ended::Interrupted => "interrupted",
            Ended::NotRun => "not run",
        }
    }

    /// Why it failed; empty where it did not.
    pub fn error(&self) -> &str {
        match self {
            Ended::Failed(error) => error,
            _ => "",
        }
    }
}

/// What became of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// How its run ended.
    pub ended: Ended,
    /// Its summary; empty unless the run is whole.
    pub summary: Map<String, Value>,
}

impl Row {
    fn without_summary(ended: Ended) -> Self {
        Row { ended, summary: Map::new() }
    }
}

/// Who hears how it goes.
pub type Listener<'a> = &'a (dyn Fn(&Moment<'_>) + Sync);

/// Runs what `standings` `[case]` say is missing; a row for every case.
pub(super) fn runs(
    plan: &Plan,
    standings: Vec<Standing>,
    options: &Options<'_>,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Vec<Row>, SweepError> {
    let wanted: Vec<usize> =
        (0..plan.cases.len()).filter(|&k| !matches!(standings[k], Standing::Finished(_))).collect();
    let all = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads = options.threads.unwrap_or_else(all);
    let pools = pools(threads, options.jobs.min(wanted.len())).map_err(SweepError::Threads)?;
    for k in (0..plan.cases.len()).filter(|k| !wanted.contains(k)) {
        tell(&Moment { case: k, progress: 1.0, ..Moment::default() });
    }
    let next = AtomicUsize::new(0);
    let rows: Mutex<Vec<Row>> = Mutex::new(standings.iter().map(kept).collect());
    std::thread::scope(|scope| {
        for pool in &pools {
            let (next, rows, wanted, standings) = (&next, &rows, &wanted, &standings);
            scope.spawn(move || {
                while let Some(&k) = wanted.get(next.fetch_add(1, Relaxed)) {
                    if stop.load(Relaxed) {
                        return;
                    }
                    let case = &plan.cases[k];
                    if let Standing::Cut(why) = &standings[k] {
                        tell(&Moment { case: k, remade: Some(why), ..Moment::default() });
                    }
                    let progress =
                        &mut |progress: f64| tell(&Moment { case: k, progress, ..Moment::default() });
                    let row = pool.install(|| run(case, &standings[k], options, stop, progress));
                    let ended = Some(&row.ended);
                    let summary = Some(&row.summary);
                    tell(&Moment { case: k, progress: 1.0, ended, summary, ..Moment::default() });
                    locked(rows)[k] = row;
                }
            });
        }
    });
    Ok(rows.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The row before anything runs.
fn kept(standing: &Standing) -> Row {
    match standing {
        Standing::Finished(summary) => Row { ended: Ended::Kept, summary: summary.clone() },
        _ => Row::without_summary(Ended::NotRun),
    }
}

fn locked(rows: &Mutex<Vec<Row>>) -> MutexGuard<'_, Vec<Row>> {
    rows.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs one case into its folder.
fn run(
    case: &Case,
    standing: &Standing,
    options: &Options<'_>,
    stop: &AtomicBool,
    progress: &mut (dyn FnMut(f64) + Send),
) -> Row {
    let folder = options.out.join(&case.name);
    // What the same case has left, interrupted, failed or cut, would come again, bit for bit.
    if matches!(standing, Standing::Unfinished | Standing::Cut(_))
        && let Err(error) = take_away_run(&folder)
    {
        let message = format!("cannot remove the unfinished run {}: {error}", folder.display());
        return Row::without_summary(Ended::Failed(message));
    }
    let mut tell = |status: &crate::run::Status| progress(status.progress);
    let replaces = matches!(standing, Standing::Foreign(_));
    match crate::run::run(&case.scenario, &folder, replaces, stop, &mut tell) {
        Ok(outcome) if outcome.interrupted => Row::without_summary(Ended::Interrupted),
        Ok(outcome) => Row { ended: Ended::Done, summary: outcome.summary },
        Err(error) => Row::without_summary(Ended::Failed(error.to_string())),
    }
}

/// Writes `text` to a file of the folder at once, so that no half of it is ever seen.
pub(super) fn write(folder: &Path, name: &str, text: &str) -> Result<(), SweepError> {
    let path = folder.join(name);
    write_whole(&path, text.as_bytes()).map_err(|source| SweepError::Write { path, source })
}
