//! What a comparison has found, ready for readers: reports, tables and tests look at this and at nothing else.

use crate::observe::measure::{Column, Dimension};
use crate::record::contents::{Frame, Walls};
use crate::scenario::kinds::Kinds;
use crate::statistics::{Estimate, Trend};

/// Several engines side by side, each with the same initial states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Title of the scenario.
    pub title: String,
    /// Name of the scenario.
    pub scenario: String,
    /// The scenario as TOML text; that of the first log where logs are compared.
    pub scenario_text: String,
    /// Two or three.
    pub dimension: usize,
    /// Names of the units of length, mass and time.
    pub units: [String; 3],
    /// Version and `numerics` of the program that made the runs.
    pub version: String,
    /// Raised whenever a release changes bits.
    pub numerics: u32,
    /// The seed from which replicas draw theirs.
    pub seed: u64,
    /// Independent initial states, each of which went through every engine.
    pub replicas: u32,
    /// Where standard errors come from, and what else a reader must know, a sentence each.
    pub remarks: Vec<String>,
    /// The engines, in the order asked for.
    pub contestants: Vec<Contestant>,
    /// Place in `contestants` of the one that the others are subtracted from: event-driven where it takes part.
    pub reference: usize,
    /// Quantities against time, or against collisions per particle.
    pub series: Vec<Compared>,
    /// Profiles, spectra and distributions, each at one time.
    pub profiles: Vec<Compared>,
    /// Figures of the summaries.
    pub figures: Vec<ComparedFigure>,
}

/// One engine and its runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contestant {
    /// What it is called in tables and legends: the engine's name, or a log's name where engines are not enough.
    pub label: String,
    /// Name of the engine.
    pub engine: String,
    /// The folders (or logs) of its runs, one per replica that came to an end, beside the comparison.
    pub folders: Vec<String>,
    /// Why a run did not come to its end, a sentence for each that did not; its others are still shown.
    pub failures: Vec<String>,
    /// What it costs; `None` where runs shared the machine, or the logs do not say.
    pub cost: Option<Cost>,
    /// The box and its walls.
    pub walls: Option<Walls>,
    /// Diameter of a grain, of the first species where there are several [length].
    pub diameter: f64,
    /// Sizes of the grains, for pictures.
    pub kinds: Kinds,
    /// Pictures of its first replica.
    pub frames: Vec<Frame>,
}

/// What an engine's runs cost, means over replicas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Seconds of the whole run.
    pub wall_seconds: f64,
    /// Seconds of advancing the state alone.
    pub advancing_seconds: f64,
    /// Particle-steps per second; `None` for engines without steps.
    pub particle_steps_per_second: Option<f64>,
    /// Events per second; `None` for engines with steps.
    pub events_per_second: Option<f64>,
    /// Peak of memory [byte].
    pub peak_memory: Option<f64>,
}

/// Curves of one quantity over one abscissa, the same points for every engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The measure's or column's name, in snake or kebab case as in the tables.
    pub name: String,
    /// What runs along x.
    pub abscissa: Column,
    /// What runs along y.
    pub ordinate: Column,
    /// When it was taken, for a profile [time]; `None` for a series, and for a profile of the whole run.
    pub time: Option<f64>,
    /// Where the curves are known.
    pub places: Vec<f64>,
    /// `[contestant]`; `None` for one that does not have it.
    pub curves: Vec<Option<CurveOf>>,
    /// `[contestant]` against the reference; `None` for the reference itself and where either has no curve.
    pub differences: Vec<Option<Difference>>,
    /// What theory says, where it says something.
    pub theory: Vec<TheoryCurve>,
}

/// What theory says of a quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TheoryCurve {
    /// What the law is called in a legend.
    pub name: String,
    /// Whose it is, and for what it holds.
    pub source: String,
    /// The values at the places of what it stands beside.
    pub values: Vec<f64>,
}

/// Mean over replicas at each place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveOf {
    /// NaN where it is not defined.
    pub values: Vec<f64>,
    /// Standard errors; NaN where nothing is known of them.
    pub errors: Vec<f64>,
}

/// How two curves, or two figures, stand to each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Whether the values are shares of the reference, as for energies, or in its unit.
    pub is_relative: bool,
    /// This one minus the reference, at each place.
    pub values: Vec<f64>,
    /// Standard errors of these, with replicas paired where they begin at the same state.
    pub errors: Vec<f64>,
    /// Where the errors are from.
    pub basis: Basis,
    /// Degrees of freedom of the errors.
    pub freedom: f64,
    /// How long the difference remembers, where its errors rest on that.
    pub correlation: Option<Correlation>,
    /// The largest of |value|/error, and where it is; `None` where no error is known.
    pub most: Option<Peak>,
    /// Standard errors beyond which values differ: 3 for a single one, more for many places.
    pub threshold: f64,
    /// Standard errors beyond which the last place of a curve in time differs, and those before it that are apart as
    /// well; `None` for what is no such curve.
    pub last_threshold: Option<f64>,
    /// The difference of the curves as wholes; `None` for single values, and where nothing is known of it.
    pub overall: Option<Overall>,
    /// The first place from which on they differ, to the last.
    pub parts_at: Option<f64>,
    /// What came out.
    pub verdict: Verdict,
    /// The same in a sentence, with numbers.
    pub sentence: String,
}

/// Where errors of a difference are from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// The scatter of replicas, at each place by itself.
    Replicas,
    /// The scatter of replicas at a place and at its neighbours.
    Neighbours,
    /// The scatter of what is added from place to place: a curve that accumulates chance.
    Growth,
    /// Blocks of one run.
    Blocks,
    /// What the runs themselves state.
    Stated,
    /// There are none.
    #[default]
    Nothing,
}

/// How long something remembers: its integrated autocorrelation time.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// The time; values this far apart, twice, count as independent.
    pub time: f64,
    /// What it is measured in: the abscissa, or `collisions_per_particle`.
    pub clock: String,
}

/// The mean difference of two curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overall {
    /// In the terms of the difference's values.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
    /// |value| / error.
    pub standard_errors: f64,
    /// Standard errors beyond which it differs from zero.
    pub threshold: f64,
}

/// A difference in standard errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Where along x.
    pub place: f64,
    /// |value| / error.
    pub standard_errors: f64,
}

/// What came out of a comparison of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nowhere beyond the threshold.
    Agrees,
    /// Somewhere beyond it.
    Differs,
    /// There are no errors to judge by.
    Unknown,
    /// A figure is not steady in one of the two, so that its mean and error say nothing.
    NotSteady,
}

/// A figure of the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedFigure {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Dimension,
    /// `[contestant]`.
    pub values: Vec<Option<Estimate>>,
    /// `[contestant]`: whether its series is steady in the runs; `None` where no run says so.
    pub trends: Vec<Option<Trend>>,
    /// `[contestant]` against the reference, each with one value.
    pub differences: Vec<Option<Difference>>,
    /// What theory says, where it says something, with its source.
    pub theory: Option<(f64, String)>,
}
