//! What a collision does to two hard grains.
//!
//! Throughout, the normal k points from grain 1 to grain 2, and v₁₂ = v₁ − v₂. The surfaces meet with
//! g = v₁₂ + ω₁ × a₁k + ω₂ × a₂k, since the contact lies at a₁k from the centre of grain 1 and at −a₂k from
//! that of grain 2. The impulse P on grain 1 (−P on grain 2) changes g by P/μ + P_t/(zμ), μ the reduced
//! mass and z = I/(ma²) the same for both. With g_n′ = −r g_n and g_t′ = −φ g_t it is
//!
//! P = −(1 + r) μ v_n − (1 + φ) μ z/(1 + z) g_t,  ω₁′ = ω₁ + k × P/(z m₁a₁),  ω₂′ = ω₂ + k × P/(z m₂a₂).
//!
//! For equal grains this is Miller 2004 (2.7) and (2.8), if k is read there as pointing from grain 2 to
//! grain 1: with k as his text has it, the signs of v_r and of the change of spin would both be wrong. It is Simić 2017
//! (1.15) with φ = −ε_t, if g has the sum of the spins as in his (1.8) and not their difference as in his (1.1).

use crate::law::roughness::Roughness;
use crate::matter::grain::Grain;
use crate::space::Vector;

/// What a collision needs to know of the two grains: the same for all collisions of two species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairOfGrains {
    /// Reduced mass μ = m₁m₂/(m₁ + m₂) [mass].
    pub reduced_mass: f64,
    /// μ/m₁ and μ/m₂: which share of the change of v₁₂ each grain takes. They add up to 1.
    pub shares: [f64; 2],
    /// Radii a₁ and a₂ [length].
    pub radii: [f64; 2],
}

impl PairOfGrains {
    /// The pair of a grain like `first` and one like `second`.
    pub fn of(first: Grain, second: Grain) -> Self {
        let total = first.mass + second.mass;
        PairOfGrains {
            reduced_mass: first.mass / total * second.mass,
            shares: [second.mass / total, first.mass / total],
            radii: [0.5 * first.diameter, 0.5 * second.diameter],
        }
    }
}

/// Two grains at contact, as far as their centres go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting<V> {
    /// x₂ − x₁ [length]; its length need not be the sum of the radii to the last digit.
    pub separation: V,
    /// v₁ − v₂ [length/time].
    pub relative_velocity: V,
    /// (v₁ − v₂)·(x₂ − x₁), positive where they approach [length²/time].
    pub approach: f64,
    /// (x₂ − x₁)² [length²].
    pub distance_squared: f64,
}

impl<V: Vector> Meeting<V> {
    /// The meeting of two grains with the given `separation` x₂ − x₁ and `velocities`.
    #[inline(always)]
    pub fn of(separation: V, velocities: &[V; 2]) -> Self {
        let relative_velocity = velocities[0] - velocities[1];
        Meeting {
            separation,
            relative_velocity,
            approach: relative_velocity.dot(separation),
            distance_squared: separation.length_squared(),
        }
    }

    /// |v₁₂·k|, the speed that restitution laws ask for [length/time].
    #[inline(always)]
    pub fn normal_speed(&self) -> f64 {
        self.approach.abs() / self.distance_squared.sqrt()
    }

    /// Smooth grains collide with `restitution` r: each velocity changes by its share of (1 + r) v_n.
    ///
    /// v_n = (v₁₂·Δx)/(Δx·Δx) Δx needs no unit vector, so that r = 1 conserves energy whatever |Δx| is.
    /// Returns the momentum transferred along k, (1 + r) μ v₁₂·k [mass·length/time], positive where they approached.
    #[inline(always)]
    pub fn collide_smooth(&self, pair: &PairOfGrains, restitution: f64, velocities: &mut [V; 2]) -> f64 {
        let change = (1.0 + restitution) * self.approach / self.distance_squared;
        velocities[0] -= self.separation * (change * pair.shares[0]);
        velocities[1] += self.separation * (change * pair.shares[1]);
        pair.reduced_mass * change * self.distance_squared.sqrt()
    }

