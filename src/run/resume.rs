//! Goes on with the run of a log, into a folder of its own.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3};

use super::folder::RunFolder;
use super::recorder::{Origin, Recorder};
use super::timetable::Timetable;
use super::{Listener, NUMERICS, OBSERVATION_KEY, Outcome, Run, RunError, log_of, older, run};
use crate::record::contents::EarlierPart;
use crate::record::error::LogError;
use crate::record::history::History;
use crate::record::log_at;
use crate::record::reader::{Placed, last_state_and_place};
use crate::record::state::SavedState;
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{AnyScenario, Scenario};
use crate::scenario::{Overrides, parse};
use crate::simulation::Simulation;
use crate::simulation::fit::Misfit;
use crate::simulation::limits::EndReason;
use crate::space::Vector;
use crate::stopwatch::Stopwatch;

/// What of a scenario may change when its run goes on, as paths of keys: its end, what is recorded, and the cure of inelastic
/// collapse, without which some runs could not go on at all.
const MAY_CHANGE: [&[&str]; 3] = [&["run"], &["record"], &["engine", "event_driven", "collapse"]];

/// Why the run of a log cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// The log cannot be used.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A change is wrong, or the scenario in the log is.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A change of something that has to stay.
    #[error(
        "{0}: a run that goes on keeps its scenario; only run.*, record.* and engine.event_driven.collapse may change \
         with --set; for anything else begin a new run, from the grains of this one with initial.positions = {{ log = \"…\" }}"
    )]
    Change(String),
    /// Another version made the bits.
    #[error("{other}: resume it with grainflow {version}", other = .0, version = .0.version)]
    Numerics(#[from] OtherNumerics),
    /// The scenario in the log is another one.
    #[error(
        "the scenario in the log {} is not the one that the log was begun with: its text has another SHA-256 than the \
         metadata say; copy the log again from where it came from", .0.display()
    )]
    OtherScenario(PathBuf),
    /// The new end is already past.
    #[error(
        "the log {} has come to t = {time}, {steps} steps and {collisions:.6} collisions per particle, where run.{limit} ends \
         the run; give a later end: --set run.{limit}=…", path.display()
    )]
    Past {
        /// The log.
        path: PathBuf,
        /// The limit that is reached.
        limit: &'static str,
        /// When its last state was saved [time].
        time: f64,
        /// Steps up to then; none of an engine without steps.
        steps: u64,
        /// Collisions per particle up to then.
        collisions: f64,
    },
}

/// A run that can go on: its log, its scenario, and the last complete state, if there is one.
#[derive(Debug)]
pub struct Resumption {
    log: PathBuf,
    history: History,
    scenario: AnyScenario,
    state: State,
    /// Measures that remember nothing of an older log.
    begun_anew: Vec<&'static str>,
    /// The changes, as on the command line; empty where the scenario stays as it was.
    changes: String,
}

#[derive(Debug)]
enum State {
    Two(Option<Placed<DVec2>>),
    Three(Option<Placed<DVec3>>),
}

impl Resumption {
    /// Reads the log at `path`, a run folder or its log, and applies the `sets` (`key=value`) to its scenario.
    pub fn open(path: &Path, sets: &[String]) -> Result<Self, ResumeError> {
        let log = log_at(path);
        if let Some(refused) = sets.iter().enumerate().find(|(_, set)| !may_change(set)) {
            return Err(ResumeError::Change(format!("--set #{} '{}'", refused.0 + 1, refused.1)));
        }
        let history = History::read(&log)?;
        check_numerics(&log, &history)?;
        if !history.has_own_scenario() {
            return Err(ResumeError::OtherScenario(log));
        }
        let overrides = Overrides { sets: sets.to_vec(), ..Overrides::default() };
        let scenario = scenario_of(&log, &history, &history.scenario, &overrides)?;
        let changed = scenario.source_text() != history.scenario;
        let changes = if changed { sets.join("; ") } else { String::new() };
        let state = match &scenario {
            AnyScenario::Two(_) => State::Two(last_state_and_place(&log)?),
            AnyScenario::Three(_) => State::Three(last_state_and_place(&log)?),
        };
        let begun_anew = match (&scenario, &state) {
            _ if older::observes_alike(history.value(OBSERVATION_KEY)) => Vec::new(),
            (AnyScenario::Two(scenario), State::Two(Some((state, _)))) => begun_anew(scenario, state),
            (AnyScenario::Three(scenario), State::Three(Some((state, _)))) => begun_anew(scenario, state),
            _ => Vec::new(),
        };
        let resumption = Resumption { log, history, scenario, state, begun_anew, changes };
        resumption.check_end()?;
        Ok(resumption)
    }

