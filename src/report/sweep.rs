//! The page of a sweep: plots of figures against what was varied, their tables, and every run.

use std::fmt::Write;

use super::axis::Scale;
use super::escape::escape;
use super::page::{document, section};
use super::plot::{Curve, Ink, Plot, Stroke};
use super::sweep_model::{FigureCurve, MeanPoint, PowerLaw, SweepFigure, SweepReport, spans_a_decade};
use crate::number::{NOT_STEADY, in_words, number, with_error};

/// More lines than these are told apart by an ordered scale of colours.
const MOST_COLOURS: usize = 6;
/// More lines than these have no legend entry for their fits.
const MOST_FITS: usize = 4;
/// Points of the curve of a power law.
const LAW_POINTS: usize = 60;

/// The whole page.
pub(super) fn page(sweep: &SweepReport) -> String {
    let shown = || sweep.figures.iter().filter(|figure| figure.curves.iter().any(|c| !c.points.is_empty()));
    let plots: String = shown().map(|figure| plot(sweep, figure).html()).collect();
    let mut body = header(sweep);
    if !plots.is_empty() {
        let plots = format!("<div class=\"plots\">\n{plots}</div>\n");
        body.push_str(&section("Figures against what was varied", &plots));
    }
    body.push_str(&section("In numbers", &shown().map(|figure| table(sweep, figure)).collect::<String>()));
    body.push_str(&section("Every run", &runs(sweep)));
    document(&format!("{}: sweep", sweep.title), &body, &sweep.version)
}

fn header(sweep: &SweepReport) -> String {
    let count = |status: &str| sweep.cases.iter().filter(|case| case.status == status).count();
    let mut counts = format!("{} of {} runs are done", count("done") + count("kept"), sweep.cases.len());
    for (status, words) in
        [("failed", "failed"), ("interrupted", "were interrupted"), ("not run", "were not begun")]
    {
        if count(status) > 0 {
            let _ = write!(counts, ", {} {words}", count(status));
        }
    }
    let mut html = format!(
        "<header>\n<p class=\"kicker\">grainflow · {} · sweep</p>\n<h1>{}</h1>\n<p class=\"lead\">{} {counts}.</p>\n",
        escape(&sweep.scenario),
        escape(&sweep.title),
        escape(&sweep.variation),
    );
    if sweep.interrupted {
        html.push_str(
            "<p class=\"warning\">The sweep was interrupted; the same command goes on where it stopped.</p>\n",
        );
    }
    html.push_str("</header>\n");
    html
}

fn plot(sweep: &SweepReport, figure: &SweepFigure) -> Plot {
    let points = || figure.curves.iter().flat_map(|curve| &curve.points);
    let scale = |logarithmic: bool| if logarithmic { Scale::Logarithmic } else { Scale::Linear };
    let x_scale = scale(sweep.abscissa.is_logarithmic());
    let y_scale = scale(spans_a_decade(points().map(|point| point.value)));
    let lines = figure.curves.len();
    let mut curves = Vec::new();
    for (k, curve) in figure.curves.iter().enumerate() {
        let ink = match lines {
            0..=MOST_COLOURS => Ink::Series(k),
            _ => Ink::Ordered(k as f64 / (lines - 1) as f64),
        };
        if let Some(law) = curve.power_law {
            let name = if lines <= MOST_FITS { fit_name(curve, &law) } else { String::new() };
            let ink = if lines == 1 { Ink::Text } else { ink };
            curves.push(Curve::new(name, law_points(curve, &law), Stroke::Dashed, ink));
        }
        let places: Vec<[f64; 2]> = curve.points.iter().map(|point| [point.x, point.value]).collect();
        if sweep.abscissa.is_numeric && curve.power_law.is_none() {
            curves.push(Curve::new("", places.clone(), Stroke::Faint, ink));
        }
        let name = if curve.name.is_empty() { in_words(&figure.name) } else { curve.name.clone() };
        curves.extend(measured(curve, name, ink));
    }
    Plot {
        title: in_words(&figure.name),
        caption: caption(sweep, figure),
        x_label: sweep.abscissa.name.clone(),
        y_label: figure.labelled(&in_words(&figure.name)),
        x_scale,
        y_scale,
        curves,
        ..Plot::default()
    }
}

/// Its steady points as dots with their errors; the others as rings, which have none.
fn measured(curve: &FigureCurve, name: String, ink: Ink) -> Vec<Curve> {
    let of = |is_steady: bool| curve.points.iter().filter(move |point| point.is_steady() == is_steady);
    let places = |is_steady: bool| of(is_steady).map(|point| [point.x, point.value]).collect::<Vec<_>>();
    let errors = of(true).map(|point| point.standard_error.unwrap_or(0.0)).collect();
    let mut curves = Vec::new();
    if curve.not_steady() < curve.points.len() {
        curves.push(Curve { errors, ..Curve::new(name.clone(), places(true), Stroke::Dots, ink) });
    }
    if curve.not_steady() > 0 {
        curves.push(Curve::new(format!("{name}, {NOT_STEADY}"), places(false), Stroke::Rings, ink));
    }
    curves
}

