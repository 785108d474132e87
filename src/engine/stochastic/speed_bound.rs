//! How fast the grains of one cell move relative to each other.

use crate::space::Vector;

/// What the velocities of a cell tell in one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RelativeSpeeds {
    /// No two grains are faster relative to each other than the square root of this [length²/time²]: the
    /// diagonal of the box in velocity space that holds them all.
    pub(crate) largest_square: f64,
    /// Σ |v − v_c|², with the mean velocity v_c [length²/time²].
    pub(crate) sum_of_squares: f64,
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
            lowest = lowest.lower(relative);
            highest = highest.upper(relative);
            sum += relative;
            squares += relative.length_squared();
        }
        let about_mean = squares - sum.length_squared() / velocities.len() as f64;
        RelativeSpeeds {
            largest_square: (highest - lowest).length_squared(),
            sum_of_squares: if about_mean < 0.0 { 0.0 } else { about_mean },
        }
    }
}
