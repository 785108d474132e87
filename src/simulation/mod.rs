//! A run: a scenario's gas, the engine that advances it, the measures that watch.

pub mod assembly;
pub mod figures;
pub mod fit;
pub mod limits;
pub mod pouring;
mod sampling;
pub mod schedule;

use std::borrow::Cow;

use crate::engine::cell_counts::{self, CellCount};
use crate::engine::report::Totals;
use crate::engine::{Engine, EngineError, Horizon, Laps};
use crate::law::boundary::{Boundary, WallKind};
use crate::matter::gas::Gas;
use crate::matter::overlaps::overlaps;
use crate::observe::field::Quantity;
use crate::observe::measure::{Cadence, Measure, Snapshot};
use crate::observe::{measures, moments};
use crate::random::{Phase, Streams};
use crate::record::state::{Beginning, SavedState};
use crate::scenario::initial::{rescale, stated_temperature};
use crate::scenario::model::Scenario;
use crate::space::Vector;
use fit::Misfit;
use limits::{EndReason, Limits};
use pouring::{Pouring, PouringError, Room};
use sampling::Work;
use schedule::{Due, ROUNDING, Spread};

/// Name under which a saved state keeps what is counted in cells, beside the memories of measures.
const CELL_COUNTS: &str = "cell-counts";

/// Why a run cannot go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The engine says so.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The source says so.
    #[error(transparent)]
    Pouring(#[from] PouringError),
}

/// A run at one of its step ends.
pub struct Simulation<'s, V: Vector> {
    scenario: &'s Scenario<V>,
    gas: Gas<V>,
    engine: Box<dyn Engine<V>>,
    totals: Totals<V>,
    pouring: Option<Pouring<V>>,
    limits: Limits,
    measures: Vec<Box<dyn Measure<V>>>,
    samples: Vec<u64>,
    beginning: Beginning<V>,
    invalid_states: Option<u64>,
    resumed: Option<Resumed>,
    /// Measures that could not take over what they remembered.
    begun_anew: Vec<&'static str>,
}

/// Where a run was resumed: what stands in its sums and is the work of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resumed {
    /// When [time].
    pub time: f64,
    /// Σ N over the steps before.
    pub particle_steps: u64,
    /// Events before.
    pub events: u64,
}

impl<'s, V: Vector> Simulation<'s, V> {
    /// Starts from `gas`, the scenario's initial state, after its equilibration if it asks for one.
    pub fn start(
        scenario: &'s Scenario<V>,
        mut gas: Gas<V>,
        laps: &mut dyn Laps,
    ) -> Result<Self, SimulationError> {
        if scenario.initial.equilibrate > 0.0 {
            equilibrate(scenario, &mut gas, laps)?;
        }
        let beginning = Beginning {
            particles: gas.len() as u64,
            kinetic_energy: moments::kinetic_energy(&gas),
            momentum: moments::momentum(&gas),
            momentum_scale: moments::momentum_scale(&gas),
        };
        let mut simulation = Self::assemble(scenario, gas, beginning);
        simulation.take_samples();
        simulation.audit();
        Ok(simulation)
    }

    /// Goes on from a saved state, to the same bits as if there had been no interruption. A state that no run of `scenario`
    /// can have left is refused.
    pub fn resume(scenario: &'s Scenario<V>, saved: SavedState<'_, V>) -> Result<Self, Misfit> {
        let time = saved.time;
        Self::go_on(scenario, saved).map_err(|reason| Misfit { time, reason })
    }

    fn go_on(scenario: &'s Scenario<V>, mut saved: SavedState<'_, V>) -> Result<Self, String> {
        fit::check(scenario, &saved)?;
        let mut gas = saved.take_gas(scenario.grid(), scenario.grain);
        gas.species.clone_from(&scenario.species);
        let mut simulation = Self::assemble(scenario, gas, saved.beginning);
        simulation.engine.restore(&saved.engine, &simulation.gas).map_err(|misfit| misfit.to_string())?;
        simulation.totals = saved.totals.clone();
        if let Some(pouring) = &mut simulation.pouring {
            let (poured, last, held) = (simulation.totals.poured, saved.last_poured, saved.held_until);
            pouring.restore(poured, last, held).ok_or("its source never comes to that")?;
        }
        simulation.invalid_states = saved.invalid_states;
        simulation.resumed = Some(Resumed {
            time: simulation.gas.time(),
            particle_steps: simulation.totals.particle_steps,
            events: simulation.totals.events.all,
        });
        // A measure that did not watch before begins now.
        simulation.spread_samples();
        simulation.recall(&saved)?;
        if let Some((_, memory)) = saved.memories.iter().find(|(name, _)| name == CELL_COUNTS) {
            let counts = cell_counts::recalled(memory, simulation.gas.grid().number_of_cells());
            simulation.engine.count_in_cells(counts.ok_or("what was counted in cells is of other cells")?);
        }
        Ok(simulation)
    }

