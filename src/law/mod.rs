//! Laws: pure functions of the matter they act on.

pub mod boundary;
pub mod homogeneous_cooling;
pub mod impact;
pub mod kinetic_theory;
pub mod mixture;
pub mod pair_collision;
pub mod piecewise;
pub mod restitution;
pub mod roughness;
pub mod source;
