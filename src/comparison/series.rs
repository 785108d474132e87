//! Series of all contestants at common places.

use super::assemble::Entry;
use super::difference::{Drawn, Rule, curve, difference};
use super::interpolate::{Path, Sampled};
use super::model::Compared;
use super::words::{Subject, in_words};
use crate::observe::measure::{Column, Dimension};
use crate::record::contents::RunLog;

const TIME: &str = "time";
const COLLISIONS: &str = "collisions_per_particle";
const ENERGY: Dimension = Dimension { mass: 1, length: 2, time: -2 };
/// Places of a series: more would widen what counts as a difference at each and tell little more.
const PLACES: usize = 200;
/// An energy of the reference that falls below this share of its first value cools.
const COOLED: f64 = 0.9;

/// All columns that two contestants have, against time; energies also against collisions per particle.
pub(super) fn compared(entries: &[Entry], reference: usize) -> Vec<Compared> {
    let mut columns: Vec<&Column> = Vec::new();
    for column in entries.iter().flat_map(|entry| &entry.runs).flat_map(|run| &run.log.columns) {
        if column.name != TIME && !columns.iter().any(|known| known.name == column.name) {
            columns.push(column);
        }
    }
    let mut all = Vec::new();
    for column in columns {
        all.extend(against(entries, reference, column, TIME));
        if column.unit == ENERGY {
            all.extend(against(entries, reference, column, COLLISIONS));
        }
    }
    all
}

/// The column `y` of a log over its column `x`.
fn sampled(log: &RunLog, x: &str, y: &str) -> Sampled {
    let place = |name: &str| log.columns.iter().position(|column| column.name == name);
    let (Some(x), Some(y)) = (place(x), place(y)) else { return Sampled::default() };
    Sampled::new(log.series.iter().filter_map(|row| Some((*row.get(x)?, *row.get(y)?))))
}

fn against(entries: &[Entry], reference: usize, column: &Column, abscissa: &str) -> Option<Compared> {
    let curves = of_entries(entries, |log| sampled(log, abscissa, &column.name));
    let unit = Dimension { time: i8::from(abscissa == TIME), ..Dimension::default() };
    let abscissa = Column { name: abscissa.to_owned(), unit };
    // A series is interpolated as what it is, and judged so.
    let is_energy = column.unit == ENERGY;
    let form = Form { name: &column.name, abscissa, ordinate: column, time: None, is_energy };
    compare(entries, reference, &curves, form)
}

/// `[contestant][run]`: initial state and curve, without those that have no value.
pub(super) fn of_entries(
    entries: &[Entry],
    sampled: impl Fn(&RunLog) -> Sampled,
) -> Vec<Vec<(u32, Sampled)>> {
    let of_entry = |entry: &Entry| {
        let runs = entry.runs.iter().map(|run| (run.number, sampled(&run.log)));
        runs.filter(|(_, curve)| curve.has_values()).collect()
    };
    entries.iter().map(of_entry).collect()
}

/// What curves are curves of.
pub(super) struct Form<'a> {
    pub(super) name: &'a str,
    pub(super) abscissa: Column,
    pub(super) ordinate: &'a Column,
    pub(super) time: Option<f64>,
    /// Compared as shares and interpolated by logarithms, where all values are above zero.
    pub(super) is_energy: bool,
}

/// At most [`PLACES`] of them, spread evenly by their number, with the first and the last.
fn thinned(places: &[f64]) -> Vec<f64> {
    let last = places.len().saturating_sub(1);
    match places.len() > PLACES {
        true => (0..PLACES).map(|k| places[k * last / (PLACES - 1)]).collect(),
        false => places.to_vec(),
    }
}

/// The curves of one contestant at common places.
fn drawn_at(runs: &[(u32, Sampled)], places: &[f64], path: Path) -> Vec<Drawn> {
    let at = |(replica, curve): &(u32, Sampled)| Drawn { replica: *replica, values: curve.at(places, path) };
    runs.iter().map(at).collect()
}

/// Curves at the places of the reference, or of the first that has any; `None` unless two have some.
pub(super) fn compare(
    entries: &[Entry],
    reference: usize,
    curves: &[Vec<(u32, Sampled)>],
    form: Form<'_>,
) -> Option<Compared> {
    if curves.iter().filter(|runs| !runs.is_empty()).count() < 2 {
        return None;
    }
    let leading = [&curves[reference]].into_iter().chain(curves).find_map(|runs| runs.first())?;
    let is_in_time = form.time.is_none() && [TIME, COLLISIONS].contains(&form.abscissa.name.as_str());
    // One run alone is cut into blocks, which need every place that there is.
    let has_replicas = curves.iter().any(|runs| runs.len() > 1);
    let places = &if is_in_time && has_replicas { thinned(&leading.1.x) } else { leading.1.x.clone() };
    let all = || curves.iter().flatten().map(|(_, curve)| curve);
    let is_relative = form.is_energy && all().all(Sampled::is_positive);
    let path = if is_relative { Path::Logarithmic } else { Path::Straight };
    let drawn: Vec<Vec<Drawn>> = curves.iter().map(|runs| drawn_at(runs, places, path)).collect();
    let ends = |values: &[f64]| {
        let known = || values.iter().filter(|y| y.is_finite());
        known().next().zip(known().next_back()).is_some_and(|(first, last)| *last < COOLED * first)
    };
    let rule = Rule { is_relative, is_in_time };
    let is_cooling = is_relative && is_in_time && ends(&leading.1.y);
    let quantity = match form.name == form.ordinate.name {
        true => in_words(form.name),
        false => format!("{}: {}", in_words(form.name), in_words(&form.ordinate.name)),
    };
    let differences = drawn.iter().enumerate().map(|(place, own)| {
        let subject = Subject {
            label: &entries[place].label,
            reference: &entries[reference].label,
            quantity: quantity.clone(),
            abscissa: in_words(&form.abscissa.name),
            time: form.time,
            is_cooling,
        };
        let other = (place != reference).then_some(&drawn[reference])?;
        difference(own, other, places, rule, &subject)
    });
    let differences = differences.collect();
    let curves = drawn.iter().map(|own| (!own.is_empty()).then(|| curve(own, places.len()))).collect();
    Some(Compared {
        theory: Vec::new(),
        name: form.name.to_owned(),
        abscissa: form.abscissa,
        ordinate: form.ordinate.clone(),
        time: form.time,
        places: places.clone(),
        curves,
        differences,
    })
}
