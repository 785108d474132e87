//! Figures of the summaries, side by side.

use serde_json::{Map, Value};

use super::assemble::{Entry, Replica};
use super::difference::{apart, difference};
use super::errors::{Along, Drawn, Missing, Raw, Terms, as_stated};
use super::judge::judged;
use super::memory::longest_memory;
use super::model::{ComparedFigure, Difference, Verdict};
use super::series::needed;
use super::words::{Subject, not_steady_sentence};
use crate::number::{figure_text, in_words};
use crate::observe::measure::{Dimension, Figure};
use crate::simulation::figures::{STANDARD_ERROR, figure_of, trend_of, trend_of_runs};
use crate::statistics::{BLOCKS, Estimate, Trend, average, mean};

/// Figures that every run has and that say something of its physics.
const COMMON: [&str; 5] =
    ["temperature", "kinetic_energy_final", "collisions", "collisions_per_particle", "simulated_time"];

/// All figures that two contestants have.
pub(super) fn compared(entries: &[Entry], reference: usize, dimension: usize) -> Vec<ComparedFigure> {
    let mut names: Vec<&str> = Vec::new();
    for summary in entries.iter().flat_map(|entry| &entry.runs).filter_map(|run| run.summary.as_ref()) {
        for name in summary.keys().map(String::as_str).filter(|name| is_figure(summary, name)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names.into_iter().filter_map(|name| figure(entries, reference, dimension, name)).collect()
}

/// A scenario's own figures have a place for their error, be there one or not.
fn is_figure(summary: &Map<String, Value>, name: &str) -> bool {
    COMMON.contains(&name) || summary.contains_key(&error_key(name))
}

fn error_key(name: &str) -> String {
    format!("{name}{STANDARD_ERROR}")
}

fn number(run: &Replica, key: &str) -> Option<f64> {
    run.summary.as_ref()?.get(key)?.as_f64()
}

fn figure(entries: &[Entry], reference: usize, dimension: usize, name: &str) -> Option<ComparedFigure> {
    let values: Vec<Option<Estimate>> = entries.iter().map(|entry| estimate(entry, name)).collect();
    if values.iter().flatten().count() < needed(name) {
        return None;
    }
    let trends: Vec<Option<Trend>> = entries.iter().map(|entry| trend(entry, name)).collect();
    let differences = entries.iter().enumerate().map(|(place, entry)| {
        let other = (place != reference).then_some(&entries[reference])?;
        let mut difference = against(entry, other, name)?;
        let unsteady = [place, reference].into_iter().find(|k| trends[*k].is_some_and(|t| !t.is_steady()));
        if let Some(k) = unsteady {
            let shown = figure_text(values[k]?.value, None, trends[k]);
            difference.verdict = Verdict::NotSteady;
            difference.sentence =
                not_steady_sentence(&subject(entry, other, name), &entries[k].label, &shown);
        }
        Some(difference)
    });
    let differences = differences.collect();
    Some(ComparedFigure {
        name: name.to_owned(),
        unit: unit(entries, name, dimension),
        values,
        trends,
        differences,
        theory: None,
    })
}

/// The mean over replicas; of one run what it says itself.
fn estimate(entry: &Entry, name: &str) -> Option<Estimate> {
    let values: Vec<f64> = entry.runs.iter().filter_map(|run| number(run, name)).collect();
    let mut estimate = average(&values)?;
    if let ([_], [run]) = (&values[..], &entry.runs[..]) {
        estimate.standard_error = number(run, &error_key(name));
    }
    Some(estimate)
}

/// Whether the series of a figure is steady in the runs that say so.
fn trend(entry: &Entry, name: &str) -> Option<Trend> {
    let trends = entry.runs.iter().filter_map(|run| trend_of(run.summary.as_ref()?, name));
    trend_of_runs(trends)
}

fn subject<'a>(own: &'a Entry, other: &'a Entry, name: &str) -> Subject<'a> {
    Subject {
        label: &own.label,
        reference: &other.label,
        quantity: in_words(name),
        abscissa: String::new(),
        time: None,
        is_cooling: false,
    }
}

/// As a share of the reference where all values of both are above zero, else in its unit.
fn against(own: &Entry, other: &Entry, name: &str) -> Option<Difference> {
    let subject = subject(own, other, name);
    let of = |entry: &Entry| -> Vec<f64> { entry.runs.iter().filter_map(|run| number(run, name)).collect() };
    let (values, others) = (of(own), of(other));
    let level = mean(&others)?;
    let is_positive = values.iter().chain(&others).all(|value| *value > 0.0);
    let (terms, scale) = if is_positive { (Terms::Shares, level) } else { (Terms::Own, 1.0) };
    if let ([a], [b]) = (&own.runs[..], &other.runs[..]) {
        let raw = of_one(a, b, name, scale, terms)?;
        return Some(judged(raw, &Along { places: &[0.0], ..Along::default() }, terms, &subject));
    }
    let drawn = |entry: &Entry| -> Vec<Drawn> {
        let runs = entry.runs.iter().filter_map(|run| Some((run.number, number(run, name)?)));
        runs.map(|(replica, value)| Drawn { replica, values: vec![value / scale], errors: Vec::new() })
            .collect()
    };
    let along = Along { places: &[0.0], level: vec![1.0], ..Along::default() };
    difference(&drawn(own), &drawn(other), &along, terms, &subject)
}

/// The difference of one run each, with the errors that they state and the degrees of freedom of these.
fn of_one(a: &Replica, b: &Replica, name: &str, scale: f64, terms: Terms) -> Option<Raw> {
    let figures = [a, b].map(|run| figure_of(run.summary.as_ref()?, name));
    let [Some(own), Some(other)] = &figures else { return None };
    let value = apart(own.value? / scale, other.value? / scale, terms);
    // A run that states degrees of freedom knows how long its series remembers.
    let outlives = |(run, figure): (&Replica, &Figure)| {
        figure.degrees_of_freedom.is_none() && outlives_its_blocks(run, name)
    };
    let (errors, missing) = match [(a, own), (b, other)].into_iter().any(outlives) {
        true => ([[f64::NAN]; 2], Missing::Remembers),
        false => {
            let stated = |figure: &Figure| [figure.standard_error.map_or(f64::NAN, |error| error / scale)];
            ([stated(own), stated(other)], Missing::NotStated)
        }
    };
    let mut raw = as_stated(vec![value], [&errors[0], &errors[1]], missing);
    let freedoms = [own, other].map(|figure| figure.degrees_of_freedom);
    if let ([[first], [second]], [Some(of_first), Some(of_second)]) = (errors, freedoms)
        && first + second > 0.0
    {
        raw.freedom = freedom_of_both([first, second], [of_first, of_second]);
    }
    Some(raw)
}

/// Degrees of freedom of the error of a difference of two independent numbers (Welch 1947, Biometrika 34, 28, eq. 28):
/// ν = (σ₁² + σ₂²)²/(σ₁⁴/ν₁ + σ₂⁴/ν₂).
fn freedom_of_both(errors: [f64; 2], freedoms: [f64; 2]) -> f64 {
    let [a, b] = errors.map(|error| error * error);
    (a + b).powi(2) / (a * a / freedoms[0] + b * b / freedoms[1])
}

/// Whether the series of a figure remembers longer than a block of the second half of the run lasts: a run cuts that
/// into [`BLOCKS`], and its error of the figure is then too small. Of a figure without a series nobody knows.
fn outlives_its_blocks(run: &Replica, name: &str) -> bool {
    let Some(column) = run.log.columns.iter().position(|column| column.name == name) else { return false };
    let values: Vec<f64> = run.log.series.iter().filter_map(|row| row.get(column).copied()).collect();
    let late = values[values.len() / 2..].iter().copied().filter(|value| value.is_finite());
    let late: Vec<f64> = late.collect();
    let block = (late.len() as f64 / BLOCKS as f64).max(2.0);
    longest_memory(&late).is_some_and(|memory| 2.0 * memory > block)
}

/// The unit of a figure, from the series where that has it.
fn unit(entries: &[Entry], name: &str, dimension: usize) -> Dimension {
    let columns = entries.iter().flat_map(|entry| &entry.runs).flat_map(|run| &run.log.columns);
    let found = columns.clone().find(|column| column.name == name);
    found.map_or_else(|| unit_of(name, dimension), |column| column.unit)
}

/// The unit of a figure in so many dimensions: a force per area is one per length in two.
pub(crate) fn unit_of(name: &str, dimension: usize) -> Dimension {
    let pressure = [1, if dimension == 3 { -1 } else { 0 }, -2];
    let [mass, length, time] = match name {
        "rotational_energy" | "kinetic_energy_final" | "kinetic_energy_initial" => [1, 2, -2],
        "temperature" => [1, 2, -2],
        // Of all grains, or of a species.
        name if name.starts_with("granular_temperature") => [1, 2, -2],
        "pressure" => pressure,
        // Of all walls, or of one by its name.
        name if name.starts_with("wall_shear_stress") || name.starts_with("wall_normal_stress") => pressure,
        "flow_velocity" => [0, 1, -1],
        "flow_rate" | "collision_frequency" => [0, 0, -1],
        "mean_free_time" | "simulated_time" => [0, 0, 1],
        "heap_height" | "centre_of_mass_height" | "centre_of_mass_mean_height" | "mean_free_path" => {
            [0, 1, 0]
        }
        _ => [0, 0, 0],
    };
    Dimension { mass, length, time }
}
