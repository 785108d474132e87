//! The beginning of a run as a log of its own, from which other runs can start.

use std::path::Path;

use super::recorder::Recorder;
use super::{RunError, initial_gas};
use crate::scenario::model::{AnyScenario, Scenario};
use crate::simulation::Simulation;
use crate::space::Vector;
use crate::stopwatch::Stopwatch;

/// Builds the grains of `scenario`, equilibrates them if it says so, and writes the log `log` of this one state, into
/// a folder that is made. A run whose `initial.positions` names that log begins with exactly these grains.
pub fn write_beginning(scenario: &AnyScenario, log: &Path) -> Result<(), RunError> {
    rayon::scope(|_| match scenario {
        AnyScenario::Two(scenario) => write_in(scenario, log),
        AnyScenario::Three(scenario) => write_in(scenario, log),
    })
}

fn write_in<V: Vector>(scenario: &Scenario<V>, log: &Path) -> Result<(), RunError> {
    let gas = initial_gas(scenario)?;
    let mut simulation =
        Simulation::start(scenario, gas, &mut Stopwatch::default()).map_err(RunError::Equilibration)?;
    if let Some(folder) = log.parent() {
        std::fs::create_dir_all(folder)
            .map_err(|source| RunError::Write { path: folder.to_owned(), source })?;
    }
    Recorder::create(log, &mut simulation)?.finish(&mut simulation)?;
    Ok(())
}
