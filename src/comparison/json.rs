//! `comparison.json`: everything that a comparison has found, for programs.

use serde_json::{Map, Value, json};

use super::model::{
    Basis, Compared, ComparedFigure, Comparison, Contestant, Difference, TheoryCurve, Verdict,
};
use crate::number::NOT_STEADY;
use crate::observe::measure::{Column, Dimension};
use crate::statistics::{Estimate, Trend};

/// The file's text: the names of [`Comparison`], all but the frames; null where a number is not known.
pub fn text(comparison: &Comparison) -> String {
    let contestants: Vec<Value> = comparison.contestants.iter().map(contestant).collect();
    let value = json!({
        "title": comparison.title,
        "scenario": comparison.scenario,
        "scenario_text": comparison.scenario_text,
        "dimension": comparison.dimension,
        "units": { "length": comparison.units[0], "mass": comparison.units[1], "time": comparison.units[2] },
        "version": comparison.version,
        "numerics": comparison.numerics,
        "seed": comparison.seed,
        "replicas": comparison.replicas,
        "remarks": comparison.remarks,
        "contestants": contestants,
        "reference": comparison.reference,
        "series": comparison.series.iter().map(compared).collect::<Vec<_>>(),
        "profiles": comparison.profiles.iter().map(compared).collect::<Vec<_>>(),
        "figures": comparison.figures.iter().map(figure).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}

impl Verdict {
    /// The verdict in a word.
    pub(super) fn name(self) -> &'static str {
        match self {
            Verdict::Agrees => "agrees",
            Verdict::Differs => "differs",
            Verdict::Unknown => "unknown",
            Verdict::NotSteady => NOT_STEADY,
        }
    }
}

impl Basis {
    /// Where errors are from, in a word.
    pub(super) fn name(self) -> &'static str {
        match self {
            Basis::Replicas => "replicas",
            Basis::Neighbours => "neighbours",
            Basis::Growth => "growth",
            Basis::Blocks => "blocks",
            Basis::Stated => "stated",
            Basis::Nothing => "nothing",
        }
    }
}

fn contestant(contestant: &Contestant) -> Value {
    json!({
        "label": contestant.label,
        "engine": contestant.engine,
        "folders": contestant.folders,
        "failures": contestant.failures,
        "cost": contestant.cost.map(|cost| json!({
            "wall_seconds": cost.wall_seconds,
            "advancing_seconds": cost.advancing_seconds,
            "particle_steps_per_second": cost.particle_steps_per_second,
            "events_per_second": cost.events_per_second,
            "peak_memory": cost.peak_memory,
        })),
        "walls": contestant.walls.as_ref().map(|walls| json!({
            "lower": walls.lower,
            "upper": walls.upper,
            "sides": walls.sides,
        })),
        "diameter": contestant.diameter,
    })
}

fn compared(compared: &Compared) -> Value {
    let curve = |curve: &Option<super::model::CurveOf>| {
        curve.as_ref().map(|curve| json!({ "values": curve.values, "errors": curve.errors }))
    };
    json!({
        "name": compared.name,
        "abscissa": column(&compared.abscissa),
        "ordinate": column(&compared.ordinate),
        "time": compared.time,
        "places": compared.places,
        "curves": compared.curves.iter().map(curve).collect::<Vec<_>>(),
        "differences": differences(&compared.differences),
        "theory": compared.theory.iter().map(theory).collect::<Vec<_>>(),
    })
}

fn figure(figure: &ComparedFigure) -> Value {
    let value = |(estimate, trend): (&Option<Estimate>, &Option<Trend>)| {
        estimate.map_or(Value::Null, |of| {
            json!({
                "value": of.value,
                "standard_error": of.standard_error,
                "steady": trend.map(Trend::is_steady),
                "trend": trend.filter(|trend| !trend.is_steady()).map(Trend::name),
            })
        })
    };
    let values: Vec<Value> = figure.values.iter().zip(&figure.trends).map(value).collect();
    json!({
        "name": figure.name,
        "unit": unit(figure.unit),
        "values": values,
        "differences": differences(&figure.differences),
        "theory": figure.theory.as_ref().map(|(value, source)| json!({ "value": value, "source": source })),
    })
}

