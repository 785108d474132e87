//! A saved state: everything that the next step reads, at full precision.

use crate::engine::EngineState;
use crate::engine::report::Totals;
use crate::matter::columns::Columns;
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
    /// Samples taken, by measure, in the order of the measures.
    pub samples: Vec<u64>,
    /// Memory of each measure, by name.
    pub memories: Vec<(String, Vec<f64>)>,
}
