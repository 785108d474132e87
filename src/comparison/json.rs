//! `comparison.json`: everything that was found, without pictures. What is not a number is null.

use serde_json::{Value, json};

use super::model::{Compared, ComparedFigure, Comparison, Contestant, Cost, Difference, Verdict};
use crate::observe::measure::{Column, Dimension};

/// The text of `comparison.json`.
pub fn json(comparison: &Comparison) -> String {
    let value = json!({
        "title": comparison.title,
        "scenario": comparison.scenario,
        "scenario_text": comparison.scenario_text,
        "dimension": comparison.dimension,
        "units": comparison.units,
        "version": comparison.version,
        "numerics": comparison.numerics,
        "seed": comparison.seed,
        "replicas": comparison.replicas,
        "remarks": comparison.remarks,
        "reference": comparison.reference,
        "contestants": comparison.contestants.iter().map(contestant).collect::<Vec<Value>>(),
        "series": comparison.series.iter().map(compared).collect::<Vec<Value>>(),
        "profiles": comparison.profiles.iter().map(compared).collect::<Vec<Value>>(),
        "figures": comparison.figures.iter().map(figure).collect::<Vec<Value>>(),
    });
    format!("{value:#}\n")
}

/// The word of a verdict, in both files.
pub(super) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "agrees",
        Verdict::Differs => "differs",
        Verdict::Unknown => "unknown",
    }
}

fn contestant(contestant: &Contestant) -> Value {
    json!({
        "label": contestant.label,
        "engine": contestant.engine,
        "folders": contestant.folders,
        "failures": contestant.failures,
        "diameter": contestant.diameter,
        "cost": contestant.cost.map(cost),
    })
}

fn cost(cost: Cost) -> Value {
    json!({
        "wall_seconds": cost.wall_seconds,
        "advancing_seconds": cost.advancing_seconds,
        "particle_steps_per_second": cost.particle_steps_per_second,
        "events_per_second": cost.events_per_second,
        "peak_memory_bytes": cost.peak_memory,
    })
}

fn compared(compared: &Compared) -> Value {
    let curve = |curve: &Option<super::model::CurveOf>| {
        curve.as_ref().map(|curve| json!({ "values": curve.values, "standard_errors": curve.errors }))
    };
    json!({
        "name": compared.name,
        "abscissa": column(&compared.abscissa),
        "ordinate": column(&compared.ordinate),
        "time": compared.time,
        "places": compared.places,
        "curves": compared.curves.iter().map(curve).collect::<Vec<_>>(),
        "differences": compared.differences.iter().map(|of| of.as_ref().map(difference)).collect::<Vec<_>>(),
    })
}

fn figure(figure: &ComparedFigure) -> Value {
    let values = figure.values.iter().map(|of| {
        of.map(|estimate| json!({ "value": estimate.value, "standard_error": estimate.standard_error }))
    });
    json!({
        "name": figure.name,
        "unit": unit(figure.unit),
        "values": values.collect::<Vec<_>>(),
        "differences": figure.differences.iter().map(|of| of.as_ref().map(difference)).collect::<Vec<_>>(),
        "theory": figure.theory.as_ref().map(|(value, source)| json!({ "value": value, "source": source })),
    })
}

fn difference(difference: &Difference) -> Value {
    let most = difference.most;
    json!({
        "is_relative": difference.is_relative,
        "values": difference.values,
        "standard_errors": difference.errors,
        "most": most.map(|peak| json!({ "place": peak.place, "standard_errors": peak.standard_errors })),
        "threshold": difference.threshold,
        "parts_at": difference.parts_at,
        "verdict": word(difference.verdict),
        "sentence": difference.sentence,
    })
}

fn column(column: &Column) -> Value {
    json!({ "name": column.name, "unit": unit(column.unit) })
}

/// Powers of mass, length and time.
fn unit(unit: Dimension) -> Value {
    json!({ "mass": unit.mass, "length": unit.length, "time": unit.time })
}
