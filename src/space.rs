//! Two and three dimensions behind one trait: the only file in which they differ.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use glam::{DVec2, DVec3};

use crate::random::Stream;

/// A position, velocity or force in D dimensions, together with the geometry of
/// spheres in that space.
pub trait Vector:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
    + Index<usize, Output = f64>
    + IndexMut<usize>
{
    /// Angular velocity: one number in 2D, three in 3D.
    type Spin: Copy + Debug + Default + PartialEq + Send + Sync + 'static + AsRef<[f64]> + AsMut<[f64]>;
    /// D, the number of axes.
    const DIMENSION: usize;
    /// The origin.
    const ZERO: Self;
    /// Volume of a sphere (area of a disk) of unit diameter: π/4 in 2D, π/6 in 3D.
    const UNIT_SPHERE_VOLUME: f64;
    /// Random close packing: the densest disordered volume fraction, 0.82 in 2D, 0.64 in 3D.
    const RANDOM_CLOSE_PACKING: f64;
    /// Volume fraction at which an elastic fluid begins to freeze: 0.69 in 2D, 0.49 in 3D.
    const FREEZING: f64;
    /// The densest lattice: volume fraction 0.9069 in 2D, 0.7405 in 3D.
    const DENSEST_PACKING: f64;
    /// Largest local volume fraction that enters g(ν) in CBA: the formula is singular at ν = 1.
    const LARGEST_LOCAL_FRACTION: f64;
    /// The same in HSMC, where no cell gets denser than random close packing.
    const LARGEST_LOCAL_FRACTION_HSMC: f64;
    /// Mean relative speed of two grains of a Maxwell gas, in units of √(T/m): √π in 2D, 4/√π in 3D.
    const MEAN_RELATIVE_SPEED: f64;
    /// Names of the axes, in order.
    const AXIS_NAMES: &'static [&'static str];

    /// The vector whose component along `axis` is `component(axis)`.
    fn from_fn(component: impl FnMut(usize) -> f64) -> Self;
    /// Scalar product.
    fn dot(self, other: Self) -> f64;
    /// Product of the components: the volume of a box of these sides.
    fn product(self) -> f64;
    /// Scattering cross-section σ of two grains of `diameter` d: the width 2d in 2D, the disc πd² in 3D.
    fn cross_section(diameter: f64) -> f64;
    /// Pair correlation at contact g(ν), the Enskog factor, of an elastic fluid at `volume_fraction` ν.
    ///
    /// 2D (1 − 7ν/16)/(1 − ν)² (Henderson 1975); 3D (1 − ν/2)/(1 − ν)³ (Carnahan and Starling 1969).
    fn contact_correlation(volume_fraction: f64) -> f64;
    /// The same of grains of two species of a fluid mixture at `volume_fraction` ν, x = `crowding` the harmonic mean of their
    /// diameters times V₁ Σ n d^{D−1} over all species; x = ν where all are of one size.
    ///
    /// 2D 1/(1 − ν) + 9x/(16 (1 − ν)²) (Jenkins and Mancini 1987); 3D 1/(1 − ν) + 3x/(2 (1 − ν)²) + x²/(2 (1 − ν)³) (Boublík 1970;
    /// Mansoori, Carnahan, Starling and Leland 1971).
    fn pair_contact_correlation(volume_fraction: f64, crowding: f64) -> f64;
    /// −(g·n)n: the velocity that two equal elastic grains of relative velocity g = `relative` exchange, for the
    /// impact parameter of molecular chaos: uniform on [−d, d] in 2D, uniform in the disc of radius d in 3D.
    /// Its length is their normal speed, its direction the contact normal n that points against g.
    fn exchange(relative: Self, random: &mut Stream) -> Self;
    /// Ratio c that makes a displacement by c·d along the relative velocity after the collision
    /// carry the collisional pressure of Enskog theory for `restitution` r, not only for r = 1.
    ///
    /// The displaced collision carries m|v′|·c d, Enskog theory asks for (1 + r)/2 m|vₙ|d; both are
    /// averaged over impact parameters: c = (1 + r)/2 ⟨√(1 − b²)⟩ / ⟨√(r²(1 − b²) + b²)⟩.
    fn displacement_ratio(restitution: f64) -> f64;
    /// Velocity ω × r of the point at `arm` r from the centre of a body of angular velocity `spin` ω.
    fn spin_velocity(spin: Self::Spin, arm: Self) -> Self;
    /// Angular momentum r × P [mass·length²/time] that an `impulse` P brings when it acts at `arm` r
    /// from the centre.
    fn torque(arm: Self, impulse: Self) -> Self::Spin;
    /// A vector of the same length across this one: the one to its left in 2D, in a direction
    /// uniform on the circle in 3D.
    fn across(self, random: &mut Stream) -> Self;

    /// ∫ from 0 to `b` over impact parameters in diameters, of 1/(1 − c b²) in 2D and b/(1 − c b²) in 3D.
    fn impact_integral(c: f64, b: f64) -> f64;
    /// The inverse of the distribution of impact parameters p ∝ 1/(1 − c b²) in 2D, b/(1 − c b²) in 3D, in diameters:
    /// b of this density for `u` uniform in [−1, 1]; in 2D with the sign of `u`. c < 1 may be negative.
    ///
    /// 2D b = tanh(u artanh √c)/√c, for c < 0 tan(u arctan √−c)/√−c; 3D b² = (1 − (1 − c)^|u|)/c.
    fn impact_quantile(c: f64, u: f64) -> f64;
    /// −(g·n)n as [`Vector::exchange`], for the impact parameter `b` in [−1, 1]: n = (b g⊥ − √(1 − b²) g)/|g| with
    /// g⊥ from [`Vector::across`].
    fn exchange_at(relative: Self, b: f64, random: &mut Stream) -> Self {
        let cosine_squared = 1.0 - b * b;
        relative.across(random) * (b * cosine_squared.sqrt()) - relative * cosine_squared
    }
    /// `spin` + `factor` · `change`.
    #[inline]
    fn add_spin(mut spin: Self::Spin, change: Self::Spin, factor: f64) -> Self::Spin {
        spin.as_mut().iter_mut().zip(change.as_ref()).for_each(|(sum, part)| *sum += factor * part);
        spin
    }
    /// The vector turned by a random angle, uniform in [−max, max], and by the opposite angle:
    /// v cos θ ± v⊥ sin θ with v⊥ from [`Vector::across`]. In 3D the axis is a random one across the vector,
    /// so that the angle itself is uniform in [0, max]. `largest_angle` in radian.
    fn turns(self, largest_angle: f64, random: &mut Stream) -> [Self; 2] {
        let (sine, cosine) = libm::sincos(largest_angle * random.symmetric());
        let (along, across) = (self * cosine, self.across(random) * sine);
        [along + across, along - across]
    }
    /// Squared length.
    fn length_squared(self) -> f64 {
        self.dot(self)
    }
    /// Length.
    fn length(self) -> f64 {
        self.length_squared().sqrt()
    }
    /// The lower of each two components.
    #[inline(always)]
    fn lower(self, other: Self) -> Self {
        Self::from_fn(|axis| if self[axis] < other[axis] { self[axis] } else { other[axis] })
    }
    /// The upper of each two components.
    #[inline(always)]
    fn upper(self, other: Self) -> Self {
        Self::from_fn(|axis| if self[axis] > other[axis] { self[axis] } else { other[axis] })
    }
    /// Whether every component is finite.
    fn is_finite(self) -> bool {
        (0..Self::DIMENSION).all(|axis| self[axis].is_finite())
    }
    /// The vector of `length` along `axis`.
    fn along(axis: usize, length: f64) -> Self {
        Self::from_fn(|a| if a == axis { length } else { 0.0 })
    }
    /// The components in order.
    fn components(self) -> Vec<f64> {
        (0..Self::DIMENSION).map(|axis| self[axis]).collect()
    }
    /// Volume of a sphere (area of a disk) of `diameter`.
    fn sphere_volume(diameter: f64) -> f64 {
        let mut volume = Self::UNIT_SPHERE_VOLUME;
        for _ in 0..Self::DIMENSION {
            volume *= diameter;
        }
        volume
    }
}

