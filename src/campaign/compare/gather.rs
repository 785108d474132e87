//! From runs to a comparison: which logs belong to which engine, and what became of the runs that have none.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::CompareError;
use super::plan::Plan;
use super::runs::Run;
use crate::comparison::model::{Comparison, Contestant, Cost};
use crate::record::contents::RunLog;
use crate::record::reader::read_log;
use crate::scenario::{Overrides, parse};
use crate::statistics::mean;

/// Why logs cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LogsError {
    /// Nothing to compare with.
    #[error("{} alone has nothing to be compared with; name two or more logs or run folders, or a scenario", .0.display())]
    Alone(PathBuf),
    /// A scenario among logs.
    #[error("{} is neither a log nor a run folder; compare takes one scenario, or two or more logs or run folders", .0.display())]
    NotALog(PathBuf),
}

/// The comparison of the runs of `plan` that came to their end, in `folder`; with their costs where each ran `alone`.
pub(super) fn of_runs(
    plan: &Plan,
    runs: &[Run],
    folder: &Path,
    alone: bool,
) -> Result<Comparison, CompareError> {
    let mut comparison = Comparison::default();
    for (place, engine) in plan.engines().enumerate() {
        let own: Vec<&Run> = runs.iter().filter(|run| run.contestant == place).collect();
        let complete = own.iter().filter_map(|run| Some((run.folder.clone(), run.summary()?)));
        let (folders, summaries): (Vec<String>, Vec<&Map<String, Value>>) = complete.unzip();
        let mut contestant = Contestant {
            label: engine.name().to_owned(),
            engine: engine.name().to_owned(),
            failures: own.iter().filter_map(|run| run.failure()).collect(),
            cost: if alone { cost(&summaries) } else { None },
            diameter: plan.diameter(),
            folders,
            ..Contestant::default()
        };
        if let Some(first) = contestant.folders.first() {
            let log = read_log(&folder.join(first).join("log.mcap"))?;
            name(&mut comparison, &log);
            (contestant.walls, contestant.frames) = (log.walls, log.frames);
        }
        comparison.contestants.push(contestant);
    }
    comparison.reference = reference(&comparison.contestants);
    (comparison.seed, comparison.replicas) = (plan.seed(), plan.replicas());
    plan.source_text().clone_into(&mut comparison.scenario_text);
    Ok(comparison)
}

/// Takes over what the first log says of its scenario and program.
fn name(comparison: &mut Comparison, log: &RunLog) {
    if !comparison.scenario.is_empty() {
        return;
    }
    let text = |key: &str| log.metadata.get(key).cloned().unwrap_or_default();
    comparison.title = text("title");
    comparison.scenario = text("scenario");
    comparison.version = text("version");
    comparison.numerics = text("numerics").parse().unwrap_or(0);
    comparison.dimension = text("dimension").parse().unwrap_or(2);
    comparison.units = ["unit_length", "unit_mass", "unit_time"].map(text);
}

/// The exact one among those that have a run, else the first that has one.
fn reference(contestants: &[Contestant]) -> usize {
    let has_run = |contestant: &Contestant| !contestant.folders.is_empty();
    let exact = contestants.iter().position(|one| has_run(one) && one.engine == "event-driven");
    exact.or_else(|| contestants.iter().position(has_run)).unwrap_or(0)
}

/// Means over runs, of what their summaries say.
fn cost(summaries: &[&Map<String, Value>]) -> Option<Cost> {
    let of = |key: &str| {
        let values: Vec<f64> = summaries.iter().filter_map(|summary| summary.get(key)?.as_f64()).collect();
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

/// The comparison of stored runs, each named by its log or its folder.
pub(super) fn of_logs(paths: &[PathBuf]) -> Result<Comparison, CompareError> {
    if let [path] = paths {
        return Err(LogsError::Alone(path.clone()).into());
    }
    let files: Vec<PathBuf> = paths.iter().map(|path| log_of(path)).collect::<Result<_, _>>()?;
    let mut comparison = Comparison { replicas: 1, ..Comparison::default() };
    for (path, file) in paths.iter().zip(&files) {
        let log = read_log(file)?;
        name(&mut comparison, &log);
        if comparison.scenario_text.is_empty() {
            log.scenario.clone_into(&mut comparison.scenario_text);
        }
        let diameter = parse("log", &log.scenario, &Overrides::default()).map_or(1.0, |one| one.diameter());
        comparison.contestants.push(Contestant {
            label: path.display().to_string(),
            engine: log.metadata.get("engine").cloned().unwrap_or_default(),
            folders: vec![path.display().to_string()],
            cost: summary_beside(file).and_then(|summary| cost(&[&summary])),
            walls: log.walls,
            frames: log.frames,
            diameter,
            ..Contestant::default()
        });
    }
    let engines: Vec<String> = comparison.contestants.iter().map(|one| one.engine.clone()).collect();
    let are_enough = engines.iter().enumerate().all(|(k, engine)| !engines[..k].contains(engine));
    if are_enough {
        comparison.contestants.iter_mut().for_each(|one| one.label.clone_from(&one.engine));
    }
    comparison.reference = reference(&comparison.contestants);
    Ok(comparison)
}

/// The log that `path` means: itself, or the one of a run folder.
fn log_of(path: &Path) -> Result<PathBuf, LogsError> {
    if path.extension().is_some_and(|ending| ending == "toml") {
        return Err(LogsError::NotALog(path.to_owned()));
    }
    let inside = path.join("log.mcap");
    match (path.is_dir(), inside.is_file()) {
        (false, _) => Ok(path.to_owned()),
        (true, true) => Ok(inside),
        (true, false) => Err(LogsError::NotALog(path.to_owned())),
    }
}

/// The summary of a stored run, where it has one.
fn summary_beside(log: &Path) -> Option<Map<String, Value>> {
    let text = std::fs::read_to_string(log.with_file_name("summary.json")).ok()?;
    serde_json::from_str(&text).ok()
}
