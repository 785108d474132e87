//! One contestant beside the reference: difference, error, verdict.

use super::memory::blocked;
use super::model::{CurveOf, Difference, Peak, Verdict};
use super::student::{HALF, THREE_SIGMA, threshold};
use super::words::{Subject, overall_sentence, sentence};
use crate::statistics::{Estimate, average, mean};

/// Differences that are a smaller share of the values than this are rounding.
const ROUNDING: f64 = 1e-12;
/// Differences that scatter less than this share of themselves are the same in all replicas.
const SHARED: f64 = 1e-9;
/// Places whose gaps differ by a larger factor are not evenly spaced, and no blocks are made of them.
const EVEN: f64 = 1.5;

/// A curve of one replica at the common places.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drawn {
    /// The initial state.
    pub(super) replica: u32,
    /// NaN where it is not known.
    pub(super) values: Vec<f64>,
}

/// How values are compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// As shares of the reference, that is by logarithms; all values are then above zero.
    pub(super) is_relative: bool,
    /// Whether the places follow each other in time, so that one run can be cut into blocks.
    pub(super) is_in_time: bool,
}

/// Mean over replicas; NaN where one of them has no value.
pub(super) fn curve(of: &[Drawn], places: usize) -> CurveOf {
    let (mut values, mut errors) = (Vec::with_capacity(places), Vec::with_capacity(places));
    for place in 0..places {
        let here: Vec<f64> = of.iter().map(|drawn| drawn.values[place]).collect();
        let estimate = average(&here);
        let error = estimate.and_then(|estimate| estimate.standard_error);
        values.push(estimate.map_or(f64::NAN, |estimate| estimate.value));
        errors.push(error.unwrap_or(f64::NAN));
    }
    CurveOf { values, errors }
}

/// Differences with the errors of their means, before anything is judged.
struct Raw {
    values: Vec<f64>,
    errors: Vec<f64>,
    /// Degrees of freedom of the errors.
    freedom: f64,
    /// Values among which the largest is looked for.
    compared: usize,
    /// The difference of whole curves: its mean along them, from replicas, in the terms of `values`.
    overall: Option<Estimate>,
}

/// `own` minus `reference` over the replicas that both have; `None` where they share no place.
pub(super) fn difference(
    own: &[Drawn],
    reference: &[Drawn],
    places: &[f64],
    rule: Rule,
    subject: &Subject<'_>,
) -> Option<Difference> {
    let pairs: Vec<Vec<f64>> = own
        .iter()
        .filter_map(|one| {
            let other = reference.iter().find(|other| other.replica == one.replica)?;
            Some(one.values.iter().zip(&other.values).map(|(a, b)| apart(*a, *b, rule)).collect())
        })
        .collect();
    if !pairs.iter().flatten().any(|value| value.is_finite()) {
        return None;
    }
    let mut raw = match &pairs[..] {
        [single] => of_one(single, places, rule),
        _ => {
            let mut raw = of_replicas(&pairs, places.len());
            raw.unpair(&[own, reference].map(|of| curve(&measured(of, rule), places.len()).errors));
            raw
        }
    };
    raw.compared = raw.compared.max(1);
    Some(judged(raw, places, rule, subject))
}

impl Raw {
    /// Differences that all pairs share by chance, as counts of few grains do, get the error of two independent means
    /// with the given `errors` `[own, reference][place]`.
    fn unpair(&mut self, errors: &[Vec<f64>; 2]) {
        for (place, error) in self.errors.iter_mut().enumerate() {
            let is_shared = *error <= SHARED * self.values[place].abs();
            if is_shared && self.values[place] != 0.0 {
                *error = errors[0][place].hypot(errors[1][place]);
            }
        }
    }
}

/// The curves in the terms in which they are subtracted.
fn measured(of: &[Drawn], rule: Rule) -> Vec<Drawn> {
    let term = |value: &f64| if rule.is_relative { value.ln() } else { *value };
    of.iter()
        .map(|one| Drawn { replica: one.replica, values: one.values.iter().map(term).collect() })
        .collect()
}

/// The logarithm of the ratio, or the difference; 0 where it is rounding.
fn apart(a: f64, b: f64, rule: Rule) -> f64 {
    if (a - b).abs() <= ROUNDING * b.abs() {
        return 0.0;
    }
    if rule.is_relative { (a / b).ln() } else { a - b }
}

/// Mean and error at each place, from replicas.
fn of_replicas(pairs: &[Vec<f64>], places: usize) -> Raw {
    let drawn: Vec<Drawn> = pairs.iter().map(|values| Drawn { replica: 0, values: values.clone() }).collect();
    let CurveOf { values, errors } = curve(&drawn, places);
    let is_tested = |(value, error): (&f64, &f64)| *error > 0.0 || (*error == 0.0 && *value != 0.0);
    let compared = values.iter().zip(&errors).filter(|pair| is_tested(*pair)).count();
    let overall = if places > 1 { overall(pairs) } else { None };
    Raw { values, errors, freedom: pairs.len() as f64 - 1.0, compared, overall }
}

