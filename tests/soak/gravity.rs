//! Runs under gravity, from every state of whose logs the run goes on: to the same end, or to the same failure, as the run
//! that nothing has interrupted; and whose logs are verified.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::state_hash::state_hash;
use grainflow::record::reader::read_states;
use grainflow::run::resume::Resumption;
use grainflow::run::verify::{Verdict, verify};
use grainflow::run::{Outcome, RunError, run};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;

use super::draw::Dice;
use super::gravity_text::{Drawn, drawn};
use super::trial::caught;
use super::watch;

/// What many runs came to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Runs that held.
    pub(crate) runs: u64,
    /// States from which they went on.
    pub(crate) states: u64,
    /// Runs that ended by a failure of their own, such as inelastic collapse.
    pub(crate) failed: u64,
    /// Runs that were stopped before their end.
    pub(crate) stopped: u64,
    /// States whose fastest grain was faster than the speed that sets the next step.
    pub(crate) outrun: u64,
    /// Scenarios that were refused.
    pub(crate) refused: u64,
}

/// The run number `seed`; the message of one that does not hold has its scenario.
pub(crate) fn trial(seed: u64, tally: &mut Tally) -> Result<(), String> {
    let Drawn { kind, engine, text } = drawn(seed);
    let name = format!("{kind} number {seed} with {engine}");
    let problem = match watch::over(name.clone(), || caught(|| check(seed, &text))) {
        Ok(found) => {
            tally.add(&found);
            return Ok(());
        }
        Err(problem) => problem,
    };
    Err(format!("{name}: {problem}\n\nshown by the scenario\n{text}"))
}

impl Tally {
    fn add(&mut self, other: &Tally) {
        self.runs += other.runs;
        self.states += other.states;
        self.failed += other.failed;
        self.stopped += other.stopped;
        self.outrun += other.outrun;
        self.refused += other.refused;
    }
}

fn check(seed: u64, text: &str) -> Result<Tally, String> {
    let scenario = parse("gravity", text, &Overrides::default()).map_err(|error| error.to_string())?;
    match &scenario {
        AnyScenario::Two(inner) => check_in(seed, &scenario, inner),
        AnyScenario::Three(inner) => check_in(seed, &scenario, inner),
    }
}

/// Where a run ends: the bits of its time, the hash of its state, what was counted, and why it failed if it did.
type End = (u64, String, [u64; 4], Option<String>);

fn check_in<V: Vector>(seed: u64, any: &AnyScenario, scenario: &Scenario<V>) -> Result<Tally, String> {
    let Ok(gas) = initial::build(scenario, None) else { return Ok(Tally { refused: 1, ..Tally::default() }) };
    let place = tempfile::tempdir().map_err(|error| error.to_string())?;
    let begun = Simulation::start(scenario, gas, &mut NoLaps).map_err(|error| error.to_string())?;
    let expected = end_of(begun);
    let dice = &mut Dice::new(!seed);
    let looks = if dice.chance(0.3) { 1 + dice.below(300) as u64 } else { u64::MAX };
    let folder = place.path().join("run");
    let stop = AtomicBool::new(false);
    let result = run(any, &folder, false, &stop, &mut stopper(&stop, looks));
    let stopped = as_expected("the run", result, &expected)?;
    let (states, outrun) = from_every_state(scenario, &folder, &expected)?;
    verified(&folder, states)?;
    let further = place.path().join("further");
    let resumption = Resumption::open(&folder, &[]).map_err(|error| error.to_string())?;
    let result = resumption.run(&further, false, &AtomicBool::new(false), &mut |_| {});
    if as_expected("the run that goes on", result, &expected)? {
        return Err("the run that goes on was stopped".to_owned());
    }
    if stopped {
        let states = read_states::<V>(&further.join("log.mcap")).map_err(|error| error.to_string())?;
        verified(&further, states.len() as u64)?;
    }
    let failed = u64::from(expected.3.is_some() && !stopped);
    Ok(Tally { runs: 1, states, failed, stopped: u64::from(stopped), outrun, refused: 0 })
}

/// Stops a run after so many looks at it.
fn stopper(stop: &AtomicBool, looks: u64) -> impl FnMut(&grainflow::run::Status) + Send {
    let mut seen = 0;
    move |_| {
        seen += 1;
        stop.store(seen >= looks, Relaxed);
    }
}

/// Advances `simulation` to its end or failure.
fn end_of<V: Vector>(mut simulation: Simulation<'_, V>) -> End {
    let mut error = None;
    while error.is_none() && simulation.end_reason().is_none() {
        error = simulation.advance(&mut NoLaps, Horizon::NONE).err().map(|error| error.to_string());
    }
    if error.is_some() {
        // A step that fails leaves the grains anywhere.
        return (0, String::new(), [0; 4], error);
    }
    let (gas, totals) = (simulation.gas(), simulation.totals());
    let counts = [totals.steps, totals.counts.collisions, totals.poured, totals.counts.removed];
    (gas.time().to_bits(), state_hash(gas), counts, None)
}

/// Whether the run of `what` was stopped; an error where it came to another end than it should.
fn as_expected(what: &str, result: Result<Outcome, RunError>, expected: &End) -> Result<bool, String> {
    let (hash, error) = match result {
        Ok(outcome) if outcome.interrupted => return Ok(true),
        Ok(outcome) => (outcome.summary["state_hash"].as_str().unwrap_or_default().to_owned(), None),
        Err(RunError::Simulation { source, .. }) => (String::new(), Some(source.to_string())),
        Err(error) => return Err(format!("{what}: {error}")),
    };
    if (&hash, &error) == (&expected.1, &expected.3) {
        return Ok(false);
    }
    Err(format!("{what} came to {hash} {error:?} in place of {expected:?}"))
}

/// Goes on from every state in the log of `folder`; how many there are, and in how many grains are faster than the speed that
/// sets the next step.
fn from_every_state<V: Vector>(
    scenario: &Scenario<V>,
    folder: &Path,
    expected: &End,
) -> Result<(u64, u64), String> {
    let states = read_states::<V>(&folder.join("log.mcap")).map_err(|error| error.to_string())?;
    if states.is_empty() {
        return Err("the log holds no state".to_owned());
    }
    let (number, mut outrun) = (states.len() as u64, 0);
    for state in states {
        let (time, pace) = (state.time, state.engine.largest_speed);
        let fastest = state.largest_speed.ok_or("a state has no largest speed")?;
        outrun += u64::from(pace > 0.0 && fastest > pace);
        let simulation = Simulation::resume(scenario, state).map_err(|misfit| misfit.to_string())?;
        let found = end_of(simulation);
        if found != *expected {
            return Err(format!(
                "from the state of t = {time:?} the run comes to {found:?} in place of {expected:?}"
            ));
        }
    }
    Ok((number, outrun))
}

/// The log of `folder` is verified, with all of its states.
fn verified(folder: &Path, states: u64) -> Result<(), String> {
    match verify(folder, &AtomicBool::new(false), &mut |_| {}).map_err(|error| error.to_string())? {
        Verdict::Identical(extent, None) if extent.states == states => Ok(()),
        other => Err(format!("{other:?} of {states} states")),
    }
}