    /// Rough grains collide with `restitution` r and tangential restitution φ: also the spins change.
    ///
    /// Returns the momentum transferred along k [mass·length/time]; the momentum along the contact plane
    /// carries no pressure.
    #[inline]
    pub fn collide_rough(
        &self,
        pair: &PairOfGrains,
        roughness: Roughness,
        restitution: f64,
        velocities: &mut [V; 2],
        spins: &mut [V::Spin; 2],
    ) -> f64 {
        let Roughness { tangential_restitution, reduced_inertia } = roughness;
        let distance = self.distance_squared.sqrt();
        let normal = self.separation * (1.0 / distance);
        let along_normal = self.separation * (self.approach / self.distance_squared);
        let surface_speed = V::spin_velocity(spins[0], normal) * pair.radii[0]
            + V::spin_velocity(spins[1], normal) * pair.radii[1];
        let sliding = self.relative_velocity - along_normal + surface_speed;
        let grip = (1.0 + tangential_restitution) * reduced_inertia / (1.0 + reduced_inertia);
        // −P/μ: what v₁₂ loses.
        let loss = along_normal * (1.0 + restitution) + sliding * grip;
        velocities[0] -= loss * pair.shares[0];
        velocities[1] += loss * pair.shares[1];
        // The part of the impulse along the normal turns nothing.
        let twist = V::torque(normal, sliding * (grip / reduced_inertia));
        spins[0] = V::add_spin(spins[0], twist, -pair.shares[0] / pair.radii[0]);
        spins[1] = V::add_spin(spins[1], twist, -pair.shares[1] / pair.radii[1]);
        pair.reduced_mass * (1.0 + restitution) * self.approach / distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Stream, Streams};
    use glam::{DVec2, DVec3};

    const LIGHT: Grain = Grain { diameter: 1.0, mass: 1.5 };
    const HEAVY: Grain = Grain { diameter: 1.8, mass: 4.0 };
    const Z: f64 = 0.4;

    /// Two grains at contact.
    #[derive(Clone, Copy)]
    struct State<V: Vector> {
        grains: [Grain; 2],
        separation: V,
        velocities: [V; 2],
        spins: [V::Spin; 2],
    }

    impl<V: Vector> State<V> {
        fn random(grains: [Grain; 2], random: &mut Stream) -> Self {
            let mut vector = || V::from_fn(|_| random.gaussian());
            let (direction, velocities) = (vector(), [vector(), vector()]);
            let contact = 0.5 * (grains[0].diameter + grains[1].diameter);
            let spins = [0; 2].map(|_| {
                let mut spin = V::Spin::default();
                spin.as_mut().iter_mut().for_each(|part| *part = random.gaussian());
                spin
            });
            State { grains, separation: direction * (contact / direction.length()), velocities, spins }
        }

        fn collide(mut self, restitution: f64, phi: Option<f64>) -> (Self, f64) {
            let pair = PairOfGrains::of(self.grains[0], self.grains[1]);
            let meeting = Meeting::of(self.separation, &self.velocities);
            let momentum = match phi {
                None => meeting.collide_smooth(&pair, restitution, &mut self.velocities),
                Some(phi) => {
                    let rough = Roughness { tangential_restitution: phi, reduced_inertia: Z };
                    meeting.collide_rough(&pair, rough, restitution, &mut self.velocities, &mut self.spins)
                }
            };
            (self, momentum)
        }

        /// Arm of the contact from the centre of grain `k`.
        fn arm(&self, k: usize) -> V {
            let normal = self.separation * (1.0 / self.separation.length());
            normal * (0.5 * self.grains[k].diameter * [1.0, -1.0][k])
        }

        fn inertia(&self, k: usize) -> f64 {
            Z * self.grains[k].mass * self.grains[k].diameter.powi(2) / 4.0
        }

