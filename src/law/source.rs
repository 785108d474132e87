//! The pouring source.

use crate::space::Vector;

/// Grains that fall one by one onto what lies below (Müller 2001, section 3.5).
#[derive(Clone, Debug, PartialEq)]
pub struct Source<V> {
    /// How many grains are poured in all.
    pub count: u32,
    /// Grains per time [1/time].
    pub rate: f64,
    /// Centre of the spout [length]; its component along gravity is not used.
    pub position: V,
    /// Width of the spout along each horizontal axis [length].
    pub width: f64,
    /// Height above the highest full place of a grid two diameters wide [length].
    pub height: f64,
    /// Velocity of a new grain [length/time].
    pub velocity: V,
}

impl<V: Vector> Source<V> {
    /// Time in which a grain falls from the spout by `depth` along `gravity` when nothing is in its way [time].
    pub fn time_to_fall(&self, gravity: V, depth: f64) -> f64 {
        let strength = gravity.length();
        let downwards = self.velocity.dot(gravity) / strength;
        ((downwards * downwards + 2.0 * strength * depth).sqrt() - downwards) / strength
    }

    /// Grains on their way between the spout and a place that is `depth` below it.
    pub fn in_flight(&self, gravity: V, depth: f64) -> f64 {
        self.rate * self.time_to_fall(gravity, depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_fall_takes_what_gravity_and_the_first_velocity_make_of_it() {
        let at_rest = Source {
            count: 1,
            rate: 8.0,
            position: DVec2::ZERO,
            width: 1.0,
            height: 10.0,
            velocity: DVec2::ZERO,
        };
        let gravity = DVec2::new(0.0, -2.0);
        assert!((at_rest.time_to_fall(gravity, 9.0) - 3.0).abs() < 1e-15);
        assert!((at_rest.in_flight(gravity, 9.0) - 24.0).abs() < 1e-14);
        // 3 t + t² = 4 downwards; upwards at 3, 3 t of it are on the way up and back.
        let thrown = Source { velocity: DVec2::new(7.0, -3.0), ..at_rest.clone() };
        assert!((thrown.time_to_fall(gravity, 4.0) - 1.0).abs() < 1e-15);
        let upwards = Source { velocity: DVec2::new(0.0, 3.0), ..at_rest };
        assert!((upwards.time_to_fall(gravity, 4.0) - 4.0).abs() < 1e-15);
    }
}