fn theory(theory: &TheoryCurve) -> Value {
    json!({ "name": theory.name, "source": theory.source, "values": theory.values })
}

fn differences(differences: &[Option<Difference>]) -> Vec<Value> {
    differences.iter().map(|one| one.as_ref().map_or(Value::Null, difference)).collect()
}

fn difference(difference: &Difference) -> Value {
    json!({
        "is_relative": difference.is_relative,
        "values": difference.values,
        "errors": difference.errors,
        "most": difference.most.map(|most| json!({ "place": most.place, "standard_errors": most.standard_errors })),
        "threshold": difference.threshold,
        "last_threshold": difference.last_threshold,
        "overall": difference.overall.map(|all| json!({
            "value": all.value,
            "error": all.error,
            "standard_errors": all.standard_errors,
            "threshold": all.threshold,
        })),
        "basis": difference.basis.name(),
        "freedom": difference.freedom,
        "correlation": difference.correlation.as_ref().map(|of| json!({ "time": of.time, "clock": of.clock })),
        "parts_at": difference.parts_at,
        "verdict": difference.verdict.name(),
        "sentence": difference.sentence,
    })
}

fn column(column: &Column) -> Value {
    json!({ "name": column.name, "unit": unit(column.unit) })
}

/// Powers of mass, length and time.
fn unit(unit: Dimension) -> Map<String, Value> {
    [("mass", unit.mass), ("length", unit.length), ("time", unit.time)]
        .into_iter()
        .map(|(name, power)| (name.to_owned(), json!(power)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::text;
    use crate::comparison::testing::made_up;
    use serde_json::{Value, json};

    #[test]
    fn everything_but_frames_comes_back_and_what_is_no_number_is_null() {
        let comparison = made_up();
        let read: Value = serde_json::from_str(&text(&comparison)).unwrap();
        assert_eq!(read["title"], comparison.title);
        assert_eq!((&read["seed"], &read["reference"]), (&json!(7), &json!(1)));
        assert_eq!(read["contestants"][0]["cost"]["peak_memory"], 1e6);
        assert_eq!(read["contestants"][0].get("frames"), None);
        assert_eq!(read["contestants"][0]["walls"], Value::Null);
        let series = &read["series"][0];
        assert_eq!(series["ordinate"]["unit"], json!({ "mass": 1, "length": 2, "time": -2 }));
        assert_eq!(series["time"], Value::Null);
        assert_eq!(series["curves"][1], json!({ "values": [1.0, null], "errors": [0.0, null] }));
        assert_eq!(series["differences"][0]["most"], json!({ "place": 0.5, "standard_errors": 4.0 }));
        let whole = json!({ "value": 0.25, "error": 0.0625, "standard_errors": 4.0, "threshold": 3.25 });
        assert_eq!(series["differences"][0]["overall"], whole);
        let correlation = json!({ "time": 0.75, "clock": "time" });
        assert_eq!(series["differences"][0]["correlation"], correlation);
        let [basis, freedom, last] =
            ["basis", "freedom", "last_threshold"].map(|key| &series["differences"][0][key]);
        assert_eq!((basis, freedom, last), (&json!("growth"), &json!(12.0), &json!(3.125)));
        assert_eq!(
            (&series["differences"][0]["verdict"], &series["differences"][1]),
            (&json!("differs"), &Value::Null)
        );
        assert_eq!(series["theory"][0]["values"], json!([1.0, 0.125]));
        assert_eq!(read["profiles"][0]["time"], 2.5);
        let figure = &read["figures"][0];
        assert_eq!(
            figure["values"],
            json!([{ "value": 1.25, "standard_error": 0.5, "steady": false, "trend": "rising" }, null])
        );
        assert_eq!(figure["theory"], json!({ "value": 1.5, "source": "Enskog" }));
    }
}