    /// This run in place of one that was resumed there, if anywhere, and that it has repeated.
    #[must_use]
    pub fn in_place_of(self, resumed: Option<Resumed>) -> Self {
        Simulation { resumed, ..self }
    }

    /// Gives back to the measures what they remembered. Those of versions before this one sampled at other places: what they
    /// cannot use is left, and the measure begins anew.
    fn recall(&mut self, saved: &SavedState<'_, V>) -> Result<(), String> {
        let is_earlier = saved.has_even_samples();
        for (measure, number) in self.measures.iter_mut().zip(&mut self.samples) {
            let place = saved.memories.iter().position(|(name, _)| name == measure.name());
            let Some(place) = place else { continue };
            let memory = &saved.memories[place].1;
            let is_taken = measure.recall(memory);
            let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<u64>>();
            if is_earlier && (!is_taken || bits(&measure.memory()) != bits(memory)) {
                self.begun_anew.push(measure.name());
                continue;
            }
            if !is_taken {
                return Err(format!(
                    "the measure {} does not remember this; take it out with --set record.measures=[…]",
                    measure.name()
                ));
            }
            if let Some(next) = saved.samples.get(place)
                && !(is_earlier && measure.cadence() == Cadence::Spread)
            {
                *number = *next;
            }
        }
        Ok(())
    }

    /// The same for a run of which limits or records have changed: samples are spread over its new length.
    pub fn resume_changed(scenario: &'s Scenario<V>, saved: SavedState<'_, V>) -> Result<Self, Misfit> {
        let mut simulation = Self::resume(scenario, saved)?;
        simulation.spread_samples();
        Ok(simulation)
    }

    /// Takes all samples that were due up to now as taken.
    fn spread_samples(&mut self) {
        self.samples = self.measures.iter().map(|measure| self.next_sample(&**measure)).collect();
    }

    /// The number of the sample that `measure` takes next, when all up to now are taken.
    fn next_sample(&self, measure: &dyn Measure<V>) -> u64 {
        match measure.cadence() {
            Cadence::Recordings => 0,
            Cadence::Spread => {
                sampling::next(self.scenario.seed, measure.effort(), self.progress(), self.work())
            }
            Cadence::Every(interval) => Spread::Every(interval).next(self.gas.time(), self.progress()),
        }
    }

    /// What `measure` waits for when its next sample has that `number`.
    fn sample_due(&self, measure: &dyn Measure<V>, number: u64) -> Due {
        match measure.cadence() {
            Cadence::Recordings => Due::Never,
            Cadence::Spread => sampling::due(self.scenario.seed, number),
            Cadence::Every(interval) => Spread::Every(interval).due(number),
        }
    }

    /// The work so far, counted.
    fn work(&self) -> Work {
        match self.is_event_driven() {
            true => Work::of_events(self.totals.events.all, self.gas.len()),
            false => Work::of_steps(self.totals.particle_steps, self.gas.len()),
        }
    }

