//! Runs the scenario of a log again and says whether every recording and every state comes out the same, bit for bit.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use super::rerun::{Reached, Rerun};
use super::resume::{OtherNumerics, check_numerics, scenario_of};
use super::state_difference::{first_difference, grain_in_picture, said, same};
use super::{Listener, OBSERVATION_KEY, RunError, older};
use crate::matter::state_hash::state_hash;
use crate::record::checkpoints::{Checkpoint, each_checkpoint};
use crate::record::contents::Frame;
use crate::record::error::{LogError, numbers};
use crate::record::frame::frame;
use crate::record::history::History;
use crate::record::log_at;
use crate::record::state::SavedState;
use crate::scenario::Overrides;
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{AnyScenario, Scenario};
use crate::simulation::fit::Misfit;
use crate::space::Vector;

/// Why a log cannot be verified.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// The log cannot be used.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The scenario in it is wrong.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The run cannot begin again.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Another version made the bits.
    #[error("{other}: verify it with grainflow {version}", other = .0, version = .0.version)]
    Numerics(#[from] OtherNumerics),
    /// Parts of the scenario are in other dimensions.
    #[error("the log {} has parts in two and in three dimensions: it is not as it was written", .0.display())]
    Dimensions(PathBuf),
    /// It holds nothing yet.
    #[error(
        "the log {} holds neither a recording nor a state: there is nothing to verify; it was cut off before anything was \
         complete", .0.display()
    )]
    Nothing(PathBuf),
    /// Something was lost before the log was recovered.
    #[error(
        "the log {} was recovered from a damaged one, and {} missing: up to t = {} it is identical ({} hashes, {} states), \
         of what follows nothing can be said", path.display(), numbers(topic, missing.start, missing.end - 1), extent.time,
         extent.hashes, extent.states
    )]
    Hole {
        /// The log.
        path: PathBuf,
        /// Where the messages belong.
        topic: String,
        /// Which are missing.
        missing: Range<u32>,
        /// What was verified before.
        extent: Extent,
    },
}

/// How much was found identical.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// State hashes of recordings.
    pub hashes: u64,
    /// Full-precision states.
    pub states: u64,
    /// Σ N over the steps that were made; 0 for engines without steps.
    pub particle_steps: u64,
    /// Events; 0 for engines with steps.
    pub events: u64,
    /// Up to when [time].
    pub time: f64,
    /// Parts of the run that it reaches into, each with its own scenario.
    pub parts: usize,
}

/// What comes out of a verification.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Everything is identical; a sentence about what is missing, where the log was cut off.
    Identical(Extent, Option<String>),
    /// The first difference, after what was identical.
    Different(Extent, String),
    /// Somebody stopped it.
    Interrupted(Extent),
}

/// Verifies the log at `path`, a run folder or its log, until `stop` turns true. `tell` hears of every step.
pub fn verify(path: &Path, stop: &AtomicBool, tell: Listener<'_>) -> Result<Verdict, VerifyError> {
    let log = log_at(path);
    let history = History::read(&log)?;
    check_numerics(&log, &history)?;
    let texts = history.earlier.iter().map(|part| part.scenario.as_str()).chain([history.scenario.as_str()]);
    let mut parts = Vec::new();
    for text in texts {
        parts.push(scenario_of(&log, &history, text, &Overrides::default())?);
    }
    if let Some(difference) = parts.last().and_then(|scenario| stranger(&history, scenario)) {
        return Ok(Verdict::Different(Extent::default(), difference));
    }
    let (mut two, mut three) = (Vec::new(), Vec::new());
    for part in parts {
        match part {
            AnyScenario::Two(scenario) => two.push(scenario),
            AnyScenario::Three(scenario) => three.push(scenario),
        }
    }
    rayon::scope(|_| match (two.is_empty(), three.is_empty()) {
        (false, true) => verify_in(&log, &history, &two, stop, tell),
        (true, false) => verify_in(&log, &history, &three, stop, tell),
        _ => Err(VerifyError::Dimensions(log.clone())),
    })
}

