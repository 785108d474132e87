//! The table of figures, engine beside engine, with what theory says.

use std::fmt::Write;

use super::verdicts::verdict;
use super::with_unit;
use crate::comparison::model::{ComparedFigure, Comparison, Verdict};
use crate::number::{figure_text, in_words, number};
use crate::report::escape::escape;
use crate::report::other_plots::capital;
use crate::statistics::Trend;

/// The table; nothing where there are no figures.
pub(super) fn html(comparison: &Comparison) -> String {
    if comparison.figures.is_empty() {
        return String::new();
    }
    let mut html = String::from("<div class=\"references\"><table>\n<thead><tr><th>Figure</th>");
    for contestant in &comparison.contestants {
        let _ = write!(html, "<th>{}</th>", escape(&contestant.label));
    }
    html.push_str("<th>Theory</th></tr></thead>\n<tbody>\n");
    for figure in &comparison.figures {
        html.push_str(&row(comparison, figure));
    }
    html.push_str("</tbody>\n</table></div>\n");
    html
}

fn row(comparison: &Comparison, figure: &ComparedFigure) -> String {
    let name = capital(&with_unit(comparison, &in_words(&figure.name), figure.unit));
    let mut html = format!("<tr><td>{}</td>", escape(&name));
    for place in 0..comparison.contestants.len() {
        let value = figure.values.get(place).copied().flatten();
        let trend = figure.trends.get(place).copied().flatten();
        let text = value
            .map_or_else(|| "–".to_owned(), |value| figure_text(value.value, value.standard_error, trend));
        let difference = figure.differences.get(place).and_then(Option::as_ref);
        // What is not steady here says so in place of its number already.
        let verdict = difference
            .filter(|of| of.verdict != Verdict::NotSteady || trend.is_none_or(Trend::is_steady))
            .map(
                |of| {
                    if of.verdict == Verdict::NotSteady { ("borderline", "no verdict") } else { verdict(of) }
                },
            )
            .map_or_else(String::new, |(class, word)| format!("<br><span class=\"{class}\">{word}</span>"));
        let _ = write!(html, "<td class=\"number\">{}{verdict}</td>", escape(&text));
    }
    let theory = figure.theory.as_ref().map_or_else(String::new, |(value, source)| {
        format!("<span class=\"number\">{}</span><br>{}", escape(&number(*value, 4)), escape(source))
    });
    let _ = writeln!(html, "<td class=\"source\">{theory}</td></tr>");
    html
}
