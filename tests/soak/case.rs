//! One case: a drawn scenario runs straight, with other threads, with an interruption, and into a log, and all of
//! these have to agree.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use grainflow::engine::report::{Counts, Totals};
use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::state_hash::state_hash;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::observe::moments;
use grainflow::record::reader::{last_state, read_log};
use grainflow::record::time_scale::time_scale;
use grainflow::record::writer::{LogHeader, LogWriter};
use grainflow::run::{RunError, run};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::{Simulation, SimulationError};
use grainflow::space::Vector;

use super::draw::{Dice, Units, scenario_text};
use super::laws::{Laws, ordered};

/// What came of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It ran, and collided so often.
    Held(u64),
    /// The scenario says why it is none; engines need not bear it.
    Refused,
}

/// The end of a simulation.
#[derive(Clone, Debug, PartialEq)]
struct End {
    state_hash: String,
    /// All sums, as text: the shortest decimal that reads back the same, so that equal text is equal bits.
    totals: String,
    /// The same without sums of momentum: those of an engine without steps are added up between looks, and depend
    /// on these in their last digit.
    counts: String,
    /// Why it could not go on.
    error: Option<String>,
    collisions: u64,
    calls: u64,
}

/// What every step left: time, hash and energy.
type Trace = Vec<(u64, String, u64)>;

/// Runs the scenario number `seed` in every way; the message says what does not hold.
pub(crate) fn check(seed: u64) -> Result<Verdict, String> {
    let text = &scenario_text(seed, Units::ONE);
    match parse("soak", text, &Overrides::default()) {
        Err(error) => {
            // A text that is not understood at all would test nothing.
            let known = error.to_string().contains("do not fit") || error.to_string().contains("too long");
            if known { Ok(Verdict::Refused) } else { Err(format!("is refused: {error}")) }
        }
        Ok(scenario) => match &scenario {
            AnyScenario::Two(inner) => check_in(seed, &scenario, inner),
            AnyScenario::Three(inner) => check_in(seed, &scenario, inner),
        },
    }
}

fn check_in<V: Vector>(seed: u64, any: &AnyScenario, scenario: &Scenario<V>) -> Result<Verdict, String> {
    let mut dice = Dice::new(!seed);
    let place = tempfile::tempdir().map_err(|error| error.to_string())?;
    if initial::build(scenario, None).is_err() {
        return Ok(Verdict::Refused);
    }
    let (straight, trace) = with_threads(1, || straight(scenario))?;
    let threads = 2 + dice.below(6);
    let shared = with_threads(threads, || interrupted(scenario, None))?;
    same("with other threads", &shared, &straight)?;
    let at = 1 + dice.below(straight.calls.max(2) as usize - 1) as u64;
    let log = place.path().join("state.mcap");
    let resumed = with_threads(2, || interrupted(scenario, Some((at, &log))))?;
    same("after an interruption", &resumed, &straight)?;
    with_threads(threads, || into_a_log(any, scenario, &place.path().join("run"), &straight, &trace))?;
    with_threads(1, || super::scaling::check_units(seed, scenario))?;
    Ok(Verdict::Held(straight.collisions))
}

fn with_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<T, String> + Send,
) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| error.to_string())?.install(work)
}

fn same(how: &str, found: &End, expected: &End) -> Result<(), String> {
    let alike = (&found.state_hash, &found.totals, &found.error)
        == (&expected.state_hash, &expected.totals, &expected.error);
    if alike { Ok(()) } else { Err(format!("{how}: {found:?}\nin place of {expected:?}")) }
}

fn start<V: Vector>(scenario: &Scenario<V>) -> Result<Result<Simulation<'_, V>, SimulationError>, String> {
    let gas = initial::build(scenario, None).map_err(|error| format!("initial state: {error}"))?;
    Ok(Simulation::start(scenario, gas, &mut NoLaps))
}

/// The end of `simulation` that was advanced so often, by itself or with `error`.
fn end_of<V: Vector>(simulation: &Simulation<'_, V>, error: Option<String>, calls: u64) -> End {
    let totals = simulation.totals();
    End {
        state_hash: state_hash(simulation.gas()),
        totals: format!("{totals:?}"),
        counts: counts_of(totals),
        error,
        collisions: totals.counts.collisions,
        calls,
    }
}

fn counts_of<V: Vector>(totals: &Totals<V>) -> String {
    let counts = Counts { wall_momentum: [[V::ZERO; 2]; 3], carried_momentum: 0.0, ..totals.counts };
    format!("{:?}", Totals { counts, ..totals.clone() })
}

fn failed_start(error: &SimulationError) -> End {
    End {
        state_hash: String::new(),
        totals: String::new(),
        counts: String::new(),
        error: Some(error.to_string()),
        collisions: 0,
        calls: 0,
    }
}

/// From start to end, with a look at every law after each step.
fn straight<V: Vector>(scenario: &Scenario<V>) -> Result<(End, Trace), String> {
    let mut simulation = match start(scenario)? {
        Ok(simulation) => simulation,
        Err(error) => return Ok((failed_start(&error), Vec::new())),
    };
    ordered(simulation.gas())?;
    let mut laws = Laws::of(scenario, simulation.gas());
    let mut trace = vec![print_of(&simulation)];
    let (mut calls, mut error) = (0, None);
    while error.is_none() && simulation.end_reason().is_none() {
        error = simulation.advance(&mut NoLaps, Horizon::NONE).err().map(|error| error.to_string());
        if error.is_none() {
            calls += 1;
            laws.check(&simulation).map_err(|problem| format!("after step {calls}: {problem}"))?;
            trace.push(print_of(&simulation));
        }
    }
    Ok((end_of(&simulation, error, calls), trace))
}

