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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::DVec3;

    #[test]
    fn bound_and_sum_are_those_of_all_pairs_in_every_frame() {
        let mut random = Streams::new(6).at(0, Phase::InitialVelocities).stream(0);
        for grains in 1..20 {
            let own: Vec<DVec3> = (0..grains).map(|_| DVec3::from_fn(|_| random.gaussian())).collect();
            for frame in [0.0, 1e6] {
                let velocities: Vec<DVec3> = own.iter().map(|&v| v + DVec3::splat(frame)).collect();
                let pairs = || {
                    velocities
                        .iter()
                        .enumerate()
                        .flat_map(|(i, &a)| velocities[i..].iter().map(move |&b| a - b))
                };
                let speeds = RelativeSpeeds::of(&velocities);
                let sum: f64 = pairs().map(DVec3::length_squared).sum();
                assert!((speeds.sum_over_pairs - sum).abs() <= 1e-12 * sum);
                assert!(pairs().all(|relative| relative.length_squared() <= speeds.largest_square));
            }
        }
        let two = [DVec3::X, DVec3::Y];
        assert_eq!(RelativeSpeeds::of(&two).largest_square, 2.0);
    }
}