/// The mean over the places that all pairs have, and its scatter over pairs; `None` where nothing scatters.
fn overall(pairs: &[Vec<f64>]) -> Option<Estimate> {
    let places = pairs.iter().map(Vec::len).min()?;
    let shared: Vec<usize> = (0..places).filter(|k| pairs.iter().all(|pair| pair[*k].is_finite())).collect();
    let of_pair = |pair: &Vec<f64>| mean(&shared.iter().map(|k| pair[*k]).collect::<Vec<f64>>());
    let means: Vec<f64> = pairs.iter().filter_map(of_pair).collect();
    average(&means).filter(|estimate| estimate.standard_error.is_some_and(|error| error > 0.0))
}

/// One replica: blocks where that is possible; errors stay unknown otherwise, but for equal values.
fn of_one(values: &[f64], places: &[f64], rule: Rule) -> Raw {
    let known: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    let mut raw = Raw {
        values: values.to_vec(),
        errors: vec![f64::NAN; values.len()],
        freedom: 1.0,
        compared: 1,
        overall: None,
    };
    if known.iter().all(|k| values[*k] == 0.0) {
        known.iter().for_each(|k| raw.errors[*k] = 0.0);
        return raw;
    }
    let at: Vec<f64> = known.iter().map(|k| places[*k]).collect();
    let series: Vec<f64> = known.iter().map(|k| values[*k]).collect();
    let found = if rule.is_in_time && is_even(&at) { blocked(&series) } else { None };
    if let Some(found) = found {
        for (order, k) in known.into_iter().enumerate() {
            (raw.values[k], raw.errors[k]) = (found.values[order], found.errors[order]);
        }
        (raw.freedom, raw.compared) = (found.freedom, found.blocks);
    }
    raw
}

fn is_even(places: &[f64]) -> bool {
    let gaps = || places.windows(2).map(|pair| pair[1] - pair[0]);
    gaps().fold(0.0, f64::max) <= EVEN * gaps().fold(f64::INFINITY, f64::min)
}

/// A difference of two numbers with known errors, each from `freedom` + 1 independent parts.
pub(super) fn of_estimates(
    values: [f64; 2],
    errors: [Option<f64>; 2],
    freedom: f64,
    subject: &Subject<'_>,
) -> Difference {
    let rule = Rule { is_relative: false, is_in_time: false };
    let value = apart(values[0], values[1], rule);
    let error = match errors {
        [Some(a), Some(b)] => a.hypot(b),
        _ if value == 0.0 => 0.0,
        _ => f64::NAN,
    };
    judged(
        Raw { values: vec![value], errors: vec![error], freedom, compared: 1, overall: None },
        &[0.0],
        rule,
        subject,
    )
}

fn judged(raw: Raw, places: &[f64], rule: Rule, subject: &Subject<'_>) -> Difference {
    // Two tests share the probability of a false alarm.
    let probability = if raw.overall.is_some() { HALF } else { THREE_SIGMA };
    let limit = threshold(probability, raw.freedom, raw.compared);
    let limit_of_all = threshold(probability, raw.freedom, 1);
    let ratio_of_all = |all: &Estimate| ratio(all.value, all.standard_error.unwrap_or(f64::NAN));
    let apart_in_all = raw.overall.filter(|all| ratio_of_all(all) > limit_of_all);
    let ratios: Vec<f64> = raw.values.iter().zip(&raw.errors).map(|(v, e)| ratio(*v, *e)).collect();
    let most = peak(&ratios, places);
    let verdict = match most {
        None => Verdict::Unknown,
        Some(peak) if peak.standard_errors > limit || apart_in_all.is_some() => Verdict::Differs,
        Some(_) => Verdict::Agrees,
    };
    let shares = |k: usize| {
        let value = if rule.is_relative { raw.values[k].exp_m1() } else { raw.values[k] };
        // So that value and error keep their ratio.
        let stretch = if raw.values[k] == 0.0 { 1.0 } else { value / raw.values[k] };
        (value, raw.errors[k] * stretch)
    };
    let (values, errors) = (0..places.len()).map(shares).unzip();
    let mut difference = Difference {
        is_relative: rule.is_relative,
        values,
        errors,
        most,
        threshold: limit,
        parts_at: parting(&raw.values, &ratios, limit).map(|k| places[k]),
        verdict,
        sentence: String::new(),
    };
    let is_apart_somewhere = difference.most.is_some_and(|peak| peak.standard_errors > limit);
    difference.sentence = match apart_in_all {
        Some(all) if !is_apart_somewhere => {
            overall_sentence(share(all, rule), rule.is_relative, [ratio_of_all(&all), limit_of_all], subject)
        }
        _ => sentence(&difference, places, subject),
    };
    difference
}

/// A mean logarithm as a share, with its ratio to its error kept.
fn share(all: Estimate, rule: Rule) -> Estimate {
    let value = if rule.is_relative { all.value.exp_m1() } else { all.value };
    let stretch = if all.value == 0.0 { 1.0 } else { value / all.value };
    Estimate { value, standard_error: all.standard_error.map(|error| error * stretch) }
}

/// In standard errors; NaN where nothing is known.
fn ratio(value: f64, error: f64) -> f64 {
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