    fn assemble(scenario: &'s Scenario<V>, gas: Gas<V>, beginning: Beginning<V>) -> Self {
        let measures = measures(&scenario.setting(), scenario.record.measures.as_deref());
        let mut engine =
            assembly::engine(scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
        if scenario.fields().any(Quantity::is_counted) {
            engine.count_in_cells(vec![CellCount::default(); gas.grid().number_of_cells()]);
        }
        Simulation {
            scenario,
            gas,
            engine,
            totals: Totals::default(),
            pouring: scenario.source.clone().map(|source| Pouring::new(source, scenario)),
            limits: Limits::new(scenario),
            samples: vec![0; measures.len()],
            measures,
            beginning,
            invalid_states: None,
            resumed: None,
            begun_anew: Vec::new(),
        }
    }

    /// Pours what is due, advances, lets the measures look: by one step where the engine has steps, else up to
    /// `horizon` or to what comes before that here.
    pub fn advance(&mut self, laps: &mut dyn Laps, horizon: Horizon) -> Result<(), SimulationError> {
        if let Some(pouring) = &mut self.pouring {
            laps.start("pouring");
            let room = Room::of(&*self.engine, &self.gas);
            self.totals.poured += pouring.pour(&mut self.gas, room)?;
        }
        let grains = self.gas.len();
        let horizon = if self.is_event_driven() { self.next_stop(horizon) } else { Horizon::NONE };
        self.engine.collided(self.totals.collisions_per_particle);
        let report = self.engine.step(&mut self.gas, horizon, laps)?;
        self.totals.add(&report, grains);
        laps.start("measures");
        self.take_samples();
        Ok(())
    }

    /// Whether the run has not ended but will at its next stop, which is no farther away than rounding: a multiple of an
    /// interval may be one step of double precision before the limit that it should be. Never so of engines with steps.
    pub fn ends_within_rounding(&self) -> bool {
        if !self.is_event_driven() || self.end_reason().is_some() {
            return false;
        }
        let end = self.limits.end(&self.gas, &self.totals, self.pouring.as_ref()).time;
        end.is_finite() && end - self.gas.time() <= ROUNDING * end
    }

    /// Where number `done` of `spread` is due; nowhere for engines with steps, which cannot stop there.
    pub fn horizon_of(&self, spread: Spread, done: u64) -> Horizon {
        self.horizon_of_due(spread.due(done))
    }

    fn horizon_of_due(&self, due: Due) -> Horizon {
        if !self.is_event_driven() {
            return Horizon::NONE;
        }
        self.limits.horizon(due, &self.gas, &self.totals, self.pouring.as_ref())
    }

    /// The nearest of `horizon`, the run's limits, the next grain and the next sample; after the present.
    fn next_stop(&self, horizon: Horizon) -> Horizon {
        let now = self.gas.time();
        let mut stop = horizon.min(self.limits.end(&self.gas, &self.totals, self.pouring.as_ref()));
        for (measure, &number) in self.measures.iter().zip(&self.samples) {
            stop = stop.min(self.horizon_of_due(self.sample_due(&**measure, number)));
        }
        let next_grain = self.pouring.as_ref().and_then(Pouring::next_time).unwrap_or(f64::INFINITY);
        Horizon { time: stop.time.min(next_grain).max(now.next_up()), collisions: stop.collisions.max(1) }
    }

    /// Shows the gas to every measure whose time has come.
    fn take_samples(&mut self) {
        let (time, progress) = (self.gas.time(), self.progress());
        let snapshot = Snapshot::new(&self.gas, &self.totals);
        for k in 0..self.measures.len() {
            if !self.sample_due(&*self.measures[k], self.samples[k]).is_reached(time, progress) {
                continue;
            }
            self.measures[k].sample(&snapshot);
            // A long step may pass several nominal times: one look stands for all of them.
            self.samples[k] = self.next_sample(&*self.measures[k]);
        }
    }

    /// Looks for grains that overlap each other or a wall, where the engine forbids it, and counts them.
    pub fn audit(&mut self) {
        if self.is_event_driven() {
            let overlaps = overlaps(&self.gas, self.scenario.boundary.fixed_walls());
            *self.invalid_states.get_or_insert(0) += overlaps;
        }
    }

    /// Overlaps found by all audits; `None` where the engine allows overlap.
    pub fn invalid_states(&self) -> Option<u64> {
        self.invalid_states
    }

    /// Whether a limit is reached, and which.
    pub fn end_reason(&self) -> Option<EndReason> {
        self.limits.end_reason(&self.gas, &self.totals, self.pouring.as_ref())
    }

    /// How much of the run is done, in [0, 1]; 1 at its end.
    pub fn progress(&self) -> f64 {
        self.limits.progress(self.gas.time(), &self.totals, self.pouring.as_ref())
    }

    /// From when on steady figures of a run that ends now are taken: `record.from` or the second half. Where walls vibrate,
    /// so much later that the stretch holds whole periods of the slowest wall, if it holds any [time].
    pub fn steady_from(&self) -> f64 {
        let end = self.gas.time();
        let from = self.scenario.record.from.unwrap_or(0.5 * end);
        let periods = self.scenario.boundary.walls().filter_map(|(_, _, wall)| match wall.kind {
            WallKind::Vibrating { frequency, .. } => Some(1.0 / frequency),
            _ => None,
        });
        let period = periods.fold(0.0, f64::max);
        // A stretch of whole periods loses none by rounding.
        let whole = ((end - from) / period * (1.0 + 4.0 * f64::EPSILON)).floor();
        if period > 0.0 && whole >= 1.0 { from.max(end - whole * period) } else { from }
    }

    /// The scenario that runs.
    pub fn scenario(&self) -> &'s Scenario<V> {
        self.scenario
    }
    /// The grains now.
    pub fn gas(&self) -> &Gas<V> {
        &self.gas
    }
    /// What has happened so far.
    pub fn totals(&self) -> &Totals<V> {
        &self.totals
    }
    /// What the run began with.
    pub fn beginning(&self) -> &Beginning<V> {
        &self.beginning
    }
    /// Grains that make a cell full, for engines with an excluded volume.
    pub fn capacity(&self) -> Option<u32> {
        self.engine.capacity(&self.gas)
    }
    /// Whether the engine works event by event, without steps.
    pub fn is_event_driven(&self) -> bool {
        self.engine.excludes_overlap()
    }
    /// Where the run was resumed, if it was.
    pub fn resumed(&self) -> Option<Resumed> {
        self.resumed
    }
    /// Measures of a run that goes on that began anew: an earlier version remembered for them what they cannot use.
    pub fn begun_anew(&self) -> &[&'static str] {
        &self.begun_anew
    }
    /// The measures, to be asked for values, profiles and conclusions, with what they look at.
    pub fn observation(&mut self) -> (&mut [Box<dyn Measure<V>>], Snapshot<'_, V>) {
        (&mut self.measures, Snapshot::new(&self.gas, &self.totals))
    }

