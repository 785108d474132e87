//! One contestant beside the reference.

use super::errors::{Along, Drawn, Missing, Terms, as_stated, curve, of_one, of_replicas};
use super::judge::judged;
use super::model::Difference;
use super::words::Subject;

/// Differences that are a smaller share of the values than this are rounding.
const ROUNDING: f64 = 1e-12;

/// `own` minus `reference` over the replicas that both have; `None` where they share no place.
pub(super) fn difference(
    own: &[Drawn],
    reference: &[Drawn],
    along: &Along<'_>,
    terms: Terms,
    subject: &Subject<'_>,
) -> Option<Difference> {
    let matching: Vec<[&Drawn; 2]> = own
        .iter()
        .filter_map(|one| Some([one, reference.iter().find(|other| other.replica == one.replica)?]))
        .collect();
    let apart = |[one, other]: &[&Drawn; 2]| -> Vec<f64> {
        one.values.iter().zip(&other.values).map(|(a, b)| apart(*a, *b, terms)).collect()
    };
    let pairs: Vec<Vec<f64>> = matching.iter().map(apart).collect();
    if !pairs.iter().flatten().any(|value| value.is_finite()) {
        return None;
    }
    let raw = match (&pairs[..], &matching[..]) {
        ([single], [[a, b]]) if !a.errors.is_empty() && !b.errors.is_empty() => {
            as_stated(single.clone(), [&a.errors, &b.errors], Missing::NoColumn)
        }
        ([single], _) => of_one(single, along),
        _ => {
            let alone = |of: &[Drawn]| curve(&measured(of, terms), along.places.len()).errors;
            of_replicas(&pairs, along, &[own, reference].map(alone))
        }
    };
    Some(judged(raw, along, terms, subject))
}

/// The curves in the terms in which they are subtracted.
fn measured(of: &[Drawn], terms: Terms) -> Vec<Drawn> {
    let term = |value: &f64| if terms == Terms::Logarithms { value.ln() } else { *value };
    of.iter().map(|one| Drawn { values: one.values.iter().map(term).collect(), ..one.clone() }).collect()
}

/// The logarithm of the ratio, or the difference; 0 where it is rounding.
pub(super) fn apart(a: f64, b: f64, terms: Terms) -> f64 {
    if (a - b).abs() <= ROUNDING * b.abs() {
        return 0.0;
    }
    if terms == Terms::Logarithms { (a / b).ln() } else { a - b }
}
