//! When hard bodies meet: the first time at which an overlap function falls below zero.
//!
//! An event is the first time t ≥ 0 at which the overlap function is ≤ 0 and decreasing (Bannerman, Strobl,
//! Formella and Pöschel 2014, arXiv 1211.6718): what overlaps by rounding and approaches meets now, what
//! overlaps and separates is left alone. No tolerance enters.

use crate::space::Vector;

/// First time t ≥ 0 at which f(t) = c + 2bt + at² is ≤ 0 and decreasing; infinite if that lies beyond all numbers.
///
/// Roots are c/(√(b² − ac) − b) for b < 0 and (b + √(b² − ac))/(−a) for b ≥ 0 > a, both free of cancellation.
/// f that only touches zero from above does not count.
#[inline(always)]
fn descent(c: f64, b: f64, a: f64) -> Option<f64> {
    if b < 0.0 {
        if c <= 0.0 {
            return Some(0.0);
        }
        let discriminant = b * b - a * c;
        return (discriminant > 0.0).then(|| c / (discriminant.sqrt() - b));
    }
    if a < 0.0 {
        // Up to the top at b/(−a), where the discriminant is negative if even the top is below zero.
        return Some((b + (b * b - a * c).max(0.0).sqrt()) / -a);
    }
    None
}

/// Time until two grains meet whose centres are `separation` dx + `relative_velocity` dv · t apart
/// and whose contact distance is `distance` + `growth` · t [length; length/time; time].
///
/// f = (dx + dv t)² − (distance + growth t)². `growth` is 0 for grains of fixed size; grains that outgrow
/// their relative speed meet sooner or later.
#[inline(always)]
pub fn pair_contact<V: Vector>(
    separation: V,
    relative_velocity: V,
    distance: f64,
    growth: f64,
) -> Option<f64> {
    if growth != 0.0 {
        return growing_contact(separation, relative_velocity, distance, growth);
    }
    let b = separation.dot(relative_velocity);
    let c = separation.length_squared() - distance * distance;
    let discriminant = b * b - relative_velocity.length_squared() * c;
    // Most pairs pass each other, for one of two reasons: looked at together they make one branch that is seldom
    // taken, and foreseen by the processor. A pair that overlaps and approaches has a positive discriminant.
    if (-b).min(discriminant) > 0.0 {
        return Some(if c <= 0.0 { 0.0 } else { c / (discriminant.sqrt() - b) });
    }
    None
}

fn growing_contact<V: Vector>(
    separation: V,
    relative_velocity: V,
    distance: f64,
    growth: f64,
) -> Option<f64> {
    let b = separation.dot(relative_velocity) - distance * growth;
    let c = separation.length_squared() - distance * distance;
    descent(c, b, relative_velocity.length_squared() - growth * growth)
}

/// Time until a grain reaches a plane: f = height + velocity · t + acceleration · t²/2, all along the
/// normal of the plane and counted away from it, the height that of the grain's lowest point [length].
///
/// At rest on the plane under an acceleration towards it the time is 0.
#[inline(always)]
pub fn plane_contact(height: f64, velocity: f64, acceleration: f64) -> Option<f64> {
    descent(2.0 * height, velocity, acceleration)
}

/// Time until a `coordinate` leaves the interval from `low` to `high` under constant `acceleration`, infinite
/// if it never does, and whether it leaves by the upper end.
///
/// Beyond an end by rounding it leaves now if it moves on outward; if it moves inward it goes on to the
/// other end, or to the turn of its flight.
#[inline(always)]
pub fn leave_interval(coordinate: f64, low: f64, high: f64, velocity: f64, acceleration: f64) -> (f64, bool) {
    if acceleration == 0.0 {
        let upper = velocity > 0.0;
        let way = if upper { high - coordinate } else { low - coordinate };
        return (if velocity == 0.0 { f64::INFINITY } else { (way / velocity).max(0.0) }, upper);
    }
    let lower = plane_contact(coordinate - low, velocity, acceleration).unwrap_or(f64::INFINITY);
    let upper = plane_contact(high - coordinate, -velocity, -acceleration).unwrap_or(f64::INFINITY);
    if upper < lower { (upper, true) } else { (lower, false) }
}