    /// What was counted in each cell of the gas since the start or since the counts were last taken, `[cell]`;
    /// empty where no field needs it.
    pub fn cell_counts(&self) -> &[CellCount] {
        self.engine.cell_counts()
    }

    /// Begins to count from nothing again, in as many cells as before.
    pub fn restart_cell_counts(&mut self) {
        let cells = self.engine.cell_counts().len();
        self.engine.count_in_cells(vec![CellCount::default(); cells]);
    }

    fn memories(&self) -> Vec<(String, Vec<f64>)> {
        let mut memories: Vec<_> =
            self.measures.iter().map(|measure| (measure.name().to_owned(), measure.memory())).collect();
        let counts = self.engine.cell_counts();
        if !counts.is_empty() {
            memories.push((CELL_COUNTS.to_owned(), cell_counts::memory(counts)));
        }
        memories
    }

    /// Everything that the next step and the final figures depend on.
    pub fn saved_state(&self, recordings: u64, states: u64) -> SavedState<'_, V> {
        SavedState {
            time: self.gas.clock.time(),
            compensation: self.gas.clock.compensation(),
            columns: Cow::Borrowed(self.gas.columns()),
            largest_speed: Some(moments::largest_speed(self.gas.velocities())),
            next_id: self.gas.next_id(),
            engine: self.engine.state(),
            totals: self.totals.clone(),
            last_poured: self.pouring.as_ref().map_or(-1.0, Pouring::last_poured),
            held_until: self.pouring.as_ref().map_or(0.0, Pouring::held_until),
            recordings,
            states,
            samples: self.samples.clone(),
            memories: self.memories(),
            beginning: self.beginning,
            invalid_states: self.invalid_states,
        }
    }
}

/// Runs elastic, without gravity, wall motion or source, until the stated number of collisions per
/// particle; then sets the stated temperature and the clock to zero.
fn equilibrate<V: Vector>(
    scenario: &Scenario<V>,
    gas: &mut Gas<V>,
    laps: &mut dyn Laps,
) -> Result<(), SimulationError> {
    let seed = Streams::new(scenario.seed).derived_seed(Phase::Equilibration);
    let quiet: Boundary<V> = scenario.boundary.at_rest();
    let mut engine = assembly::engine(scenario, seed, &quiet, V::ZERO, Some(1.0));
    let mut totals = Totals::default();
    let goal = scenario.initial.equilibrate;
    while totals.collisions_per_particle < goal {
        let grains = gas.len();
        let collisions = totals.collisions_until(grains, goal, |done| done >= goal);
        let report = engine.step(gas, Horizon { collisions, ..Horizon::NONE }, laps)?;
        totals.add(&report, grains);
    }
    rescale(gas, stated_temperature(scenario));
    gas.clock = Default::default();
    Ok(())
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod wall_impulse_tests;
