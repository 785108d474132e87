//! Sums over all grains that do not depend on the number of threads.
//!
//! Grains are cut into blocks of a fixed length; each block is summed in order, and the sums of the
//! blocks are added in order with compensation (Kahan 1965).

use std::ops::{Add, Sub};

use rayon::prelude::*;

use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::space::Vector;

/// Grains in a block; part of the definition of every sum, so that it never changes with the machine.
const BLOCK: usize = 4096;

/// Kinetic energy of translation Σ ½ m|v|² in the frame of the laboratory [mass·length²/time²].
pub fn kinetic_energy<V: Vector>(gas: &Gas<V>) -> f64 {
    match Mixture::of(gas) {
        Some(mixture) => 0.5 * mixture.sum(|grain, v| v.length_squared() * grain.mass),
        None => 0.5 * gas.grain.mass * sum(gas.velocities(), |v| v.length_squared()),
    }
}

/// Kinetic energy of rotation Σ ½ I|ω|² [mass·length²/time²], with I = z m a² for the reduced moment of inertia
/// z and the radius a; zero where grains do not spin.
pub fn rotational_energy<V: Vector>(gas: &Gas<V>, reduced_inertia: f64) -> f64 {
    let Some(spins) = &gas.columns().spins else { return 0.0 };
    let squares = |row: usize| spins[row].as_ref().iter().map(|x| x * x).sum::<f64>();
    let inertia = |row: usize| {
        let grain = gas.grain_at(row);
        0.25 * reduced_inertia * grain.mass * grain.diameter * grain.diameter
    };
    0.5 * sum_rows(spins.len(), |row| squares(row) * inertia(row))
}

/// Momentum Σ m v of all grains [mass·length/time].
pub fn momentum<V: Vector>(gas: &Gas<V>) -> V {
    match Mixture::of(gas) {
        Some(mixture) => mixture.sum(|grain, v| v * grain.mass),
        None => sum(gas.velocities(), |v| *v) * gas.grain.mass,
    }
}

/// Σ m|v|: the momentum there would be if all grains went the same way [mass·length/time].
pub fn momentum_scale<V: Vector>(gas: &Gas<V>) -> f64 {
    match Mixture::of(gas) {
        Some(mixture) => mixture.sum(|grain, v| v.length() * grain.mass),
        None => gas.grain.mass * sum(gas.velocities(), |v| v.length()),
    }
}

/// Velocity of the centre of mass of all grains [length/time]; zero without grains.
pub fn mean_velocity<V: Vector>(gas: &Gas<V>) -> V {
    match Mixture::of(gas) {
        _ if gas.is_empty() => V::ZERO,
        Some(mixture) => momentum(gas) * (1.0 / mixture.sum(|grain, _| grain.mass)),
        None => sum(gas.velocities(), |v| *v) * (1.0 / gas.len() as f64),
    }
}

/// Mean of |v − v̄| over all grains, v̄ the velocity of their centre of mass [length/time]; zero without grains.
pub fn mean_speed<V: Vector>(gas: &Gas<V>) -> f64 {
    let mean = mean_velocity(gas);
    let speeds = sum(gas.velocities(), |v| (*v - mean).length());
    if gas.is_empty() { 0.0 } else { speeds / gas.len() as f64 }
}

/// Speed of the fastest grain [length/time]; zero without grains.
pub fn largest_speed<V: Vector>(velocities: &[V]) -> f64 {
    velocities.iter().map(|velocity| velocity.length_squared()).fold(0.0, f64::max).sqrt()
}

/// Temperature ⟨m|v − v̄|²⟩/D about the velocity v̄ of the centre of mass of all grains
/// [mass·length²/time²]; zero without grains.
pub fn temperature<V: Vector>(gas: &Gas<V>) -> f64 {
    if gas.is_empty() {
        return 0.0;
    }
    let mean = mean_velocity(gas);
    let squares = match Mixture::of(gas) {
        Some(mixture) => mixture.sum(|grain, v| (v - mean).length_squared() * grain.mass),
        None => gas.grain.mass * sum(gas.velocities(), |v| (*v - mean).length_squared()),
    };
    squares / (gas.len() * V::DIMENSION) as f64
}

/// [`kinetic_energy`] and [`temperature`], in one look less at the grains.
pub fn energy_and_temperature<V: Vector>(gas: &Gas<V>) -> (f64, f64) {
    if gas.is_empty() || Mixture::of(gas).is_some() {
        return (kinetic_energy(gas), temperature(gas));
    }
    let mass = gas.grain.mass;
    let Both(squares, total) = sum(gas.velocities(), |v| Both(v.length_squared(), *v));
    let mean = total * (1.0 / gas.len() as f64);
    let thermal = mass * sum(gas.velocities(), |v| (*v - mean).length_squared());
    (0.5 * mass * squares, thermal / (gas.len() * V::DIMENSION) as f64)
}

