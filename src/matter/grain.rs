//! What one grain is made of.

use crate::space::Vector;

/// Diameter and mass, shared by all grains of a gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Diameter d = 2R [length], positive.
    pub diameter: f64,
    /// Mass m [mass], positive.
    pub mass: f64,
}

impl Grain {
    /// Volume (2D: area) of one grain [lengthᴰ].
    pub fn volume<V: Vector>(self) -> f64 {
        V::sphere_volume(self.diameter)
    }
}
