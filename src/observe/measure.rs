//! What a measure is, and the forms its results take.

use std::sync::OnceLock;

use super::local_flow::{LocalFlow, grains_of_a_bin};
use crate::engine::report::Totals;
use crate::matter::gas::Gas;
use crate::space::Vector;
use crate::statistics::Trend;

/// The state of a run at a step end, as a measure sees it.
#[derive(Clone, Debug)]
pub struct Snapshot<'a, V: Vector> {
    /// The grains.
    pub gas: &'a Gas<V>,
    /// What happened since the start of the run.
    pub totals: &'a Totals<V>,
    /// The flow of the grains, once a measure has asked for it.
    flow: OnceLock<LocalFlow<V>>,
}

/// Which of the states of a run one is: two that agree in this are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Simulated time [time].
    pub time: f64,
    /// Steps so far.
    pub steps: u64,
    /// Events so far.
    pub events: u64,
    /// Grains.
    pub grains: usize,
}

impl<'a, V: Vector> Snapshot<'a, V> {
    /// The state of `gas` after all that `totals` say.
    pub fn new(gas: &'a Gas<V>, totals: &'a Totals<V>) -> Self {
        Snapshot { gas, totals, flow: OnceLock::new() }
    }

    /// The local flow in bins for temperatures; found once for all measures that ask for it.
    pub(super) fn local_flow(&self) -> &LocalFlow<V> {
        self.flow.get_or_init(|| LocalFlow::of(self.gas, grains_of_a_bin::<V>()))
    }

    /// Which of the states of its run it shows.
    pub fn place(&self) -> Place {
        Place {
            time: self.gas.time(),
            steps: self.totals.steps,
            events: self.totals.events.all,
            grains: self.gas.len(),
        }
    }
}

/// When a measure wants to be shown the gas, beside recordings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cadence {
    /// Never.
    Recordings,
    /// At random places spread over the run's limit, as many as its work deserves.
    Spread,
    /// Every so much time [time].
    Every(f64),
}

/// What it costs to look at one grain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Sums over the grains.
    Sums,
    /// Distributions or other tables over the grains, which may make long samples; quantities about the local flow.
    Table,
}

/// A quantity with its unit, as it stands in the header of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, in snake case.
    pub name: String,
    /// Unit, made of the powers of mass, length and time; `1` for pure numbers.
    pub unit: Dimension,
}

/// Powers of mass, length and time of a physical quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension {
    /// Power of mass.
    pub mass: i8,
    /// Power of length.
    pub length: i8,
    /// Power of time.
    pub time: i8,
}

/// A table at one time: a profile, a spectrum, a distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The measure's name, such as `velocity-profile`.
    pub name: String,
    /// When it was taken, or when its average ended [time].
    pub time: f64,
    /// What the columns hold; the first is the abscissa.
    pub columns: Vec<Column>,
    /// `[column][row]`.
    pub values: Vec<Vec<f64>>,
}

/// A figure of the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name, in snake case.
    pub name: String,
    /// The value; `None` where the run was too short to have one.
    pub value: Option<f64>,
    /// Its standard error, where there is one.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of that error: Student's t with so many gives intervals; `None` without an error.
    pub degrees_of_freedom: Option<f64>,
    /// Whether its series is steady; `None` where the test does not apply.
    pub trend: Option<Trend>,
}

/// One measure of a run.
pub trait Measure<V: Vector>: Send {
    /// The name that scenarios use, in kebab case.
    fn name(&self) -> &'static str;

    /// Whether it costs so much that it is taken only where a scenario names it.
    fn is_costly(&self) -> bool {
        false
    }

    /// When it wants to be shown the gas by [`Measure::sample`].
    fn cadence(&self) -> Cadence {
        Cadence::Recordings
    }

    /// What [`Measure::sample`] costs.
    fn effort(&self) -> Effort {
        Effort::Sums
    }

    /// Looks at the gas at one of its times.
    fn sample(&mut self, _snapshot: &Snapshot<'_, V>) {}

    /// Columns of the series that it fills at recordings.
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// Values of these columns now; NaN where one is not defined.
    fn values(&mut self, _snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        Vec::new()
    }

    /// The same at a recording between two full ones: NaN where a value takes a look at every grain and its neighbours.
    fn brief_values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        match self.effort() {
            Effort::Sums if !self.is_costly() => self.values(snapshot),
            _ => vec![f64::NAN; self.columns().len()],
        }
    }

    /// Profiles of this moment, stored at full recordings.
    fn profiles(&mut self, _snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        Vec::new()
    }

    /// Profiles and figures of the whole run, from samples at times from `from` on.
    fn conclusion(&self, _snapshot: &Snapshot<'_, V>, _from: f64) -> (Vec<Profile>, Vec<Figure>) {
        (Vec::new(), Vec::new())
    }

    /// What it remembers, as numbers: part of a saved state.
    fn memory(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes over what [`Measure::memory`] gave, and tells whether it is such a memory; of another one nothing is taken.
    fn recall(&mut self, memory: &[f64]) -> bool {
        memory.is_empty()
    }
}
