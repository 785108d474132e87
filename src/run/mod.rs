//! Runs a scenario into a folder: log, tables, summary, report.

pub mod beginning;
pub mod folder;
mod last_good;
mod looks;
mod older;
mod recorder;
mod rerun;
pub mod resume;
pub(crate) mod series;
mod shown;
mod state_difference;
mod summary;
mod timetable;
pub mod verify;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use serde_json::{Map, Value};

use crate::engine::{EngineError, Horizon, Laps, NoLaps};
use crate::observe::measure::Place;
use crate::observe::moments;
use crate::placing::write_whole;
use crate::record::error::LogError;
use crate::record::reader::{last_state, read_log};
use crate::record::summary::SUMMARY;
use crate::record::{LOG, log_at};
use crate::report;
use crate::scenario::initial::{self, InitialError};
use crate::scenario::model::{AnyScenario, InitialPositions, Scenario, Units};
use crate::simulation::{Simulation, SimulationError};
use crate::space::Vector;
use crate::stopwatch::Stopwatch;
use folder::{FolderError, REPORT, RunFolder};
use recorder::{Recorded, Recorder};
use summary::Ending;

/// Raised whenever a release changes the bits of a trajectory.
pub const NUMERICS: u32 = 2;

/// Raised whenever a release changes what is observed beside the grains, sums and measures, and no trajectory. Verification
/// compares these between logs of one number alone. Logs that do not say it are of number 1; since 2 a wall is given what it
/// carries while grains rest on it.
pub const OBSERVATION: u32 = 2;
/// Where a log says it.
pub(crate) const OBSERVATION_KEY: &str = "observation";

/// Why a run could not be made, or not to its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The initial state cannot be built.
    #[error(transparent)]
    Initial(#[from] InitialError),
    /// The initial state cannot be read from its log.
    #[error("initial.positions: {0}")]
    InitialLog(LogError),
    /// The log of the initial state has none.
    #[error(
        "initial.positions: {} holds no complete state, from which grains could be taken: it was cut off before the first one, \
         or belongs to another program; name the log of a run that has ended", .0.display()
    )]
    InitialState(PathBuf),
    /// The simulation cannot begin: there is no log yet.
    #[error("{0}\nthis was while the grains were equilibrated, before the run: there is no log")]
    Equilibration(SimulationError),
    /// The log cannot be written.
    #[error(transparent)]
    Log(#[from] LogError),
    /// Another file of the run folder cannot be written.
    #[error("cannot write {}: {source}; what was written before is kept", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The simulation cannot go on. The run folder holds everything up to here.
    #[error(
        "{source}\nthe log up to this time is {}{}{}", log.display(), last_state_words(*state),
        continuation(source, log, *state).map_or_else(String::new, |words| format!("\n{words}"))
    )]
    Simulation {
        /// What happened.
        source: SimulationError,
        /// The log.
        log: PathBuf,
        /// When its last state was, that before the step which failed [time]: report and summary are of the run up to there.
        /// `None` where it could not be found again; then there are none.
        state: Option<f64>,
    },
}

fn last_state_words(state: Option<f64>) -> String {
    let words = |time| {
        format!(
            ", with the state before that, at t = {time}; {REPORT} and {SUMMARY} beside it show the run up to there"
        )
    };
    state.map_or_else(String::new, words)
}

/// How a run that `source` has ended goes on from the last `state` of its `log`, where another cure of collapse lets it.
fn continuation(source: &SimulationError, log: &Path, state: Option<f64>) -> Option<String> {
    let SimulationError::Engine(EngineError::Collapse { remedy, .. }) = source else { return None };
    state?;
    let folder = log.parent().unwrap_or(Path::new("."));
    Some(format!(
        "with a cure it goes on from that state:\n  grainflow run --resume '{}' --set \
         'engine.event_driven.collapse={remedy}'",
        folder.display()
    ))
}

impl RunError {
    /// Whether the input is at fault, rather than the run.
    pub fn is_bad_input(&self) -> bool {
        match self {
            RunError::Folder(error) => error.is_bad_input(),
            RunError::Initial(_)
            | RunError::InitialLog(_)
            | RunError::InitialState(_)
            | RunError::Log(LogError::Unfit { .. }) => true,
            _ => false,
        }
    }
}

/// How a run looks from outside while it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Share of the run that is done, in [0, 1].
    pub progress: f64,
    /// Simulated time [time].
    pub time: f64,
    /// Collisions per particle so far.
    pub collisions_per_particle: f64,
    /// Grains now.
    pub grains: usize,
    /// Particle-steps so far; 0 for engines without steps.
    pub particle_steps: u64,
    /// Events so far; 0 for engines with steps.
    pub events: u64,
}

