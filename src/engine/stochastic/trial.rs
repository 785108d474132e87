//! Small gases in the plane, and laws for them, on which unit tests try the parts of a step.

use glam::DVec2;

use super::laws::{DenseGas, Laws};
use super::rules::{EnskogFactor, Transfer};
use crate::law::boundary::Boundary;
use crate::law::impact::Impacts;
use crate::law::restitution::Constant;
use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::random::{Phase, Streams};

/// Diameter 1, mass 2.
pub(crate) const GRAIN: Grain = Grain { diameter: 1.0, mass: 2.0 };

/// What CBA adds, with the local density.
pub(crate) const DENSE: DenseGas = DenseGas {
    enskog_factor: EnskogFactor::Local,
    transfer: Transfer::MomentumChange,
    displacement_ratio: 1.0,
    largest_volume_fraction: 0.8,
};

/// Laws of elastic grains in a periodic box without gravity.
pub(crate) fn laws(dense: Option<DenseGas>) -> Laws<DVec2, Constant> {
    Laws {
        grain: GRAIN,
        restitution: Constant(1.0),
        impacts: Impacts::UNIFORM,
        gravity: DVec2::ZERO,
        boundary: Boundary::periodic(),
        dense,
        streams: Streams::new(1),
        seed: 1,
    }
}

/// A gas in cells of side 2, which hold four grains each where they are full: `grains` `[cell]`, at random places, with a mean
/// velocity for each cell and `thermal` times that about it.
pub(crate) fn gas(
    cells: [u32; 2],
    periodic: [bool; 2],
    grains: &[u32],
    thermal: f64,
    seed: u64,
) -> Gas<DVec2> {
    let size = DVec2::new(2.0 * f64::from(cells[0]), 2.0 * f64::from(cells[1]));
    let grid = Grid::new(DVec2::ZERO, size, &cells, &periodic);
    let mut random = Streams::new(seed).at(0, Phase::InitialPositions).stream(0);
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for (cell, &grains) in (0..).zip(grains) {
        let flow = DVec2::new(random.gaussian(), random.gaussian());
        for _ in 0..grains {
            positions.push(grid.centre(cell) + DVec2::new(random.symmetric(), random.symmetric()) * 0.99);
            velocities.push(flow + DVec2::new(random.gaussian(), random.gaussian()) * thermal);
        }
    }
    Gas::new(grid, GRAIN, positions, velocities)
}