impl Vector for DVec2 {
    type Spin = [f64; 1];
    const DIMENSION: usize = 2;
    const ZERO: Self = DVec2::ZERO;
    const UNIT_SPHERE_VOLUME: f64 = std::f64::consts::FRAC_PI_4;
    const RANDOM_CLOSE_PACKING: f64 = 0.82;
    const FREEZING: f64 = 0.69;
    const DENSEST_PACKING: f64 = 0.906_899_682_117_109;
    const LARGEST_LOCAL_FRACTION: f64 = 0.9;
    const LARGEST_LOCAL_FRACTION_HSMC: f64 = 0.9;
    const MEAN_RELATIVE_SPEED: f64 = 1.772_453_850_905_516;
    const AXIS_NAMES: &'static [&'static str] = &["x", "y"];

    fn impact_integral(c: f64, b: f64) -> f64 {
        let root = c.abs().sqrt();
        match c {
            _ if c.abs() < 1e-7 => b + c * b * b * b / 3.0,
            _ if c > 0.0 => libm::atanh(root * b) / root,
            _ => libm::atan(root * b) / root,
        }
    }
    fn impact_quantile(c: f64, u: f64) -> f64 {
        let root = c.abs().sqrt();
        let b = match c {
            _ if c.abs() < 1e-7 => u + c * u * (1.0 - u * u) / 3.0,
            _ if c > 0.0 => libm::tanh(u * libm::atanh(root)) / root,
            _ => libm::tan(u * libm::atan(root)) / root,
        };
        b.clamp(-1.0, 1.0)
    }
    #[inline(always)]
    fn from_fn(mut component: impl FnMut(usize) -> f64) -> Self {
        DVec2::new(component(0), component(1))
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        DVec2::dot(self, other)
    }
    fn product(self) -> f64 {
        self.x * self.y
    }
    fn cross_section(diameter: f64) -> f64 {
        2.0 * diameter
    }
    #[inline]
    fn contact_correlation(volume_fraction: f64) -> f64 {
        let free = 1.0 - volume_fraction;
        (1.0 - 0.4375 * volume_fraction) / (free * free)
    }
    fn pair_contact_correlation(volume_fraction: f64, crowding: f64) -> f64 {
        let free = 1.0 - volume_fraction;
        1.0 / free + 0.5625 * crowding / (free * free)
    }
    #[inline(always)]
    fn exchange(relative: Self, random: &mut Stream) -> Self {
        // With g⊥ to the left of g, n = (b g⊥ − √(1 − b²) g)/|g|; of g·n = −|g| √(1 − b²) no root of |g|² is left.
        let b = random.symmetric();
        let cosine_squared = 1.0 - b * b;
        let across = DVec2::new(-relative.y, relative.x);
        across * (b * cosine_squared.sqrt()) - relative * cosine_squared
    }
    fn displacement_ratio(restitution: f64) -> f64 {
        // ⟨√(1 − b²)⟩ = π/4 over uniform b; the other mean by Simpson's rule.
        let r = restitution;
        let speed_after = |b: f64| (r * r * (1.0 - b * b) + b * b).sqrt();
        const INTERVALS: u32 = 512;
        let width = 1.0 / f64::from(INTERVALS);
        let weight = |k: u32| match k {
            0 | INTERVALS => 1.0,
            k => f64::from(2 + 2 * (k % 2)),
        };
        let sum: f64 = (0..=INTERVALS).map(|k| weight(k) * speed_after(f64::from(k) * width)).sum();
        0.5 * (1.0 + r) * std::f64::consts::FRAC_PI_4 / (sum * width / 3.0)
    }
    #[inline(always)]
    fn spin_velocity(spin: [f64; 1], arm: Self) -> Self {
        DVec2::new(-arm.y, arm.x) * spin[0]
    }
    #[inline(always)]
    fn torque(arm: Self, impulse: Self) -> [f64; 1] {
        [arm.x * impulse.y - arm.y * impulse.x]
    }
    fn across(self, _random: &mut Stream) -> Self {
        DVec2::new(-self.y, self.x)
    }
}