/// What tells that the scenario is not the one that the log was begun with, before anything runs.
fn stranger(history: &History, scenario: &AnyScenario) -> Option<String> {
    let (seed, dimension) = match scenario {
        AnyScenario::Two(scenario) => (scenario.seed, 2),
        AnyScenario::Three(scenario) => (scenario.seed, 3),
    };
    let own = [
        ("seed", seed.to_string()),
        ("engine", scenario.engine().name().to_owned()),
        ("dimension", dimension.to_string()),
    ];
    let other = own.into_iter().find(|(key, value)| history.value(key) != value);
    if let Some((key, value)) = other {
        return Some(format!(
            "the log was made with {key} {}, and the scenario in it says {value}: it is another one",
            history.value(key)
        ));
    }
    (!history.has_own_scenario()).then(|| {
        "the scenario in the log is another one than it was begun with: its text has another SHA-256 than the metadata say"
            .to_owned()
    })
}

fn verify_in<V: Vector>(
    log: &Path,
    history: &History,
    parts: &[Scenario<V>],
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Verdict, VerifyError> {
    let same_version = history.value("version") == env!("CARGO_PKG_VERSION");
    let observes_alike = same_version && older::observes_alike(history.value(OBSERVATION_KEY));
    let rerun = Rerun::new(log, parts, &history.earlier, stop, tell);
    let mut check = Check {
        rerun,
        observes_alike,
        columns: Vec::new(),
        extent: Extent::default(),
        parted: None,
        end: None,
    };
    each_checkpoint(log, &mut |checkpoint| check.take(checkpoint))?;
    let extent = check.extent;
    match (check.end, check.parted) {
        (Some(End::Hole(topic, missing)), _) => {
            Err(VerifyError::Hole { path: log.to_owned(), topic, missing, extent })
        }
        (Some(End::Failed(error)), _) => Err(error.into()),
        (Some(End::Interrupted), _) => Ok(Verdict::Interrupted(extent)),
        (Some(End::Different(difference)), _) | (None, Some(difference)) => {
            Ok(Verdict::Different(extent, difference))
        }
        (None, None) if extent.hashes + extent.states == 0 => Err(VerifyError::Nothing(log.to_owned())),
        (None, None) => Ok(Verdict::Identical(extent, history.cut_off.clone())),
    }
}

/// Why a check does not go on.
enum End {
    Different(String),
    Hole(String, Range<u32>),
    Failed(RunError),
    Interrupted,
}

/// A log that is held against a re-run.
struct Check<'s, V: Vector> {
    rerun: Rerun<'s, V>,
    /// Whether sums and measures are those of the log.
    observes_alike: bool,
    /// Names of the columns in the log.
    columns: Vec<String>,
    extent: Extent,
    /// What to say of a recording with another hash, if its picture shows no grain that differs.
    parted: Option<String>,
    end: Option<End>,
}

