//! The checked scenario.

use glam::{DVec2, DVec3};

pub use crate::engine::event_driven::rules::{Cure, EventDrivenRules, Structure};
pub use crate::engine::stochastic::rules::{
    Admission, DisplacementRule, EnskogFactor, HsmcRules, TimeStep, Transfer,
};
use crate::law::boundary::Boundary;
use crate::law::impact::ImpactLaw;
use crate::law::piecewise::PiecewiseLinear;
use crate::law::restitution::RestitutionLaw;
use crate::law::roughness::Roughness;
use crate::law::source::Source;
use crate::matter::grain::Grain;
use crate::observe::field::Quantity;

/// A scenario in two or three dimensions.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyScenario {
    /// Disks in a plane.
    Two(Scenario<DVec2>),
    /// Spheres in space.
    Three(Scenario<DVec3>),
}

/// A checked scenario in the space of `V`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scenario<V> {
    /// The file's stem, or the built-in name.
    pub name: String,
    /// Title for reports.
    pub title: String,
    /// The scenario as TOML text, with every `--set` applied: running it gives the same run.
    pub source_text: String,
    /// Seed of all random streams, below 2⁶³.
    pub seed: u64,
    /// Constant acceleration of every grain [length/time²].
    pub gravity: V,
    /// The engine and its parameters.
    pub engine: EngineChoice,
    /// `domain.size` [length].
    pub size: V,
    /// Lower corner of the grid: below zero only by the amplitude of a vibrating wall [length].
    pub grid_origin: V,
    /// Sides of the grid [length].
    pub grid_size: V,
    /// Cells along each axis of the grid; 1 beyond D.
    pub cells: [u32; 3],
    /// The sides of the box.
    pub boundary: Boundary<V>,
    /// Diameter and mass of a grain; of the first species where there are several, which is the one that a
    /// source pours. Means over all grains are asked for by name: [`Scenario::mean_volume`] and its kin.
    pub grain: Grain,
    /// Diameter and mass of each species `[species]`; empty where all grains are alike.
    pub species: Vec<Grain>,
    /// Grains of each species at the start `[species]`; empty where all grains are alike.
    pub species_counts: Vec<u32>,
    /// Tangential restitution and moment of inertia; `None` where grains are smooth.
    pub roughness: Option<Roughness>,
    /// Restitution of grain–grain collisions.
    pub restitution: RestitutionLaw,
    /// Grains at the start.
    pub count: u32,
    /// How positions and velocities begin.
    pub initial: Initial,
    /// The pouring source, if any.
    pub source: Option<Source<V>>,
    /// When the run ends.
    pub run: RunLimits,
    /// What is recorded.
    pub record: RecordPlan,
    /// Names of the units, for labels.
    pub units: Units,
}

/// The engine and its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct EngineChoice {
    /// Which engine.
    pub kind: EngineKind,
    /// How the time step is chosen.
    pub time_step: TimeStep,
    /// Where the Enskog factor takes its density from (CBA, HSMC).
    pub enskog_factor: EnskogFactor,
    /// How the collisional transfer of momentum is made (CBA, HSMC).
    pub transfer: Transfer,
    /// Impact parameters of pair collisions (DSMC, CBA, HSMC).
    pub impact_law: ImpactLaw,
    /// Rules of HSMC.
    pub hsmc: HsmcRules,
    /// HSMC: p(ν) of entering a cell of volume fraction ν; `None` where only a lack of room keeps grains out.
    pub entry_probability: Option<PiecewiseLinear>,
    /// Rules of the event-driven engine.
    pub event_driven: EventDrivenRules,
}

/// The engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngineKind {
    /// Direct simulation Monte Carlo (Bird; Nanbu's fixed-step form).
    Dsmc,
    /// Consistent Boltzmann algorithm (Alexander, Garcia and Alder 1995).
    Cba,
    /// Hybrid simulation Monte Carlo (Müller 2001).
    Hsmc,
    /// Exact dynamics of hard grains, one collision after another (Lubachevsky 1991).
    EventDriven,
}