        fn energy(&self) -> f64 {
            let of_grain = |k: usize| {
                let spin: f64 = self.spins[k].as_ref().iter().map(|part| part * part).sum();
                0.5 * (self.grains[k].mass * self.velocities[k].length_squared() + self.inertia(k) * spin)
            };
            of_grain(0) + of_grain(1)
        }

        fn momentum(&self) -> V {
            self.velocities[0] * self.grains[0].mass + self.velocities[1] * self.grains[1].mass
        }

        /// Angular momentum of grain `k` about the contact, which the collision cannot change.
        fn angular_momentum(&self, k: usize) -> V::Spin {
            let orbital = V::torque(-self.arm(k), self.velocities[k] * self.grains[k].mass);
            V::add_spin(orbital, self.spins[k], self.inertia(k))
        }

        /// Relative velocity of the surfaces at the contact: its part along the normal, and the rest.
        fn surface_velocity(&self) -> (f64, V) {
            let surface = |k: usize| self.velocities[k] + V::spin_velocity(self.spins[k], self.arm(k));
            let (relative, normal) =
                (surface(0) - surface(1), self.separation * (1.0 / self.separation.length()));
            (relative.dot(normal), relative - normal * relative.dot(normal))
        }
    }

    fn near<V: Vector>(one: V, other: V) {
        assert!((one - other).length() < 1e-12, "{one:?} {other:?}");
    }