/// The flight of a grain above a vibrating wall, along the normal of the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightOverVibration {
    /// Height of the grain's lowest point over the mean place of the wall at time 0 [length].
    pub height: f64,
    /// Velocity of the grain away from the wall at time 0 [length/time].
    pub velocity: f64,
    /// Acceleration of the grain away from the wall, negative where gravity pulls towards it [length/time²].
    pub acceleration: f64,
    /// Amplitude A of the wall [length], not negative.
    pub amplitude: f64,
    /// Angular frequency ω of the wall [1/time], not negative.
    pub angular_frequency: f64,
    /// Phase of the wall at time 0 [radian]: it stands at A sin(ωt + phase).
    pub phase: f64,
}

impl FlightOverVibration {
    /// Gap h = height + velocity · t + acceleration · t²/2 − A sin(ωt + phase) between grain and wall at
    /// time `t`, and its first two derivatives [length; length/time; length/time²].
    pub fn gap(&self, t: f64) -> [f64; 3] {
        let (sine, cosine) = libm::sincos(self.angular_frequency * t + self.phase);
        let wall_velocity = self.amplitude * self.angular_frequency;
        [
            self.height_at(t) - self.amplitude * sine,
            self.velocity_at(t) - wall_velocity * cosine,
            self.acceleration + wall_velocity * self.angular_frequency * sine,
        ]
    }

    fn height_at(&self, t: f64) -> f64 {
        self.height + t * (self.velocity + 0.5 * self.acceleration * t)
    }

    fn velocity_at(&self, t: f64) -> f64 {
        self.velocity + self.acceleration * t
    }

    /// A time that surely passes from `t` on before h is ≤ 0 and decreasing, given h and its derivatives at `t`:
    /// 0 if it is so now, `None` if it never is.
    fn safe_time(&self, t: f64, [gap, rate, curvature]: [f64; 3]) -> Option<f64> {
        let wall_acceleration = self.amplitude * self.angular_frequency * self.angular_frequency;
        if gap <= 0.0 {
            if rate < 0.0 {
                return Some(0.0);
            }
            // It still rises for as long as h' + h''s − Aω³s²/2 is positive.
            return descent(2.0 * rate, curvature, -wall_acceleration * self.angular_frequency);
        }
        // Above the highest place of the wall; and above the lowest parabola that h can follow.
        let clearance = self.height_at(t) - self.amplitude;
        let falling = if clearance > 0.0 {
            plane_contact(clearance, self.velocity_at(t), self.acceleration)?
        } else {
            0.0
        };
        Some(falling.max(plane_contact(gap, rate, self.acceleration - wall_acceleration)?))
    }
}

/// First time t in [0, `until`] at which a grain meets a vibrating wall: h ≤ 0 and decreasing. `until` is finite.
///
/// Conservative advancement: a parabola with h'' at its least, a − Aω², stays below h, so that no root lies
/// before the parabola's. Its steps approach a root from the left and converge as those of Newton's rule do,
/// without missing an earlier root; h is always counted from time 0, so that steps add no rounding. A grain
/// that has just bounced, with h = 0 within rounding and rising, is not met again before h has turned.
pub fn vibrating_contact(flight: &FlightOverVibration, until: f64) -> Option<f64> {
    let mut t = 0.0;
    while t <= until {
        let gap = flight.gap(t);
        let step = flight.safe_time(t, gap)?;
        let next = t + step;
        if next > t {
            t = next;
        } else if gap[0] > 0.0 && gap[1] >= 0.0 {
            // The wall grazes the grain without a speed of approach.
            t = t.next_up();
        } else {
            return Some(t);
        }
    }
    None
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
