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
