//! How a comparison was made: its runs, its program, its scenario.

use std::fmt::Write;

use crate::comparison::model::Comparison;
use crate::report::escape::escape;

/// The runs, and folded the scenario.
pub(super) fn html(comparison: &Comparison) -> String {
    let mut html = String::new();
    let runs: String = comparison
        .contestants
        .iter()
        .map(|contestant| {
            let links: Vec<String> = contestant.folders.iter().map(|folder| link(folder)).collect();
            let links = if links.is_empty() { "none came to its end".to_owned() } else { links.join(", ") };
            format!("<tr><td class=\"engine\">{}</td><td>{links}</td></tr>\n", escape(&contestant.label))
        })
        .collect();
    if !runs.is_empty() {
        let _ = writeln!(
            html,
            "<table class=\"runs\"><thead><tr><th>Engine</th><th>Runs</th></tr></thead><tbody>\n{runs}</tbody></table>"
        );
    }
    let mut facts = vec![format!("seed {}", comparison.seed)];
    if !comparison.version.is_empty() {
        facts.push(format!("grainflow {}, numerics {}", comparison.version, comparison.numerics));
    }
    let _ = writeln!(html, "<p class=\"note\">{}.</p>", escape(&facts.join(", ")));
    if !comparison.scenario_text.is_empty() {
        let _ = writeln!(
            html,
            "<details><summary>Scenario</summary>\n<pre>{}</pre></details>",
            escape(comparison.scenario_text.trim_end())
        );
    }
    html
}

/// The report of a run beside this page; a log is named only.
fn link(folder: &str) -> String {
    let name = escape(folder);
    let is_beside = folder.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if is_beside { format!("<a href=\"{name}/report.html\">{name}</a>") } else { name }
}
