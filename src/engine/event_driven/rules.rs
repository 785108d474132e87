//! Choices that a scenario makes for the event-driven engine.

use std::fmt;

/// How the engine works.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventDrivenRules {
    /// How partners are found.
    pub structure: Structure,
    /// What prevents inelastic collapse.
    pub cure: Cure,
}

/// How the partners of a grain are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Structure {
    /// Cells or neighbour lists, by the counts of events.
    #[default]
    Automatic,
    /// The cells around its own.
    Cells,
    /// A list of the grains nearby.
    NeighbourLists,
}

/// Cures of inelastic collapse (Simić 2017, section 5.2); those that are given act together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cure {
    /// A collision with a normal relative speed below this one is elastic [length/time].
    pub elastic_below: Option<f64>,
    /// A collision is elastic when either partner has collided less than this time ago [time]: the TC
    /// model (Luding and McNamara 1998).
    pub contact_time: Option<f64>,
    /// An inelastic collision turns the relative velocity by a random angle up to this one [radian].
    pub rotation: Option<f64>,
}

impl Cure {
    /// The cure with which grains that come to lie under `gravity` were followed to the end: elastic below 0.3 √(g d) and within
    /// 10⁻⁵ √(d/g) of another collision. Without the latter strongly dissipative grains, pressed together at gaps below all
    /// rounding, collide without end at any speed; it is far below the time between collisions of grains at rest.
    /// docs/event-driven.md has the runs, among them those that ended in collapse with other cures.
    pub fn at_rest(gravity: f64, diameter: f64) -> Self {
        let (speed, time) = ((gravity * diameter).sqrt(), (diameter / gravity).sqrt());
        Cure { elastic_below: Some(0.3 * speed), contact_time: Some(1e-5 * time), rotation: None }
    }

    /// At least as much of each as `other` has.
    #[must_use]
    pub fn or_more(self, other: Self) -> Self {
        // `None` is less than any number.
        let more = |one: Option<f64>, other: Option<f64>| if other > one { other } else { one };
        Cure {
            elastic_below: more(self.elastic_below, other.elastic_below),
            contact_time: more(self.contact_time, other.contact_time),
            rotation: more(self.rotation, other.rotation),
        }
    }
}

/// As the value of `engine.event_driven.collapse` in a scenario, with one digit of each number: more is not known.
impl fmt::Display for Cure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            ("elastic_below", self.elastic_below),
            ("contact_time", self.contact_time),
            ("rotation", self.rotation.map(f64::to_degrees)),
        ];
        let parts: Vec<String> = parts
            .into_iter()
            .filter_map(|(key, value)| Some(format!("{key} = {}", one_digit(value?))))
            .collect();
        if parts.is_empty() { f.write_str("\"none\"") } else { write!(f, "{{ {} }}", parts.join(", ")) }
    }
}

/// `value` with one digit.
pub fn one_digit(value: f64) -> String {
    let text = format!("{value:.0e}");
    match text.parse::<f64>() {
        Ok(rounded) if (1e-3..1e3).contains(&rounded) => format!("{rounded}"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cure_is_written_as_a_scenario_has_it() {
        assert_eq!(Cure::at_rest(1.0, 1.0).to_string(), "{ elastic_below = 0.3, contact_time = 1e-5 }");
        // Disks of a millimetre: √(g d) = 0.099 m/s, √(d/g) = 0.0101 s.
        assert_eq!(Cure::at_rest(9.81, 1e-3).to_string(), "{ elastic_below = 0.03, contact_time = 1e-7 }");
        let turned = Cure { rotation: Some(5.0_f64.to_radians()), ..Cure::default() };
        assert_eq!(turned.to_string(), "{ rotation = 5 }");
        assert_eq!(Cure::default().to_string(), "\"none\"");
    }

    #[test]
    fn of_two_cures_the_stronger_parts_are_taken() {
        let one = Cure { elastic_below: Some(0.1), rotation: Some(0.2), ..Cure::default() };
        let other = Cure { elastic_below: Some(0.3), contact_time: Some(1e-5), ..Cure::default() };
        let both = Cure { elastic_below: Some(0.3), contact_time: Some(1e-5), rotation: Some(0.2) };
        assert_eq!((one.or_more(other), other.or_more(one)), (both, both));
    }
}
