//! Closed forms of kinetic theory that every engine is checked against.
//!
//! Symbols: D dimension, ν volume fraction, d diameter, m mass, r restitution,
//! T temperature (m⟨v²⟩/D about the mean flow), g(ν) pair correlation at contact.

use crate::matter::grain::Grain;
use crate::space::Vector;

/// Collisions per grain and time of a Maxwell gas: f_E = D 2^{D−1} ν g √(T/m)/(√π a), a = d/2 (Miller 2004, 4.33).
///
/// `contact_correlation` is g: [`Vector::contact_correlation`] of ν for Enskog theory, 1 for the Boltzmann gas.
pub fn collision_frequency<V: Vector>(
    grain: Grain,
    volume_fraction: f64,
    temperature: f64,
    contact_correlation: f64,
) -> f64 {
    let number_density = volume_fraction / grain.volume::<V>();
    number_density
        * V::cross_section(grain.diameter)
        * V::MEAN_RELATIVE_SPEED
        * (temperature / grain.mass).sqrt()
        * contact_correlation
}

/// γ₀ = (1 − r²)/(2D): a homogeneous Maxwell gas cools as exp(−2γ₀τ), τ in collisions per particle 2C/N.
pub fn cooling_per_collision<V: Vector>(restitution: f64) -> f64 {
    (1.0 - restitution * restitution) / (2.0 * V::DIMENSION as f64)
}

/// Haff's time t₀ = 2D/((1 − r²) f_E(0)) of T(t) = T₀ (1 + t/t₀)⁻², for a Maxwell gas (Haff 1983; Miller 2004, 4.36).
pub fn haff_time<V: Vector>(restitution: f64, collision_frequency: f64) -> f64 {
    2.0 * V::DIMENSION as f64 / ((1.0 - restitution * restitution) * collision_frequency)
}

/// c* of the homogeneous cooling state, twice the Sonine coefficient a₂ (van Noije and Ernst 1998; Simić 2017, 6.9).
pub fn sonine_c_star<V: Vector>(restitution: f64) -> f64 {
    let r = restitution;
    let d = V::DIMENSION as f64;
    32.0 * (1.0 - r) * (1.0 - 2.0 * r * r)
        / (9.0 + 24.0 * d + (8.0 * d - 41.0) * r + 30.0 * r * r * (1.0 - r))
}

/// Factor of the cooling rate in time against Haff with the Maxwellian frequency: 1 + 3c*/32.
pub fn sonine_cooling_factor<V: Vector>(restitution: f64) -> f64 {
    1.0 + 3.0 * sonine_c_star::<V>(restitution) / 32.0
}

/// Factor of the cooling rate per counted collision: (1 + 3c*/32)/(1 − c*/32).
pub fn sonine_cooling_factor_per_collision<V: Vector>(restitution: f64) -> f64 {
    sonine_cooling_factor::<V>(restitution) / (1.0 - sonine_c_star::<V>(restitution) / 32.0)
}

/// PV/NT = 1 + (1 + r) 2^{D−2} ν g (Miller 2004, 4.44).
pub fn compressibility_factor<V: Vector>(volume_fraction: f64, restitution: f64) -> f64 {
    let power = f64::from(1 << (V::DIMENSION - 2));
    1.0 + (1.0 + restitution) * power * volume_fraction * V::contact_correlation(volume_fraction)
}

/// Mean free path of a Maxwell gas: mean speed over collision frequency.
///
/// 2D πd/(8√2 νg), 3D d/(6√2 νg); the mean speed is the mean relative speed over √2.
pub fn mean_free_path<V: Vector>(grain: Grain, volume_fraction: f64) -> f64 {
    let g = V::contact_correlation(volume_fraction);
    let number_density = volume_fraction / grain.volume::<V>();
    1.0 / (std::f64::consts::SQRT_2 * number_density * V::cross_section(grain.diameter) * g)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    const GRAIN: Grain = Grain { diameter: 1.3, mass: 0.7 };

    #[test]
    fn frequency_is_the_printed_formula() {
        let (nu, t, g) = (0.2, 1.7, 1.4);
        let a = GRAIN.diameter / 2.0;
        let flat = 2.0 * 2.0 * nu * g * f64::sqrt(t / GRAIN.mass) / (PI.sqrt() * a);
        let deep = 3.0 * 4.0 * nu * g * f64::sqrt(t / GRAIN.mass) / (PI.sqrt() * a);
        assert!((collision_frequency::<DVec2>(GRAIN, nu, t, g) / flat - 1.0).abs() < 1e-14);
        assert!((collision_frequency::<DVec3>(GRAIN, nu, t, g) / deep - 1.0).abs() < 1e-14);
    }

    #[test]
    fn cooling_factors_at_nine_tenths() {
        assert!((sonine_cooling_factor_per_collision::<DVec2>(0.9) - 0.9933).abs() < 1e-4);
        assert!((sonine_cooling_factor_per_collision::<DVec3>(0.9) - 0.9964).abs() < 1e-4);
    }

    #[test]
    fn free_paths_are_the_printed_formulas() {
        let nu = 0.15;
        let (g2, g3) = (DVec2::contact_correlation(nu), DVec3::contact_correlation(nu));
        let flat = PI * GRAIN.diameter / (8.0 * f64::sqrt(2.0) * nu * g2);
        let deep = GRAIN.diameter / (6.0 * f64::sqrt(2.0) * nu * g3);
        assert!((mean_free_path::<DVec2>(GRAIN, nu) / flat - 1.0).abs() < 1e-14);
        assert!((mean_free_path::<DVec3>(GRAIN, nu) / deep - 1.0).abs() < 1e-14);
    }
}
