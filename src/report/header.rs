//! The head of the page: title, one sentence on what ran, and the figures that count.

use std::fmt::Write;

use serde_json::Value;

use super::escape::escape;
use super::evidence::Evidence;
use super::number::{in_words, number, with_error};
use super::other_plots::capital;
use super::reference::{Comparison, comparisons};

/// Keys of the summary that every run has; all others are figures of its scenario.
pub(super) const COMMON: [&str; 27] = [
    "scenario",
    "engine",
    "dimension",
    "particles_initial",
    "particles_final",
    "volume_fraction",
    "seed",
    "threads",
    "version",
    "numerics",
    "steps",
    "steps_capped",
    "events",
    "collisions",
    "collisions_per_particle",
    "simulated_time",
    "end_reason",
    "interrupted",
    "kinetic_energy_initial",
    "kinetic_energy_final",
    "temperature",
    "momentum_drift",
    "wall_seconds",
    "particle_steps_per_second",
    "events_per_second",
    "peak_memory_bytes",
    "state_hash",
];

/// Title, sentence, figures.
pub(super) fn html(evidence: &Evidence<'_>) -> String {
    let setup = evidence.setup;
    let mut html = format!(
        "<header>\n<p class=\"kicker\">grainflow · {} · {}</p>\n<h1>{}</h1>\n<p class=\"lead\">{}</p>\n",
        escape(&setup.scenario),
        escape(&setup.engine),
        escape(&setup.title),
        escape(&sentence(evidence)),
    );
    if evidence.summary.get("interrupted") == Some(&Value::Bool(true)) {
        html.push_str("<p class=\"warning\">This run was interrupted before its end.</p>\n");
    }
    let references = comparisons(evidence);
    let cards: String = own_figures(evidence).iter().map(|name| card(evidence, name, &references)).collect();
    let common: String =
        ["particles_final", "simulated_time", "collisions_per_particle", "temperature", "wall_seconds"]
            .iter()
            .map(|name| card(evidence, name, &references))
            .collect();
    if !(cards.is_empty() && common.is_empty()) {
        let _ = writeln!(html, "<dl class=\"figures\">\n{cards}{common}</dl>");
    }
    html.push_str("</header>\n");
    html
}

/// What ran, for how long, in one sentence.
fn sentence(evidence: &Evidence<'_>) -> String {
    let setup = evidence.setup;
    let shape = if setup.dimension == 3 { "spheres" } else { "disks" };
    let count = evidence.figure("particles_final").filter(|n| *n > 0.0).or(setup.count);
    let mut text = match count {
        Some(count) => format!("{} {shape}", number(count, 9)),
        None => capital(shape),
    };
    if let Some(restitution) = setup.restitution {
        let _ = write!(text, " of restitution {}", number(restitution, 6));
    }
    // A volume fraction of a box that is filled by pouring says nothing.
    if let Some(nu) = setup.volume_fraction.filter(|nu| *nu > 0.0 && setup.source.is_none()) {
        let _ = write!(text, " at volume fraction {}", number(nu, 3));
    }
    if !setup.size.is_empty() {
        let sides: Vec<String> = setup.size.iter().map(|s| number(*s, 5)).collect();
        let into = if setup.source.is_some() { "poured into" } else { "in" };
        let _ = write!(text, " {into} a box of {} {}", sides.join(" × "), setup.named(0));
    }
    text.push_str(match (setup.wall_velocities.is_some(), setup.has_gravity()) {
        (true, _) => ", sheared by its walls",
        (false, true) if setup.source.is_none() => ", under gravity",
        _ => "",
    });
    let _ = write!(text, ", simulated with {}", engine_name(&setup.engine));
    if let Some(time) = evidence.figure("simulated_time") {
        let _ = write!(text, " for {} {}", number(time, 4), setup.named(2));
    }
    if let Some(collisions) = evidence.figure("collisions_per_particle") {
        let _ = write!(text, " and {} collisions per particle", number(collisions, 4));
    }
    text.push('.');
    text
}

fn engine_name(engine: &str) -> String {
    match engine {
        "dsmc" | "cba" | "cuba" | "esmc" | "hsmc" => engine.to_uppercase(),
        "event-driven" => "event-driven dynamics".to_owned(),
        other => other.to_owned(),
    }
}

/// Figures of the scenario itself that have a value, in the order of their names.
pub(super) fn own_figures<'a>(evidence: &Evidence<'a>) -> Vec<&'a str> {
    let names = evidence.summary.keys().map(String::as_str);
    names
        .filter(|name| !COMMON.contains(name) && !name.ends_with("_standard_error"))
        .filter(|name| evidence.figure(name).is_some())
        .collect()
}

/// A figure, with what is known about it below.
fn card(evidence: &Evidence<'_>, name: &str, references: &[Comparison]) -> String {
    let Some(value) = evidence.figure(name) else {
        return String::new();
    };
    let error = evidence.standard_error(name);
    let is_count = value.fract() == 0.0 && value.abs() < 1e9;
    let text = if is_count { number(value, 10) } else { with_error(value, error) };
    // A reference of a scaled figure belongs to the table only.
    let known = references
        .iter()
        .find(|r| r.figure == name)
        .map_or_else(String::new, |r| format!("<dd>expected {}</dd>", escape(&r.expected.text())));
    let unit = evidence.column(name).map_or_else(String::new, |(_, column)| evidence.setup.unit(column.unit));
    let unit = match name {
        "simulated_time" => evidence.setup.named(2),
        "wall_seconds" => "s".to_owned(),
        _ => unit,
    };
    let title = if name == "wall_seconds" { "computing time".to_owned() } else { in_words(name) };
    let unit = if unit.is_empty() { unit } else { format!(" <small>{}</small>", escape(&unit)) };
    format!("<div><dt>{}</dt><dd>{}{unit}</dd>{known}</div>\n", escape(&title), escape(&text))
}