/// Two sums at a time.
#[derive(Clone, Copy, Default)]
struct Both<V>(f64, V);

impl<V: Vector> Add for Both<V> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Both(self.0 + other.0, self.1 + other.1)
    }
}

impl<V: Vector> Sub for Both<V> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Both(self.0 - other.0, self.1 - other.1)
    }
}

/// Volume (2D: area) of all grains [lengthᴰ].
pub fn volume<V: Vector>(gas: &Gas<V>) -> f64 {
    match Mixture::of(gas) {
        Some(mixture) => mixture.sum(|grain, _| grain.volume::<V>()),
        None => gas.len() as f64 * gas.grain.volume::<V>(),
    }
}

/// A gas of several species.
struct Mixture<'a, V: Vector>(&'a Gas<V>);

impl<'a, V: Vector> Mixture<'a, V> {
    /// `gas`, if it has several species.
    fn of(gas: &'a Gas<V>) -> Option<Self> {
        (!gas.species.is_empty() && gas.columns().species.is_some()).then_some(Mixture(gas))
    }

    /// The sum of `term` over all grains and their velocities.
    fn sum<S>(&self, term: impl Fn(Grain, V) -> S + Sync) -> S
    where
        S: Copy + Default + Send + Add<Output = S> + Sub<Output = S>,
    {
        let velocities = self.0.velocities();
        sum_rows(velocities.len(), |row| term(self.0.grain_at(row), velocities[row]))
    }
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
    compensated(blocks)
}

/// The sum of `term` over rows 0 … `rows` − 1, in the same blocks.
pub(crate) fn sum_rows<S>(rows: usize, term: impl Fn(usize) -> S + Sync) -> S
where
    S: Copy + Default + Send + Add<Output = S> + Sub<Output = S>,
{
    let blocks: Vec<S> = (0..rows.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let rows = block * BLOCK..rows.min((block + 1) * BLOCK);
            rows.fold(S::default(), |total, row| total + term(row))
        })
        .collect();
    compensated(blocks)
}

/// The sums of blocks, added in order with compensation.
fn compensated<S: Copy + Default + Add<Output = S> + Sub<Output = S>>(blocks: Vec<S>) -> S {
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
        assert_eq!((largest_speed(gas.velocities()), largest_speed::<DVec2>(&[])), (5.0, 0.0));
        // |v − v̄|² = 5 each; 2 · 10 / (2 · 2).
        assert_eq!(temperature(&gas), 5.0);
        assert_eq!(energy_and_temperature(&gas), (26.0, 5.0));
    }

    #[test]
    fn every_grain_of_a_mixture_has_its_mass() {
        let bed = setting_of(DVec2::splat(4.0), [1, 1, 1]);
        let velocities = vec![DVec2::new(3.0, 4.0), DVec2::new(-1.0, 0.0)];
        let mut gas = bed.gas(0.0, vec![DVec2::ONE, DVec2::splat(3.0)], velocities);
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 2.0, mass: 3.0 }];
        let columns = gas.parts_mut().2;
        columns.species = Some(vec![0, 1]);
        columns.spins = Some(vec![[2.0], [-1.0]]);
        assert_eq!(kinetic_energy(&gas), 14.0);
        assert_eq!(momentum(&gas), DVec2::new(0.0, 4.0));
        assert_eq!(momentum_scale(&gas), 8.0);
        assert_eq!(mean_velocity(&gas), DVec2::new(0.0, 1.0));
        // (9 + 9 + 3 (1 + 1)) / (2 · 2).
        assert_eq!(temperature(&gas), 6.0);
        assert!((volume(&gas) - 5.0 * std::f64::consts::FRAC_PI_4).abs() < 1e-15);
        // z/2 (1/4 · 4 + 3 · 1).
        assert_eq!(rotational_energy(&gas, 0.5), 1.0);
        gas.species = vec![gas.grain; 2];
        let mixed = (kinetic_energy(&gas), momentum(&gas), temperature(&gas));
        gas.species.clear();
        assert_eq!(mixed, (kinetic_energy(&gas), momentum(&gas), temperature(&gas)));
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
        assert_eq!(energy_and_temperature(&gas), (kinetic_energy(&gas), temperature(&gas)));
        // 150 000 squares of unit Gaussians: 1 ± √(2/150000).
        assert!((temperature(&gas) - 1.0).abs() < 4.0 * (2.0_f64 / 150_000.0).sqrt());
    }
}
