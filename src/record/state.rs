//! A saved state: everything that the next step reads, at full precision.

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
pub struct SavedState<V: Vector> {
    /// Simulated time [time].
    pub time: f64,
    /// Rounding held back by the clock.
    pub compensation: f64,
    /// Grains in container order.
    pub columns: Columns<V>,
    /// The next identity to be given.
    pub next_id: u32,
    /// What the engine remembers.
    pub engine: EngineState,
    /// Sums since the start of the run.
    pub totals: Totals<V>,
    /// When the last grain was poured [time]; −1 before.
    pub last_poured: f64,
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

impl<V: Vector> SavedState<V> {
    /// The gas of this state, in the box of `grid`.
    pub fn gas(&self, grid: Grid<V>, grain: Grain) -> Gas<V> {
        let clock = Clock::restored(self.time, self.compensation);
        Gas::restored(grid, grain, self.columns.clone(), clock, self.next_id)
    }
}
