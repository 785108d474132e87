//! Series of all contestants at common places.

use super::assemble::Entry;
use super::difference::difference;
use super::errors::{Along, Drawn, Terms, curve};
use super::extent::{Remarks, level, say_where_it_ends, without_short};
use super::interpolate::{Path, Sampled};
use super::model::Compared;
use super::words::Subject;
use crate::number::in_words;
use crate::observe::measure::{Column, Dimension};
use crate::record::contents::RunLog;

const TIME: &str = "time";
const COLLISIONS: &str = "collisions_per_particle";
const ENERGY: Dimension = Dimension { mass: 1, length: 2, time: -2 };
/// Places of a series: more would widen what counts as a difference at each and tell little more.
const PLACES: usize = 200;
/// What is above zero and changes by a larger factor is compared by its logarithms, as energies are.
const SPAN: f64 = 3.0;
/// An energy of the reference that falls below this share of its first value cools.
const COOLED: f64 = 0.9;

/// All columns that two contestants have, against time; energies also against collisions per particle.
pub(super) fn compared(entries: &[Entry], reference: usize, remarks: &mut Remarks) -> Vec<Compared> {
    let mut columns: Vec<&Column> = Vec::new();
    for column in entries.iter().flat_map(|entry| &entry.runs).flat_map(|run| &run.log.columns) {
        if column.name != TIME && !columns.iter().any(|known| known.name == column.name) {
            columns.push(column);
        }
    }
    let mut all = Vec::new();
    for column in columns {
        all.extend(against(entries, reference, column, TIME, remarks));
        if column.unit == ENERGY {
            all.extend(against(entries, reference, column, COLLISIONS, remarks));
        }
    }
    all
}

/// The column `y` of a log over its column `x`. Where a recording is not full, what it does not have is no gap.
fn sampled(log: &RunLog, x: &str, y: &str) -> Sampled {
    let place = |name: &str| log.columns.iter().position(|column| column.name == name);
    let (Some(x), Some(y)) = (place(x), place(y)) else { return Sampled::default() };
    let is_brief = |number: usize| log.state_hashes.get(number).is_some_and(String::is_empty);
    let points = log.series.iter().enumerate().filter_map(|(number, row)| {
        let (x, y) = (*row.get(x)?, *row.get(y)?);
        (y.is_finite() || !is_brief(number)).then_some((x, y))
    });
    Sampled::new(points)
}

fn against(
    entries: &[Entry],
    reference: usize,
    column: &Column,
    abscissa: &str,
    remarks: &mut Remarks,
) -> Option<Compared> {
    let curves = of_entries(entries, |log| sampled(log, abscissa, &column.name));
    let curves = without_short(entries, curves, Sampled::range, &in_words(abscissa), remarks);
    let unit = Dimension { time: i8::from(abscissa == TIME), ..Dimension::default() };
    let abscissa = Column { name: abscissa.to_owned(), unit };
    // A series is interpolated as what it is, and judged so.
    let is_energy = column.unit == ENERGY;
    let form =
        Form { name: &column.name, abscissa, ordinate: column, time: None, is_series: true, is_energy };
    compare(entries, reference, &curves, form, remarks)
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
    /// Whether the places follow each other in time.
    pub(super) is_series: bool,
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
    let at = |(replica, curve): &(u32, Sampled)| Drawn {
        replica: *replica,
        values: curve.at(places, path),
        errors: curve.errors_at(places),
    };
    runs.iter().map(at).collect()
}

/// Those of the leading places, without those at the ends where less than two contestants have a whole curve.
fn shared(places: &[f64], curves: &[Vec<(u32, Sampled)>]) -> Vec<f64> {
    let covers = |runs: &Vec<(u32, Sampled)>, place: f64| {
        let holds =
            |curve: &Sampled| curve.range().is_some_and(|[first, last]| first <= place && place <= last);
        !runs.is_empty() && runs.iter().all(|(_, curve)| holds(curve))
    };
    let is_shared = |place: &f64| curves.iter().filter(|runs| covers(runs, *place)).count() > 1;
    places.iter().copied().filter(is_shared).collect()
}

/// Those of `places` between which every curve has a recording of its own: what is interpolated twice between the same
/// two recordings tells nothing new, and would look like memory.
fn recorded(places: &[f64], curves: &[Vec<(u32, Sampled)>]) -> Vec<f64> {
    let mut kept: Vec<f64> = places.first().copied().into_iter().collect();
    for place in places {
        let last = kept[kept.len() - 1];
        let has_one = |curve: &Sampled| {
            let next = curve.x.partition_point(|x| *x <= last);
            curve.x.get(next).is_some_and(|x| x <= place) || curve.x.last().is_some_and(|end| *end <= last)
        };
        if *place > last && curves.iter().flatten().all(|(_, curve)| has_one(curve)) {
            kept.push(*place);
        }
    }
    kept
}

/// Contestants that have to have a quantity so that it is shown. Impact parameters are only counted by exact dynamics; those
/// that the others draw are what theory says beside them.
pub(super) fn needed(name: &str) -> usize {
    if name.starts_with("impact") { 1 } else { 2 }
}

