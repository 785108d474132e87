//! Means over replicas, curves against the first varied key, and the power laws through them.

use serde_json::{Map, Value, json};

use super::plan::{Case, Plan};
use super::power_law::power_law;
use super::runs::{Ended, Row};
use crate::comparison::unit_of;
use crate::observe::measure::Figure;
use crate::report::{Abscissa, FigureCurve, MeanPoint, SweepCase, SweepFigure, SweepReport};
use crate::run::NUMERICS;
use crate::run::series::unit_name;
use crate::scenario::model::AnyScenario;
use crate::simulation::figures::{figure_of, is_attribute, trend_of_runs};
use crate::statistics::{Estimate, Trend, average};

/// A point of the grid with all its replicas.
struct GridPoint<'a> {
    case: &'a Case,
    summaries: Vec<&'a Map<String, Value>>,
}

/// A figure at a point of the grid.
struct Mean {
    value: f64,
    standard_error: Option<f64>,
    /// Of that error.
    degrees_of_freedom: Option<f64>,
    /// Whether its series is steady in the runs that tested it.
    trend: Option<Trend>,
    /// Runs that have it.
    runs: usize,
}

impl GridPoint<'_> {
    /// Mean of a figure over the replicas that have it, its error from their scatter; of one run what that states.
    fn mean(&self, name: &str) -> Option<Mean> {
        let figures: Vec<Figure> =
            self.summaries.iter().filter_map(|summary| figure_of(summary, name)).collect();
        let values: Vec<f64> = figures.iter().filter_map(|figure| figure.value).collect();
        let Estimate { value, standard_error } = average(&values)?;
        let (standard_error, degrees_of_freedom) = match &figures[..] {
            [alone] => (alone.standard_error, alone.degrees_of_freedom),
            _ => (standard_error, standard_error.map(|_| values.len() as f64 - 1.0)),
        };
        let trend = trend_of_runs(figures.iter().filter_map(|figure| figure.trend));
        Some(Mean { value, standard_error, degrees_of_freedom, trend, runs: values.len() })
    }
}

/// The points of the grid in order.
fn points<'a>(plan: &'a Plan, rows: &'a [Row]) -> Vec<GridPoint<'a>> {
    let mut points: Vec<GridPoint<'a>> = Vec::new();
    for (case, row) in plan.cases.iter().zip(rows) {
        if points.last().is_none_or(|last| last.case.point != case.point) {
            points.push(GridPoint { case, summaries: Vec::new() });
        }
        if let Some(point) = points.last_mut().filter(|_| !row.summary.is_empty()) {
            point.summaries.push(&row.summary);
        }
    }
    points
}

/// Engines in the order in which they first run.
fn engines(plan: &Plan) -> Vec<&'static str> {
    let mut engines: Vec<&str> = Vec::new();
    for case in &plan.cases {
        let engine = case.scenario.engine().name();
        if !engines.contains(&engine) {
            engines.push(engine);
        }
    }
    engines
}

/// What the figures are plotted against: the first variation, or the engines where there is none.
fn abscissa(plan: &Plan) -> Abscissa {
    let Some(variation) = plan.variations.first() else {
        let values: Vec<String> = engines(plan).into_iter().map(str::to_owned).collect();
        let places = (1..=values.len()).map(|k| k as f64).collect();
        return Abscissa { name: "engine".to_owned(), values, places, is_numeric: false };
    };
    let leader = variation.leader();
    let numbers = leader.numbers();
    let is_numeric = numbers.is_some();
    let places = numbers.unwrap_or_else(|| (1..=leader.values.len()).map(|k| k as f64).collect());
    Abscissa { name: leader.path.clone(), values: leader.values.clone(), places, is_numeric }
}

/// Where a case stands on the abscissa.
fn place(abscissa: &Abscissa, case: &Case) -> f64 {
    let engine = case.scenario.engine().name();
    let of_engine = || abscissa.values.iter().position(|value| value == engine);
    let place = case.places.first().copied().or_else(of_engine);
    abscissa.places[place.expect("without varied keys the abscissa holds the engines of all cases")]
}

/// What tells the line of a case from the others: further varied keys, and the engine where there are several.
fn line_name(plan: &Plan, case: &Case) -> String {
    let further = plan.variations.iter().zip(&case.places).skip(1);
    let mut parts: Vec<String> = further
        .map(|(variation, &place)| {
            let leader = variation.leader();
            let name = leader.path.rsplit('.').next().unwrap_or(&leader.path);
            format!("{name} = {}", leader.values[place])
        })
        .collect();
    if plan.sweeps_engines && !plan.variations.is_empty() {
        parts.push(case.scenario.engine().name().to_owned());
    }
    parts.join(", ")
}

