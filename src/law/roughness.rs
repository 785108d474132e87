//! Grains that set each other spinning.

/// Tangential restitution and moment of inertia of rough grains (Miller 2004, equations 2.7 and 2.8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Tangential restitution φ in [−1, 1]: −1 smooth, 1 perfectly rough.
    pub tangential_restitution: f64,
    /// Reduced moment of inertia z = I/(m a²), a the radius: 2/5 for a solid sphere, 1/2 for a solid disk.
    pub reduced_inertia: f64,
}
