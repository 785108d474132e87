//! Profiles of all contestants, at the times of the reference.

use super::assemble::Entry;
use super::interpolate::Sampled;
use super::model::Compared;
use super::series::{Form, compare, of_entries};
use crate::observe::measure::Profile;
use crate::record::contents::RunLog;

/// Times at which a profile that was taken often is compared, spread evenly with the last.
const TIMES: usize = 5;

/// The column in which profiles state the errors of another.
const STANDARD_ERROR: &str = "standard_error";

/// Every column of every profile that two contestants have.
pub(super) fn compared(entries: &[Entry], reference: usize) -> Vec<Compared> {
    let logs = || entries.iter().flat_map(|entry| &entry.runs).map(|run| &run.log);
    let mut names: Vec<&str> = Vec::new();
    for profile in logs().flat_map(|log| &log.profiles) {
        if !names.contains(&profile.name.as_str()) {
            names.push(&profile.name);
        }
    }
    let mut all = Vec::new();
    for name in names {
        let own = entries[reference].runs.iter().map(|run| &run.log);
        let Some(leading) = own.chain(logs()).find(|log| of(log, name).next().is_some()) else { continue };
        let times: Vec<f64> = of(leading, name).map(|profile| profile.time).collect();
        let Some(pattern) = of(leading, name).next_back() else { continue };
        for at in spread(times.len()) {
            // What one run knows of its own errors is no quantity to be compared.
            let columns = (1..pattern.columns.len()).filter(|c| pattern.columns[*c].name != STANDARD_ERROR);
            for column in columns {
                all.extend(at_time(entries, reference, pattern, column, &times, at));
            }
        }
    }
    all
}

fn of<'a>(log: &'a RunLog, name: &str) -> impl DoubleEndedIterator<Item = &'a Profile> {
    let is_whole = |profile: &&Profile| profile.values.len() == profile.columns.len();
    log.profiles.iter().filter(move |profile| profile.name == name).filter(is_whole)
}

/// Places of at most [`TIMES`] among `count`, with the last.
fn spread(count: usize) -> impl Iterator<Item = usize> {
    let wanted = TIMES.min(count);
    (1..=wanted).map(move |k| k * count / wanted - 1)
}

fn at_time(
    entries: &[Entry],
    reference: usize,
    pattern: &Profile,
    column: usize,
    times: &[f64],
    at: usize,
) -> Option<Compared> {
    let (x, y) = (&pattern.columns[0], &pattern.columns[column]);
    let sampled = |log: &RunLog| {
        let found = nearest(log, &pattern.name, times, at);
        found.map_or_else(Sampled::default, |profile| {
            let place = |name: &str| profile.columns.iter().position(|column| column.name == name);
            let (Some(x), Some(y)) = (place(&x.name), place(&y.name)) else { return Sampled::default() };
            Sampled::new(profile.values[x].iter().copied().zip(profile.values[y].iter().copied()))
        })
    };
    let curves = of_entries(entries, sampled);
    let time = (times.len() > 1).then(|| times[at]);
    let form = Form { name: &pattern.name, abscissa: x.clone(), ordinate: y, time, is_energy: false };
    compare(entries, reference, &curves, form)
}

/// The profile of a log nearest to the time `times[at]`, unless another of `times` is nearer to it.
fn nearest<'a>(log: &'a RunLog, name: &str, times: &[f64], at: usize) -> Option<&'a Profile> {
    let apart = |profile: &Profile, time: f64| (profile.time - time).abs();
    let found = of(log, name).min_by(|a, b| apart(a, times[at]).total_cmp(&apart(b, times[at])))?;
    let is_nearest = times.iter().all(|time| apart(found, *time) >= apart(found, times[at]));
    is_nearest.then_some(found)
}
