//! Engines: what advances a gas.

pub mod cell_counts;
pub mod event_driven;
pub mod report;
pub mod stochastic;

use crate::matter::gas::Gas;
use crate::space::Vector;
use cell_counts::CellCount;
use event_driven::rules::Cure;
use report::StepReport;

/// Something that advances a gas.
pub trait Engine<V: Vector>: Send {
    /// Advances `gas`: by one step where the engine has steps, which are never shortened; otherwise up to
    /// `horizon`, or less far where that would take long. `laps` is told which verb of the algorithm begins.
    fn step(
        &mut self,
        gas: &mut Gas<V>,
        horizon: Horizon,
        laps: &mut dyn Laps,
    ) -> Result<StepReport<V>, EngineError>;

    /// Told before a step how many collisions per particle the run has had, for laws that change with them.
    fn collided(&mut self, _per_particle: f64) {}

    /// Everything beside the gas that the next step reads, as numbers to be saved.
    fn state(&self) -> EngineState;

    /// Takes over what [`Engine::state`] gave when the grains were those of `gas`. A state without numbers and words is that of
    /// an engine that begins with `gas`. Nothing changes where it does not fit.
    fn restore(&mut self, state: &EngineState, gas: &Gas<V>) -> Result<(), EngineMisfit>;

    /// Somebody has changed velocities from outside: what the engine knew of them is void.
    fn forget_pace(&mut self);

    /// Counts from now on what happens in each cell of the gas, on top of `counts` `[cell]`. What happens does not
    /// depend on it.
    fn count_in_cells(&mut self, counts: Vec<CellCount>);

    /// What was counted `[cell]`; empty where nothing is.
    fn cell_counts(&self) -> &[CellCount];

    /// Grains that make a cell full, for engines with an excluded volume.
    fn capacity(&self, gas: &Gas<V>) -> Option<u32>;

    /// Whether grains never overlap, so that none may be put where another one is. Such an engine works
    /// event by event and has no steps.
    fn excludes_overlap(&self) -> bool {
        false
    }
}

/// Where somebody wants to look at the gas next. An engine without steps of its own stops there; where it stops
/// has no influence on the bits of its trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon {
    /// Simulated time [time].
    pub time: f64,
    /// Collisions of pairs, counted from the call on.
    pub collisions: u64,
}

impl Horizon {
    /// No place to stop.
    pub const NONE: Horizon = Horizon { time: f64::INFINITY, collisions: u64::MAX };

    /// The nearer of both, for time and for collisions.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Horizon { time: self.time.min(other.time), collisions: self.collisions.min(other.collisions) }
    }
}

/// Told of each verb of the algorithm as it begins: a timer in a run, nothing in a test.
pub trait Laps {
    /// `verb` begins, and with it the last one ends.
    fn start(&mut self, verb: &'static str);
}

/// Nobody keeps time.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoLaps;

impl Laps for NoLaps {
    fn start(&mut self, _verb: &'static str) {}
}

/// What the next step reads beside the gas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EngineState {
    /// Steps made: names the random streams and flips the checkerboard.
    pub step: u64,
    /// Largest speed at the end of a flight of the last step [length/time], or −1 when it has to be measured. The length of the
    /// next step follows from it. Grains whose moves were rejected after their flight may be faster.
    pub largest_speed: f64,
    /// Collisions per time of the whole gas that the next step expects [1/time], or −1.
    pub collision_rate: f64,
    /// What an event-driven engine holds, as numbers in an order of its own; empty for others.
    pub numbers: Vec<f64>,
    /// The same, as words.
    pub words: Vec<u32>,
}

/// Why an engine cannot go on from a state: something in it is not as any engine leaves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("what the engine held is not whole: {0}")]
pub struct EngineMisfit(pub &'static str);

/// Why a step could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// A fixed step is longer than a cell allows.
    #[error(
        "the fixed time step {step} is too long at t = {time}: nothing may cross more than a cell per step, \
         and the fastest grain or wall moves at {speed}; `engine.time_step.fixed` = {longest} would just do here"
    )]
    StepTooLong {
        /// The step asked for [time].
        step: f64,
        /// The longest that would do [time].
        longest: f64,
        /// The largest speed [length/time].
        speed: f64,
        /// When [time].
        time: f64,
    },
    /// Grains collide too often in a fixed step.
    #[error(
        "the fixed time step {step} is too long at t = {time}: a grain would collide {collisions:.1} times in it, and {most} \
         times is the most; `engine.time_step.fixed` = {longest} would just do here"
    )]
    TooManyCollisions {
        /// The step asked for [time].
        step: f64,
        /// The longest that would do [time].
        longest: f64,
        /// Collisions of a grain in the step, on an average.
        collisions: f64,
        /// The most that may be.
        most: f64,
        /// When [time].
        time: f64,
    },
    /// A number is no longer finite.
    #[error(
        "grain {id} in cell {cell} has a position or velocity that is not finite after step {step} (seed {seed}, t = {time})"
    )]
    NotFinite {
        /// Identity of the grain.
        id: u32,
        /// Its cell.
        cell: u32,
        /// The step.
        step: u64,
        /// The seed.
        seed: u64,
        /// When [time].
        time: f64,
    },
    /// Grains collide without end in no time.
    #[error(
        "inelastic collapse at t = {time}: grain {id} has collided {collisions} times within {span:e} time units \
         (seed {seed}); set a cure in [engine.event_driven], such as collapse = {remedy}"
    )]
    Collapse {
        /// Identity of a grain that takes part.
        id: u32,
        /// Its collisions in the span.
        collisions: u32,
        /// The span in which they happened [time].
        span: f64,
        /// The seed.
        seed: u64,
        /// When [time].
        time: f64,
        /// A cure that goes further than the one there was.
        remedy: Cure,
    },
    /// Nothing moves and nothing will.
    #[error(
        "nothing moves any more at t = {time}: no speed, no gravity and no moving wall from which a time step could be taken"
    )]
    NothingMoves {
        /// When [time].
        time: f64,
    },
}
