//! One grain on a vibrating floor under gravity: the map from bounce to bounce, as exact as bisection makes it.

use super::reference::bisect;
use std::f64::consts::{PI, TAU};

/// Floor at A sin(ωt), grain without size, gravity g downwards, restitution r in the frame of the floor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Floor {
    pub(crate) amplitude: f64,
    pub(crate) angular_frequency: f64,
    pub(crate) gravity: f64,
    pub(crate) restitution: f64,
}

/// A bounce: when, and the velocity with which the grain leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounce {
    pub(crate) time: f64,
    pub(crate) velocity: f64,
}

impl Floor {
    pub(crate) fn height(&self, time: f64) -> f64 {
        self.amplitude * (self.angular_frequency * time).sin()
    }

    pub(crate) fn velocity(&self, time: f64) -> f64 {
        self.amplitude * self.angular_frequency * (self.angular_frequency * time).cos()
    }

    pub(crate) fn period(&self) -> f64 {
        TAU / self.angular_frequency
    }

    /// The bounce after `last`: the first root of z + vs − gs²/2 − A sin(ω(t + s)), by a scan in 10⁻⁵ of a period and
    /// bisection, then v′ = u − r(v − u) with the velocity u of the floor.
    pub(crate) fn next(&self, last: Bounce) -> Bounce {
        let start = self.height(last.time);
        let gap =
            |s: f64| start + last.velocity * s - 0.5 * self.gravity * s * s - self.height(last.time + s);
        let step = 1e-5 * self.period();
        let mut k = 1.0;
        while gap(k * step) > 0.0 {
            k += 1.0;
        }
        let flight = bisect(gap, (k - 1.0) * step, k * step);
        let time = last.time + flight;
        let floor = self.velocity(time);
        Bounce { time, velocity: floor - self.restitution * (last.velocity - self.gravity * flight - floor) }
    }

    /// The orbit that bounces every `periods` k periods T of the floor, always at the same phase θ.
    ///
    /// From one height to the same the grain returns with −v after 2v/g = kT, so v = gkT/2. The bounce repeats if
    /// v = (1 + r)u + rv, so u = Aω cos θ = v (1 − r)/(1 + r): two orbits if that is below Aω, `None` otherwise.
    /// A bounce that is late by δt and faster by δv is followed by one with
    /// δt′ = δt + (1 + r)δv/g, δv′ = −(1 + r)s δt + (r² − (1 + r)²s/g)δv, where s = Aω² sin θ; the determinant is
    /// r², so that the orbit is stable if 0 < (1 + r)²s/g < 2(1 + r²) (as Luck and Mehta 1993 have it): the orbit
    /// given is the one with sin θ > 0.
    pub(crate) fn orbit(&self, periods: u32) -> Option<Bounce> {
        let velocity = 0.5 * self.gravity * f64::from(periods) * self.period();
        let share = (1.0 - self.restitution) / (1.0 + self.restitution);
        let cosine = velocity * share / (self.amplitude * self.angular_frequency);
        (cosine < 1.0).then(|| Bounce { time: cosine.acos() / self.angular_frequency, velocity })
    }
}

/// Aω²/g = 1.207.
#[cfg(test)]
const FLOOR: Floor =
    Floor { amplitude: 0.003, angular_frequency: 20.0 * PI, gravity: 9.81, restitution: 0.5 };

#[test]
fn the_orbit_repeats() {
    // cos θ = πk (1 − r)/(1 + r) g/(Aω²) = 1.047 k/1.207.
    let cosine = PI / 3.0 * 9.81 / (0.003 * (20.0 * PI).powi(2));
    assert!(((20.0 * PI * FLOOR.orbit(1).unwrap().time).cos() - cosine).abs() < 1e-14);
    assert!(FLOOR.orbit(2).is_none());
    // Over a stronger floor there are more, none of them stable.
    let strong = Floor { amplitude: 0.01, ..FLOOR };
    for (floor, k) in [(FLOOR, 1), (strong, 1), (strong, 2), (strong, 3)] {
        let orbit = floor.orbit(k).unwrap();
        let next = floor.next(orbit);
        assert!((next.time - orbit.time - 0.1 * f64::from(k)).abs() < 1e-13, "{k} {next:?}");
        assert!((next.velocity - orbit.velocity).abs() < 1e-12, "{k} {next:?}");
    }
    assert!(strong.orbit(4).is_none());
}

#[test]
fn a_disturbed_orbit_returns_to_itself() {
    let orbit = FLOOR.orbit(1).unwrap();
    let mut bounce = Bounce { velocity: orbit.velocity * 1.02, ..orbit };
    for _ in 0..60 {
        bounce = FLOOR.next(bounce);
    }
    let phase = bounce.time / FLOOR.period();
    assert!((phase - phase.floor() - orbit.time / FLOOR.period()).abs() < 1e-10);
    assert!((bounce.velocity - orbit.velocity).abs() < 1e-10);
}

/// The derivatives of the map at the orbit, by differences, have the determinant and the trace derived above.
#[test]
fn the_orbit_is_as_stable_as_derived() {
    let orbit = FLOOR.orbit(1).unwrap();
    let difference = |time: f64, velocity: f64| {
        let [up, down] = [1.0, -1.0].map(|sign| {
            FLOOR.next(Bounce { time: orbit.time + sign * time, velocity: orbit.velocity + sign * velocity })
        });
        let step = 2.0 * (time + velocity);
        [(up.time - down.time) / step, (up.velocity - down.velocity) / step]
    };
    let (by_time, by_velocity) = (difference(1e-7, 0.0), difference(0.0, 1e-6));
    let s = 0.003 * (20.0 * PI).powi(2) * (20.0 * PI * orbit.time).sin();
    let trace = 1.25 - 2.25 * s / 9.81;
    assert!((by_time[0] + by_velocity[1] - trace).abs() < 1e-5);
    assert!((by_time[0] * by_velocity[1] - by_time[1] * by_velocity[0] - 0.25).abs() < 1e-5);
    assert!(2.25 * s / 9.81 < 2.5);
}