    /// When the run goes on [time]; `None` where the log holds no complete state, and it begins again.
    pub fn time(&self) -> Option<f64> {
        match &self.state {
            State::Two(state) => state.as_ref().map(|(state, _)| state.time),
            State::Three(state) => state.as_ref().map(|(state, _)| state.time),
        }
    }

    /// The log.
    pub fn log(&self) -> &Path {
        &self.log
    }

    /// What is missing in the log, as a sentence, where it was cut off.
    pub fn cut_off(&self) -> Option<&str> {
        self.history.cut_off.as_deref()
    }

    /// Measures of an older log that begin anew where the run goes on: what they remember has another form now.
    pub fn begun_anew(&self) -> &[&'static str] {
        &self.begun_anew
    }

    /// The folder that it goes into unless somebody wants another one: beside that of the log.
    pub fn usual_folder(&self) -> PathBuf {
        let folder = self.log.parent().and_then(Path::file_name).map(|name| name.to_string_lossy());
        match folder {
            Some(name) => {
                self.log.parent().unwrap_or(Path::new("")).with_file_name(format!("{name}-resumed"))
            }
            None => {
                let value = |key| self.history.value(key);
                PathBuf::from("out").join(format!("{}-{}-resumed", value("scenario"), value("engine")))
            }
        }
    }

    /// Runs into `folder` until the end, or until `stop` turns true. `tell` hears of every step.
    pub fn run(
        self,
        folder: &Path,
        force: bool,
        stop: &AtomicBool,
        tell: Listener<'_>,
    ) -> Result<Outcome, RunError> {
        let Resumption { log, history, scenario, state, changes, .. } = self;
        if matches!(state, State::Two(None) | State::Three(None)) {
            return run(&scenario, folder, force, stop, tell);
        }
        let from = From { log: &log, history: &history, changes };
        rayon::scope(|_| match (&scenario, state) {
            (AnyScenario::Two(scenario), State::Two(Some(state))) => {
                from.resume(scenario, state, (folder, force))?.end_and_write(stop, tell)
            }
            (AnyScenario::Three(scenario), State::Three(Some(state))) => {
                from.resume(scenario, state, (folder, force))?.end_and_write(stop, tell)
            }
            _ => unreachable!("the state was read in the dimension of the scenario"),
        })
    }

    /// A changed end has to come after the state.
    fn check_end(&self) -> Result<(), ResumeError> {
        if !self.changes.split("; ").any(|set| set.trim_start().starts_with("run")) {
            return Ok(());
        }
        let reached = match (&self.scenario, &self.state) {
            (AnyScenario::Two(scenario), State::Two(Some((state, _)))) => self.end_reason(scenario, state)?,
            (AnyScenario::Three(scenario), State::Three(Some((state, _)))) => {
                self.end_reason(scenario, state)?
            }
            _ => None,
        };
        match reached {
            Some((limit, Progress { time, steps, collisions })) => {
                Err(ResumeError::Past { path: self.log.clone(), limit, time, steps, collisions })
            }
            None => Ok(()),
        }
    }

    /// The limit that `state` has reached, and how far it has come.
    fn end_reason<V: Vector>(
        &self,
        scenario: &Scenario<V>,
        state: &SavedState<'_, V>,
    ) -> Result<Option<(&'static str, Progress)>, LogError> {
        let simulation =
            Simulation::resume(scenario, state.clone()).map_err(|misfit| unfit(&self.log, &misfit))?;
        let (steps, collisions) = (state.totals.steps, state.totals.collisions_per_particle);
        let reached = |reason: EndReason| (reason.name(), Progress { time: state.time, steps, collisions });
        Ok(simulation.end_reason().map(reached))
    }
}

