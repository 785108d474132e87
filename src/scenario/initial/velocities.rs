//! Velocities of a stated kind, with zero momentum and an exact temperature.

use rayon::prelude::*;

use super::super::model::{InitialVelocities, Scenario};
use crate::matter::gas::Gas;
use crate::random::{Phase, Stream, Streams};
use crate::space::Vector;

/// Gives `velocities` zero total momentum and exactly `temperature` = Σ m v²/(D N); `mass` is that of the
/// first species, `weight(k)` the mass of grain `k` in units of it: 1 where all grains are alike.
///
/// A single grain keeps its direction: without momentum it would have no temperature.
/// Grains at rest stay at rest.
fn set_temperature<V: Vector>(
    velocities: &mut [V],
    weight: impl Fn(usize) -> f64,
    mass: f64,
    temperature: f64,
) {
    let number = velocities.len() as f64;
    if velocities.len() > 1 {
        let total = compensated_sum((0..velocities.len()).map(&weight));
        let mean = V::from_fn(|axis| {
            compensated_sum(velocities.iter().enumerate().map(|(k, velocity)| weight(k) * velocity[axis]))
                / total
        });
        for velocity in velocities.iter_mut() {
            *velocity -= mean;
        }
    }
    let mean_square = compensated_sum(
        velocities.iter().enumerate().map(|(k, velocity)| weight(k) * velocity.length_squared()),
    ) / (number * V::DIMENSION as f64);
    if mean_square > 0.0 {
        let factor = (temperature / mass / mean_square).sqrt();
        for velocity in velocities.iter_mut() {
            *velocity = *velocity * factor;
        }
    }
}

/// Brings `gas` to rest as a whole and to `temperature` [mass·length²/time²], Σ m v²/(D N).
///
/// A single grain keeps its direction: without momentum it would have no temperature.
/// Grains at rest stay at rest. Spins stay as they are.
pub fn rescale<V: Vector>(gas: &mut Gas<V>, temperature: f64) {
    let mass = gas.grain.mass;
    let weights: Vec<f64> = (0..gas.len()).map(|row| gas.grain_at(row).mass / mass).collect();
    set_temperature(gas.velocities_mut(), |row| weights[row], mass, temperature);
}

/// The temperature that a scenario states: T, m w²/3 for uniform velocities (m the mean mass), 0 at rest.
pub fn stated_temperature<V: Vector>(scenario: &Scenario<V>) -> f64 {
    match scenario.initial.velocities {
        InitialVelocities::Maxwell(temperature) => temperature,
        InitialVelocities::Uniform(w) => scenario.mean_mass() * w * w / 3.0,
        InitialVelocities::Rest => 0.0,
    }
}

/// Velocities `[id]` of the stated kind for grains of these `species`, momentum zero and temperature exact.
pub(super) fn velocities<V: Vector>(scenario: &Scenario<V>, species: Option<&[u8]>) -> Vec<V> {
    let mass = scenario.grain.mass;
    let weight = |id: usize| species.map_or(1.0, |of| scenario.species[usize::from(of[id])].mass / mass);
    let streams = Streams::new(scenario.seed).at(0, Phase::InitialVelocities);
    let draw = |component: fn(&mut Stream) -> f64| -> Vec<V> {
        let one = |id| {
            let mut random = streams.stream(u64::from(id));
            V::from_fn(|_| component(&mut random))
        };
        (0..scenario.count).into_par_iter().map(one).collect()
    };
    let mut velocities = match scenario.initial.velocities {
        InitialVelocities::Maxwell(_) => draw(Stream::gaussian),
        InitialVelocities::Uniform(_) => draw(Stream::symmetric),
        InitialVelocities::Rest => return vec![V::ZERO; scenario.count as usize],
    };
    if matches!(scenario.initial.velocities, InitialVelocities::Maxwell(_)) {
        // Every component has the variance T/m of its own mass.
        for (id, velocity) in velocities.iter_mut().enumerate() {
            *velocity = *velocity * (1.0 / weight(id).sqrt());
        }
    }
    set_temperature(&mut velocities, weight, mass, stated_temperature(scenario));
    velocities
}

/// A sum whose rounding does not grow with the number of terms (Neumaier 1974).
fn compensated_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}