impl EngineKind {
    /// Every engine.
    pub const ALL: [EngineKind; 4] =
        [EngineKind::Dsmc, EngineKind::Cba, EngineKind::Hsmc, EngineKind::EventDriven];

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            EngineKind::Dsmc => "dsmc",
            EngineKind::Cba => "cba",
            EngineKind::Hsmc => "hsmc",
            EngineKind::EventDriven => "event-driven",
        }
    }

    /// Whether grains must not overlap at the start, and collide as spheres of their own size.
    pub fn is_event_driven(self) -> bool {
        self == EngineKind::EventDriven
    }
}

/// How positions and velocities begin.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// Where grains are.
    pub positions: InitialPositions,
    /// How they move.
    pub velocities: InitialVelocities,
    /// Collisions per particle before t = 0, elastic and undriven; 0 for none.
    pub equilibrate: f64,
}

/// Where grains are at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum InitialPositions {
    /// Independent places.
    Random,
    /// Counts per cell that differ by at most one, random places inside; a regular lattice for the
    /// event-driven engine.
    Lattice,
    /// Grown from a dilute gas of small grains until they have their size: dense and without overlap.
    Compressed,
    /// The last state of a log, with its velocities.
    Log(std::path::PathBuf),
}

impl InitialPositions {
    /// Whether they come from a log.
    pub fn is_log(&self) -> bool {
        matches!(self, InitialPositions::Log(_))
    }
}

/// How grains move at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InitialVelocities {
    /// Maxwellian at this temperature [mass·length²/time²].
    Maxwell(f64),
    /// Each component uniform in [−w, w], this w [length/time]; the temperature m w²/3 is met exactly.
    Uniform(f64),
    /// Not at all.
    Rest,
}

/// When a run ends: at the first limit reached. At least one is set.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunLimits {
    /// Simulated time [time].
    pub time: Option<f64>,
    /// Steps.
    pub steps: Option<u64>,
    /// Collisions per particle, Σ 2ΔC/N.
    pub collisions_per_particle: Option<f64>,
    /// Time after the last poured grain [time].
    pub rest: Option<f64>,
}

/// What is recorded, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordPlan {
    /// When recordings are made.
    pub spacing: Spacing,
    /// Which share of the time of the run those may take that are spread over it; `None` for all of them, whatever they take.
    pub share: Option<f64>,
    /// Every n-th recording is full, and the last: it has the state hash, what its channels ask for, and the quantities for
    /// which measures look at the neighbours of every grain.
    pub full_every: u32,
    /// Whether the scenario does not state that number.
    pub usual_full: bool,
    /// Points of a frame: at most this many, `None` for all.
    pub points: Option<u32>,
    /// Frames are made at every n-th recording, or the next full one, and at the end.
    pub frames_every: u32,
    /// Profiles are stored at every n-th recording, or the next full one, and at the end.
    pub profiles_every: u32,
    /// Fields that are recorded where the engine has them.
    pub fields: Vec<Quantity>,
    /// Fields are recorded at every n-th recording, or the next full one, and at the end.
    pub fields_every: u32,
    /// Names of the measures whose series and profiles are stored; `None` for all that apply and are cheap.
    pub measures: Option<Vec<String>>,
    /// Full-precision states during the run, beside the one at the end.
    pub states: u32,
    /// Whether that is the default: the scenario states neither it nor an interval.
    pub usual_states: bool,
    /// One every so much time instead, beginning at 0 [time].
    pub state_every: Option<f64>,
    /// Steady figures are taken from this time on [time]; `None` for the second half.
    pub from: Option<f64>,
}

/// When recordings are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spacing {
    /// This many, spread evenly over the limit that comes first; one at the start beside them.
    Frames(u32),
    /// This many, spread evenly in the logarithm of time or collisions; one at the start beside them.
    LogFrames(u32),
    /// One every so much time [time].
    Every(f64),
    /// Only at the start and at the end.
    Ends,
}

/// Names of the units, for labels.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// Unit of length.
    pub length: String,
    /// Unit of mass.
    pub mass: String,
    /// Unit of time.
    pub time: String,
}
