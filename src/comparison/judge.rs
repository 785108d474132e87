//! Whether a difference is more than chance.
//!
//! Up to three tests share the probability of a false alarm: the largest difference at any place, the last place of a
//! curve in time, and the mean of the whole curve.

use super::errors::{Along, Raw, Terms, Whole};
use super::model::{Difference, Overall, Peak, Verdict};
use super::words::{Shown, Subject, overall_sentence, sentence, unknown_sentence};
use crate::statistics::student::{THREE_SIGMA, threshold};

/// The verdict on `raw`, with its words.
pub(super) fn judged(raw: Raw, along: &Along<'_>, terms: Terms, subject: &Subject<'_>) -> Difference {
    let places = along.places;
    let is_relative = terms != Terms::Own;
    let has_end = along.clock.is_some() && raw.compared > 1;
    let tests = 1 + usize::from(has_end) + usize::from(raw.whole.is_some());
    let probability = THREE_SIGMA / tests as f64;
    let limit = threshold(probability, raw.freedom, raw.compared.max(1));
    let lone = if has_end { threshold(probability, raw.freedom, 1) } else { limit };
    let ratios: Vec<f64> = raw.values.iter().zip(&raw.errors).map(|(v, e)| ratio(*v, *e)).collect();
    let most = peak(&ratios, places);
    let end = parting(&raw.values, &ratios, lone);
    let overall = raw.whole.map(|whole| overall(whole, probability, terms));
    let shown = if most.is_some_and(|peak| peak.standard_errors > limit) {
        Some(Shown { place: most.and_then(|peak| places.iter().position(|x| *x == peak.place)), limit })
    } else if has_end && end.is_some() {
        Some(Shown { place: ratios.iter().rposition(|ratio| !ratio.is_nan()), limit: lone })
    } else {
        None
    };
    let apart_in_all = overall.filter(|all| all.standard_errors > all.threshold);
    let verdict = match most {
        None => Verdict::Unknown,
        Some(_) if shown.is_some() || apart_in_all.is_some() => Verdict::Differs,
        Some(_) => Verdict::Agrees,
    };
    let (values, errors) = (0..places.len())
        .map(|k| {
            let [value, error] = share([raw.values[k], raw.errors[k]], terms);
            (value, error)
        })
        .unzip();
    let mut difference = Difference {
        is_relative,
        values,
        errors,
        most,
        threshold: limit,
        last_threshold: has_end.then_some(lone),
        overall,
        parts_at: end.map(|k| places[k]),
        basis: raw.basis,
        freedom: raw.freedom,
        correlation: raw.correlation,
        verdict,
        sentence: String::new(),
    };
    difference.sentence = match (most, shown, apart_in_all) {
        (None, ..) => unknown_sentence(raw.missing, subject),
        (_, None, Some(all)) => overall_sentence(all, is_relative, subject),
        _ => sentence(&difference, shown, &ratios, places, subject),
    };
    difference
}

fn overall(whole: Whole, probability: f64, terms: Terms) -> Overall {
    let standard_errors = ratio(whole.value, whole.error);
    let [value, error] = share([whole.value, whole.error], terms);
    Overall { value, error, standard_errors, threshold: threshold(probability, whole.freedom, 1) }
}

/// A logarithm and its error as shares, so that they keep their ratio.
fn share([value, error]: [f64; 2], terms: Terms) -> [f64; 2] {
    if terms != Terms::Logarithms || value == 0.0 {
        return [value, error];
    }
    let share = value.exp_m1();
    [share, error * share / value]
}

/// In standard errors; NaN where nothing is known.
pub(super) fn ratio(value: f64, error: f64) -> f64 {
    match (value == 0.0, error == 0.0) {
        (true, _) if error.is_finite() => 0.0,
        (false, true) if value.is_finite() => f64::INFINITY,
        _ => value.abs() / error,
    }
}

fn peak(ratios: &[f64], places: &[f64]) -> Option<Peak> {
    let known = ratios.iter().zip(places).filter(|(ratio, _)| !ratio.is_nan());
    let peaks = known.map(|(ratio, place)| Peak { place: *place, standard_errors: *ratio });
    peaks.reduce(|most, peak| if peak.standard_errors > most.standard_errors { peak } else { most })
}

/// The first place from which on all are beyond `limit`, on the same side.
fn parting(values: &[f64], ratios: &[f64], limit: f64) -> Option<usize> {
    let known: Vec<usize> = (0..values.len()).filter(|k| !ratios[*k].is_nan()).collect();
    let side = values[*known.last()?].signum();
    let apart = known.iter().rev().take_while(|k| ratios[**k] > limit && values[**k].signum() == side);
    apart.last().copied()
}
