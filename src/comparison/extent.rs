//! What runs have in common: those that end long before the others of their contestant are left out, and it is said.

use super::assemble::{Entry, Replica};
use super::errors::Drawn;
use crate::number::plain;
use crate::statistics::mean;

/// A run that is shorter than this share of the middle one of its contestant would cut off the others.
const SHORT: f64 = 0.9;

/// What is said of what was left out, each thing once.
pub(super) type Remarks = Vec<String>;

/// Adds what was not yet said.
pub(super) fn say(remarks: &mut Remarks, remark: String) {
    if !remarks.contains(&remark) {
        remarks.push(remark);
    }
}

/// `curves` `[contestant][run]` without runs that end early; `range` are the ends of a curve along `what`.
pub(super) fn without_short<T>(
    entries: &[Entry],
    curves: Vec<Vec<(u32, T)>>,
    range: impl Fn(&T) -> Option<[f64; 2]>,
    what: &str,
    remarks: &mut Remarks,
) -> Vec<Vec<(u32, T)>> {
    let of_contestant = |(entry, runs): (&Entry, Vec<(u32, T)>)| {
        let length = |curve: &T| range(curve).map_or(0.0, |[first, last]| last - first);
        let mut lengths: Vec<f64> = runs.iter().map(|(_, curve)| length(curve)).collect();
        lengths.sort_by(f64::total_cmp);
        let middle = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
        let mut kept = Vec::new();
        for (number, curve) in runs {
            if length(&curve) >= SHORT * middle {
                kept.push((number, curve));
                continue;
            }
            let end = range(&curve).map_or(0.0, |ends| ends[1]);
            let name = name(entry, number);
            say(
                remarks,
                format!(
                    "{name} ends at {what} {}, long before the others of {}, and is left out of what runs along {what}.",
                    plain(end, 3),
                    entry.label
                ),
            );
        }
        kept
    };
    entries.iter().zip(curves).map(of_contestant).collect()
}

/// What a run is called in a remark.
pub(super) fn name(entry: &Entry, number: u32) -> String {
    match entry.runs.iter().find(|run| run.number == number) {
        Some(Replica { folder, .. }) if !folder.is_empty() => folder.clone(),
        _ => format!("replica {number} of {}", entry.label),
    }
}

/// Says that `what` is compared up to `end` only, where that is much less than the reference has.
pub(super) fn say_where_it_ends(what: &str, [first, end]: [f64; 2], whole: [f64; 2], remarks: &mut Remarks) {
    if end - first < SHORT * (whole[1] - whole[0]) {
        say(
            remarks,
            format!(
                "Along {what}, curves are compared from {} to {}, what at least two engines have of {} to {}.",
                plain(first, 3),
                plain(end, 3),
                plain(whole[0], 3),
                plain(whole[1], 3)
            ),
        );
    }
}

/// A smoothed size of a quantity: the mean of the values at each place that are known.
pub(super) fn level(curves: &[Drawn], places: usize) -> Vec<f64> {
    let at = |k: usize| -> Vec<f64> {
        curves.iter().map(|drawn| drawn.values[k]).filter(|value| value.is_finite()).collect()
    };
    (0..places).map(|k| mean(&at(k)).unwrap_or(f64::NAN).abs()).collect()
}
