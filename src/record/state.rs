//! A saved state: everything that the next step reads, at full precision.

use std::borrow::Cow;

use crate::engine::EngineState;
use crate::engine::report::Totals;
use crate::matter::clock::Clock;
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// Everything that the next step, and the figures at the end, depend on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedState<'a, V: Vector> {
    /// Simulated time [time].
    pub time: f64,
    /// Rounding held back by the clock.
    pub compensation: f64,
    /// Grains in container order: those of a running gas on the way into a log, owned on the way out.
    pub columns: Cow<'a, Columns<V>>,
    /// Largest speed of these grains [length/time], by which a state is known to be whole; `None` in logs that have none. The
    /// speed that the length of the next step follows from is the engine's.
    pub largest_speed: Option<f64>,
    /// The next identity to be given.
    pub next_id: u32,
    /// What the engine remembers.
    pub engine: EngineState,
    /// Sums since the start of the run.
    pub totals: Totals<V>,
    /// When the last grain was poured [time]; −1 before.
    pub last_poured: f64,
    /// Until when the source is held up by grains in its way [time]; 0 where it never was.
    pub held_until: f64,
    /// Recordings made.
    pub recordings: u64,
    /// States saved before this one.
    pub states: u64,
    /// Samples taken, by measure, in the order of the measures.
    pub samples: Vec<u64>,
    /// Memory of each measure, by name.
    pub memories: Vec<(String, Vec<f64>)>,
    /// What the run began with.
    pub beginning: Beginning<V>,
    /// Overlaps found by audits so far; `None` where the engine allows overlap.
    pub invalid_states: Option<u64>,
}

/// What a run began with, after equilibration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beginning<V> {
    /// Grains.
    pub particles: u64,
    /// Kinetic energy in the frame of the laboratory [mass·length²/time²].
    pub kinetic_energy: f64,
    /// Momentum [mass·length/time].
    pub momentum: V,
    /// Σ m|v|, against which lost momentum is measured [mass·length/time].
    pub momentum_scale: f64,
}

/// A measure that every run has and that samples.
const COLLISIONS: &str = "collisions";
/// Samples of versions that took 400 at even places of a run have numbers from 1 to 401; later ones are 0 or above this.
const LARGEST_EVEN_SAMPLE: u64 = 401;

impl<V: Vector> SavedState<'_, V> {
    /// Whether its measures sampled at even places of the run, as versions before the one with random places did.
    pub fn has_even_samples(&self) -> bool {
        self.memories
            .iter()
            .zip(&self.samples)
            .any(|((name, _), number)| name == COLLISIONS && (1..=LARGEST_EVEN_SAMPLE).contains(number))
    }

    /// Takes the gas of this state out of it, into the box of `grid`.
    pub fn take_gas(&mut self, grid: Grid<V>, grain: Grain) -> Gas<V> {
        let clock = Clock::restored(self.time, self.compensation);
        Gas::restored(grid, grain, std::mem::take(&mut self.columns).into_owned(), clock, self.next_id)
    }
}
