//! The table of costs, with ratios to the reference.

use std::fmt::Write;

use super::reference;
use crate::comparison::model::{Comparison, Contestant, Cost};
use crate::number::number;
use crate::report::escape::escape;

/// The table; nothing where nobody knows what anything cost.
pub(super) fn html(comparison: &Comparison) -> String {
    if comparison.contestants.iter().all(|contestant| contestant.cost.is_none()) {
        return String::new();
    }
    let mut html = format!(
        "<div class=\"references\"><table>\n<thead><tr><th>Engine</th><th>Whole run</th><th>Advancing alone</th>\
         <th>Beside {}</th><th>Speed</th><th>Memory</th></tr></thead>\n<tbody>\n",
        escape(reference(comparison))
    );
    let exact = comparison.contestants.get(comparison.reference).and_then(|contestant| contestant.cost);
    for (place, contestant) in comparison.contestants.iter().enumerate() {
        let beside = exact.filter(|_| place != comparison.reference);
        html.push_str(&row(contestant, beside));
    }
    html.push_str("</tbody>\n</table></div>\n");
    html.push_str(
        "<p class=\"note\">Means over the runs of an engine, one run at a time. Advancing is the time of the algorithm \
         alone, without start, measures and writing. Memory is the most that the program held during a run, with what \
         earlier runs left in it: a few ten MB.</p>\n",
    );
    html
}

fn row(contestant: &Contestant, exact: Option<Cost>) -> String {
    let mut html = format!("<tr><td class=\"engine\">{}</td>", escape(&contestant.label));
    let Some(cost) = contestant.cost else {
        html.push_str("<td colspan=\"5\">not known</td></tr>\n");
        return html;
    };
    let speed = match (cost.particle_steps_per_second, cost.events_per_second) {
        (Some(speed), _) => format!("{} million particle-steps/s", number(speed * 1e-6, 3)),
        (None, Some(speed)) => format!("{} million events/s", number(speed * 1e-6, 3)),
        (None, None) => String::new(),
    };
    let memory = cost.peak_memory.map_or_else(String::new, |bytes| format!("{} MB", number(bytes / 1e6, 3)));
    let ratio = exact.map_or_else(|| "the measure".to_owned(), |exact| beside(cost, exact));
    let seconds = |seconds: f64| format!("{} s", number(seconds, 3));
    for cell in [seconds(cost.wall_seconds), seconds(cost.advancing_seconds), ratio, speed, memory] {
        let _ = write!(html, "<td class=\"number\">{}</td>", escape(&cell));
    }
    html.push_str("</tr>\n");
    html
}

/// How many times faster or slower the algorithm is.
fn beside(cost: Cost, exact: Cost) -> String {
    let ratio = exact.advancing_seconds / cost.advancing_seconds;
    if !ratio.is_finite() || ratio <= 0.0 {
        "too short to tell".to_owned()
    } else if ratio >= 1.0 {
        format!("{} times faster", number(ratio, 3))
    } else {
        format!("{} times slower", number(1.0 / ratio, 3))
    }
}
