//! Units as they stand in a log: `mass length^2 time^-2`.

use crate::observe::measure::Dimension;

/// The text for `dimension`: powers of mass, length and time, or `1` for a pure number.
pub(crate) fn unit_text(dimension: Dimension) -> String {
    let powers = [("mass", dimension.mass), ("length", dimension.length), ("time", dimension.time)];
    let parts: Vec<String> = powers
        .into_iter()
        .filter(|&(_, power)| power != 0)
        .map(|(name, power)| if power == 1 { name.to_owned() } else { format!("{name}^{power}") })
        .collect();
    if parts.is_empty() { "1".to_owned() } else { parts.join(" ") }
}

/// The dimension that `text` names; `None` where it is no such text.
pub(crate) fn dimension_of(text: &str) -> Option<Dimension> {
    let mut dimension = Dimension::default();
    if text == "1" {
        return Some(dimension);
    }
    for part in text.split(' ') {
        let (name, power) = match part.split_once('^') {
            Some((name, power)) => (name, power.parse().ok()?),
            None => (part, 1),
        };
        match name {
            "mass" => dimension.mass = power,
            "length" => dimension.length = power,
            "time" => dimension.time = power,
            _ => return None,
        }
    }
    Some(dimension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_comes_back() {
        for mass in -3..=3 {
            for length in [-128, -1, 0, 1, 2, 127] {
                for time in -3..=3 {
                    let dimension = Dimension { mass, length, time };
                    assert_eq!(dimension_of(&unit_text(dimension)), Some(dimension));
                }
            }
        }
        assert_eq!(unit_text(Dimension { mass: 1, length: 2, time: -2 }), "mass length^2 time^-2");
        assert_eq!(dimension_of("furlong"), None);
        assert_eq!(dimension_of("mass^x"), None);
    }
}
