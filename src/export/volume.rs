//! The box as other programs know it: three axes, each periodic or not.

use crate::record::contents::Walls;
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// The box that grains live in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Lower corner [length]; in 2D the box is as deep as the largest grain, about z = 0.
    pub lower: [f64; 3],
    /// Upper corner [length].
    pub upper: [f64; 3],
    /// `[axis]`; the depth of a plane is not.
    pub periodic: [bool; 3],
    /// D.
    pub dimension: usize,
}

impl Volume {
    /// The box of the run of `scenario`, with the strokes of its vibrating walls: that of its cells.
    pub(crate) fn of<V: Vector>(scenario: &Scenario<V>) -> Self {
        let Walls { mut lower, mut upper, sides } = scenario.walls();
        for axis in V::DIMENSION..3 {
            lower[axis] = -0.5 * scenario.largest_diameter();
            upper[axis] = 0.5 * scenario.largest_diameter();
        }
        let periodic = std::array::from_fn(|axis| sides[axis][0] == "periodic");
        Volume { lower, upper, periodic, dimension: V::DIMENSION }
    }

    /// Length along `axis` [length].
    pub fn length(&self, axis: usize) -> f64 {
        self.upper[axis] - self.lower[axis]
    }
}
