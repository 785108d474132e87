//! Everything that the dynamics of grains and walls depends on.

use super::rules::Cure;
use crate::law::boundary::Boundary;
use crate::law::restitution::RestitutionLaw;
use crate::law::roughness::Roughness;
use crate::matter::grain::Grain;
use crate::random::Streams;
use crate::space::Vector;

/// The laws of an event-driven run.
#[derive(Clone, Debug)]
pub struct Laws<V> {
    /// Diameter and mass of every grain; of the first species where there are several.
    pub grain: Grain,
    /// Diameter and mass of each species `[species]`; empty where all grains are alike.
    pub species: Vec<Grain>,
    /// Restitution of collisions between grains.
    pub restitution: RestitutionLaw,
    /// Tangential restitution, where grains are rough.
    pub roughness: Option<Roughness>,
    /// Constant acceleration [length/time²].
    pub gravity: V,
    /// Sides of the box, which has its lower corner at the origin [length].
    pub size: V,
    /// What happens there.
    pub boundary: Boundary<V>,
    /// What prevents inelastic collapse.
    pub cure: Cure,
    /// The size of all grains at the start, and how it grows.
    pub growth: Growth,
    /// Random numbers.
    pub streams: Streams,
    /// Their seed, to be named in errors.
    pub seed: u64,
}

/// All diameters as a share of those that the laws state: a(t) = a₀ + u t (Miller 2004, equation 2.16).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// The share at the start, in (0, 1].
    pub start: f64,
    /// Its rate [1/time], not negative. The share must not exceed 1 as long as the engine is used.
    pub rate: f64,
}

impl Growth {
    /// Grains of full and constant size.
    pub const NONE: Growth = Growth { start: 1.0, rate: 0.0 };
}

impl<V: Vector> Laws<V> {
    /// Diameter and mass of a grain of `species`.
    #[inline(always)]
    pub(super) fn kind(&self, species: u8) -> Grain {
        if self.species.is_empty() { self.grain } else { self.species[species as usize] }
    }

    /// The largest diameter [length].
    pub(super) fn largest_diameter(&self) -> f64 {
        self.species.iter().map(|grain| grain.diameter).fold(self.grain.diameter, f64::max)
    }
}