fn print_of<V: Vector>(simulation: &Simulation<'_, V>) -> (u64, String, u64) {
    let gas = simulation.gas();
    (gas.time().to_bits(), state_hash(gas), moments::kinetic_energy(gas).to_bits())
}

/// From start to end; after the given number of steps the state goes through a log and a new simulation.
fn interrupted<V: Vector>(scenario: &Scenario<V>, at: Option<(u64, &Path)>) -> Result<End, String> {
    let mut simulation = match start(scenario)? {
        Ok(simulation) => simulation,
        Err(error) => return Ok(failed_start(&error)),
    };
    let (mut calls, mut error) = (0, None);
    while error.is_none() && simulation.end_reason().is_none() {
        error = simulation.advance(&mut NoLaps, Horizon::NONE).err().map(|error| error.to_string());
        calls += 1;
        if let Some((at, log)) = at
            && calls == at
            && error.is_none()
        {
            simulation = through_log(&simulation, log)?;
        }
    }
    Ok(end_of(&simulation, error, calls))
}

fn through_log<'s, V: Vector>(
    simulation: &Simulation<'s, V>,
    log: &Path,
) -> Result<Simulation<'s, V>, String> {
    let time = Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } };
    let header =
        LogHeader { columns: vec![time], time_scale: time_scale(f64::INFINITY, 0.0), ..LogHeader::default() };
    let saved = simulation.saved_state(7, 2);
    let told = |error: grainflow::record::error::LogError| error.to_string();
    let mut writer = LogWriter::create(log, &header).map_err(told)?;
    writer.state(&saved).map_err(told)?;
    writer.finish().map_err(told)?;
    let read = last_state::<V>(log).map_err(told)?.ok_or("the state is not in the log")?;
    // As text: a measure may remember what is not a number, and that equals nothing.
    if format!("{read:?}") != format!("{saved:?}") {
        return Err("the state does not come back from the log as it was".to_owned());
    }
    let resumed = Simulation::resume(simulation.scenario(), read).map_err(|misfit| misfit.to_string())?;
    let again = format!("{:?}", resumed.saved_state(7, 2));
    if again != format!("{saved:?}") {
        return Err(format!("the simulation that goes on has another state: {again}\nin place of {saved:?}"));
    }
    Ok(resumed)
}

/// The run into a folder leaves a log that holds the same run.
fn into_a_log<V: Vector>(
    any: &AnyScenario,
    scenario: &Scenario<V>,
    folder: &Path,
    straight: &End,
    trace: &Trace,
) -> Result<(), String> {
    let result = run(any, folder, false, &AtomicBool::new(false), &mut |_| {});
    let log = folder.join("log.mcap");
    match (result, &straight.error) {
        (Err(RunError::Equilibration(error)), Some(expected)) if error.to_string() == *expected => {
            return Ok(());
        }
        (Err(RunError::Simulation { source, .. }), Some(expected)) if source.to_string() == *expected => {}
        (Ok(outcome), None) => {
            let hash = outcome.summary["state_hash"].as_str().unwrap_or_default();
            if hash != straight.state_hash {
                return Err(format!("run into a folder: {hash} in place of {}", straight.state_hash));
            }
            let last = last_state::<V>(&log).map_err(|error| error.to_string())?;
            let mut last = last.ok_or("the log has no last state")?;
            let event_driven = scenario.engine.kind.is_event_driven();
            let totals = format!("{:?}", last.totals);
            let same_totals =
                totals == straight.totals || (event_driven && counts_of(&last.totals) == straight.counts);
            let mut gas = last.take_gas(scenario.grid(), scenario.grain);
            gas.species.clone_from(&scenario.species);
            if state_hash(&gas) != hash {
                return Err("the last state of the log is not that of the run".to_owned());
            }
            if !same_totals {
                return Err(format!("the log has the sums {totals}\nin place of {}", straight.totals));
            }
        }
        (Ok(_), Some(error)) => return Err(format!("run into a folder: no error in place of {error}")),
        (Err(error), _) => return Err(format!("run into a folder: {error}")),
    }
    recorded(&log, scenario, trace)
}

/// Every recording is one of the steps, to the bit.
fn recorded<V: Vector>(log: &Path, scenario: &Scenario<V>, trace: &Trace) -> Result<(), String> {
    let read = read_log(log).map_err(|error| error.to_string())?;
    let place = |name: &str| read.columns.iter().position(|column| column.name == name);
    let (time, energy) = (place("time"), place("kinetic_energy"));
    let (Some(time), Some(energy)) = (time, energy) else {
        return Err("the series has no time or no energy".to_owned());
    };
    if read.cut_off.is_some() || read.series.len() != read.state_hashes.len() {
        return Err("the log has no end, or recordings without hashes".to_owned());
    }
    for (row, hash) in read.series.iter().zip(&read.state_hashes) {
        let print = (row[time].to_bits(), hash.clone(), row[energy].to_bits());
        // Engines without steps stop where recordings are due; then the last alone is known.
        let between = scenario.engine.kind.is_event_driven() && print.0 != trace[trace.len() - 1].0;
        // Recordings that are not full have no hash.
        let is_step = |(time, full, energy): &(u64, String, u64)| {
            *time == print.0 && *energy == print.2 && (print.1.is_empty() || *full == print.1)
        };
        if !between && !trace.iter().any(is_step) {
            return Err(format!("recording at t = {} is none of the steps", row[time]));
        }
    }
    Ok(())
}
