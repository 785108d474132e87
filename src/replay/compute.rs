//! Measures that a run did not take, computed from what its log holds of the grains.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::selection::Selection;
use super::tables::Tables;
use super::{ScenarioUnknown, scenario_of};
use crate::engine::report::Totals;
use crate::matter::clock::Clock;
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::observe::measure::{Cadence, Column, Dimension, Measure, Snapshot};
use crate::observe::measures;
use crate::record::contents::{Frame, within_rounding};
use crate::record::error::LogError;
use crate::record::overview::{Overview, overview};
use crate::record::walk::{each_frame, each_state};
use crate::scenario::kinds::Kinds;
use crate::scenario::model::{AnyScenario, Scenario};
use crate::space::Vector;

/// Measures that count collisions, which neither a state nor a frame holds one by one.
pub const OF_COLLISIONS: [&str; 4] = ["wall-stress", "pressure", "collisions", "impact-parameter"];

/// What the grains are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Saved states: full precision, all grains, few times.
    States,
    /// Frames: single precision, many times.
    Frames,
}

/// Measures that were computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Computed {
    /// Their tables.
    pub tables: Tables,
    /// What they were computed from.
    pub basis: Basis,
    /// From how many states or frames.
    pub looks: usize,
}

/// Why measures could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum ComputeError {
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The scenario in the log is not understood.
    #[error(transparent)]
    Scenario(#[from] ScenarioUnknown),
    /// The measure needs the collisions themselves.
    #[error(
        "--measures: `{0}` is made of collisions, which neither states nor frames hold; name it in record.measures and run again"
    )]
    Collisions(String),
    /// The measure needs samples in fixed steps of time.
    #[error(
        "--measures: `{0}` needs samples at fixed intervals during the run, which the log does not hold; name it in record.measures and run again"
    )]
    Samples(String),
    /// The scenario does not have it.
    #[error(
        "--measures: `{0}` does not apply to the scenario of this log, which lacks the walls, the gravity or the periodic axis that it needs"
    )]
    NotApplying(String),
    /// There is nothing to compute from.
    #[error("{} has no {what} {words} to compute measures from", log.display())]
    Nothing {
        /// The log.
        log: PathBuf,
        /// States or frames.
        what: &'static str,
        /// The span.
        words: String,
    },
    /// Frames that do not show all grains.
    #[error("frames of {} show {points} of {grains} grains, too few to measure; use --source states, or run again with record.points = \"all\"", log.display())]
    Thinned {
        /// The log.
        log: PathBuf,
        /// Points of a frame.
        points: u64,
        /// Grains.
        grains: u64,
    },
}

/// The measures `names` of the log at `path` in the span of `selection`, from `basis`; without one from states, and
/// from frames where there is no state in the span.
pub fn compute(
    path: &Path,
    names: &[String],
    selection: Selection,
    basis: Option<Basis>,
) -> Result<Computed, ComputeError> {
    let found = overview(path)?;
    let has_state = found.states.iter().any(|state| selection.spans(state.0));
    let basis = basis.unwrap_or(if has_state { Basis::States } else { Basis::Frames });
    match scenario_of(path, &found.metadata, &found.scenario)? {
        AnyScenario::Two(scenario) => compute_in(path, &found, &scenario, names, selection, basis),
        AnyScenario::Three(scenario) => compute_in(path, &found, &scenario, names, selection, basis),
    }
}

fn compute_in<V: Vector>(
    path: &Path,
    found: &Overview,
    scenario: &Scenario<V>,
    names: &[String],
    selection: Selection,
    basis: Basis,
) -> Result<Computed, ComputeError> {
    let mut look = Look::new(scenario, chosen(scenario, names)?, selection);
    match basis {
        Basis::States => look.at_states(path)?,
        Basis::Frames => look.at_frames(path, &Kinds::new(scenario, found.species.clone()))?,
    }
    let log = path.to_owned();
    if let Some((points, grains)) = look.thinned {
        return Err(ComputeError::Thinned { log, points, grains });
    }
    if look.last.is_none() {
        let what = if basis == Basis::States { "saved state" } else { "frame" };
        return Err(ComputeError::Nothing { log, what, words: selection.words() });
    }
    Ok(Computed { looks: look.tables.series.len(), tables: look.conclude(), basis })
}

/// The measures `names`, if they can be computed afterwards.
fn chosen<V: Vector>(
    scenario: &Scenario<V>,
    names: &[String],
) -> Result<Vec<Box<dyn Measure<V>>>, ComputeError> {
    if let Some(name) = names.iter().find(|name| OF_COLLISIONS.contains(&name.as_str())) {
        return Err(ComputeError::Collisions(name.clone()));
    }
    let mut measures = measures(&scenario.setting(), Some(names));
    measures.retain(|measure| names.iter().any(|name| name == measure.name()));
    if let Some(name) = names.iter().find(|name| measures.iter().all(|one| one.name() != name.as_str())) {
        return Err(ComputeError::NotApplying(name.clone()));
    }
    match measures.iter().find(|measure| matches!(measure.cadence(), Cadence::Every(_))) {
        Some(measure) => Err(ComputeError::Samples(measure.name().to_owned())),
        None => Ok(measures),
    }
}

