//! The head of the page: title, what was compared, one sentence for each engine, and what went wrong.

use std::fmt::Write;

use super::judgement::{Judgement, judgements};
use super::{label, reference};
use crate::comparison::model::Comparison;
use crate::report::escape::escape;

/// Title, sentences, remarks.
pub(super) fn html(comparison: &Comparison) -> String {
    let mut html = format!(
        "<header>\n<p class=\"kicker\">grainflow · {} · comparison</p>\n<h1>{}</h1>\n<p class=\"lead\">{}</p>\n",
        escape(&comparison.scenario),
        escape(&comparison.title),
        escape(&sentence(comparison)),
    );
    for contestant in &comparison.contestants {
        for failure in &contestant.failures {
            let text = format!("{}: {failure}", contestant.label);
            let _ = writeln!(html, "<p class=\"warning\">{}</p>", escape(&text));
        }
    }
    let judged = judgements(comparison);
    if judged.iter().any(|judgement| judgement.quantities() > 0) {
        let cards: String = judged.iter().map(|judgement| card(comparison, judgement)).collect();
        let _ = writeln!(html, "<dl class=\"figures\">\n{cards}</dl>");
    }
    let remarks = comparison.remarks.iter().map(|remark| format!("<li>{}</li>", escape(remark)));
    let remarks: String = remarks.collect();
    if !remarks.is_empty() {
        let _ = writeln!(html, "<ul class=\"remarks\">{remarks}</ul>");
    }
    html.push_str("</header>\n");
    html
}

/// What stands beside what.
fn sentence(comparison: &Comparison) -> String {
    let others: Vec<&str> = (0..comparison.contestants.len())
        .filter(|place| *place != comparison.reference)
        .map(|place| label(comparison, place))
        .collect();
    let others = match others[..] {
        [] => return "Nothing to compare.".to_owned(),
        [one] => one.to_owned(),
        [ref first @ .., last] => format!("{} and {last}", first.join(", ")),
    };
    let beginning = match comparison.replicas {
        0 => String::new(),
        1 => ", from one initial state".to_owned(),
        number => format!(", each from the same {number} independent initial states"),
    };
    let shape = if comparison.dimension == 3 { "spheres" } else { "disks" };
    format!("{others} beside {}{beginning}, of {shape}.", reference(comparison))
}

/// An engine, with the number of quantities in which it agrees.
fn card(comparison: &Comparison, judgement: &Judgement) -> String {
    let (agreeing, all) = (judgement.agreeing, judgement.quantities());
    let class = if judgement.differing.is_empty() { "" } else { " class=\"doubt\"" };
    let mut notes = vec![format!("agrees with {}", reference(comparison))];
    if !judgement.differing.is_empty() {
        notes.push(format!("differs in {}", judgement.differing.len()));
    }
    if judgement.unknown > 0 {
        notes.push(format!("{} without errors to judge by", judgement.unknown));
    }
    if !judgement.not_steady.is_empty() {
        notes.push(format!("{} not steady, without verdict", judgement.not_steady.len()));
    }
    let notes: String = notes
        .iter()
        .enumerate()
        .map(|(k, note)| {
            let class = if k == 1 { class } else { "" };
            format!("<dd{class}>{}</dd>", escape(note))
        })
        .collect();
    format!(
        "<div><dt>{}</dt><dd>{agreeing} <small>of {all} quantities</small></dd>{notes}</div>\n",
        escape(&judgement.engine)
    )
}
