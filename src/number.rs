//! Numbers as text: to the digits that mean something, on pages, in terminals and in messages alike.

use crate::statistics::Trend;

/// A whole number in superscript digits, for powers of ten and units.
pub fn superscript(power: i32) -> String {
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
pub fn power_of_ten(power: i32) -> String {
    match power {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(power)),
    }
}

/// `value` with `digits` significant digits; powers of ten for the very large and very small.
pub fn number(value: f64, digits: usize) -> String {
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
pub fn count(value: f64) -> String {
    if value.abs() < 1e15 { signed(&group(&format!("{value:.0}"))) } else { number(value, 4) }
}

/// A value with its standard error: two digits of the error and the value to the same place, but not more than
/// four digits of the value unless the error is smaller still.
pub fn with_error(value: f64, standard_error: Option<f64>) -> String {
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

/// `value` with up to `digits` significant digits in the form that scenarios and options take: `0.25`, `1.1e-9`.
pub fn plain(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}"));
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// `value` in the shortest form that reads back to the same bits, as scenarios and options take it.
pub fn exact(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{value:e}") } else { format!("{value}") }
}

/// A figure as text: its value and standard error, or, where it is not steady, what it does and its mean alone.
///
/// The one form of every page, table and terminal: a mean of something that drifts has no error that means anything.
pub fn figure_text(value: f64, standard_error: Option<f64>, trend: Option<Trend>) -> String {
    figure_with_unit(value, standard_error, trend, "")
}

/// The same with a unit behind the number; an empty one for pure numbers.
pub fn figure_with_unit(value: f64, standard_error: Option<f64>, trend: Option<Trend>, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    match trend {
        None | Some(Trend::Steady) => with_error(value, standard_error) + &unit,
        Some(trend) => format!("{NOT_STEADY} ({}, mean {}{unit})", trend.name(), number(value, 3)),
    }
}

/// What is said of a figure whose series drifts or wanders.
pub const NOT_STEADY: &str = "not steady";

/// `heap_slope` as "heap slope".
pub fn in_words(name: &str) -> String {
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
    fn errors_far_below_their_values_and_numbers_without_errors_are_short() {
        assert_eq!(with_error(2.1e-8, Some(2.29e-9)), "(2.10 ± 0.23) × 10⁻⁸");
        assert_eq!(with_error(264_960.0, Some(5.38e-11)), "264\u{202f}960");
        assert_eq!(with_error(0.0, Some(0.0)), "0");
    }

    #[test]
    fn a_figure_that_drifts_has_no_error() {
        assert_eq!(figure_text(0.0013099, Some(0.00003), Some(Trend::Steady)), "0.001310 ± 0.000030");
        assert_eq!(figure_text(0.0013099, Some(0.00003), None), "0.001310 ± 0.000030");
        assert_eq!(figure_text(0.92846, Some(0.001), Some(Trend::Rising)), "not steady (rising, mean 0.928)");
        let falling = figure_with_unit(0.021, Some(0.001), Some(Trend::Falling), "mass/time^2");
        assert_eq!(falling, "not steady (falling, mean 0.021 mass/time^2)");
    }

    #[test]
    fn plain_numbers_read_back() {
        let cases =
            [(1.1e-9, "1.1e-9"), (0.25, "0.25"), (1234.5678, "1234.57"), (-4.8e14, "-4.8e14"), (0.0, "0")];
        for (value, text) in cases {
            assert_eq!(plain(value, 6), text);
            assert!((text.parse::<f64>().unwrap() - value).abs() <= 1e-5 * value.abs());
        }
        assert_eq!(plain(123_456.0, 3), "123456");
        assert_eq!(plain(9.9999, 3), "10");
        assert_eq!([0.1, 1.25e-9, 2e7, 0.0].map(exact), ["0.1", "1.25e-9", "2e7", "0"]);
    }

    #[test]
    fn counts_are_grouped_from_five_digits_on() {
        assert_eq!(
            [2037.0, 12_345.0, 17_334_407.0].map(count),
            ["2037", "12\u{202f}345", "17\u{202f}334\u{202f}407"]
        );
    }
}
