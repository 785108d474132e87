//! The runs of a comparison: every initial state through every engine, one replica after another or side by side.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering::SeqCst};

use serde_json::{Map, Value};

use super::plan::Plan;
use super::{CompareError, write_text};
use crate::campaign::pools::pools;
use crate::machine::forget_peak_memory;
use crate::run::beginning::write_beginning;
use crate::run::{RunError, Status, run};

/// One run of a comparison.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// Which engine.
    pub(super) contestant: usize,
    /// Which initial state, counted from 1.
    pub(super) replica: u32,
    /// Its folder, seen from the comparison's.
    pub(super) folder: String,
    /// What became of it.
    pub(super) ending: Ending,
}

impl Run {
    /// The summary, where it came to its end.
    pub(super) fn summary(&self) -> Option<&Map<String, Value>> {
        match &self.ending {
            Ending::Complete(summary) => Some(summary),
            _ => None,
        }
    }

    /// Why it has no end, as a sentence; nothing where it has one.
    pub(super) fn failure(&self) -> Option<String> {
        match &self.ending {
            Ending::Complete(_) => None,
            Ending::Interrupted => {
                Some(format!("replica {} was interrupted, and is not compared", self.replica))
            }
            Ending::Failed(reason) => Some(format!("replica {}: {reason}", self.replica)),
        }
    }
}

/// What became of a run.
#[derive(Clone, Debug)]
pub(super) enum Ending {
    /// It came to its end, with this summary.
    Complete(Map<String, Value>),
    /// Somebody stopped it.
    Interrupted,
    /// It could not go on, and why.
    Failed(String),
}

/// How a comparison looks from outside while it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<'a> {
    /// The engine at work.
    pub engine: &'a str,
    /// Its initial state, counted from 1.
    pub replica: u32,
    /// Initial states in all.
    pub replicas: u32,
    /// Share of the whole comparison that is done, in [0, 1].
    pub progress: f64,
    /// How the run goes.
    pub status: Status,
}

/// Hears of every step, from several threads where replicas run side by side.
pub type Listener<'a> = &'a (dyn Fn(&Moment<'_>) + Sync);

/// What all runs share.
pub(super) struct Runs<'a> {
    pub(super) plan: &'a Plan,
    /// The comparison's folder.
    pub(super) folder: &'a Path,
    /// Replicas side by side.
    pub(super) jobs: usize,
    pub(super) stop: &'a AtomicBool,
    pub(super) tell: Listener<'a>,
    /// Runs that have ended.
    pub(super) done: AtomicUsize,
}

impl Runs<'_> {
    /// Makes all of them, in the order of replicas and engines; fewer where somebody stops them.
    pub(super) fn all(&self) -> Result<Vec<Run>, CompareError> {
        let mut runs = match self.jobs {
            1 => self.some(&AtomicU32::new(1))?,
            jobs => self.side_by_side(jobs)?,
        };
        runs.sort_by_key(|run| (run.replica, run.contestant));
        Ok(runs)
    }

    /// Replicas on `jobs` groups of threads, each of which takes the next one when it is free.
    fn side_by_side(&self, jobs: usize) -> Result<Vec<Run>, CompareError> {
        let pools = pools(rayon::current_num_threads(), jobs)?;
        let next = AtomicU32::new(1);
        let gathered = Mutex::new(Ok(Vec::new()));
        std::thread::scope(|scope| {
            for pool in pools {
                let (next, gathered) = (&next, &gathered);
                scope.spawn(move || {
                    let result = pool.install(|| self.some(next));
                    if result.is_err() {
                        // The others end the replica that they are at.
                        next.store(u32::MAX, SeqCst);
                    }
                    let mut all = gathered.lock().expect("nobody panics while holding it");
                    match (&mut *all, result) {
                        (Ok(runs), Ok(more)) => runs.extend(more),
                        (Ok(_), Err(error)) => *all = Err(error),
                        (Err(_), _) => {}
                    }
                });
            }
        });
        gathered.into_inner().expect("nobody panics while holding it")
    }

    /// Takes replica after replica from `next` until there are no more.
    fn some(&self, next: &AtomicU32) -> Result<Vec<Run>, CompareError> {
        let mut runs = Vec::new();
        loop {
            let taken = next.fetch_update(SeqCst, SeqCst, |replica| replica.checked_add(1));
            let replica = taken.unwrap_or(u32::MAX);
            if replica > self.plan.replicas() || self.stop.load(SeqCst) {
                return Ok(runs);
            }
            self.replica(replica, &mut runs)?;
        }
    }

    /// One initial state through every engine.
    fn replica(&self, replica: u32, runs: &mut Vec<Run>) -> Result<(), CompareError> {
        let beginning = format!("initial-{replica}/log.mcap");
        write_beginning(&self.plan.beginning(replica)?, &self.folder.join(&beginning))?;
        for (contestant, engine) in self.plan.engines().enumerate() {
            if self.stop.load(SeqCst) {
                break;
            }
            let folder = format!("{}-{replica}", engine.name());
            let scenario = self.plan.contestant(contestant, replica, self.folder, &beginning)?;
            write_text(&self.folder.join(format!("{folder}.toml")), scenario.source_text())?;
            if self.jobs == 1 {
                forget_peak_memory();
            }
            let mut tell = |status: &Status| self.hear(engine.name(), replica, status);
            let result = run(&scenario, &self.folder.join(&folder), false, self.stop, &mut tell);
            runs.push(Run { contestant, replica, folder, ending: ending(result)? });
            self.done.fetch_add(1, SeqCst);
        }
        Ok(())
    }

    fn hear(&self, engine: &str, replica: u32, status: &Status) {
        let (done, replicas) = (self.done.load(SeqCst) as f64, self.plan.replicas());
        let runs = f64::from(replicas) * self.plan.engines().len() as f64;
        let progress = (done + status.progress) / runs;
        (self.tell)(&Moment { engine, replica, replicas, progress, status: *status });
    }
}

/// A run that cannot go on is a finding about its engine; one that cannot be written or begun is an error.
fn ending(result: Result<crate::run::Outcome, RunError>) -> Result<Ending, CompareError> {
    match result {
        Ok(outcome) if outcome.interrupted => Ok(Ending::Interrupted),
        Ok(outcome) => Ok(Ending::Complete(outcome.summary)),
        Err(RunError::Simulation { source, .. }) => Ok(Ending::Failed(source.to_string())),
        Err(error) => Err(error.into()),
    }
}
