//! Closed forms of kinetic theory that every engine is checked against.
//!
//! Symbols: D dimension, ν volume fraction, d diameter, m mass, r restitution,
//! T temperature (m⟨v²⟩/D about the mean flow), g(ν) pair correlation at contact.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::matter::grain::Grain;
use crate::space::Vector;

/// Collisions per grain and time of a Maxwell gas at `temperature` [1/time; energy]: f_E = D 2^{D−1} ν g √(T/m)/(√π a), a = d/2 (Miller 2004, 4.33).
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

/// Haff's time [time] t₀ = 2D/((1 − r²) f_E(0)) of T(t) = T₀ (1 + t/t₀)⁻², for a Maxwell gas (Haff 1983; Miller 2004, 4.36).
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

/// The same for collisions that are displaced by d along the change of momentum, which carry 2r in place of 1 + r.
pub fn displaced_compressibility_factor<V: Vector>(volume_fraction: f64, restitution: f64) -> f64 {
    let share = 2.0 * restitution / (1.0 + restitution);
    1.0 + share * (compressibility_factor::<V>(volume_fraction, restitution) - 1.0)
}

/// Shear viscosity of an elastic gas in units of √(mT) d^{1−D}: Enskog's, to first order in Sonine polynomials.
///
/// η = η₀ ((1 + 2ᴰ ν g/(D + 2))²/g + D 2^{2D+2}/(π (D + 2)²) ν² g), η₀ = √π (D + 2)/(2^{D+2} D V₁), V₁ the
/// volume of a sphere of unit diameter: η₀ = 1/(2√π) in 2D, 5/(16√π) in 3D (Chapman and Cowling 1970, 16.41; Gass 1971).
pub fn shear_viscosity<V: Vector>(volume_fraction: f64) -> f64 {
    let dimension = V::DIMENSION as f64;
    let power = f64::from(1 << V::DIMENSION);
    let (nu, g) = (volume_fraction, V::contact_correlation(volume_fraction));
    let dilute = (dimension + 2.0) * PI.sqrt() / (4.0 * power * dimension * V::UNIT_SPHERE_VOLUME);
    let kinetic = (1.0 + power * nu * g / (dimension + 2.0)).powi(2) / g;
    let collisional = dimension * 4.0 * power * power / (PI * (dimension + 2.0).powi(2)) * nu * nu * g;
    dilute * (kinetic + collisional)
}

/// Shear stress of a gas that is sheared at γ̇, in units of m γ̇² d^{2−D}: Bagnold's law with the coefficient of
/// Navier–Stokes–Enskog theory.
///
/// What viscosity heats, η γ̇², is what collisions lose, (D/2) n T (1 − r²) f_E/D, so that T ∝ γ̇² and η γ̇ ∝ √T γ̇.
pub fn bagnold_coefficient<V: Vector>(volume_fraction: f64, restitution: f64) -> f64 {
    let unit = Grain { diameter: 1.0, mass: 1.0 };
    let g = V::contact_correlation(volume_fraction);
    let frequency = collision_frequency::<V>(unit, volume_fraction, 1.0, g);
    let density = volume_fraction / V::UNIT_SPHERE_VOLUME;
    let loss = 0.5 * density * (1.0 - restitution * restitution) * frequency;
    shear_viscosity::<V>(volume_fraction).powf(1.5) / loss.sqrt()
}

/// By which factor partners from anywhere in a cell of side L raise the shear viscosity; `side` is L/d.
///
/// Each collision carries momentum over the distance of its partners, of which ⟨Δy²⟩ = L²/6 in a cell that is cubic. With
/// ⟨(Δv_x)²⟩ = ((1 + r)/2)² 4T/(D m) this adds Δη = n m f_E L²/(6D) ((1 + r)/2)² to Enskog's viscosity; for a dilute elastic gas
/// of spheres that is 16/(45π) (L/λ)² of it (Alexander, Garcia and Alder, Phys. Fluids 10, 1540, 1998).
pub fn cell_viscosity_factor<V: Vector>(volume_fraction: f64, restitution: f64, side: f64) -> f64 {
    let unit = Grain { diameter: 1.0, mass: 1.0 };
    let correlation = V::contact_correlation(volume_fraction);
    let frequency = collision_frequency::<V>(unit, volume_fraction, 1.0, correlation);
    let density = volume_fraction / V::UNIT_SPHERE_VOLUME;
    let share = (0.5 * (1.0 + restitution)).powi(2);
    let added = density * frequency * side * side / (6.0 * V::DIMENSION as f64) * share;
    1.0 + added / shear_viscosity::<V>(volume_fraction)
}

