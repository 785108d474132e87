//! The table of verdicts: every quantity, every engine, in words.

use std::fmt::Write;

use super::judgement::{Finding, findings};
use super::{label, moment};
use crate::comparison::model::{Comparison, Difference, Verdict};
use crate::number::{NOT_STEADY, in_words};
use crate::report::escape::escape;
use crate::report::other_plots::capital;

/// The table; nothing where nothing was compared.
pub(super) fn html(comparison: &Comparison) -> String {
    let findings = findings(comparison);
    if findings.is_empty() {
        return String::new();
    }
    let mut html = String::from(
        "<div class=\"references\"><table class=\"verdicts\">\n<thead><tr><th>Quantity</th><th>Engine</th><th>Verdict</th>\
         <th>In words</th></tr></thead>\n",
    );
    let same = |a: &Finding<'_>, b: &Finding<'_>| a.quantity == b.quantity && a.column == b.column;
    for group in findings.chunk_by(same) {
        html.push_str("<tbody>\n");
        for (place, finding) in group.iter().enumerate() {
            html.push_str("<tr>");
            if place == 0 {
                let name = escape(&name(finding));
                let _ = write!(html, "<td rowspan=\"{}\" class=\"quantity\">{name}</td>", group.len());
            }
            html.push_str(&cells(comparison, finding));
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody>\n");
    }
    html.push_str("</table></div>\n");
    html.push_str(
        "<p class=\"note\">Two differ where they are farther apart than the threshold: 3 standard errors for a single number, \
         more for a curve, which has many places at which chance could part them, and for errors that few runs tell. Of a profile that was taken at several \
         times the line tells of the one where they are farthest apart. A figure that is not steady in one of the two gets no verdict.</p>\n",
    );
    html
}

/// The quantity in words.
fn name(finding: &Finding<'_>) -> String {
    let quantity = capital(&in_words(finding.quantity));
    if finding.column.is_empty() { quantity } else { format!("{quantity}: {}", in_words(finding.column)) }
}

fn cells(comparison: &Comparison, finding: &Finding<'_>) -> String {
    let (class, word) = verdict(finding.difference);
    let time = finding.time.map_or_else(String::new, |time| format!(" ({})", moment(comparison, time)));
    format!(
        "<td class=\"engine\">{}</td><td class=\"{class}\"><b>{word}</b></td><td>{}{}</td>",
        escape(label(comparison, finding.contestant)),
        escape(&finding.difference.sentence),
        escape(&time)
    )
}

/// The class and the word of a verdict.
pub(super) fn verdict(difference: &Difference) -> (&'static str, &'static str) {
    match difference.verdict {
        Verdict::Agrees => ("holds", "agrees"),
        Verdict::Differs => ("differs", "differs"),
        Verdict::Unknown => ("borderline", "no errors"),
        Verdict::NotSteady => ("borderline", NOT_STEADY),
    }
}
