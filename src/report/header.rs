//! The head of the page: title, one sentence on what ran, and the figures that count.

use std::fmt::Write;

use serde_json::Value;

use super::escape::escape;
use super::evidence::Evidence;
use super::figures;
use super::other_plots::capital;
use super::reference::{Reference, references};
use super::setup::Setup;
use crate::number::{NOT_STEADY, count, in_words, number, with_error};
use crate::observe::measure::Dimension;
use crate::record::summary::failure;
use crate::scenario::trust;

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
    html.push_str(&failure_words(evidence));
    if evidence.summary.get("interrupted") == Some(&Value::Bool(true)) {
        html.push_str("<p class=\"warning\">This run was interrupted before its end.</p>\n");
    }
    html.push_str(&known_faults(evidence));
    let references = references(evidence);
    let mut cards: String = references
        .iter()
        .filter(|row| row.figure.starts_with("cooling_time"))
        .map(|row| cooling_card(evidence, row))
        .collect();
    cards.extend(figures::of_the_physics(evidence).iter().map(|name| card(evidence, name, &references)));
    if !cards.is_empty() {
        let _ = writeln!(html, "<dl class=\"figures\">\n{cards}</dl>");
    }
    let facts = facts(evidence);
    if !facts.is_empty() {
        let _ = writeln!(html, "<dl class=\"figures facts\">\n{facts}</dl>");
    }
    html.push_str("</header>\n");
    html
}

/// That the run failed, when, why, and what to do; nothing where it did not.
fn failure_words(evidence: &Evidence<'_>) -> String {
    let Some(why) = failure(evidence.summary) else { return String::new() };
    let when = evidence.figure("simulated_time").map_or_else(String::new, |time| {
        format!(" after t = {} {}", number(time, 6), evidence.setup.named(2)).trim_end().to_owned()
    });
    format!(
        "<p class=\"warning\"><b>This run failed{}.</b> {}<br>Everything on this page is of the run up to then; the log holds its \
         last state before the failure.</p>\n",
        escape(&when),
        escape(why).replace('\n', "<br>"),
    )
}

/// Where the engine is known to be wrong, before the figures that it concerns.
fn known_faults(evidence: &Evidence<'_>) -> String {
    let Some(known) = &evidence.setup.known else { return String::new() };
    let doubts = trust::doubts(&known.scenario).into_iter().filter(|doubt| doubt.is_warning);
    doubts
        .map(|doubt| {
            let sentence = format!("Known of this engine here: {}.", doubt.sentence);
            format!("<p class=\"warning\">{}</p>\n", escape(&sentence))
        })
        .collect()
}

