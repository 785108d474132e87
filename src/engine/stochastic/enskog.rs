//! The Enskog factor of a cell.

use super::laws::DenseGas;
use super::rules::EnskogFactor;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// Computes χ = g(ν) cell by cell; 1 for plain DSMC.
#[derive(Clone, Debug)]
pub(crate) struct EnskogFactors<'a, V: Vector> {
    dense: Option<DenseGas>,
    grid: &'a Grid<V>,
    offsets: &'a [u32],
    /// ν of one grain in a cell.
    fraction_of_one: f64,
}

impl<'a, V: Vector> EnskogFactors<'a, V> {
    pub(crate) fn new(dense: Option<DenseGas>, grid: &'a Grid<V>, offsets: &'a [u32], diameter: f64) -> Self {
        let fraction_of_one = V::sphere_volume(diameter) / grid.cell_volume();
        EnskogFactors { dense, grid, offsets, fraction_of_one }
    }

    /// χ of `cell`, which holds `grains`.
    #[inline(always)]
    pub(crate) fn of(&self, cell: u32, grains: usize) -> f64 {
        let Some(dense) = self.dense else { return 1.0 };
        let grains = match dense.enskog_factor {
            EnskogFactor::Local => grains as f64,
            EnskogFactor::HalfGrain => grains as f64 - 0.5,
            EnskogFactor::Smoothed => self.mean_occupancy_around(cell),
        };
        V::contact_correlation((grains * self.fraction_of_one).min(dense.largest_volume_fraction))
    }

    /// Mean number of grains in the 3ᴰ cells around `cell`, those beyond a wall left out.
    fn mean_occupancy_around(&self, cell: u32) -> f64 {
        let mut around = vec![self.grid.coordinates(cell)];
        for axis in 0..V::DIMENSION {
            for k in 0..around.len() {
                for upwards in [false, true] {
                    if let Some(neighbour) = self.grid.neighbour(around[k], axis, upwards) {
                        around.push(self.grid.coordinates(neighbour));
                    }
                }
            }
        }
        let occupancy = |at: &[u32; 3]| {
            let cell = self.grid.cell_at(*at) as usize;
            self.offsets[cell + 1] - self.offsets[cell]
        };
        around.iter().map(|at| f64::from(occupancy(at))).sum::<f64>() / around.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::stochastic::trial::{DENSE, gas};
    use glam::DVec2;
    use std::f64::consts::PI;

    /// g(ν) of disks, (1 − 7ν/16)/(1 − ν)².
    fn henderson(fraction: f64) -> f64 {
        (1.0 - 7.0 / 16.0 * fraction) / ((1.0 - fraction) * (1.0 - fraction))
    }

    #[test]
    fn the_factor_of_a_cell_is_that_of_its_density() {
        let grains = [0, 1, 2, 3, 4, 3, 2, 1, 0, 4, 4, 4];
        let gas = gas([4, 3], [true, false], &grains, 1.0, 1);
        // Disks of diameter 1 in a cell of side 2.
        let one = PI / 16.0;
        let factor = |dense: Option<DenseGas>, cell: u32| {
            EnskogFactors::new(dense, gas.grid(), gas.offsets(), 1.0).of(cell, gas.occupancy(cell) as usize)
        };
        let of =
            |enskog_factor: EnskogFactor, cell: u32| factor(Some(DenseGas { enskog_factor, ..DENSE }), cell);
        let is = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-14, "{value}, {expected}");
        for cell in 0..12 {
            let here = f64::from(grains[cell as usize]);
            assert_eq!(factor(None, cell), 1.0);
            is(of(EnskogFactor::Local, cell), henderson((here * one).min(DENSE.largest_volume_fraction)));
            if here > 0.0 {
                is(of(EnskogFactor::HalfGrain, cell), henderson((here - 0.5) * one));
            }
            let near = |other: u32| {
                let ([i, j, _], [k, l, _]) = (gas.grid().coordinates(cell), gas.grid().coordinates(other));
                i.abs_diff(k).min(4 - i.abs_diff(k)) <= 1 && j.abs_diff(l) <= 1
            };
            let around: Vec<u32> = (0..12).filter(|&other| near(other)).map(|c| grains[c as usize]).collect();
            assert!(around.len() == 6 || around.len() == 9);
            let mean = f64::from(around.iter().sum::<u32>()) / around.len() as f64;
            is(of(EnskogFactor::Smoothed, cell), henderson(mean * one));
        }
    }

    #[test]
    fn the_factor_stays_finite_where_grains_overfill_a_cell() {
        let gas = gas([1, 1], [true, true], &[9], 1.0, 1);
        let factors = EnskogFactors::<DVec2>::new(Some(DENSE), gas.grid(), gas.offsets(), 1.0);
        assert_eq!(factors.of(0, 9), DVec2::contact_correlation(DENSE.largest_volume_fraction));
    }
}
