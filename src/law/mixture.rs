//! Kinetic theory of mixtures: how often grains of several sizes and masses collide, and how far they get.
//!
//! Grains of species i collide with those of species j at the rate ω_ij = n_j σ_ij ⟨g_ij⟩ χ_ij, with the number density n_j, the
//! cross-section σ_ij of the diameter (d_i + d_j)/2, the mean relative speed ⟨g_ij⟩ = c √(T/(2μ_ij)) of Maxwell gases of one
//! temperature, c = √π in 2D and 4/√π in 3D, μ_ij the reduced mass (Chapman and Cowling 1970, 5.2), and the contact value
//! χ_ij ([`Vector::pair_contact_correlation`]; Jenkins and Mancini 1987 in 2D; Boublík 1970 and Mansoori, Carnahan, Starling and
//! Leland 1971 in 3D). Velocities are those of the start: in an inelastic mixture the species part in temperature later on.

use crate::matter::grain::Grain;
use crate::space::Vector;

/// Species with their number densities.
#[derive(Clone, Debug)]
pub struct Mixture {
    /// `[species]`: what its grains are, and how many there are per volume [1/lengthᴰ].
    species: Vec<(Grain, f64)>,
}

impl Mixture {
    /// Species with their numbers of grains in a box of `volume` [lengthᴰ].
    pub fn new(species: impl Iterator<Item = (Grain, u32)>, volume: f64) -> Self {
        Mixture { species: species.map(|(grain, count)| (grain, f64::from(count) / volume)).collect() }
    }

    /// Grains per volume [1/lengthᴰ].
    fn density(&self) -> f64 {
        self.species.iter().map(|(_, density)| density).sum()
    }

    /// ξ_k = V₁ Σ n d^k, V₁ the volume of a sphere of unit diameter; for k = D the volume fraction [length^(k − D)].
    fn moment<V: Vector>(&self, power: usize) -> f64 {
        let powers = self.species.iter().map(|(grain, density)| density * grain.diameter.powi(power as i32));
        V::UNIT_SPHERE_VOLUME * powers.sum::<f64>()
    }

    /// χ_ij of two species.
    fn contact_correlation<V: Vector>(&self, one: Grain, other: Grain) -> f64 {
        let harmonic = 2.0 * one.diameter * other.diameter / (one.diameter + other.diameter);
        let crowding = harmonic * self.moment::<V>(V::DIMENSION - 1);
        V::pair_contact_correlation(self.moment::<V>(V::DIMENSION), crowding)
    }

    /// Collisions per time of a grain of the first kind with all of species `other` [1/time].
    fn rate<V: Vector>(&self, one: Grain, (other, density): (Grain, f64), temperature: f64) -> f64 {
        let reduced = one.mass * other.mass / (one.mass + other.mass);
        let speed = V::MEAN_RELATIVE_SPEED * (temperature / (2.0 * reduced)).sqrt();
        let section = V::cross_section(0.5 * (one.diameter + other.diameter));
        density * section * speed * self.contact_correlation::<V>(one, other)
    }

    /// Collisions per grain and time at `temperature`, on the average over all grains: 2C/N per time [1/time; energy].
    pub fn collision_frequency<V: Vector>(&self, temperature: f64) -> f64 {
        let all = self.species.iter().flat_map(|(one, density)| {
            self.species.iter().map(move |other| density * self.rate::<V>(*one, *other, temperature))
        });
        all.sum::<f64>() / self.density()
    }

    /// Mean speed of all grains, c √(T/(2m)) of one of mass m, over the collision frequency [length].
    pub fn mean_free_path<V: Vector>(&self) -> f64 {
        let speed = |mass: f64| V::MEAN_RELATIVE_SPEED * (0.5 / mass).sqrt();
        let speeds: f64 = self.species.iter().map(|(grain, density)| density * speed(grain.mass)).sum();
        speeds / self.density() / self.collision_frequency::<V>(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::kinetic_theory::{collision_frequency, mean_free_path};
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    const GRAIN: Grain = Grain { diameter: 1.3, mass: 0.7 };

    /// Two species of the same grains are one.
    fn equal_species<V: Vector>() {
        let volume = 1000.0;
        let nu = 300.0 * GRAIN.volume::<V>() / volume;
        let mixture = Mixture::new([(GRAIN, 100), (GRAIN, 200)].into_iter(), volume);
        let alone = collision_frequency::<V>(GRAIN, nu, 1.7, V::contact_correlation(nu));
        assert!((mixture.collision_frequency::<V>(1.7) / alone - 1.0).abs() < 1e-13);
        assert!((mixture.mean_free_path::<V>() / mean_free_path::<V>(GRAIN, nu) - 1.0).abs() < 1e-13);
    }

    #[test]
    fn species_that_are_alike_are_one_gas() {
        equal_species::<DVec2>();
        equal_species::<DVec3>();
    }

    #[test]
    fn contact_values_are_the_printed_formulas() {
        let [small, large] = [Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 3.0, mass: 2.0 }];
        let mixture = Mixture::new([(small, 50), (large, 5)].into_iter(), 400.0);
        // Jenkins and Mancini 1987, in radii: 1/(1 − ν) + (9 π/8) (n₁ a₁ + n₂ a₂) a_i a_j/(a_i + a_j)/(1 − ν)².
        let (n1, n2) = (0.125, 0.0125);
        let nu = PI / 4.0 * (n1 + 9.0 * n2);
        let sum = n1 * 0.5 + n2 * 1.5;
        let flat = 1.0 / (1.0 - nu) + 9.0 * PI / 8.0 * sum * (0.5 * 1.5 / 2.0) / (1.0 - nu).powi(2);
        assert!((mixture.contact_correlation::<DVec2>(small, large) / flat - 1.0).abs() < 1e-14);
        // Mansoori et al. 1971 with ξ₂ = π/6 Σ n d².
        let nu = PI / 6.0 * (n1 + 27.0 * n2);
        let (xi, ratio) = (PI / 6.0 * (n1 + 9.0 * n2), 3.0 / 4.0);
        let free: f64 = 1.0 - nu;
        let deep =
            1.0 / free + 3.0 * ratio * xi / free.powi(2) + 2.0 * ratio * ratio * xi * xi / free.powi(3);
        assert!((mixture.contact_correlation::<DVec3>(small, large) / deep - 1.0).abs() < 1e-14);
    }

    #[test]
    fn heavy_grains_of_one_size_collide_less_often() {
        // √(T/(2μ)) for masses 1 and 8: 1, √(9/16) and √(1/8), of which a quarter, a half and a quarter count.
        let kinds = [1.0, 8.0].map(|mass| (Grain { diameter: 1.0, mass }, 500));
        let mixture = Mixture::new(kinds.into_iter(), 5000.0);
        let nu = 0.2 * PI / 6.0;
        let light = collision_frequency::<DVec3>(kinds[0].0, nu, 1.0, DVec3::contact_correlation(nu));
        let share = 0.25 + 0.5 * 0.75 + 0.25 * 0.125_f64.sqrt();
        assert!((mixture.collision_frequency::<DVec3>(1.0) / light / share - 1.0).abs() < 1e-13);
    }
}