    fn laws_of_collision<V: Vector>() {
        let mut random = Streams::new(2).at(0, Phase::Collisions).stream(0);
        for k in 0..400 {
            let grains = [[LIGHT, LIGHT], [LIGHT, HEAVY], [HEAVY, LIGHT]][k % 3];
            let state = State::<V>::random(grains, &mut random);
            let (r, phi) = (random.uniform(), random.symmetric());
            let mu = grains[0].mass * grains[1].mass / (grains[0].mass + grains[1].mass);
            for phi in [None, Some(-1.0), Some(phi), Some(1.0)] {
                let (after, momentum) = state.collide(r, phi);
                near(after.momentum(), state.momentum());
                for k in [0, 1] {
                    let change = V::add_spin(after.angular_momentum(k), state.angular_momentum(k), -1.0);
                    assert!(change.as_ref().iter().all(|part| part.abs() < 1e-12));
                }
                let (normal, sliding) = state.surface_velocity();
                let (normal_after, sliding_after) = after.surface_velocity();
                assert!((normal_after + r * normal).abs() < 1e-12);
                near(sliding_after, sliding * -phi.unwrap_or(-1.0));
                let grip = Z / (1.0 + Z) * (1.0 - phi.unwrap_or(-1.0).powi(2));
                let loss = 0.5 * mu * ((1.0 - r * r) * normal * normal + grip * sliding.length_squared());
                assert!((state.energy() - after.energy() - loss).abs() < 1e-12);
                assert!((momentum - (1.0 + r) * mu * normal).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn momenta_and_energies_are_those_of_the_laws() {
        laws_of_collision::<DVec2>();
        laws_of_collision::<DVec3>();
    }

    #[test]
    fn equal_smooth_elastic_grains_exchange_their_normal_velocities() {
        let velocities = [DVec2::new(3.0, 1.0), DVec2::new(-1.0, 2.0)];
        let mut after = velocities;
        let pair = PairOfGrains::of(LIGHT, LIGHT);
        let meeting = Meeting::of(DVec2::new(1.0, 0.0), &velocities);
        assert_eq!((meeting.normal_speed(), meeting.approach), (4.0, 4.0));
        assert_eq!(meeting.collide_smooth(&pair, 1.0, &mut after), 6.0);
        assert_eq!(after, [DVec2::new(-1.0, 1.0), DVec2::new(3.0, 2.0)]);
        // With r = 1/2 at 45°: v₁₂ = (4, −1), v₁₂·k k = (3/2, 3/2), and each takes 3/4 of it.
        let mut after = velocities;
        let meeting = Meeting::of(DVec2::new(0.5, 0.5), &velocities);
        meeting.collide_smooth(&pair, 0.5, &mut after);
        near(after[0], DVec2::new(1.875, -0.125));
        near(after[1], DVec2::new(0.125, 3.125));
    }

    #[test]
    fn an_inexact_distance_costs_no_energy() {
        let velocities = [DVec3::new(0.3, -0.7, 1.1), DVec3::new(-0.2, 0.4, 0.9)];
        let energy = |v: [DVec3; 2]| v[0].length_squared() + v[1].length_squared();
        for stretch in [0.9, 1.0 - 1e-9, 1.0 + 1e-9, 1.1] {
            let mut after = velocities;
            let meeting = Meeting::of(DVec3::new(0.6, 0.0, 0.8) * stretch, &velocities);
            let momentum = meeting.collide_smooth(&PairOfGrains::of(LIGHT, LIGHT), 1.0, &mut after);
            assert!((energy(after) / energy(velocities) - 1.0).abs() < 1e-15);
            // v₁₂·k = 0.3 + 0.16 and μ = 3/4.
            assert!((momentum - 0.69).abs() < 1e-15);
        }
    }

    /// Equal disks, z = 1/2, φ = 1: the upper one slides to the right over one at rest at speed 1.
    /// k = (0, −1), g_t = (1, 0), P = −2 (m/2)(1/3)(1, 0) = −m/3; a k × P = −ma/3, shared by I = ma²/2.
    #[test]
    fn a_sliding_disk_sets_both_rolling() {
        let grain = Grain { diameter: 3.0, mass: 2.0 };
        let mut velocities = [DVec2::X, DVec2::ZERO];
        let mut spins = [[0.0]; 2];
        let rough = Roughness { tangential_restitution: 1.0, reduced_inertia: 0.5 };
        let meeting = Meeting::of(DVec2::new(0.0, -3.0), &velocities);
        let pair = PairOfGrains::of(grain, grain);
        let momentum = meeting.collide_rough(&pair, rough, 0.7, &mut velocities, &mut spins);
        assert_eq!(momentum, 0.0);
        near(velocities[0], DVec2::new(2.0 / 3.0, 0.0));
        near(velocities[1], DVec2::new(1.0 / 3.0, 0.0));
        // −2/(3a) with a = 3/2: both turn to the right, as the wheels of a gear do not.
        assert!(spins.iter().all(|spin| (spin[0] + 4.0 / 9.0).abs() < 1e-15));
    }

    /// Solid spheres one above the other; the lower one spins about x and drives the upper one along y.
    /// k = (0, 0, 1), g = ω₁ × a k = (0, −aω, 0), P = (1 + φ) μ z/(1 + z) (0, aω, 0) on grain 1.
    #[test]
    fn a_spinning_sphere_throws_itself_off() {
        let (a, omega, phi) = (0.5, 4.0, 0.5);
        let mut velocities = [DVec3::ZERO; 2];
        let mut spins = [[omega, 0.0, 0.0], [0.0; 3]];
        let rough = Roughness { tangential_restitution: phi, reduced_inertia: 0.4 };
        let grain = Grain { diameter: 2.0 * a, mass: 1.0 };
        let meeting = Meeting::of(DVec3::Z * 2.0 * a, &velocities);
        meeting.collide_rough(&PairOfGrains::of(grain, grain), rough, 1.0, &mut velocities, &mut spins);
        let impulse = (1.0 + phi) * 0.5 * 0.4 / 1.4 * a * omega;
        near(velocities[0], DVec3::Y * impulse);
        near(velocities[1], DVec3::Y * -impulse);
        // k × P = (−P, 0, 0).
        near(DVec3::from_array(spins[0]), DVec3::X * (omega - impulse / (0.4 * a)));
        near(DVec3::from_array(spins[1]), DVec3::X * (-impulse / (0.4 * a)));
    }
}
