//! How fast the grains of one cell move relative to each other.

use crate::space::Vector;

/// What the velocities of a cell tell in one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RelativeSpeeds {
    /// No two grains are faster relative to each other than the square root of this [length²/time²]: the
    /// diagonal of the box in velocity space that holds them all.
    pub(crate) largest_square: f64,
    /// Σ (v_i − v_j)² over all pairs, N Σ |v − v_c|² with the mean velocity v_c [length²/time²].
    pub(crate) sum_over_pairs: f64,
}

impl RelativeSpeeds {
    /// Of at least one grain. Relative to the first of them, so that a fast common motion costs no precision.
    #[inline(always)]
    pub(crate) fn of<V: Vector>(velocities: &[V]) -> Self {
        let pivot = velocities[0];
        let (mut lowest, mut highest) = (V::ZERO, V::ZERO);
        let (mut sum, mut squares) = (V::ZERO, 0.0);
        for &velocity in &velocities[1..] {
            let relative = velocity - pivot;
            lowest = relative.lower(lowest);
            highest = relative.upper(highest);
            sum += relative;
            squares += relative.length_squared();
        }
        let over_pairs = velocities.len() as f64 * squares - sum.length_squared();
        RelativeSpeeds {
            largest_square: (highest - lowest).length_squared(),
            sum_over_pairs: if over_pairs < 0.0 { 0.0 } else { over_pairs },
        }
    }
}