/// What a finished run leaves.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The folder with everything in it.
    pub folder: PathBuf,
    /// The summary.
    pub summary: Map<String, Value>,
    /// Names of its units.
    pub units: Units,
    /// Whether somebody stopped the run before its end.
    pub interrupted: bool,
    /// Seconds of each verb of the algorithm.
    pub laps: Vec<(&'static str, f64)>,
}

/// Hears of every step.
pub type Listener<'a> = &'a mut (dyn FnMut(&Status) + Send);

/// Runs `scenario`, with as many recordings as its `record.share` lets it have, into `folder` until its end, or until `stop` turns
/// true. `tell` hears of every step.
pub fn run(
    scenario: &AnyScenario,
    folder: &Path,
    force: bool,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Outcome, RunError> {
    let scenario = scenario.clone().with_affordable_recordings();
    // On a thread of the pool, parallel calls need not wake anybody to begin.
    rayon::scope(|_| match &scenario {
        AnyScenario::Two(scenario) => run_in(scenario, folder, force, stop, tell),
        AnyScenario::Three(scenario) => run_in(scenario, folder, force, stop, tell),
    })
}

fn run_in<V: Vector>(
    scenario: &Scenario<V>,
    folder: &Path,
    force: bool,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Outcome, RunError> {
    let mut watch = Stopwatch::default();
    watch.start(INITIAL_STATE);
    let gas = initial_gas(scenario)?;
    let folder = RunFolder::claim(folder, force)?;
    if scenario.initial.equilibrate > 0.0 {
        watch.start(EQUILIBRATION);
    }
    let mut simulation = match Simulation::start(scenario, gas, &mut NoLaps) {
        Ok(simulation) => simulation,
        Err(error) => {
            folder.abandon();
            return Err(RunError::Equilibration(error));
        }
    };
    let recorder = Recorder::create(&log_of(&folder), &mut simulation)?;
    Run { folder, simulation, recorder, watch }.end_and_write(stop, tell)
}

/// The making of the initial state, in the laps of a run.
const INITIAL_STATE: &str = "initial state";
/// Elastic collisions before the run begins.
const EQUILIBRATION: &str = "equilibration";
/// Recordings and states, until they are written.
const RECORDING: &str = "recording";

/// Where the log of a run in `folder` stands.
fn log_of(folder: &RunFolder) -> PathBuf {
    folder.path().join(LOG)
}

/// A run that has begun, or goes on.
struct Run<'s, V: Vector> {
    folder: RunFolder,
    simulation: Simulation<'s, V>,
    recorder: Recorder,
    watch: Stopwatch,
}

impl<V: Vector> Run<'_, V> {
    /// Goes on until an end is reached or `stop` turns true, and writes all files.
    fn end_and_write(self, stop: &AtomicBool, tell: Listener<'_>) -> Result<Outcome, RunError> {
        let Run { folder, mut simulation, mut recorder, mut watch } = self;
        let ended = go_on(&mut simulation, &mut recorder, &mut watch, stop, tell);
        watch.start(RECORDING);
        let ending = match ended {
            Ok(ending) => ending,
            Err(StepError::Log(error)) => return Err(error.into()),
            Err(StepError::Simulation(source, before)) => {
                let failed = Failed { source, before };
                return Err(failed.write(&folder, &simulation, recorder, &watch, stop)?);
            }
        };
        let recorded = recorder.finish(&mut simulation)?;
        watch.stop();
        let summary = write_files(&folder, &mut simulation, ending, &watch, &recorded)?;
        let folder = folder.settle()?;
        let units = simulation.scenario().units.clone();
        Ok(Outcome {
            folder,
            summary,
            units,
            interrupted: ending == Ending::Interrupted,
            laps: watch.laps().to_vec(),
        })
    }
}

/// A step that could not be made, and where the run was before it.
struct Failed {
    source: SimulationError,
    before: Place,
}

impl Failed {
    /// Ends log, tables, summary and report at the state before the step. The error of the run, or that of writing.
    fn write<V: Vector>(
        self,
        folder: &RunFolder,
        simulation: &Simulation<'_, V>,
        recorder: Recorder,
        watch: &Stopwatch,
        stop: &AtomicBool,
    ) -> Result<RunError, RunError> {
        let Failed { source, before } = self;
        let log = log_of(folder);
        let last = recorder.finish_after_failure(simulation.scenario(), before, stop)?;
        let state = last.is_some().then_some(before.time);
        if let Some((recorded, there)) = last {
            let mut there = there.in_place_of(simulation.resumed());
            let continuation = continuation(&source, &log, state);
            let why =
                [Some(source.to_string()), continuation].into_iter().flatten().collect::<Vec<_>>().join("\n");
            write_files(folder, &mut there, Ending::Failed(&why), watch, &recorded)?;
        }
        Ok(RunError::Simulation { source, log, state })
    }
}

