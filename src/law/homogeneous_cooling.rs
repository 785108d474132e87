//! How a homogeneous gas without drive cools: Haff's law with the first Sonine correction.

use super::kinetic_theory::{
    collision_frequency, cooling_per_collision, haff_time, sonine_cooling_factor,
    sonine_cooling_factor_per_collision,
};
use crate::matter::grain::Grain;
use crate::space::Vector;

/// T(t) = T₀ (1 + t/t₀)⁻² and T(τ) = T₀ exp(−γτ), τ in collisions per particle (Haff 1983; van Noije and Ernst 1998).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousCooling {
    /// T₀: temperature at the start [energy].
    pub temperature: f64,
    /// t₀: time in which the temperature falls to a quarter [time].
    pub time: f64,
    /// γ: ln T falls by this much with each collision per particle [1].
    pub per_collision: f64,
}

impl HomogeneousCooling {
    /// The law of a gas of `volume_fraction` and constant `restitution` below 1 that begins at `temperature`;
    /// `contact_correlation` as in [`collision_frequency`].
    pub fn of<V: Vector>(
        grain: Grain,
        volume_fraction: f64,
        temperature: f64,
        restitution: f64,
        contact_correlation: f64,
    ) -> Self {
        let frequency = collision_frequency::<V>(grain, volume_fraction, temperature, contact_correlation);
        let factor = sonine_cooling_factor_per_collision::<V>(restitution);
        HomogeneousCooling {
            temperature,
            time: haff_time::<V>(restitution, frequency) / sonine_cooling_factor::<V>(restitution),
            per_collision: 2.0 * cooling_per_collision::<V>(restitution) * factor,
        }
    }

    /// T at `time` [energy; time].
    pub fn at_time(&self, time: f64) -> f64 {
        self.temperature / (1.0 + time / self.time).powi(2)
    }

    /// T after so many collisions per particle, 2C/N [energy].
    pub fn after_collisions(&self, collisions: f64) -> f64 {
        self.temperature * (-self.per_collision * collisions).exp()
    }

    /// Collisions per particle up to `time` [1; time]: what both laws together say, (2/γ) ln(1 + t/t₀).
    pub fn collisions_until(&self, time: f64) -> f64 {
        2.0 / self.per_collision * (time / self.time).ln_1p()
    }

    /// Collisions per particle and time at `time` [1/time; time].
    pub fn collision_frequency(&self, time: f64) -> f64 {
        2.0 / (self.per_collision * (self.time + time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::kinetic_theory::sonine_c_star;
    use glam::{DVec2, DVec3};

    /// The rates at the start, by differences: dT/dt and 2C/N per time of a gas that is Maxwellian up to c*.
    fn begins_at_its_rates<V: Vector>() {
        let grain = Grain { diameter: 1.3, mass: 0.7 };
        let (nu, temperature, r, g) = (0.2, 1.7, 0.8, 1.4);
        let law = HomogeneousCooling::of::<V>(grain, nu, temperature, r, g);
        let frequency = collision_frequency::<V>(grain, nu, temperature, g);
        let c = sonine_c_star::<V>(r);
        let lost = (1.0 - r * r) / V::DIMENSION as f64 * frequency * (1.0 + 3.0 * c / 32.0);
        let step = 1e-6 / frequency;
        let fall = (1.0 - law.at_time(step) / temperature) / step;
        assert!((fall / lost - 1.0).abs() < 1e-5, "{fall} beside {lost}");
        let rate = law.collisions_until(step) / step;
        assert!((rate / (frequency * (1.0 - c / 32.0)) - 1.0).abs() < 1e-5, "{rate}");
    }

    #[test]
    fn both_laws_are_one() {
        begins_at_its_rates::<DVec2>();
        begins_at_its_rates::<DVec3>();
        let law = HomogeneousCooling::of::<DVec2>(Grain { diameter: 1.0, mass: 1.0 }, 0.25, 1.0, 0.9, 1.5);
        assert!((law.at_time(law.time) - 0.25).abs() < 1e-15);
        for time in [0.3, 7.0, 500.0] {
            let counted = law.collisions_until(1.001 * time) - law.collisions_until(0.999 * time);
            assert!((law.collision_frequency(time) / (counted / (0.002 * time)) - 1.0).abs() < 1e-5);
            let beside = law.after_collisions(law.collisions_until(time));
            assert!((law.at_time(time) / beside - 1.0).abs() < 1e-12);
        }
    }
}