/// One figure against the abscissa, a curve for every line.
fn figure(plan: &Plan, abscissa: &Abscissa, points: &[GridPoint<'_>], name: &str) -> SweepFigure {
    let mut curves: Vec<FigureCurve> = Vec::new();
    for point in points {
        let line = line_name(plan, point.case);
        let index = curves.iter().position(|curve| curve.name == line).unwrap_or_else(|| {
            curves.push(FigureCurve { name: line, points: Vec::new(), power_law: None });
            curves.len() - 1
        });
        if let Some(mean) = point.mean(name) {
            let x = place(abscissa, point.case);
            let Mean { value, standard_error, trend, runs, .. } = mean;
            curves[index].points.push(MeanPoint { x, value, standard_error, trend, runs });
        }
    }
    for curve in &mut curves {
        curve.points.sort_by(|a, b| a.x.total_cmp(&b.x));
        if abscissa.is_logarithmic() {
            let steady = curve.points.iter().filter(|point| point.is_steady());
            let points: Vec<_> = steady.map(|p| ([p.x, p.value], p.standard_error)).collect();
            curve.power_law = power_law(&points);
        }
    }
    SweepFigure { name: name.to_owned(), unit: unit(&plan.cases[0].scenario, name), curves }
}

/// The unit of a figure in the names of `scenario`.
fn unit(scenario: &AnyScenario, name: &str) -> String {
    let (dimension, units) = match scenario {
        AnyScenario::Two(scenario) => (2, &scenario.units),
        AnyScenario::Three(scenario) => (3, &scenario.units),
    };
    Some(unit_name(unit_of(name, dimension), units)).filter(|unit| unit != "1").unwrap_or_default()
}

/// All that the page, the JSON and the last words tell.
pub(super) fn report(plan: &Plan, rows: &[Row]) -> SweepReport {
    let (abscissa, points) = (abscissa(plan), points(plan, rows));
    let first = &plan.cases[0].scenario;
    let title = match first {
        AnyScenario::Two(scenario) => &scenario.title,
        AnyScenario::Three(scenario) => &scenario.title,
    };
    let case = |(case, row): (&Case, &Row)| SweepCase {
        name: case.name.clone(),
        status: row.ended.word(),
        error: row.ended.error().to_owned(),
        has_page: !row.summary.is_empty(),
    };
    SweepReport {
        title: title.clone(),
        scenario: first.name().to_owned(),
        variation: variation(plan),
        figures: plan.figures.iter().map(|name| figure(plan, &abscissa, &points, name)).collect(),
        abscissa,
        cases: plan.cases.iter().zip(rows).map(case).collect(),
        interrupted: rows.iter().any(|row| matches!(row.ended, Ended::Interrupted | Ended::NotRun)),
        scenario_text: first.source_text().to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    }
}

/// What varies, in a sentence.
fn variation(plan: &Plan) -> String {
    let mut parts: Vec<String> = plan
        .variations
        .iter()
        .map(|variation| {
            let keys = variation.keys.iter().map(|key| key.path.as_str()).collect::<Vec<_>>().join(" with ");
            let values = if variation.len() == 1 { "value" } else { "values" };
            format!("{keys} takes {} {values}", variation.len())
        })
        .collect();
    if plan.sweeps_engines {
        parts.push(format!("engines are {}", engines(plan).join(", ")));
    }
    if plan.replicas > 1 {
        parts.push(format!("every case is run with {} seeds", plan.replicas));
    }
    parts.join("; ") + "."
}

/// `sweep.json`: means over replicas with standard errors for every number of the summaries, and the power laws.
pub(super) fn json(plan: &Plan, rows: &[Row], report: &SweepReport) -> String {
    let points: Vec<Value> = points(plan, rows).iter().map(|point| point_json(plan, point)).collect();
    let laws = report.figures.iter().flat_map(|figure| {
        figure.curves.iter().filter_map(move |curve| {
            let law = curve.power_law?;
            Some(json!({
                "figure": figure.name,
                "line": curve.name,
                "exponent": law.exponent,
                "exponent_standard_error": law.standard_error,
                "prefactor": law.prefactor,
                "largest_deviation": law.largest_deviation,
                "points": law.points,
                "points_left_out_as_not_steady": curve.not_steady(),
            }))
        })
    });
    let cases = report
        .cases
        .iter()
        .map(|case| json!({"case": case.name, "status": case.status, "error": case.error}));
    let value = json!({
        "scenario": report.scenario,
        "version": report.version,
        "numerics": NUMERICS,
        "abscissa": report.abscissa.name,
        "varied": plan.paths(),
        "replicas": plan.replicas,
        "interrupted": report.interrupted,
        "points": points,
        "power_laws": laws.collect::<Vec<_>>(),
        "runs": cases.collect::<Vec<_>>(),
    });
    serde_json::to_string_pretty(&value).expect("numbers and texts are JSON") + "\n"
}

fn point_json(plan: &Plan, point: &GridPoint<'_>) -> Value {
    let settings: Map<String, Value> =
        plan.settings(point.case).map(|(path, value)| (path.to_owned(), typed(value))).collect();
    let mut figures = Map::new();
    for key in point.summaries.iter().flat_map(|summary| summary.keys()) {
        if is_attribute(key) || key == "seed" || figures.contains_key(key) {
            continue;
        }
        if let Some(mean) = point.mean(key) {
            let mean = json!({
                "mean": mean.value,
                "standard_error": mean.standard_error,
                "degrees_of_freedom": mean.degrees_of_freedom,
                "steady": mean.trend.map(Trend::is_steady),
                "trend": mean.trend.filter(|trend| !trend.is_steady()).map(Trend::name),
                "runs": mean.runs,
            });
            figures.insert(key.clone(), mean);
        }
    }
    json!({
        "settings": settings,
        "engine": point.case.scenario.engine().name(),
        "runs": point.summaries.len(),
        "figures": figures,
    })
}

/// A value of a varied key: a number or truth value where it is one, else its text.
fn typed(value: &str) -> Value {
    let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
    match (number, value.parse::<bool>()) {
        (Some(number), _) => json!(number),
        (None, Ok(truth)) => json!(truth),
        (None, Err(_)) => json!(value),
    }
}