/// What ran, for how long, in one sentence.
fn sentence(evidence: &Evidence<'_>) -> String {
    let setup = evidence.setup;
    let shape = if setup.dimension == 3 { "spheres" } else { "disks" };
    let grains = evidence.figure("particles_final").filter(|n| *n > 0.0).or(setup.count);
    let mut text = match grains {
        Some(grains) => format!("{} {shape}", count(grains)),
        None => capital(shape),
    };
    text.push_str(&grains_are(setup));
    // A volume fraction of a box that is filled by pouring says nothing.
    if let Some(nu) = setup.volume_fraction.filter(|nu| *nu > 0.0 && setup.source().is_none()) {
        let _ = write!(text, " at volume fraction {}", number(nu, 3));
    }
    if !setup.size.is_empty() {
        let sides: Vec<String> = setup.size.iter().map(|s| number(*s, 4)).collect();
        let into = if setup.source().is_some() { "poured into" } else { "in" };
        let _ = write!(text, " {into} a box of {} {}", sides.join(" × "), setup.named(0));
    }
    text.push_str(match (setup.shear().is_some(), setup.has_gravity()) {
        (true, _) => ", sheared by its walls",
        (false, true) if setup.source().is_none() => ", under gravity",
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

/// What kind of grains they are, as far as the scenario can be read.
fn grains_are(setup: &Setup) -> String {
    let mut text = String::new();
    let Some(known) = &setup.known else { return text };
    if known.species > 1 {
        let _ = write!(text, " of {} kinds", known.species);
    }
    if known.is_rough {
        text.push_str(", rough,");
    }
    if let Some(restitution) = known.restitution {
        let _ = write!(text, " of restitution {}", number(restitution, 6));
    }
    text
}

fn engine_name(engine: &str) -> String {
    match engine {
        "dsmc" | "cba" | "hsmc" => engine.to_uppercase(),
        "event-driven" => "event-driven dynamics".to_owned(),
        other => other.to_owned(),
    }
}

/// A figure of the physics, with what is known about it below.
fn card(evidence: &Evidence<'_>, name: &str, references: &[Reference]) -> String {
    let Some(value) = evidence.figure(name) else {
        return String::new();
    };
    let mut notes = details(evidence, name);
    // A reference of a scaled figure belongs to the table only.
    notes.extend(
        references.iter().find(|r| r.figure == name).map(|r| format!("expected {}", r.expected.text())),
    );
    notes.extend(figures::known_faults(evidence, name));
    let unit = figures::unit_of(evidence, name);
    if let Some(trend) = evidence.unsteady(name) {
        let told = format!("{}, mean {} {unit}", trend.name(), number(value, 3));
        return entry(&in_words(name), NOT_STEADY, "", &notes, Some(told.trim_end()));
    }
    let text = with_error(value, evidence.standard_error(name));
    let doubt = figures::doubt(evidence, name);
    entry(&in_words(name), &text, &unit, &notes, doubt.as_deref())
}

/// t₀ is no figure of the summary: it is fitted here.
fn cooling_card(evidence: &Evidence<'_>, row: &Reference) -> String {
    let unit = evidence.setup.unit(Dimension { time: 1, ..Dimension::default() });
    entry(
        "cooling time t₀",
        &row.measured_text(),
        &unit,
        &[format!("expected {}", row.expected.text())],
        None,
    )
}

/// What belongs to a figure and would be a figure too many.
fn details(evidence: &Evidence<'_>, name: &str) -> Vec<String> {
    let parts: &[(&str, &str)] = match name {
        "heap_slope" => &[("left", "heap_slope_left"), ("right", "heap_slope_right")],
        "velocity_profile_slope" => &[("R² of the straight line", "velocity_profile_r_squared")],
        _ => &[],
    };
    let part = |(title, key): &(&str, &str)| Some(format!("{title} {}", number(evidence.figure(key)?, 4)));
    let parts: Vec<String> = parts.iter().filter_map(part).collect();
    if parts.is_empty() { parts } else { vec![parts.join(", ")] }
}

/// How much was run.
fn facts(evidence: &Evidence<'_>) -> String {
    let energy = figures::unit_of(evidence, "temperature");
    let facts = [
        ("particles_final", "grains at the end", String::new()),
        ("simulated_time", "simulated time", evidence.setup.named(2)),
        ("resumed_at", "resumed at", evidence.setup.named(2)),
        ("collisions_per_particle", "collisions per particle", String::new()),
        ("granular_temperature", "granular temperature at the end, about the local flow", energy.clone()),
        ("temperature", "temperature at the end, about the mean of all grains", energy),
        ("wall_seconds", "computing time", "s".to_owned()),
    ];
    let entries = facts.iter().filter_map(|(key, title, unit)| {
        let value = evidence.figure(key)?;
        let text = if *key == "particles_final" { count(value) } else { number(value, 4) };
        Some(entry(title, &text, unit, &[], None))
    });
    entries.collect()
}

/// A title with its value, unit, and lines below.
fn entry(title: &str, value: &str, unit: &str, notes: &[String], doubt: Option<&str>) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" <small>{}</small>", escape(unit)) };
    let notes: String = notes.iter().map(|note| format!("<dd>{}</dd>", escape(note))).collect();
    let doubt = doubt.map_or_else(String::new, |text| format!("<dd class=\"doubt\">{}</dd>", escape(text)));
    format!("<div><dt>{}</dt><dd>{}{unit}</dd>{doubt}{notes}</div>\n", escape(title), escape(value))
}
