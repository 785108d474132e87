//! How long a run lasts and how often it is recorded, as far as a scenario alone tells: what the ticks of its log are
//! chosen by.

use super::model::{RunLimits, Scenario, Spacing};
use super::pace::falling_speed;
use super::{cost, estimate};
use crate::space::Vector;

/// Progress at the first of recordings that are spread logarithmically.
const FIRST_PLACE: f64 = 1e-3;

impl<V: Vector> Scenario<V> {
    /// How long the run lasts [time]; `None` where that cannot be told. Collisions of a gas that cools take as long as Haff's
    /// law says.
    pub fn expected_duration(&self) -> Option<f64> {
        let RunLimits { time, steps, .. } = self.run;
        let by_collisions = estimate::time_of_collisions(self);
        let by_time =
            [time, estimate::resting_time(self), by_collisions].into_iter().flatten().reduce(f64::min);
        let duration = if steps.is_some() || by_time.is_none() { cost::duration(self) } else { None };
        [by_time, duration].into_iter().flatten().reduce(f64::min).filter(|duration| *duration > 0.0)
    }

    /// The shortest pause between two recordings [time]; `None` where that cannot be told.
    ///
    /// Grains of a gas that cools collide most often at the start, so that pauses of so many collisions are shortest there.
    /// Where nothing tells how fast grains collide, it is the time in which the fastest of them flies its diameter.
    pub fn expected_pause(&self) -> Option<f64> {
        let share = match self.record.spacing {
            Spacing::Every(interval) => return Some(interval),
            Spacing::Frames(number) => 1.0 / f64::from(number.max(1)),
            Spacing::LogFrames(_) => FIRST_PLACE,
            Spacing::Ends => 1.0,
        };
        let RunLimits { time, steps, collisions_per_particle, .. } = self.run;
        let step = estimate::first_step(self).filter(|_| !self.engine.kind.is_event_driven());
        let by_steps = steps.zip(step).map(|(steps, step)| steps as f64 * step);
        let frequency = estimate::rates(self).map(|rates| rates.collision_frequency);
        let by_collisions = collisions_per_particle.zip(frequency).map(|(limit, rate)| limit / rate);
        let lengths = [time, estimate::resting_time(self), by_steps, by_collisions];
        let shortest = lengths.into_iter().flatten().reduce(f64::min).map(|length| share * length);
        let pause = shortest.or_else(|| self.flight_over_a_diameter());
        pause.map(|pause| pause.max(step.unwrap_or(0.0))).filter(|pause| *pause > 0.0)
    }

    /// The time in which the fastest grain to be expected flies its diameter [time].
    fn flight_over_a_diameter(&self) -> Option<f64> {
        let speed = falling_speed(self);
        (speed > 0.0).then(|| self.largest_diameter() / speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::time_scale::time_scale;
    use crate::scenario::model::AnyScenario;
    use crate::scenario::{Overrides, parse};
    use glam::{DVec2, DVec3};

    /// Argon in a box of 25 nm, in SI units.
    const ARGON: &str = "dimension = 3\n[engine]\nkind = \"dsmc\"\n[domain]\nsize = [25e-9, 25e-9, 25e-9]\n\
        [particles]\ncount = 1000\ndiameter = 0.4e-9\nmass = 6.63e-26\nrestitution = 1.0\n\
        [initial]\nvelocities = { maxwell = 4.14e-21 }\n[run]\ncollisions_per_particle = 20.0\n[record]\nframes = 20\n";
    /// Very inelastic disks that cool for a long time.
    const COOLING: &str = "dimension = 2\n[engine]\nkind = \"hsmc\"\n[domain]\nsize = [20.0, 20.0]\n\
        [particles]\ncount = 100\nrestitution = 0.1\n[initial]\nvelocities = { maxwell = 1.0 }\n\
        [run]\ncollisions_per_particle = 200.0\n[record]\nframes = 20\n";

    fn two(text: &str) -> Scenario<DVec2> {
        match parse("text", text, &Overrides::default()) {
            Ok(AnyScenario::Two(scenario)) => scenario,
            _ => unreachable!("it is a sound scenario of disks"),
        }
    }

    fn three(text: &str) -> Scenario<DVec3> {
        match parse("text", text, &Overrides::default()) {
            Ok(AnyScenario::Three(scenario)) => scenario,
            _ => unreachable!("it is a sound scenario of spheres"),
        }
    }

    #[test]
    fn ticks_of_a_run_that_ends_by_collisions_fit_its_collisions() {
        let argon = three(ARGON);
        // √2 n π σ² v̄ with v̄ = 468 m/s: 2.1·10¹⁰ collisions per atom and second.
        let pause = argon.expected_pause().unwrap();
        assert!((4e-11..7e-11).contains(&pause), "{pause}");
        assert!((argon.expected_duration().unwrap() / (20.0 * pause) - 1.0).abs() < 0.1);
        let scale = time_scale(argon.expected_duration().unwrap(), pause) as f64;
        assert!(pause * scale >= 1000.0 && pause * scale < 1e5, "{scale:e}");
    }

    #[test]
    fn ticks_of_a_gas_that_cools_for_long_tell_its_first_recordings_apart_as_far_as_the_range_allows() {
        let cooling = two(COOLING);
        let (duration, pause) = (cooling.expected_duration().unwrap(), cooling.expected_pause().unwrap());
        assert!(duration > 1e12 && (0.5..50.0).contains(&pause), "{duration} {pause}");
        assert!(time_scale(duration, pause) as f64 * pause >= 1.0);
    }

    #[test]
    fn grains_at_rest_are_told_apart_by_their_fall() {
        let falling = "dimension = 2\ngravity = [0.0, -9.81]\n[engine]\nkind = \"event-driven\"\n\
            [domain]\nsize = [4e-6, 4e-6]\n[boundary]\ny = { lower = { wall = \"smooth\" }, upper = \"open\" }\n\
            [particles]\ncount = 10\ndiameter = 1e-7\nrestitution = 0.9\n[initial]\nvelocities = \"rest\"\n\
            [run]\ncollisions_per_particle = 2.0\n[record]\nframes = 4\n";
        // 10⁻⁷/√(2 · 9.81 · 4·10⁻⁶) = 1.1·10⁻⁵.
        let pause = two(falling).expected_pause().unwrap();
        assert!((1.0e-5..1.3e-5).contains(&pause), "{pause}");
    }
}
