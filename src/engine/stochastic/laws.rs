//! The laws that a stochastic step obeys, resolved for one engine and one gas.

use crate::law::boundary::{AxisBoundary, Boundary, Face, Wall, WallKind};
use crate::law::impact::Impacts;
use crate::law::restitution::Restitution;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::random::Streams;
use crate::space::Vector;

use super::rules::{EnskogFactor, Transfer};

/// What grains do to each other and what is done to them.
#[derive(Clone, Debug)]
pub struct Laws<V: Vector, R: Restitution> {
    /// Diameter and mass.
    pub grain: Grain,
    /// Restitution of pair collisions.
    pub restitution: R,
    /// Impact parameters of pair collisions in the next step.
    pub impacts: Impacts,
    /// Constant acceleration [length/time²].
    pub gravity: V,
    /// Sides of the box.
    pub boundary: Boundary<V>,
    /// Enskog factor and displacement; `None` for plain DSMC.
    pub dense: Option<DenseGas>,
    /// All random numbers.
    pub streams: Streams,
    /// The seed behind them, for messages.
    pub seed: u64,
}

/// What CBA adds to DSMC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DenseGas {
    /// Where the Enskog factor takes its density from.
    pub enskog_factor: EnskogFactor,
    /// Along what a collision displaces its partners.
    pub transfer: Transfer,
    /// c(r) of [`Vector::displacement_ratio`], used by [`Transfer::Corrected`].
    pub displacement_ratio: f64,
    /// The local volume fraction that enters g(ν) is at most this: the formula is singular at ν = 1.
    pub largest_volume_fraction: f64,
}

impl<V: Vector, R: Restitution> Laws<V, R> {
    /// Whether grains fall.
    pub fn has_gravity(&self) -> bool {
        self.gravity != V::ZERO
    }

    /// Whether there is a side that grains can meet.
    pub fn has_faces(&self) -> bool {
        !self.boundary.is_fully_periodic()
    }
}

/// Where walls stand at one time: a place beyond them is outside.
#[derive(Clone, Copy, Debug)]
pub struct Room<V> {
    lower: V,
    upper: V,
}

impl<V: Vector> Room<V> {
    /// The room between the walls of `boundary` at `time`; endless where there is none.
    pub fn at(grid: &Grid<V>, boundary: &Boundary<V>, time: f64) -> Self {
        let side = |axis: usize, upper: bool| match boundary.axes[axis] {
            AxisBoundary::Periodic => None,
            AxisBoundary::Faces { lower, upper: above } => match if upper { above } else { lower } {
                Face::Open => None,
                Face::Wall(wall) => Some(wall_place(grid, axis, upper, &wall, time)),
            },
        };
        Room {
            lower: V::from_fn(|axis| side(axis, false).unwrap_or(f64::NEG_INFINITY)),
            upper: V::from_fn(|axis| side(axis, true).unwrap_or(f64::INFINITY)),
        }
    }

    /// Whether `position` is on the inner side of every wall.
    #[inline]
    pub fn holds(&self, position: V) -> bool {
        (0..V::DIMENSION).all(|a| position[a] >= self.lower[a] && position[a] <= self.upper[a])
    }
}

/// Where a wall stands at `time` [length]. The grid reaches as far as a vibrating wall does.
pub fn wall_place<V: Vector>(grid: &Grid<V>, axis: usize, upper: bool, wall: &Wall<V>, time: f64) -> f64 {
    let edge = if upper { grid.end()[axis] } else { grid.origin()[axis] };
    match wall.kind {
        WallKind::Vibrating { amplitude, frequency } => {
            let place = if upper { edge - amplitude } else { edge + amplitude };
            place + amplitude * libm::sin(std::f64::consts::TAU * phase(frequency, time))
        }
        _ => edge,
    }
}

/// Velocity of a wall along its normal axis at `time` [length/time].
pub fn wall_speed<V: Vector>(wall: &Wall<V>, time: f64) -> f64 {
    match wall.kind {
        WallKind::Vibrating { amplitude, frequency } => {
            let omega = std::f64::consts::TAU * frequency;
            amplitude * omega * libm::cos(std::f64::consts::TAU * phase(frequency, time))
        }
        _ => 0.0,
    }
}

/// Turns since the last full one: keeps the argument of the sine small in long runs.
fn phase(frequency: f64, time: f64) -> f64 {
    let turns = frequency * time;
    turns - turns.floor()
}