/// Optical depth l = ν L/d of a box of side L (Miller 2004, 4.9).
pub fn optical_depth(volume_fraction: f64, side: f64, diameter: f64) -> f64 {
    volume_fraction * side / diameter
}

/// λ_sh: a cooling gas shears by itself where 1 − r² exceeds it: 2D π³/(4 l²), 3D 5π³/(96 l²), l the optical depth.
///
/// (D + 2)/(2D) π³/(2^{2D−2} l²), a dilute gas: the longest wave, 2π/L, decays by viscosity as slowly as the thermal
/// speed falls, η k²/(n m) = (1 − r²) f_E/(2D) (Miller 2004, 4.73–4.75, where D is printed as 2).
pub fn shear_threshold<V: Vector>(optical_depth: f64) -> f64 {
    let dimension = V::DIMENSION as f64;
    let power = f64::from(1 << (2 * V::DIMENSION - 2));
    (dimension + 2.0) / (2.0 * dimension * power) * PI.powi(3) / (optical_depth * optical_depth)
}

/// λ_cl: a cooling gas clusters where 1 − r² exceeds it: 2D π³/l², 3D 25π³/(192 l²), l the optical depth.
///
/// (D + 2)²/(D (D − 1) 2^{2D−1}) π³/l², a dilute gas: at constant pressure the longest wave, 2π/L, loses its excess of
/// heat by conduction as fast as dense places cool ahead, 4κk²/n = (1 − r²) f_E (Miller 2004, 4.71, 4.72).
pub fn cluster_threshold<V: Vector>(optical_depth: f64) -> f64 {
    let dimension = V::DIMENSION as f64;
    let power = f64::from(1 << (2 * V::DIMENSION - 1));
    let factor = (dimension + 2.0).powi(2) / (dimension * (dimension - 1.0) * power);
    factor * PI.powi(3) / (optical_depth * optical_depth)
}

/// r_ic = tan²(π/4 (1 − 1/l)): below this restitution a gas of optical depth l can collapse (Miller 2004, 4.8).
pub fn collapse_restitution(optical_depth: f64) -> f64 {
    (FRAC_PI_4 * (1.0 - 1.0 / optical_depth.max(1.0))).tan().powi(2)
}

/// Probability density of one component of the velocities of a Maxwell gas, in thermal velocities √(T/m).
pub fn maxwell_density(scaled_velocity: f64) -> f64 {
    libm::exp(-0.5 * scaled_velocity * scaled_velocity) / (2.0 * PI).sqrt()
}

/// Probability density [1] of the impact parameter |b|/d under molecular chaos: 1 for disks, 2b for spheres.
pub fn chaotic_impact_density<V: Vector>(impact_parameter: f64) -> f64 {
    let power = V::DIMENSION as i32 - 2;
    f64::from(power + 1) * impact_parameter.powi(power)
}