/// Writes what stands beside the log: tables, report, and at last the summary, which it returns.
fn write_files<V: Vector>(
    folder: &RunFolder,
    simulation: &mut Simulation<'_, V>,
    ending: Ending<'_>,
    watch: &Stopwatch,
    recorded: &Recorded,
) -> Result<Map<String, Value>, RunError> {
    simulation.audit();
    let summary = summary::summary(simulation, ending, watch, &recorded.figures);
    series::write_tables(folder.path(), simulation.scenario(), recorded)?;
    write_text(&folder.path().join(REPORT), &report::render(&read_log(&log_of(folder))?, &summary))?;
    // The last one: where it stands, the folder is complete.
    write_text(&folder.path().join(SUMMARY), &(pretty(&summary) + "\n"))?;
    Ok(summary)
}

/// Why a step or its recording failed.
enum StepError {
    /// And where it was before the step.
    Simulation(SimulationError, Place),
    Log(LogError),
}

/// Record, advance, until an end is reached or asked for.
fn go_on<V: Vector>(
    simulation: &mut Simulation<'_, V>,
    recorder: &mut Recorder,
    watch: &mut Stopwatch,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<Ending<'static>, StepError> {
    let mut stops = false;
    loop {
        watch.start(RECORDING);
        recorder.record_if_due(simulation).map_err(StepError::Log)?;
        tell(&status(simulation));
        if let Some(reason) = simulation.end_reason() {
            return Ok(Ending::Reached(reason));
        }
        if stops || stop.load(Relaxed) && !simulation.is_event_driven() {
            return Ok(Ending::Interrupted);
        }
        let mut horizon = recorder.horizon(simulation);
        if stop.load(Relaxed) {
            // Without steps a run stops at a time, which a re-run will find again.
            let time = simulation.gas().time().next_up();
            (stops, horizon) = (true, horizon.min(Horizon { time, ..Horizon::NONE }));
        }
        let before = simulation.observation().1.place();
        simulation.advance(watch, horizon).map_err(|error| StepError::Simulation(error, before))?;
    }
}

/// How `simulation` looks from outside.
pub(crate) fn status<V: Vector>(simulation: &Simulation<'_, V>) -> Status {
    Status {
        progress: simulation.progress(),
        time: simulation.gas().time(),
        collisions_per_particle: simulation.totals().collisions_per_particle,
        grains: simulation.gas().len(),
        particle_steps: simulation.totals().particle_steps,
        events: simulation.totals().events.all,
    }
}

/// Whether the grains that `scenario` begins with can be had: those of a log may not.
pub fn check_beginning(scenario: &AnyScenario) -> Result<(), RunError> {
    match scenario {
        AnyScenario::Two(scenario) if scenario.initial.positions.is_log() => initial_gas(scenario).map(drop),
        AnyScenario::Three(scenario) if scenario.initial.positions.is_log() => {
            initial_gas(scenario).map(drop)
        }
        _ => Ok(()),
    }
}

/// The gas that the scenario begins with, read from a log if it says so.
pub(crate) fn initial_gas<V: Vector>(scenario: &Scenario<V>) -> Result<crate::matter::gas::Gas<V>, RunError> {
    let saved = match &scenario.initial.positions {
        InitialPositions::Log(path) => {
            let log = log_at(path);
            let state = last_state::<V>(&log).map_err(RunError::InitialLog)?;
            let state = state.ok_or(RunError::InitialState(log))?;
            Some(state.columns.into_owned())
        }
        _ => None,
    };
    Ok(initial::build(scenario, saved)?)
}

/// Writes a file of a run folder, whole or not at all.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), RunError> {
    write_whole(path, text.as_bytes()).map_err(|source| RunError::Write { path: path.to_owned(), source })
}

fn pretty(summary: &Map<String, Value>) -> String {
    serde_json::to_string_pretty(summary).expect("a map of numbers and texts is JSON")
}

/// Momentum that got lost, relative to Σ m|v(0)|; only a closed box without gravity keeps it.
fn momentum_drift<V: Vector>(simulation: &Simulation<'_, V>) -> Option<f64> {
    let scenario = simulation.scenario();
    let closed = scenario.boundary.is_fully_periodic() && scenario.gravity == V::ZERO;
    let beginning = simulation.beginning();
    (closed && beginning.momentum_scale > 0.0).then(|| {
        (moments::momentum(simulation.gas()) - beginning.momentum).length() / beginning.momentum_scale
    })
}
