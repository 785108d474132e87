//! What a calibration writes: tables that a scenario can name, the whole as JSON, a page.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use crate::report::calibration::{Calibration, Entry, Stage, calibration_page};
use crate::run::{RunError, write_text};

/// Writes all files into `folder`.
pub(super) fn write(folder: &Path, calibration: &Calibration) -> Result<(), RunError> {
    if !calibration.stages.is_empty() {
        write_text(&folder.join("impact.csv"), &impact_table(calibration))?;
    }
    if !calibration.entries.is_empty() {
        write_text(&folder.join("entry.csv"), &entry_table(calibration))?;
    }
    let json = serde_json::to_string_pretty(&as_json(calibration)).expect("numbers and texts are JSON");
    write_text(&folder.join("calibration.json"), &(json + "\n"))?;
    write_text(&folder.join("calibration.html"), &calibration_page(calibration))
}

/// c in the course of a run, at the middle of every stage.
fn impact_table(calibration: &Calibration) -> String {
    let mut text = format!(
        "# engine.impact_parameter = {{ table = \"impact.csv\" }}; calibrated from {} event-driven runs of {}\n\
         collisions_per_particle,c,standard_error,collisions\n",
        calibration.replicas, calibration.scenario
    );
    for stage in &calibration.stages {
        let error = stage.c.standard_error.map(|error| error.to_string()).unwrap_or_default();
        let collisions: u64 = stage.impacts.iter().sum();
        let _ = writeln!(text, "{},{},{error},{collisions}", stage.place(), stage.c.value);
    }
    text
}

/// p(ν) of entering a cell.
fn entry_table(calibration: &Calibration) -> String {
    let mut text = format!(
        "# engine.hsmc.entry_probability = {{ table = \"entry.csv\" }}; calibrated from {} event-driven runs of {}\n\
         volume_fraction,probability,standard_error,attempts,arrivals_over_attempts\n",
        calibration.replicas, calibration.scenario
    );
    for entry in &calibration.entries {
        let error = entry.probability.standard_error.map(|error| error.to_string()).unwrap_or_default();
        let (place, value) = (entry.volume_fraction, entry.probability.value);
        let _ = writeln!(text, "{place},{value},{error},{},{}", entry.attempts, entry.flux_ratio());
    }
    text
}

fn as_json(calibration: &Calibration) -> Value {
    json!({
        "scenario": calibration.scenario,
        "title": calibration.title,
        "dimension": calibration.dimension,
        "particles": calibration.particles,
        "volume_fraction": calibration.volume_fraction,
        "seed": calibration.seed,
        "replicas": calibration.replicas,
        "version": env!("CARGO_PKG_VERSION"),
        "numerics": crate::run::NUMERICS,
        "cell": calibration.cell,
        "capacity": calibration.capacity,
        "impact_parameter": calibration.stages.iter().map(stage).collect::<Vec<_>>(),
        "entry_probability": calibration.entries.iter().map(entry).collect::<Vec<_>>(),
        "remarks": calibration.remarks,
    })
}

fn stage(stage: &Stage) -> Value {
    json!({
        "from": stage.stretch[0],
        "to": stage.stretch[1],
        "c": stage.c.value,
        "c_standard_error": stage.c.standard_error,
        "chi_squared": stage.chi_squared,
        "cooling_factor": stage.cooling_factor,
        "impacts": stage.impacts.to_vec(),
    })
}

fn entry(entry: &Entry) -> Value {
    json!({
        "volume_fraction": entry.volume_fraction,
        "attempts": entry.attempts,
        "entered": entry.entered,
        "arrivals": entry.arrivals,
        "probability": entry.probability.value,
        "probability_standard_error": entry.probability.standard_error,
    })
}
