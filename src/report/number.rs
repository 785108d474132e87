//! Numbers as a reader wants them.

use crate::observe::measure::Dimension;

/// Superscript digits, for powers of ten and units.
fn superscript(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    };
    power.to_string().chars().map(digit).collect()
}

/// 10 to a whole power, in words of type.
pub(super) fn power_of_ten(power: i32) -> String {
    match power {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(power)),
    }
}

/// `value` with `digits` significant digits; powers of ten for the very large and very small.
pub(super) fn number(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "not finite".to_owned();
    }
    // Scientific form rounds first, so 9.996 at three digits knows that it is 10.0.
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return signed(&trimmed(&group(&format!("{value:.decimals$}"))));
    }
    signed(&format!("{} × {}", trimmed(mantissa), power_of_ten(exponent)))
}

/// A typographic minus sign.
fn signed(text: &str) -> String {
    text.replacen('-', "−", 1)
}

/// Without zeros at the end of a decimal fraction.
fn trimmed(text: &str) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text.to_owned()
    }
}

/// Thin spaces between groups of three digits of a whole part of five or more.
fn group(text: &str) -> String {
    let (sign, digits) = text.strip_prefix('-').map_or(("", text), |rest| ("-", rest));
    let (whole, fraction) = digits.split_once('.').map_or((digits, None), |(w, f)| (w, Some(f)));
    if whole.len() < 5 {
        return text.to_owned();
    }
    let mut grouped = String::from(sign);
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && (whole.len() - index).is_multiple_of(3) {
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    if let Some(fraction) = fraction {
        grouped.push('.');
        grouped.push_str(fraction);
    }
    grouped
}

/// A count, whole, in groups of three digits.
pub(super) fn count(value: f64) -> String {
    if value.abs() < 1e15 { signed(&group(&format!("{value:.0}"))) } else { number(value, 4) }
}

/// A value with its standard error: two digits of the error and the value to the same place, but not more than
/// four digits of the value unless the error is smaller still.
pub(super) fn with_error(value: f64, standard_error: Option<f64>) -> String {
    // Values that are all the same scatter by rounding alone.
    let is_real = |error: &f64| error.is_finite() && *error > 1e-13 * value.abs();
    let Some(error) = standard_error.filter(is_real) else {
        return number(value, 4);
    };
    let exponent = value.abs().max(error).log10().floor() as i32;
    let first = error.log10().floor() as i32;
    let place = (first - 1).max(exponent - 3).min(first);
    if (-4..6).contains(&exponent) {
        let step = 10f64.powi(place.max(0));
        let decimals = (-place).max(0) as usize;
        let text =
            |x: f64| group(&format!("{:.decimals$}", if place > 0 { (x / step).round() * step } else { x }));
        return signed(&format!("{} ± {}", text(value), text(error)));
    }
    let scale = 10f64.powi(exponent);
    let decimals = (exponent - place).max(0) as usize;
    let (value, error) = (value / scale, error / scale);
    signed(&format!("({value:.decimals$} ± {error:.decimals$}) × {}", power_of_ten(exponent)))
}

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

/// `heap_slope` as "heap slope".
pub(super) fn in_words(name: &str) -> String {
    name.replace(['_', '-'], " ").replace("poisson", "Poisson")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(number(0.123456, 3), "0.123");
        assert_eq!(number(9.996, 3), "10");
        assert_eq!(number(-1234567.0, 3), "−1.23 × 10⁶");
        assert_eq!(number(99_856.0, 5), "99\u{202f}856");
        assert_eq!(number(2.5e-7, 4), "2.5 × 10⁻⁷");
        assert_eq!(number(40.0, 4), "40");
    }

    #[test]
    fn errors_set_the_digits_of_values() {
        assert_eq!(with_error(0.99412, Some(0.0031)), "0.9941 ± 0.0031");
        assert_eq!(with_error(0.0017123, Some(0.000052)), "0.001712 ± 0.000052");
        assert_eq!(with_error(1.23456e-7, Some(2.0e-9)), "(1.235 ± 0.020) × 10⁻⁷");
        assert_eq!(with_error(2.0, None), "2");
        assert_eq!(with_error(0.120_228_252_187_381, Some(4.0e-18)), "0.1202");
        assert_eq!(with_error(16149.08, Some(1173.3)), "16\u{202f}100 ± 1200");
        assert_eq!(with_error(1.68354, Some(0.00284)), "1.684 ± 0.003");
        assert_eq!(with_error(1.68354, Some(0.00028)), "1.6835 ± 0.0003");
    }

    #[test]
    fn counts_are_grouped_from_five_digits_on() {
        assert_eq!(
            [2037.0, 12_345.0, 17_334_407.0].map(count),
            ["2037", "12\u{202f}345", "17\u{202f}334\u{202f}407"]
        );
    }

    #[test]
    fn units_are_products_of_powers() {
        let names = ["d".to_owned(), "m".to_owned(), "√(d/g)".to_owned()];
        let unit = |mass, length, time| unit(Dimension { mass, length, time }, &names);
        assert_eq!(unit(1, 2, -2), "m\u{202f}d²\u{202f}√(d/g)⁻²");
        assert_eq!(unit(0, 0, 0), "");
    }
}
