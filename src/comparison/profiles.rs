//! Profiles of all contestants, at the times of the reference.

use super::assemble::{Entry, Replica};
use super::extent::{Remarks, say, say_where_it_ends, without_short};
use super::interpolate::{Path, Sampled};
use super::model::Compared;
use super::series::{Form, compare};
use crate::observe::measure::Profile;

/// Times at which a profile that was taken often is compared, spread evenly with the last.
const TIMES: usize = 5;
/// Times that are apart by a smaller share are the same.
const SAME: f64 = 1e-9;

/// The column in which profiles state the errors of the one before it.
const STANDARD_ERROR: &str = "standard_error";
/// The column in which velocity distributions state what theory says of all of them.
const MAXWELL: &str = "maxwell";

/// What a run has recorded of one profile, in the course of time.
type Recordings<'a> = Vec<&'a Profile>;

/// Every column of every profile that two contestants have.
pub(super) fn compared(entries: &[Entry], reference: usize, remarks: &mut Remarks) -> Vec<Compared> {
    let logs = || entries.iter().flat_map(|entry| &entry.runs).map(|run| &run.log);
    let mut names: Vec<&str> = Vec::new();
    for profile in logs().flat_map(|log| &log.profiles) {
        if !names.contains(&profile.name.as_str()) {
            names.push(&profile.name);
        }
    }
    names.into_iter().flat_map(|name| of_name(entries, reference, name, remarks)).collect()
}

fn of_name(entries: &[Entry], reference: usize, name: &str, remarks: &mut Remarks) -> Vec<Compared> {
    let of_entry = |entry| -> Vec<(u32, Recordings<'_>)> { recordings(entry, name) };
    let all: Vec<Vec<(u32, Recordings<'_>)>> = entries.iter().map(of_entry).collect();
    let all = without_short(entries, all, range, &format!("the time of {name}"), remarks);
    let Some(leading) = [reference].into_iter().chain(0..all.len()).find_map(|place| all[place].first())
    else {
        return Vec::new();
    };
    let runs = || all.iter().flatten().map(|(_, recordings)| recordings);
    let times: Vec<Option<f64>> = if runs().all(|recordings| recordings.len() == 1) {
        vec![None]
    } else {
        let ends = runs().filter_map(range);
        let ends = ends
            .fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], [first, last]| [a.max(first), b.min(last)]);
        if ends[0] > ends[1] {
            say(remarks, format!("{name}: the runs have no time in common, and it is not compared."));
            return Vec::new();
        }
        let whole = range(&leading.1).unwrap_or(ends);
        say_where_it_ends(&format!("the time of {name}"), ends, whole, remarks);
        spread(&within(&leading.1, ends)).into_iter().map(Some).collect()
    };
    let Some(pattern) = leading.1.last() else { return Vec::new() };
    let mut found = Vec::new();
    for time in times {
        // What one run knows of its own errors is no quantity to be compared.
        let is_measured = |c: &usize| ![STANDARD_ERROR, MAXWELL].contains(&pattern.columns[*c].name.as_str());
        for column in (1..pattern.columns.len()).filter(is_measured) {
            let at = |recordings: &Recordings<'_>| sampled(recordings, pattern, column, time);
            let of_runs = |runs: &Vec<(u32, Recordings<'_>)>| -> Vec<(u32, Sampled)> {
                let curves = runs.iter().map(|(number, recordings)| (*number, at(recordings)));
                curves.filter(|(_, curve)| curve.has_values()).collect()
            };
            let curves: Vec<Vec<(u32, Sampled)>> = all.iter().map(of_runs).collect();
            let (x, y) = (&pattern.columns[0], &pattern.columns[column]);
            let form =
                Form { name, abscissa: x.clone(), ordinate: y, time, is_series: false, is_energy: false };
            found.extend(compare(entries, reference, &curves, form, remarks));
        }
    }
    found
}

/// `[run]`: what those that have the profile have recorded of it.
fn recordings<'a>(entry: &'a Entry, name: &str) -> Vec<(u32, Recordings<'a>)> {
    let is_it = |profile: &&Profile| profile.name == name && profile.values.len() == profile.columns.len();
    let of_run =
        |run: &'a Replica| (run.number, run.log.profiles.iter().filter(is_it).collect::<Recordings<'a>>());
    entry.runs.iter().map(of_run).filter(|(_, recordings)| !recordings.is_empty()).collect()
}

fn range(recordings: &Recordings<'_>) -> Option<[f64; 2]> {
    Some([recordings.first()?.time, recordings.last()?.time])
}

/// The times of `recordings` between `ends`, with the last of these.
fn within(recordings: &Recordings<'_>, [first, last]: [f64; 2]) -> Vec<f64> {
    let times = recordings.iter().map(|profile| profile.time);
    let mut times: Vec<f64> = times.filter(|time| first <= *time && *time <= last).collect();
    if times.last().is_none_or(|time| last - time > SAME * last.abs()) {
        times.push(last);
    }
    times
}

/// At most [`TIMES`] of them, with the last.
fn spread(times: &[f64]) -> Vec<f64> {
    let wanted = TIMES.min(times.len());
    (1..=wanted).map(|k| times[k * times.len() / wanted - 1]).collect()
}

/// Column number `column` of `pattern` at `time`, straight between the recordings before and after; the only recording
/// where no time is given.
fn sampled(recordings: &Recordings<'_>, pattern: &Profile, column: usize, time: Option<f64>) -> Sampled {
    let curve = |profile: &Profile| curve(profile, pattern, column).unwrap_or_default();
    let Some(time) = time else { return recordings.last().map_or_else(Sampled::default, |last| curve(last)) };
    let above = recordings.partition_point(|profile| profile.time < time);
    match (recordings.get(above), above.checked_sub(1).and_then(|below| recordings.get(below))) {
        (Some(at), _) if at.time == time => curve(at),
        (Some(after), Some(before)) => {
            let share = (time - before.time) / (after.time - before.time);
            between(curve(before), &curve(after), share)
        }
        _ => Sampled::default(),
    }
}

/// The curve that lies at `share` of the way from `before` to `after`, at the places of `before`.
fn between(before: Sampled, after: &Sampled, share: f64) -> Sampled {
    let mix = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
    let y = mix(&before.y, &after.at(&before.x, Path::Straight));
    let errors = mix(&before.errors, &after.errors_at(&before.x));
    Sampled { x: before.x, y, errors }
}

/// A profile as a curve, with the errors that it states of itself.
fn curve(profile: &Profile, pattern: &Profile, column: usize) -> Option<Sampled> {
    let place = |name: &str| profile.columns.iter().position(|column| column.name == name);
    let [x, y] = [place(&pattern.columns[0].name)?, place(&pattern.columns[column].name)?];
    let points = profile.values[x].iter().copied().zip(profile.values[y].iter().copied());
    let states = profile.columns.get(y + 1).is_some_and(|next| next.name == STANDARD_ERROR);
    let mut curve = Sampled::new(points);
    if states {
        let errors =
            Sampled::new(profile.values[x].iter().copied().zip(profile.values[y + 1].iter().copied()));
        curve.errors = errors.y;
    }
    Some(curve)
}
