//! A difference as a sentence.

use super::model::{Difference, Verdict};
use crate::statistics::Estimate;

/// What a sentence is about.
#[derive(Clone, Debug)]
pub(super) struct Subject<'a> {
    /// The contestant.
    pub(super) label: &'a str,
    /// The one that it is compared with.
    pub(super) reference: &'a str,
    /// Name of the quantity, in words.
    pub(super) quantity: String,
    /// Name of the abscissa, in words; empty for a single number.
    pub(super) abscissa: String,
    /// When, for one profile of several [time].
    pub(super) time: Option<f64>,
    /// Whether it falls in the reference because the grains cool.
    pub(super) is_cooling: bool,
}

/// A name of a column or measure without the signs between its words.
pub(super) fn in_words(name: &str) -> String {
    name.replace(['_', '-'], " ")
}

/// `value` with `digits` significant digits, without a tail of zeros.
fn short(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = digits as i32 - 1 - value.abs().log10().floor() as i32;
    match decimals {
        ..-4 | 9.. => format!("{value:.*e}", digits - 1),
        _ => format!("{value:.*}", decimals.max(0) as usize),
    }
}

/// `value ± error`, to two digits of the error.
fn with_error(value: f64, error: f64) -> String {
    if !(error > 0.0 && error.is_finite()) || value.abs() < error {
        return format!("{} ± {}", short(value, 2), short(error, 2));
    }
    let more = (value.abs().log10().floor() - error.log10().floor()) as usize;
    format!("{} ± {}", short(value, more.min(13) + 2), short(error, 2))
}

/// What `difference` says at `places`.
pub(super) fn sentence(difference: &Difference, places: &[f64], subject: &Subject<'_>) -> String {
    let Subject { label, reference, quantity, .. } = subject;
    let when = subject.time.map_or_else(String::new, |time| format!(" at time {}", short(time, 3)));
    let Some(most) = difference.most else {
        return format!(
            "{label}: no error is known for {quantity}{when}, since one run alone does not tell it, so \
             nothing is said against {reference}"
        );
    };
    let place = |x: f64| match subject.abscissa.is_empty() {
        true => String::new(),
        false => format!(" at {} {}", subject.abscissa, short(x, 3)),
    };
    let (peak, limit) = (short(most.standard_errors, 2), short(difference.threshold, 2));
    if difference.verdict != Verdict::Differs {
        return match most.standard_errors == 0.0 {
            true => format!("{label}: {quantity}{when} is equal to that of {reference}"),
            false => format!(
                "{label}: {quantity}{when} agrees with {reference}, at most {peak} standard errors apart{} (differs \
                 beyond {limit})",
                place(most.place)
            ),
        };
    }
    let shown = places.iter().position(|x| *x == most.place).unwrap_or(0);
    let (value, error) = (difference.values[shown], difference.errors[shown]);
    let amount = match difference.is_relative {
        true => format!("{} %", with_error(100.0 * value.abs(), 100.0 * error)),
        false => with_error(value.abs(), error),
    };
    let (side, cools) = if value < 0.0 { ("below", "faster") } else { ("above", "more slowly") };
    let claim = match subject.is_cooling {
        true => format!("cools {cools} than {reference}, {quantity}{when} {amount} {side}"),
        false => format!("{quantity}{when} is {amount} {side} {reference}"),
    };
    let apart = match most.standard_errors.is_finite() {
        true => format!("{peak} standard errors, beyond {limit}"),
        false => "the same in all replicas".to_owned(),
    };
    let stays = difference
        .parts_at
        .filter(|_| places.len() > 1)
        .map_or_else(String::new, |x| format!("; apart from {} {} on", subject.abscissa, short(x, 3)));
    format!("{label}: {claim}{} ({apart}){stays}", place(most.place))
}

/// What whole curves say where no single place says it: `all` is their mean difference, `ratios` that in standard errors
/// and the limit.
pub(super) fn overall_sentence(
    all: Estimate,
    is_relative: bool,
    ratios: [f64; 2],
    subject: &Subject<'_>,
) -> String {
    let Subject { label, reference, quantity, .. } = subject;
    let when = subject.time.map_or_else(String::new, |time| format!(" at time {}", short(time, 3)));
    let error = all.standard_error.unwrap_or(f64::NAN);
    let amount = match is_relative {
        true => format!("{} %", with_error(100.0 * all.value.abs(), 100.0 * error)),
        false => with_error(all.value.abs(), error),
    };
    let (side, cools) = if all.value < 0.0 { ("below", "faster") } else { ("above", "more slowly") };
    let [ratio, limit] = ratios.map(|ratio| short(ratio, 2));
    let apart = format!(
        "({ratio} standard errors, beyond {limit}; the error is too wide at any single {})",
        subject.abscissa
    );
    match subject.is_cooling {
        true => format!(
            "{label}: cools {cools} than {reference}, {quantity}{when} {amount} {side} in the mean of the whole curve {apart}"
        ),
        false => format!(
            "{label}: {quantity}{when} is {amount} {side} {reference} in the mean of the whole curve {apart}"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_two_digits_of_their_error() {
        assert_eq!(with_error(2.71559, 0.0412), "2.716 ± 0.041");
        assert_eq!(with_error(1234.5, 12.0), "1234 ± 12");
        assert_eq!(with_error(0.001, 0.03), "0.0010 ± 0.030");
        assert_eq!(short(0.0, 3), "0");
        assert_eq!(short(1.5e-12, 2), "1.5e-12");
    }
}
