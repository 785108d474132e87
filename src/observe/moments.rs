//! Sums over all grains that do not depend on the number of threads.
//!
//! Grains are cut into blocks of a fixed length; each block is summed in order, and the sums of the
//! blocks are added in order with compensation (Kahan 1965).

use std::ops::{Add, Sub};

use rayon::prelude::*;

use crate::matter::gas::Gas;
use crate::space::Vector;

/// Grains in a block; part of the definition of every sum, so that it never changes with the machine.
const BLOCK: usize = 4096;

/// Kinetic energy ½ m Σ|v|² in the frame of the laboratory [mass·length²/time²].
pub fn kinetic_energy<V: Vector>(gas: &Gas<V>) -> f64 {
    0.5 * gas.grain.mass * sum(gas.velocities(), |v| v.length_squared())
}

/// Momentum m Σ v of all grains [mass·length/time].
pub fn momentum<V: Vector>(gas: &Gas<V>) -> V {
    sum(gas.velocities(), |v| *v) * gas.grain.mass
}

/// m Σ|v|: the momentum there would be if all grains went the same way [mass·length/time].
pub fn momentum_scale<V: Vector>(gas: &Gas<V>) -> f64 {
    gas.grain.mass * sum(gas.velocities(), |v| v.length())
}

/// Mean velocity of all grains [length/time]; zero without grains.
pub fn mean_velocity<V: Vector>(gas: &Gas<V>) -> V {
    if gas.is_empty() { V::ZERO } else { sum(gas.velocities(), |v| *v) * (1.0 / gas.len() as f64) }
}

/// Granular temperature m⟨|v − v̄|²⟩/D about the mean of all grains [mass·length²/time²]; zero without grains.
pub fn temperature<V: Vector>(gas: &Gas<V>) -> f64 {
    if gas.is_empty() {
        return 0.0;
    }
    let mean = mean_velocity(gas);
    let squares = sum(gas.velocities(), |v| (*v - mean).length_squared());
    gas.grain.mass * squares / (gas.len() * V::DIMENSION) as f64
}

/// The sum of `term` over `items`.
pub(crate) fn sum<T, S>(items: &[T], term: impl Fn(&T) -> S + Sync) -> S
where
    T: Sync,
    S: Copy + Default + Send + Add<Output = S> + Sub<Output = S>,
{
    let blocks: Vec<S> = items
        .par_chunks(BLOCK)
        .map(|block| block.iter().fold(S::default(), |total, item| total + term(item)))
        .collect();
    let (mut total, mut compensation) = (S::default(), S::default());
    for block in blocks {
        let increment = block - compensation;
        let next = total + increment;
        compensation = (next - total) - increment;
        total = next;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::testing::{random_positions, random_velocities, setting_of};
    use glam::{DVec2, DVec3};

    #[test]
    fn two_grains_by_hand() {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let positions = vec![DVec2::ONE, DVec2::splat(3.0)];
        let mut gas = bed.gas(0.0, positions, vec![DVec2::new(3.0, 4.0), DVec2::new(1.0, 0.0)]);
        gas.grain.mass = 2.0;
        assert_eq!(kinetic_energy(&gas), 26.0);
        assert_eq!(momentum(&gas), DVec2::new(8.0, 8.0));
        assert_eq!(momentum_scale(&gas), 12.0);
        assert_eq!(mean_velocity(&gas), DVec2::new(2.0, 2.0));
        // |v − v̄|² = 5 each; 2 · 10 / (2 · 2).
        assert_eq!(temperature(&gas), 5.0);
    }

    #[test]
    fn an_empty_gas_has_no_energy() {
        let gas = setting_of(DVec3::splat(4.0), [2, 2, 2]).gas(0.0, vec![], vec![]);
        assert_eq!((kinetic_energy(&gas), temperature(&gas)), (0.0, 0.0));
        assert_eq!(mean_velocity(&gas), DVec3::ZERO);
    }

    #[test]
    fn threads_change_no_bit() {
        let size = DVec3::splat(10.0);
        let gas = setting_of(size, [5, 5, 5]).gas(
            0.0,
            random_positions(1, 50_000, size),
            random_velocities(2, 50_000),
        );
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (kinetic_energy(&gas), momentum(&gas), temperature(&gas)))
        };
        assert_eq!(with(1), with(2));
        assert_eq!(with(1), with(7));
        // 150 000 squares of unit Gaussians: 1 ± √(2/150000).
        assert!((temperature(&gas) - 1.0).abs() < 4.0 * (2.0_f64 / 150_000.0).sqrt());
    }
}