impl<V: Vector> Check<'_, V> {
    /// Checks one thing; returns whether to go on.
    fn take(&mut self, checkpoint: Checkpoint<V>) -> bool {
        let done = match checkpoint {
            Checkpoint::Frame(frame) => self.frame(&frame),
            // A recording without a picture: what its hash says is all there is.
            _ if self.parted.is_some() => Err(End::Different(self.parted.take().unwrap_or_default())),
            Checkpoint::Columns(columns) => {
                self.columns = columns;
                Ok(())
            }
            Checkpoint::Hole { topic, missing } => Err(End::Hole(topic, missing)),
            Checkpoint::Recording { values, state_hash, grains } => {
                self.recording(&values, &state_hash, grains)
            }
            Checkpoint::State(state) => self.begin(&state).and_then(|()| {
                let unlike = |misfit: Misfit| End::Different(misfit.to_string());
                self.reach(
                    state.time,
                    self.rerun.is_interruption(&self.without_old_memories(&state)).map_err(unlike)?,
                )?;
                let compared = self.rerun.state(state.totals.steps, state.totals.events.all, |rerun| {
                    first_difference(&state, rerun, self.observes_alike)
                });
                self.count(compared.map_err(unlike)?, |extent| extent.states += 1)
            }),
        };
        self.end = done.err();
        self.end.is_none()
    }

    fn begin(&mut self, state: &SavedState<'static, V>) -> Result<(), End> {
        let state = self.without_old_memories(state);
        self.rerun.begin(Some(&state)).map_err(End::Failed)
    }

    /// The state to go on from: what measures of another release remember is left out.
    fn without_old_memories(&self, state: &SavedState<'static, V>) -> SavedState<'static, V> {
        let mut state = state.clone();
        if !self.observes_alike {
            state.memories.clear();
            state.samples.clear();
        }
        state
    }

    fn recording(&mut self, values: &[f64], hash: &str, grains: u64) -> Result<(), End> {
        self.rerun.begin(None).map_err(End::Failed)?;
        let time = values.first().copied().unwrap_or(f64::NAN);
        self.reach(time, false)?;
        let (columns, row, is_full) = self.rerun.recording(!hash.is_empty());
        let gas = self.rerun.gas();
        if hash.is_empty() && !is_full {
            let difference = self.observes_alike.then(|| self.first_column(values, &columns, &row)).flatten();
            return self.count(difference, |_| ());
        }
        if state_hash(gas) != hash {
            let difference = match gas.len() as u64 {
                rerun if rerun != grains => said("the number of grains", grains, rerun),
                _ => said("the state hash", hash, state_hash(gas)),
            };
            self.parted = Some(self.at(difference));
            return Ok(());
        }
        let difference = self.observes_alike.then(|| self.first_column(values, &columns, &row)).flatten();
        self.count(difference, |extent| extent.hashes += 1)
    }

    /// The first column that differs, among those that both have.
    fn first_column(&self, values: &[f64], columns: &[String], row: &[f64]) -> Option<String> {
        self.columns.iter().zip(values).find_map(|(name, &value)| {
            let place = columns.iter().position(|column| column == name)?;
            (!same(&[value], &[row[place]])).then(|| said(name, value, row[place]))
        })
    }

    /// A picture shows which grain differs, if it is precise enough.
    fn frame(&mut self, log: &Frame) -> Result<(), End> {
        let Some(parted) = self.parted.take() else { return Ok(()) };
        let gas = self.rerun.gas();
        let grain = grain_in_picture(log, &frame(gas.time(), gas.columns(), None));
        Err(End::Different(grain.map_or(parted, |grain| self.at(grain))))
    }

    fn reach(&mut self, time: f64, stops: bool) -> Result<(), End> {
        match self.rerun.advance_to(time, stops) {
            Reached::Here => Ok(()),
            Reached::Interrupted => Err(End::Interrupted),
            Reached::Not(difference) => Err(End::Different(difference)),
        }
    }

    /// Counts what is identical, or ends.
    fn count(&mut self, difference: Option<String>, add: impl Fn(&mut Extent)) -> Result<(), End> {
        if let Some(difference) = difference {
            return Err(End::Different(self.at(difference)));
        }
        add(&mut self.extent);
        (self.extent.particle_steps, self.extent.events) = self.rerun.work();
        self.extent.time = self.rerun.gas().time();
        self.extent.parts = self.rerun.parts_begun();
        Ok(())
    }

    /// The difference with its time.
    fn at(&self, difference: String) -> String {
        let gas = self.rerun.gas();
        let hint = if self.extent.hashes == 0 {
            "; the very beginning differs: the scenario or its seed is not that of the run"
        } else {
            ""
        };
        format!("at t = {:?}, {difference}{hint}", gas.time())
    }
}