impl Vector for DVec3 {
    type Spin = [f64; 3];
    const DIMENSION: usize = 3;
    const ZERO: Self = DVec3::ZERO;
    const UNIT_SPHERE_VOLUME: f64 = std::f64::consts::FRAC_PI_6;
    const RANDOM_CLOSE_PACKING: f64 = 0.64;
    const FREEZING: f64 = 0.49;
    const DENSEST_PACKING: f64 = 0.740_480_489_693_061;
    const LARGEST_LOCAL_FRACTION: f64 = 0.7;
    const LARGEST_LOCAL_FRACTION_HSMC: f64 = 0.64;
    const MEAN_RELATIVE_SPEED: f64 = 2.256_758_334_191_025;
    const AXIS_NAMES: &'static [&'static str] = &["x", "y", "z"];

    fn impact_integral(c: f64, b: f64) -> f64 {
        if c.abs() < 1e-7 {
            return 0.5 * b * b + 0.25 * c * b * b * b * b;
        }
        -0.5 * libm::log1p(-c * b * b) / c
    }
    fn impact_quantile(c: f64, u: f64) -> f64 {
        let u = u.abs();
        let square = match c {
            _ if c.abs() < 1e-7 => u + 0.5 * c * u * (1.0 - u),
            _ => -libm::expm1(u * libm::log1p(-c)) / c,
        };
        square.clamp(0.0, 1.0).sqrt()
    }
    #[inline(always)]
    fn from_fn(mut component: impl FnMut(usize) -> f64) -> Self {
        DVec3::new(component(0), component(1), component(2))
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }
    fn product(self) -> f64 {
        self.x * self.y * self.z
    }
    fn cross_section(diameter: f64) -> f64 {
        std::f64::consts::PI * diameter * diameter
    }
    #[inline]
    fn contact_correlation(volume_fraction: f64) -> f64 {
        let free = 1.0 - volume_fraction;
        (1.0 - 0.5 * volume_fraction) / (free * free * free)
    }
    fn pair_contact_correlation(volume_fraction: f64, crowding: f64) -> f64 {
        let (free, share) = (1.0 - volume_fraction, crowding / (1.0 - volume_fraction));
        (1.0 + 1.5 * share + 0.5 * share * share) / free
    }
    #[inline(always)]
    fn exchange(relative: Self, random: &mut Stream) -> Self {
        // Elastic spheres scatter into all directions alike: −(g·n)n = (|g|u − g)/2 with u uniform on the sphere
        // (Marsaglia 1972).
        let (p, q, square) = random.in_disc();
        let equator = 2.0 * (1.0 - square).sqrt();
        let direction = DVec3::new(p * equator, q * equator, 1.0 - 2.0 * square);
        (direction * relative.length() - relative) * 0.5
    }
    fn displacement_ratio(restitution: f64) -> f64 {
        let r = restitution;
        (1.0 + r) * (1.0 + r) / (2.0 * (1.0 + r + r * r))
    }
    #[inline(always)]
    fn spin_velocity(spin: [f64; 3], arm: Self) -> Self {
        DVec3::from_array(spin).cross(arm)
    }
    #[inline(always)]
    fn torque(arm: Self, impulse: Self) -> [f64; 3] {
        arm.cross(impulse).to_array()
    }
    fn across(self, random: &mut Stream) -> Self {
        let length = self.length();
        if length == 0.0 {
            return self;
        }
        let (p, q, square) = loop {
            let point = random.in_disc();
            // A point too near to the centre has no direction.
            if point.2 > 1e-12 {
                break point;
            }
        };
        let (first, second) = tangents(self * (1.0 / length));
        (first * p + second * q) * (length / square.sqrt())
    }
}

/// Two unit vectors that complete the unit vector `n` to an orthonormal basis, without
/// a branch that loses precision (Duff et al. 2017).
#[inline]
fn tangents(n: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

#[cfg(test)]
mod tests;
