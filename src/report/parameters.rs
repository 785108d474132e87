//! How the run was made: scenario, metadata, costs, and the hash that identifies its end.

use std::fmt::Write;

use serde_json::Value;

use super::escape::escape;
use super::evidence::Evidence;
use super::figures;
use crate::number::{count, in_words, number};

/// Folded tables and the text of the scenario.
pub(super) fn html(evidence: &Evidence<'_>) -> String {
    let mut html = String::new();
    let costs = costs(evidence);
    if !costs.is_empty() {
        let _ = writeln!(html, "<p>{}</p>", escape(&costs));
    }
    let hash = evidence.summary.get("state_hash").and_then(Value::as_str);
    if let Some(hash) = hash.or_else(|| evidence.log.state_hashes.last().map(String::as_str)) {
        let _ =
            writeln!(html, "<p>State at the end, SHA-256: <span class=\"hash\">{}</span></p>", escape(hash));
    }
    if !evidence.log.scenario.is_empty() {
        let _ = writeln!(
            html,
            "<details><summary>Scenario</summary>\n<pre>{}</pre></details>",
            escape(evidence.log.scenario.trim_end())
        );
    }
    let counters = figures::counters(evidence);
    let counters = counters.into_iter().map(|(name, value)| (in_words(name), whole(value)));
    html.push_str(&folded("What the engine counted", counters));
    let metadata = evidence.log.metadata.iter().map(|(key, value)| (key.clone(), value.clone()));
    html.push_str(&folded("Metadata of the log", metadata));
    let summary = evidence.summary.iter().map(|(key, value)| (in_words(key), text(value)));
    html.push_str(&folded("Summary, in full", summary));
    html
}

/// What the run cost, in a sentence.
fn costs(evidence: &Evidence<'_>) -> String {
    let mut parts = Vec::new();
    if let Some(seconds) = evidence.figure("wall_seconds") {
        let threads = evidence.figure("threads").map_or_else(String::new, |t| match t {
            1.0 => " on 1 thread".to_owned(),
            t => format!(" on {} threads", number(t, 6)),
        });
        parts.push(format!("It took {} s{threads}", number(seconds, 3)));
    }
    for (key, name) in [("particle_steps_per_second", "particle steps"), ("events_per_second", "events")] {
        if let Some(rate) = evidence.figure(key).filter(|rate| *rate > 0.0) {
            parts.push(format!("{} {name} per second", number(rate, 3)));
        }
    }
    if let Some(bytes) = evidence.figure("peak_memory_bytes") {
        parts.push(format!("{} MB of memory at most", number(bytes / 1e6, 3)));
    }
    if parts.is_empty() { String::new() } else { format!("{}.", parts.join(", ")) }
}

/// A count; a share has digits behind its point.
fn whole(value: f64) -> String {
    if value.fract() == 0.0 { count(value) } else { number(value, 3) }
}

fn text(value: &Value) -> String {
    match value {
        Value::Null => "does not apply".to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A folded table of keys and values; nothing when it is empty.
fn folded(title: &str, rows: impl Iterator<Item = (String, String)>) -> String {
    let rows: String = rows
        .map(|(key, value)| format!("<tr><td>{}</td><td>{}</td></tr>\n", escape(&key), escape(&value)))
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    format!("<details><summary>{title}</summary>\n<table><tbody>\n{rows}</tbody></table></details>\n")
}