/// Measures that cannot take over what an older log remembers in `state`; none where the run cannot go on from it, which it says
/// itself.
fn begun_anew<V: Vector>(scenario: &Scenario<V>, state: &SavedState<'_, V>) -> Vec<&'static str> {
    Simulation::resume(scenario, state.clone())
        .map_or_else(|_| Vec::new(), |simulation| simulation.begun_anew().to_vec())
}

/// How far a run has come: time, steps, collisions per particle.
struct Progress {
    time: f64,
    steps: u64,
    collisions: f64,
}

/// The error for a state in the `log` that its run cannot go on from.
pub(super) fn unfit(log: &Path, misfit: &Misfit) -> LogError {
    LogError::Unfit { path: log.to_owned(), reason: misfit.to_string() }
}

/// Whether `--set` may change this key.
fn may_change(set: &str) -> bool {
    let key = set.split('=').next().unwrap_or_default();
    let path: Vec<&str> = key.split(['.', '[']).map(str::trim).collect();
    MAY_CHANGE.iter().any(|free| path.starts_with(free))
}

/// The scenario of `text` in the `log`, with `overrides`.
pub(super) fn scenario_of(
    log: &Path,
    history: &History,
    text: &str,
    overrides: &Overrides,
) -> Result<AnyScenario, ScenarioError> {
    parse(history.value("scenario"), text, overrides)
        .map_err(|error| ScenarioError { file: format!("the scenario in {}", log.display()), ..error })
}

/// A log of a program that gives trajectories other bits.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the log {} was made with numerics {found} (grainflow {version}), and this is grainflow {} with numerics {NUMERICS}, whose \
     trajectories have other bits", path.display(), env!("CARGO_PKG_VERSION")
)]
pub struct OtherNumerics {
    /// The log.
    pub path: PathBuf,
    /// Its numerics.
    pub found: String,
    /// The version that wrote it.
    pub version: String,
}

/// Whether this program gives the run of `log` the same bits.
pub(super) fn check_numerics(log: &Path, history: &History) -> Result<(), OtherNumerics> {
    if history.value("numerics") == NUMERICS.to_string() {
        return Ok(());
    }
    let (found, version) = (history.value("numerics").to_owned(), history.value("version").to_owned());
    Err(OtherNumerics { path: log.to_owned(), found, version })
}

/// Where a run goes on from.
struct From<'a> {
    log: &'a Path,
    history: &'a History,
    changes: String,
}

impl From<'_> {
    /// The parts of the run that end at `state` at the latest. A log that was killed while it was copied may not have come to
    /// where its last part begins.
    fn parts_before<V: Vector>(&self, state: &SavedState<'_, V>) -> Vec<EarlierPart> {
        let (steps, events) = (state.totals.steps, state.totals.events.all);
        let is_over =
            |part: &EarlierPart| part.time <= state.time && part.steps <= steps && part.events <= events;
        let History { earlier, scenario, .. } = self.history;
        let over = earlier.iter().position(|part| !is_over(part)).unwrap_or(earlier.len());
        let (over, open) = earlier.split_at(over);
        let mut changes: Vec<&str> = open.iter().map(|part| part.changes.as_str()).collect();
        changes.extend((!self.changes.is_empty()).then_some(self.changes.as_str()));
        let mut parts = over.to_vec();
        if !changes.is_empty() {
            let scenario = open.first().map_or(scenario, |part| &part.scenario).clone();
            parts.push(EarlierPart {
                scenario,
                time: state.time,
                steps,
                events,
                changes: changes.join("; "),
            });
        }
        parts
    }

    fn resume<'s, V: Vector>(
        self,
        scenario: &'s Scenario<V>,
        (state, place): Placed<V>,
        (folder, force): (&Path, bool),
    ) -> Result<Run<'s, V>, RunError> {
        let watch = Stopwatch::default();
        let earlier = self.parts_before(&state);
        let changed = earlier != self.history.earlier;
        // Where a part of the run begins, and what it begins with, stands in that state only.
        let begins_part = earlier.last().is_some_and(|part| {
            let (steps, events) = (state.totals.steps, state.totals.events.all);
            (part.time, part.steps, part.events) == (state.time, steps, events)
        });
        let begins_log = state.recordings == 0;
        let (mut simulation, timetable) =
            go_on_with(scenario, state, changed).map_err(|misfit| unfit(self.log, &misfit))?;
        let folder = RunFolder::claim(folder, force)?;
        let origin = Origin {
            log: self.log,
            history: self.history,
            state: place,
            keeps_state: begins_part || begins_log,
            earlier,
        };
        let recorder = Recorder::resume(&log_of(&folder), &mut simulation, timetable, &origin)?;
        Ok(Run { folder, simulation, recorder, watch })
    }
}

/// The simulation that goes on from `state`, and when it is recorded; `changed` where its end or its records are
/// other ones than before.
pub(super) fn go_on_with<'s, V: Vector>(
    scenario: &'s Scenario<V>,
    state: SavedState<'_, V>,
    changed: bool,
) -> Result<(Simulation<'s, V>, Timetable), Misfit> {
    let (recordings, states) = (state.recordings, state.states);
    if !changed {
        let timetable = Timetable::after(&scenario.record, recordings, states);
        return Ok((Simulation::resume(scenario, state)?, timetable));
    }
    let simulation = Simulation::resume_changed(scenario, state)?;
    let timetable = Timetable::from_now(&simulation);
    Ok((simulation, timetable))
}
