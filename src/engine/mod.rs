//! Engines: what advances a gas.

pub mod report;
pub mod stochastic;

use crate::matter::gas::Gas;
use crate::space::Vector;
use report::StepReport;

/// Something that advances a gas by one step.
pub trait Engine<V: Vector>: Send {
    /// One step. `laps` is told which verb of the algorithm begins.
    fn step(&mut self, gas: &mut Gas<V>, laps: &mut dyn Laps) -> Result<StepReport<V>, EngineError>;

    /// Everything beside the gas that the next step reads, as numbers to be saved.
    fn state(&self) -> EngineState;

    /// Takes over what [`Engine::state`] gave.
    fn restore(&mut self, state: &EngineState);

    /// Somebody has changed velocities from outside: what the engine knew of them is void.
    fn forget_pace(&mut self);

    /// Grains that make a cell full, for engines with an excluded volume.
    fn capacity(&self, gas: &Gas<V>) -> Option<u32>;
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
    /// Largest speed after the last step [length/time], or −1 when it has to be measured.
    pub largest_speed: f64,
    /// Collisions per time of the whole gas that the next step expects [1/time], or −1.
    pub collision_rate: f64,
}

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
    /// Nothing moves and nothing will.
    #[error(
        "nothing moves any more at t = {time}: no speed, no gravity and no moving wall from which a time step could be taken"
    )]
    NothingMoves {
        /// When [time].
        time: f64,
    },
}
