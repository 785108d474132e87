//! Temperatures of the species of a mixture about the local flow, without the assumption that they are equal.
//!
//! What a grain moves the fitted flow by takes part of its velocity out, and puts part of that of others in. With the φ_k of
//! [`LocalFlow`], φ₀ = 1/√M among them, the sum over the grains of species s in a bin has the expectation
//!
//! E Σ_s m|v − u|²/D = (N_s − 2 tr Pˢ) T_s + Σ_t (Pˢ : Pᵗ) T_t, Pˢ_kl = Σ_s m φ_k φ_l,
//!
//! which follows from velocities that are independent and of variance T_s/m_s. As Σ_t Pᵗ = 1 it is (N_s − tr Pˢ) T where all
//! temperatures are T. Summed over bins these are as many linear equations as there are species.

use std::ops::Range;

use super::local_flow::{Flow, LocalFlow};
use crate::matter::gas::Gas;
use crate::space::Vector;

/// A pivot below this share of the diagonal is rounding.
const SINGULAR: f64 = 1e-9;

/// The equations of a bin, or their sums over bins.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    /// `[species][species]`: factors of the temperatures.
    factors: Vec<Vec<f64>>,
    /// `[species]`: Σ m|v − u|²/D.
    squares: Vec<f64>,
}

/// Σ m φ_k φ_l of one species.
type Products = [[f64; 4]; 4];

impl Equations {
    fn none(species: usize) -> Self {
        Equations { factors: vec![vec![0.0; species]; species], squares: vec![0.0; species] }
    }

    fn add(&mut self, other: &Self) {
        let rows = self.factors.iter_mut().zip(&other.factors);
        rows.flat_map(|(mine, theirs)| mine.iter_mut().zip(theirs)).for_each(|(sum, part)| *sum += part);
        self.squares.iter_mut().zip(&other.squares).for_each(|(sum, part)| *sum += part);
    }

    /// The equations of the grains in these runs of `rows` about their flow.
    fn of_bin<V: Vector>(gas: &Gas<V>, flow: &Flow<V>, rows: &mut dyn Iterator<Item = Range<usize>>) -> Self {
        let mut equations = Self::none(gas.species.len());
        let mut products = vec![[[0.0; 4]; 4]; gas.species.len()];
        let Some(species) = &gas.columns().species else { return equations };
        for row in rows.flatten() {
            let s = usize::from(species[row]);
            let mass = gas.species[s].mass;
            let coordinates = flow.all_coordinates(gas.positions()[row]);
            let rest = flow.rest(gas.positions()[row], gas.velocities()[row]);
            equations.squares[s] += mass * rest.length_squared() / V::DIMENSION as f64;
            equations.factors[s][s] += 1.0;
            for (k, sums) in products[s].iter_mut().enumerate() {
                let weighted = mass * coordinates[k];
                sums.iter_mut().zip(coordinates).for_each(|(sum, coordinate)| *sum += weighted * coordinate);
            }
        }
        for (s, of_one) in products.iter().enumerate() {
            equations.factors[s][s] -= 2.0 * (0..4).map(|k| of_one[k][k]).sum::<f64>();
            for (t, of_other) in products.iter().enumerate() {
                equations.factors[s][t] += contraction(of_one, of_other);
            }
        }
        equations
    }

    /// The temperatures [mass·length²/time²], `[species]`; NaN where the equations do not tell.
    fn solve(mut self) -> Vec<f64> {
        let species = self.squares.len();
        let scale: Vec<f64> = (0..species).map(|s| self.factors[s][s].abs()).collect();
        // The factors of a species itself outweigh those of others, so that the diagonal will do.
        for (s, &scale) in scale.iter().enumerate() {
            let pivot = self.factors[s][s];
            if scale == 0.0 {
                continue;
            }
            if pivot <= SINGULAR * scale {
                // Too few grains to tell one species from another.
                return vec![f64::NAN; species];
            }
            for t in (0..species).filter(|&t| t != s) {
                let share = self.factors[t][s] / pivot;
                for k in 0..species {
                    self.factors[t][k] -= share * self.factors[s][k];
                }
                self.squares[t] -= share * self.squares[s];
            }
        }
        // Zero over zero, NaN, of a species that has no grains.
        (0..species).map(|s| self.squares[s] / self.factors[s][s]).collect()
    }
}