/// Curves at the places of the reference, or of the first that has any; `None` unless enough have some.
pub(super) fn compare(
    entries: &[Entry],
    reference: usize,
    curves: &[Vec<(u32, Sampled)>],
    form: Form<'_>,
    remarks: &mut Remarks,
) -> Option<Compared> {
    if curves.iter().filter(|runs| !runs.is_empty()).count() < needed(form.name) {
        return None;
    }
    let leading = [reference].into_iter().chain(0..curves.len()).find(|place| !curves[*place].is_empty())?;
    let (number, pattern) = curves[leading].first()?;
    let mut places = shared(&pattern.x, curves);
    let ends = [*places.first()?, *places.last()?];
    if form.is_series {
        say_where_it_ends(&in_words(&form.abscissa.name), ends, pattern.range()?, remarks);
    }
    if form.is_series {
        places = recorded(&places, curves);
    }
    // One run alone is cut into blocks, which need every place that there is.
    if form.is_series && curves.iter().any(|runs| runs.len() > 1) {
        places = thinned(&places);
    }
    let is_relative = form.is_relative(curves);
    let path = if is_relative { Path::Logarithmic } else { Path::Straight };
    let drawn: Vec<Vec<Drawn>> = curves.iter().map(|runs| drawn_at(runs, &places, path)).collect();
    let collisions = collisions(&entries[leading], *number);
    let along = Along {
        places: &places,
        abscissa: &form.abscissa.name,
        clock: form.is_series.then(|| clock(&form.abscissa.name, &places, &collisions)),
        level: if is_relative { vec![1.0; places.len()] } else { level(&drawn[leading], places.len()) },
    };
    let terms = if is_relative { Terms::Logarithms } else { Terms::Own };
    let is_cooling = form.is_energy && is_relative && pattern.falls_below(COOLED);
    let differences = drawn.iter().enumerate().map(|(place, own)| {
        let subject = Subject {
            label: &entries[place].label,
            reference: &entries[reference].label,
            quantity: form.quantity(),
            abscissa: in_words(&form.abscissa.name),
            time: form.time,
            is_cooling,
        };
        let other = (place != reference).then_some(&drawn[reference])?;
        difference(own, other, &along, terms, &subject)
    });
    let curves = drawn.iter().map(|own| (!own.is_empty()).then(|| curve(own, places.len()))).collect();
    Some(Compared {
        differences: differences.collect(),
        theory: Vec::new(),
        name: form.name.to_owned(),
        abscissa: form.abscissa,
        ordinate: form.ordinate.clone(),
        time: form.time,
        places,
        curves,
    })
}

/// Collisions per particle over time in run `number`.
fn collisions(entry: &Entry, number: u32) -> Sampled {
    let run = entry.runs.iter().find(|run| run.number == number);
    run.map(|run| sampled(&run.log, TIME, COLLISIONS)).unwrap_or_default()
}

impl Form<'_> {
    /// Whether `curves` are compared by their logarithms.
    fn is_relative(&self, curves: &[Vec<(u32, Sampled)>]) -> bool {
        let all = || curves.iter().flatten().map(|(_, curve)| curve);
        let is_positive = self.is_series && all().all(Sampled::is_positive);
        is_positive && (self.is_energy || all().any(|curve| curve.span() > SPAN))
    }

    /// The quantity in words.
    fn quantity(&self) -> String {
        match self.name == self.ordinate.name {
            true => in_words(self.name),
            false => format!("{}: {}", in_words(self.name), in_words(&self.ordinate.name)),
        }
    }
}

/// What counts the events by which a curve over `abscissa` changes: collisions where the log has them at all places.
fn clock<'a>(abscissa: &'a str, places: &[f64], collisions: &Sampled) -> (Vec<f64>, &'a str) {
    let counted = collisions.at(places, Path::Straight);
    let rises =
        counted.iter().all(|count| count.is_finite()) && counted.windows(2).all(|pair| pair[0] < pair[1]);
    if abscissa == TIME && rises { (counted, COLLISIONS) } else { (places.to_vec(), abscissa) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::measure::Dimension;

    #[test]
    fn what_a_recording_between_full_ones_lacks_is_no_gap_and_what_is_not_defined_is_one() {
        let column = |name: &str| Column { name: name.to_owned(), unit: Dimension::default() };
        let nothing = f64::NAN;
        let mut log = RunLog {
            columns: vec![column(TIME), column("pressure")],
            series: [[0.0, 1.0], [1.0, nothing], [2.0, 3.0], [3.0, nothing], [4.0, 5.0]]
                .map(Vec::from)
                .to_vec(),
            state_hashes: ["a", "", "b", "c", "d"].map(str::to_owned).to_vec(),
            ..RunLog::default()
        };
        let at = |log: &RunLog| sampled(log, TIME, "pressure").at(&[0.5, 1.0, 2.0, 2.5, 3.5], Path::Straight);
        let found = at(&log);
        assert_eq!(found[..3], [1.5, 2.0, 3.0]);
        assert!(found[3].is_nan() && found[4].is_nan());
        log.state_hashes[3].clear();
        assert_eq!(at(&log), [1.5, 2.0, 3.0, 3.5, 4.5]);
    }
}