fn fit_name(curve: &FigureCurve, law: &PowerLaw) -> String {
    let whose = if curve.name.is_empty() { String::new() } else { format!("{}: ", curve.name) };
    format!("{whose}exponent {}", with_error(law.exponent, Some(law.standard_error)))
}

/// The law from the first to the last point, evenly in the logarithm.
fn law_points(curve: &FigureCurve, law: &PowerLaw) -> Vec<[f64; 2]> {
    let range = |(least, most): (f64, f64), x: f64| (least.min(x), most.max(x));
    let (least, most) = curve.points.iter().map(|p| p.x).fold((f64::INFINITY, 0.0), range);
    let x = |k: usize| least * (most / least).powf(k as f64 / (LAW_POINTS - 1) as f64);
    (0..LAW_POINTS).map(|k| [x(k), law.prefactor * x(k).powf(law.exponent)]).collect()
}

/// What a reader should know of the points and of the fit.
fn caption(sweep: &SweepReport, figure: &SweepFigure) -> String {
    let points = || figure.curves.iter().flat_map(|curve| &curve.points);
    let runs = points().map(|point| point.runs).max().unwrap_or(0);
    let mut sentences = Vec::new();
    if points().any(|point| point.standard_error.is_some()) {
        sentences.push(match runs {
            0 | 1 => "Bars: one standard error, as each run states it.".to_owned(),
            runs => format!("Means of up to {runs} runs; bars: one standard error, from their scatter."),
        });
    }
    match points().filter(|point| !point.is_steady()).count() {
        0 => {}
        1 => sentences.push("The ring is a mean of runs that are not steady; no fit takes it.".to_owned()),
        many => sentences
            .push(format!("The {many} rings are means of runs that are not steady; no fit takes them.")),
    }
    if !sweep.abscissa.is_numeric {
        let names = sweep.abscissa.values.iter().zip(1..).map(|(value, k)| format!("{k} = {value}"));
        sentences.push(format!("Places: {}.", names.collect::<Vec<_>>().join(", ")));
    }
    let deviation = figure
        .curves
        .iter()
        .filter_map(|curve| curve.power_law)
        .map(|law| law.largest_deviation)
        .reduce(f64::max);
    if let Some(deviation) = deviation {
        let percent = number(100.0 * deviation, 2);
        sentences.push(format!("Points lie within {percent} % of their power laws."));
    }
    sentences.join(" ")
}

/// The means of one figure: a row for each value, a column for each line.
fn table(sweep: &SweepReport, figure: &SweepFigure) -> String {
    let mut html = format!(
        "<details><summary>{}</summary>\n<div class=\"references\"><table>\n<thead><tr><th>{}</th>",
        escape(&figure.labelled(&in_words(&figure.name))),
        escape(&sweep.abscissa.name)
    );
    for curve in &figure.curves {
        let name = if curve.name.is_empty() { in_words(&figure.name) } else { curve.name.clone() };
        let _ = write!(html, "<th>{}</th>", escape(&name));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for (value, place) in sweep.abscissa.values.iter().zip(&sweep.abscissa.places) {
        let _ = write!(html, "<tr><td class=\"number\">{}</td>", escape(value));
        for curve in &figure.curves {
            let point = curve.points.iter().find(|point| point.x == *place);
            let text = point.map_or("–".to_owned(), MeanPoint::text);
            let _ = write!(html, "<td class=\"number\">{}</td>", escape(&text));
        }
        html.push_str("</tr>\n");
    }
    if figure.curves.iter().any(|curve| curve.power_law.is_some()) {
        html.push_str("<tr><td>exponent</td>");
        for curve in &figure.curves {
            let text = curve
                .power_law
                .map_or("–".to_owned(), |law| with_error(law.exponent, Some(law.standard_error)));
            let _ = write!(html, "<td class=\"number\">{}</td>", escape(&text));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody>\n</table></div></details>\n");
    html
}

/// Every run with its page, and the scenario.
fn runs(sweep: &SweepReport) -> String {
    let mut html = String::from("<table>\n<thead><tr><th>Run</th><th>Status</th></tr></thead>\n<tbody>\n");
    for case in &sweep.cases {
        let name = escape(&case.name);
        let name = match case.has_page {
            true => format!("<a href=\"{name}/report.html\">{name}</a>"),
            false => name,
        };
        let class = if case.status == "failed" { "differs" } else { "" };
        let error = if case.error.is_empty() { String::new() } else { format!(": {}", escape(&case.error)) };
        let _ = writeln!(
            html,
            "<tr><td>{name}</td><td><span class=\"{class}\">{}</span>{error}</td></tr>",
            case.status
        );
    }
    html.push_str("</tbody>\n</table>\n");
    let _ = writeln!(
        html,
        "<details><summary>Scenario of the first run</summary>\n<pre>{}</pre></details>",
        escape(sweep.scenario_text.trim_end())
    );
    html
}