fn contraction(one: &Products, other: &Products) -> f64 {
    one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| a * b).sum()
}

/// Temperatures of all species of `gas` about its `flow`, `[species]` [mass·length²/time²]; NaN where there are too few grains.
pub(crate) fn temperatures<V: Vector>(gas: &Gas<V>, flow: &LocalFlow<V>) -> Vec<f64> {
    let mut total = Equations::none(gas.species.len());
    for bin in equations(gas, flow).iter().flatten() {
        total.add(bin);
    }
    total.solve()
}

/// The same in each bin of the flow, `[bin][species]`; NaN where a bin holds too few grains.
pub(crate) fn temperatures_by_bin<V: Vector>(gas: &Gas<V>, flow: &LocalFlow<V>) -> Vec<Vec<f64>> {
    let nothing = || vec![f64::NAN; gas.species.len()];
    equations(gas, flow).into_iter().map(|bin| bin.map_or_else(nothing, Equations::solve)).collect()
}

fn equations<V: Vector>(gas: &Gas<V>, flow: &LocalFlow<V>) -> Vec<Option<Equations>> {
    flow.each_bin(gas, |flow, rows| Equations::of_bin(gas, flow, rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::grain::Grain;
    use crate::observe::testing::{random_positions, random_velocities, setting_of};
    use glam::DVec3;

    /// A mixture of temperatures 1 and 3, masses 1 and 8, three light grains to a heavy one, in a linear flow.
    fn mixture(seed: u64) -> Gas<DVec3> {
        let size = DVec3::new(12.0, 12.0, 24.0);
        let bed = setting_of(size, [12, 12, 24]);
        let mut gas = bed.gas(0.0, random_positions(seed, 800, size), random_velocities(seed + 1, 800));
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 1.0, mass: 8.0 }];
        gas.parts_mut().2.species = Some((0..800).map(|row| u8::from(row % 4 == 0)).collect());
        let moved: Vec<DVec3> = (0..800)
            .map(|row| {
                let thermal = if row % 4 == 0 { f64::sqrt(3.0 / 8.0) } else { 1.0 };
                gas.velocities()[row] * thermal + DVec3::Y * (2.0 * gas.positions()[row].z)
            })
            .collect();
        gas.velocities_mut().copy_from_slice(&moved);
        gas
    }

    #[test]
    fn species_of_two_temperatures_in_a_linear_flow_have_theirs() {
        let mut means = [[0.0; 2]; 2];
        let gases = 60;
        for seed in 0..gases {
            let gas = mixture(2 * seed);
            let found = temperatures(&gas, &LocalFlow::of(&gas, 30.0));
            for (mean, value) in means.iter_mut().zip(found) {
                mean[0] += value / gases as f64;
                mean[1] += value * value / gases as f64;
            }
        }
        for ([mean, square], expected) in means.into_iter().zip([1.0, 3.0]) {
            let error = ((square - mean * mean) / gases as f64).sqrt();
            assert!((mean - expected).abs() < 3.0 * error, "{mean} ± {error}, not {expected}");
            // A flow that took its grains along would be seen: it takes a tenth of their energy.
            assert!(error < 0.02 * expected, "{error}");
        }
    }

    #[test]
    fn a_species_without_grains_has_no_temperature() {
        let mut gas = mixture(1);
        gas.species.push(Grain { diameter: 2.0, mass: 1.0 });
        let found = temperatures(&gas, &LocalFlow::of(&gas, 30.0));
        assert!(found[2].is_nan() && found[0] > 0.5 && found[1] > 1.5, "{found:?}");
    }
}
