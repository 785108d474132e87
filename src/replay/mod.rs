//! A stored run played back: its tables, pictures and pages, from the log alone.

pub mod compute;
pub mod film;
pub mod selection;
pub mod tables;
pub mod text_picture;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::record::contents::Walls;
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{AnyScenario, Units};
use crate::scenario::{Overrides, parse};

/// The scenario in a log is none that this version takes.
#[derive(Debug, thiserror::Error)]
#[error("the scenario in {} is not one that grainflow {} understands; use the version that wrote the log ({writer})\n{source}", log.display(), env!("CARGO_PKG_VERSION"))]
pub struct ScenarioUnknown {
    log: PathBuf,
    writer: String,
    source: ScenarioError,
}

/// The scenario that the log at `path` holds as `text`.
pub fn scenario_of(
    path: &Path,
    metadata: &BTreeMap<String, String>,
    text: &str,
) -> Result<AnyScenario, ScenarioUnknown> {
    let name = metadata.get("scenario").map_or("log", String::as_str);
    parse(name, text, &Overrides::default()).map_err(|source| ScenarioUnknown {
        log: path.to_owned(),
        writer: metadata.get("version").map_or_else(|| "unknown".to_owned(), Clone::clone),
        source,
    })
}

/// The box of `scenario`, as logs describe it.
pub fn walls_of(scenario: &AnyScenario) -> Walls {
    match scenario {
        AnyScenario::Two(scenario) => scenario.walls(),
        AnyScenario::Three(scenario) => scenario.walls(),
    }
}

/// The names of the units that a log with this `metadata` uses.
pub fn units_of(metadata: &BTreeMap<String, String>) -> Units {
    let name = |key: &str, usual: &str| metadata.get(key).map_or_else(|| usual.to_owned(), Clone::clone);
    Units {
        length: name("unit_length", "length"),
        mass: name("unit_mass", "mass"),
        time: name("unit_time", "time"),
    }
}