/// Measures on their way through a log.
struct Look<'s, V: Vector> {
    scenario: &'s Scenario<V>,
    measures: Vec<Box<dyn Measure<V>>>,
    selection: Selection,
    tables: Tables,
    /// The last gas that they were shown, for their conclusions.
    last: Option<(Gas<V>, Totals<V>)>,
    /// Points and grains of a frame that is not whole.
    thinned: Option<(u64, u64)>,
}

impl<'s, V: Vector> Look<'s, V> {
    fn new(scenario: &'s Scenario<V>, measures: Vec<Box<dyn Measure<V>>>, selection: Selection) -> Self {
        let time = Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } };
        let columns =
            std::iter::once(time).chain(measures.iter().flat_map(|measure| measure.columns())).collect();
        let tables = Tables { columns, ..Tables::default() };
        Look { scenario, measures, selection, tables, last: None, thinned: None }
    }

    fn at_states(&mut self, path: &Path) -> Result<(), LogError> {
        let mut picker = self.selection.picker();
        each_state::<V>(path, &mut |mut state| {
            if picker.takes(state.time) {
                let totals = state.totals.clone();
                let gas = state.take_gas(self.scenario.grid(), self.scenario.grain);
                self.take(gas, totals);
            }
            ControlFlow::Continue(())
        })
    }

    fn at_frames(&mut self, path: &Path, kinds: &Kinds) -> Result<(), LogError> {
        let mut picker = self.selection.picker();
        each_frame(path, &mut |_, frame| {
            if !picker.takes(frame.time) {
                return ControlFlow::Continue(());
            }
            let points = frame.ids.len() as u64;
            if points < frame.grains {
                self.thinned = Some((points, frame.grains));
                return ControlFlow::Break(());
            }
            // A frame does not know how often its grains have collided.
            let totals = Totals { collisions_per_particle: f64::NAN, ..Totals::default() };
            self.take(gas_of(self.scenario, &frame, kinds), totals);
            ControlFlow::Continue(())
        })
    }

    fn take(&mut self, mut gas: Gas<V>, totals: Totals<V>) {
        // The last state of a run may be there twice.
        if self.last.as_ref().is_some_and(|(last, _)| last.time() >= gas.time()) {
            return;
        }
        gas.species.clone_from(&self.scenario.species);
        let snapshot = Snapshot::new(&gas, &totals);
        let mut row = vec![gas.time()];
        for measure in &mut self.measures {
            if measure.cadence() == Cadence::Spread {
                measure.sample(&snapshot);
            }
            row.extend(measure.values(&snapshot));
            self.tables.profiles.extend(measure.profiles(&snapshot));
        }
        self.tables.series.push(row);
        self.last = Some((gas, totals));
    }

    /// The tables with the profiles of the whole span, which count from its first look on.
    fn conclude(mut self) -> Tables {
        if let Some((gas, totals)) = &self.last {
            let from = self.tables.series.first().map_or(0.0, |row| row[0]);
            for measure in &self.measures {
                self.tables.profiles.extend(measure.conclusion(&Snapshot::new(gas, totals), from).0);
            }
        }
        self.tables
    }
}

/// The grains of `frame` as a gas: every position is moved by its rounding, though not out of the box.
fn gas_of<V: Vector>(scenario: &Scenario<V>, frame: &Frame, kinds: &Kinds) -> Gas<V> {
    let grid = scenario.grid();
    let (lower, upper) = (grid.origin(), grid.end());
    let vector = |row: &[f32; 3]| V::from_fn(|axis| f64::from(row[axis]));
    let inside = |place: V| V::from_fn(|axis| within_rounding(place[axis], lower[axis], upper[axis]));
    let species = || frame.ids.iter().map(|&id| kinds.species_of(id)).collect();
    let columns = Columns {
        positions: frame.positions.iter().map(|row| inside(vector(row))).collect(),
        velocities: frame.velocities.iter().map(vector).collect(),
        ids: frame.ids.clone(),
        spins: None,
        species: (!scenario.species.is_empty()).then(species),
    };
    let next_id = frame.ids.last().map_or(0, |id| id + 1);
    let clock = Clock::restored(frame.time, 0.0);
    Gas::restored(grid, scenario.grain, columns, clock, next_id)
}

/// Measures that the run of `scenario` has stored.
pub fn stored_measures(scenario: &AnyScenario) -> Vec<(&'static str, Vec<Column>)> {
    fn of<V: Vector>(scenario: &Scenario<V>) -> Vec<(&'static str, Vec<Column>)> {
        let named = scenario.record.measures.as_deref();
        let is_stored = |name: &str| named.is_none_or(|names| names.iter().any(|one| one == name));
        let all = measures(&scenario.setting(), named);
        all.iter().filter(|one| is_stored(one.name())).map(|one| (one.name(), one.columns())).collect()
    }
    match scenario {
        AnyScenario::Two(scenario) => of(scenario),
        AnyScenario::Three(scenario) => of(scenario),
    }
}