/// Mean free path of a Maxwell gas [length]: mean speed over collision frequency.
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

    #[test]
    fn viscosities_are_the_printed_formulas() {
        let nu = 0.15;
        let (g2, g3) = (DVec2::contact_correlation(nu), DVec3::contact_correlation(nu));
        // In powers of bρ = 2^{D−1} ν; Gass 1971 and Chapman and Cowling 1970 without their second Sonine order.
        let flat = (1.0 / g2 + 2.0 * nu + (0.25 + 2.0 / PI) * 4.0 * nu * nu * g2) / (2.0 * PI.sqrt());
        let deep = (1.0 / g3 + 0.8 * 4.0 * nu + (0.16 + 48.0 / (25.0 * PI)) * 16.0 * nu * nu * g3) * 5.0
            / (16.0 * PI.sqrt());
        assert!((shear_viscosity::<DVec2>(nu) / flat - 1.0).abs() < 1e-14);
        assert!((shear_viscosity::<DVec3>(nu) / deep - 1.0).abs() < 1e-14);
    }

    #[test]
    fn cells_raise_the_viscosity_of_a_dilute_gas_as_printed() {
        let nu = 1e-9;
        for paths in [0.5, 1.0, 3.0] {
            let side = paths * mean_free_path::<DVec3>(Grain { diameter: 1.0, mass: 1.0 }, nu);
            let printed = 1.0 + 16.0 / (45.0 * PI) * paths * paths;
            let found = cell_viscosity_factor::<DVec3>(nu, 1.0, side);
            assert!((found / printed - 1.0).abs() < 1e-7, "{found} beside {printed}");
        }
        // Each collision of r = 0 exchanges half as much as an elastic one.
        let added = |r: f64| cell_viscosity_factor::<DVec2>(0.1, r, 2.5) - 1.0;
        assert!((added(0.0) / added(1.0) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn sheared_grains_lose_what_viscosity_heats() {
        fn balance<V: Vector>() {
            let (nu, r) = (0.1, 0.9);
            let stress = bagnold_coefficient::<V>(nu, r);
            // At γ̇ = 1 and unit grains the stress is η̂√T: from it the temperature, from that both sides.
            let temperature = (stress / shear_viscosity::<V>(nu)).powi(2);
            let unit = Grain { diameter: 1.0, mass: 1.0 };
            let g = V::contact_correlation(nu);
            let rate = collision_frequency::<V>(unit, nu, temperature, g);
            let energy = 0.5 * V::DIMENSION as f64 * nu / unit.volume::<V>() * temperature;
            let lost = energy * 2.0 * cooling_per_collision::<V>(r) * rate;
            assert!((lost / stress - 1.0).abs() < 1e-13, "{lost} beside {stress}");
        }
        balance::<DVec2>();
        balance::<DVec3>();
        assert!((bagnold_coefficient::<DVec2>(0.1, 0.9) - 2.12).abs() < 0.005);
    }

    /// Thresholds from the dilute gas they are made for: viscosity, and conduction 75/(64√π) and 2/√π.
    fn thresholds<V: Vector>(conductivity: f64) {
        let unit = Grain { diameter: 1.0, mass: 1.0 };
        let (nu, side) = (0.01, 700.0);
        let depth = optical_depth(nu, side, 1.0);
        let dimension = V::DIMENSION as f64;
        let frequency = collision_frequency::<V>(unit, nu, 1.0, 1.0);
        let density = nu / unit.volume::<V>();
        let wave = (2.0 * PI / side).powi(2);
        let viscosity = shear_viscosity::<V>(0.0);
        let shear = 2.0 * dimension * viscosity * wave / (density * frequency);
        assert!((shear_threshold::<V>(depth) / shear - 1.0).abs() < 1e-13);
        let heat = 4.0 * conductivity * wave / (density * frequency);
        assert!((cluster_threshold::<V>(depth) / heat - 1.0).abs() < 1e-13);
    }

    #[test]
    fn thresholds_are_those_of_the_longest_wave() {
        thresholds::<DVec2>(2.0 / PI.sqrt());
        thresholds::<DVec3>(75.0 / (64.0 * PI.sqrt()));
        assert!((shear_threshold::<DVec3>(25.0) - 5.0 * PI.powi(3) / (96.0 * 625.0)).abs() < 1e-15);
        // Miller 2004, below 4.75: 6·10⁻³ at l = 25.
        assert!((cluster_threshold::<DVec3>(25.0) - 6.46e-3).abs() < 1e-5);
    }

    #[test]
    fn collapse_begins_at_one_less_pi_over_the_depth() {
        for depth in [1e3, 1e4] {
            assert!((1.0 - collapse_restitution(depth) - PI / depth).abs() < 6.0 / (depth * depth));
        }
        assert_eq!(collapse_restitution(0.5), 0.0);
    }

    #[test]
    fn densities_are_normed() {
        let middles = (0..1000).map(|k| (f64::from(k) + 0.5) / 1000.0);
        let impacts: [f64; 2] = middles.clone().fold([0.0; 2], |[flat, deep], b| {
            [flat + chaotic_impact_density::<DVec2>(b), deep + chaotic_impact_density::<DVec3>(b)]
        });
        assert!(impacts.iter().all(|sum| (sum / 1000.0 - 1.0).abs() < 1e-12), "{impacts:?}");
        let gauss = |power: i32| -> f64 {
            middles
                .clone()
                .map(|x| (20.0 * x - 10.0).powi(power) * maxwell_density(20.0 * x - 10.0) / 50.0)
                .sum()
        };
        assert!((gauss(0) - 1.0).abs() < 1e-12 && (gauss(2) - 1.0).abs() < 1e-12, "{}", gauss(0));
    }

    #[test]
    fn a_displacement_along_the_change_of_momentum_carries_two_r() {
        let nu = 0.2;
        for r in [0.0, 0.6, 1.0] {
            let exact = 1.0 + 2.0 * r * nu * DVec2::contact_correlation(nu);
            assert!((displaced_compressibility_factor::<DVec2>(nu, r) - exact).abs() < 1e-14);
        }
    }
}
