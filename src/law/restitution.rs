//! How much of the normal velocity survives a collision.

/// The coefficient of normal restitution as a function of the normal relative speed.
pub trait Restitution: Copy + Send + Sync + 'static {
    /// r at the normal relative speed `normal_speed` ≥ 0 [length/time]; r itself lies in [0, 1].
    fn at(self, normal_speed: f64) -> f64;
}

/// One r for every speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

/// r falls with the speed: 1 − (1 − r₀)(v/v₀)^{1/5} below v₀, r₀ (v/v₀)^{−1/4} above
/// (Simić 2017, equation 5.1, which is McNamara and Falcon 2005).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityDependent {
    /// r at the speed v₀, in [0, 1].
    pub r0: f64,
    /// The speed v₀ where the branches meet [length/time], positive.
    pub v0: f64,
}

/// The law a scenario names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestitutionLaw {
    /// One r for every speed.
    Constant(Constant),
    /// r falls with the speed.
    VelocityDependent(VelocityDependent),
}

impl Restitution for Constant {
    #[inline(always)]
    fn at(self, _normal_speed: f64) -> f64 {
        self.0
    }
}

impl Restitution for VelocityDependent {
    #[inline]
    fn at(self, normal_speed: f64) -> f64 {
        let ratio = normal_speed / self.v0;
        if ratio < 1.0 {
            1.0 - (1.0 - self.r0) * libm::pow(ratio, 0.2)
        } else {
            self.r0 / ratio.sqrt().sqrt()
        }
    }
}

impl RestitutionLaw {
    /// The r that stands for the law where one number is needed: the constant, or r₀.
    pub fn typical(self) -> f64 {
        match self {
            RestitutionLaw::Constant(Constant(r)) => r,
            RestitutionLaw::VelocityDependent(law) => law.r0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branches_meet() {
        let law = VelocityDependent { r0: 0.95, v0: 0.3 };
        assert!((law.at(0.3) - 0.95).abs() < 1e-15);
        assert!((law.at(0.3 - 1e-12) - 0.95).abs() < 1e-9);
        assert!((law.at(0.0) - 1.0).abs() < 1e-15);
        assert!((law.at(0.3 * 16.0) - 0.475).abs() < 1e-15);
    }
}
