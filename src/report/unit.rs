//! Units as products of powers, with superscripts.

use crate::number::superscript;
use crate::observe::measure::Dimension;

/// The unit that `dimension` makes of the names of `[length, mass, time]`; empty for a pure number.
pub(super) fn unit(dimension: Dimension, names: &[String; 3]) -> String {
    let powers = [(dimension.mass, &names[1]), (dimension.length, &names[0]), (dimension.time, &names[2])];
    let factors: Vec<String> = powers
        .iter()
        .filter(|(power, _)| *power != 0)
        .map(|(power, name)| {
            // A name that is itself a formula, such as √(d/g), needs brackets under a power.
            let simple = name.chars().all(char::is_alphanumeric) || name.ends_with(')');
            let name = if simple || *power == 1 { (*name).clone() } else { format!("({name})") };
            if *power == 1 { name } else { name + &superscript(i32::from(*power)) }
        })
        .collect();
    factors.join("\u{202f}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_products_of_powers() {
        let names = ["d".to_owned(), "m".to_owned(), "√(d/g)".to_owned()];
        let unit = |mass, length, time| unit(Dimension { mass, length, time }, &names);
        assert_eq!(unit(1, 2, -2), "m\u{202f}d²\u{202f}√(d/g)⁻²");
        assert_eq!(unit(0, 0, 0), "");
    }
}
