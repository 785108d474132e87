//! From runs to a comparison.

use serde_json::{Map, Value};

use super::extent::Remarks;
use super::model::{Basis, Compared, Comparison, Contestant, Correlation, Cost};
use super::{figures, profiles, same_runs, series};
use crate::number::{in_words, plain};
use crate::record::contents::RunLog;
use crate::scenario::kinds::Kinds;
use crate::scenario::{Overrides, parse};
use crate::statistics::mean;

/// What is the same for all runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Head {
    /// The scenario as TOML text.
    pub scenario_text: String,
    /// The seed from which replicas draw theirs.
    pub seed: u64,
    /// Independent initial states that were asked for.
    pub replicas: u32,
    /// What a reader must know beside what is said here, a sentence each.
    pub remarks: Vec<String>,
}

/// An engine with its runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// What it is called.
    pub label: String,
    /// Name of the engine.
    pub engine: String,
    /// Runs that came to their end.
    pub runs: Vec<Replica>,
    /// Why others did not, a sentence each.
    pub failures: Vec<String>,
    /// Whether each run had the machine for itself, so that its costs mean something.
    pub was_alone: bool,
    /// Diameter of a grain [length].
    pub diameter: f64,
}

/// A run that came to its end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Replica {
    /// Its initial state: those of the same number are compared with each other.
    pub number: u32,
    /// Its folder, or its log.
    pub folder: String,
    /// The log.
    pub log: RunLog,
    /// The summary; `None` for a log without one beside it.
    pub summary: Option<Map<String, Value>>,
}

/// Compares `entries`: their series, profiles and figures.
pub fn assemble(head: Head, entries: Vec<Entry>) -> Comparison {
    let mut comparison = Comparison {
        scenario_text: head.scenario_text,
        seed: head.seed,
        replicas: head.replicas,
        reference: reference(&entries),
        ..Comparison::default()
    };
    if let Some(run) = entries.iter().find_map(|entry| entry.runs.first()) {
        name(&mut comparison, &run.log);
    }
    comparison.remarks = remarks(&entries);
    comparison.remarks.extend(same_runs::remarks(&entries));
    comparison.remarks.extend(head.remarks);
    if !entries.is_empty() {
        let mut left_out = Remarks::new();
        comparison.series = series::compared(&entries, comparison.reference, &mut left_out);
        comparison.profiles = profiles::compared(&entries, comparison.reference, &mut left_out);
        comparison.figures = figures::compared(&entries, comparison.reference, comparison.dimension);
        comparison.remarks.extend(left_out);
        comparison.remarks.extend(memories(&comparison, &entries));
    }
    comparison.contestants = entries.into_iter().map(contestant).collect();
    comparison
}

/// Takes over what a log says of its scenario and program.
fn name(comparison: &mut Comparison, log: &RunLog) {
    let text = |key: &str| log.metadata.get(key).cloned().unwrap_or_default();
    comparison.title = text("title");
    comparison.scenario = text("scenario");
    comparison.version = text("version");
    comparison.numerics = text("numerics").parse().unwrap_or(0);
    comparison.dimension = text("dimension").parse().unwrap_or(2);
    comparison.units = ["unit_length", "unit_mass", "unit_time"].map(text);
}

/// Event-driven where it has a run, else the first that has one.
fn reference(entries: &[Entry]) -> usize {
    let exact = entries.iter().position(|entry| !entry.runs.is_empty() && entry.engine == "event-driven");
    exact.or_else(|| entries.iter().position(|entry| !entry.runs.is_empty())).unwrap_or(0)
}

/// Where the errors come from.
fn remarks(entries: &[Entry]) -> Vec<String> {
    let most = entries.iter().map(|entry| entry.runs.len()).max().unwrap_or(0);
    let mut remarks = vec![match most {
        0 => "No run came to its end.".to_owned(),
        1 => "Each engine ran once. Errors of a series come from blocks of the difference in time, longer than its \
              correlation time; where it does not settle but both begin alike, as in a gas that cools, from the scatter \
              of what it grows by in distinct stretches. Errors of profiles and figures are those that the runs state."
            .to_owned(),
        _ => "Standard errors come from the scatter of replicas; runs that begin at the same state are subtracted from \
              each other before the scatter is taken, and neighbouring places help each other to know it."
            .to_owned(),
    }];
    for entry in entries.iter().filter(|entry| entry.runs.len() < most) {
        remarks.push(format!("{} has {} of {most} runs.", entry.label, entry.runs.len()));
    }
    remarks
}

/// How long the differences of single runs remember, a sentence for each contestant: their errors rest on that.
fn memories(comparison: &Comparison, entries: &[Entry]) -> Vec<String> {
    let of_contestant = |(place, entry): (usize, &Entry)| {
        let of_series = |compared: &Compared| {
            let difference = compared.differences.get(place)?.as_ref()?;
            let is_of_one =
                matches!(difference.basis, Basis::Blocks | Basis::Growth) && entry.runs.len() == 1;
            let Correlation { time, clock } = difference.correlation.as_ref().filter(|_| is_of_one)?;
            let over = if compared.abscissa.name == "time" { "" } else { " over collisions" };
            Some(format!("{}{over} {} in {}", in_words(&compared.name), plain(*time, 3), in_words(clock)))
        };
        let known: Vec<String> = comparison.series.iter().filter_map(of_series).collect();
        let reference = &entries[comparison.reference].label;
        let head = format!("Correlation times of {} minus {reference}", entry.label);
        (!known.is_empty()).then(|| format!("{head}: {}.", known.join(", ")))
    };
    entries.iter().enumerate().filter_map(of_contestant).collect()
}

fn contestant(entry: Entry) -> Contestant {
    let cost = if entry.was_alone { cost(&entry.runs) } else { None };
    let folders = entry.runs.iter().map(|run| run.folder.clone()).collect();
    let mut first = entry.runs.into_iter().next().map(|run| run.log).unwrap_or_default();
    let species = std::mem::take(&mut first.species);
    let kinds = match parse("log", &first.scenario, &Overrides::default()) {
        Ok(scenario) => Kinds::of(&scenario, species),
        Err(_) => Kinds::of_diameter(entry.diameter),
    };
    Contestant {
        label: entry.label,
        engine: entry.engine,
        folders,
        failures: entry.failures,
        cost,
        walls: first.walls,
        diameter: entry.diameter,
        kinds,
        frames: first.frames,
    }
}

/// Means over runs, of what their summaries say.
fn cost(runs: &[Replica]) -> Option<Cost> {
    let of = |key: &str| {
        let summaries = runs.iter().filter_map(|run| run.summary.as_ref());
        let values: Vec<f64> = summaries.filter_map(|summary| summary.get(key)?.as_f64()).collect();
        mean(&values)
    };
    Some(Cost {
        wall_seconds: of("wall_seconds")?,
        advancing_seconds: of("advancing_seconds")?,
        particle_steps_per_second: of("particle_steps_per_second"),
        events_per_second: of("events_per_second"),
        peak_memory: of("peak_memory_bytes"),
    })
}
