//! The page: its sections in the order of a reader's questions.

use std::fmt::Write;

use serde_json::{Map, Value};

use super::escape::escape;
use super::evidence::Evidence;
use super::plot::{Plot, colour_bar};
use super::scene::Scene;
use super::setup::Setup;
use super::{colour::ColourMap, picture};
use super::{
    energy_plots, figures, header, heap_plots, other_plots, parameters, player, reference, shear_plots,
    wave_plots,
};
use crate::comparison::laws;
use crate::number::{count, number};
use crate::observe::measure::Dimension;
use crate::record::contents::{Frame, RunLog};

/// The whole page.
pub(super) fn page(log: &RunLog, summary: &Map<String, Value>) -> String {
    let setup = Setup::of(log, summary);
    let evidence = Evidence { log, summary, setup: &setup };
    let frames = player::chosen(&log.frames);
    let scene = Scene::of(&frames, log.walls.as_ref(), setup.kinds.largest_diameter(), !setup.has_gravity());
    let mut body = header::html(&evidence);
    body.push_str(&section("The run in motion", &grains(&frames, &scene, &setup)));
    let references = references(&evidence);
    body.push_str(&section("Beside theory and literature", &references));
    let density = wave_plots::plots(&evidence);
    let mut own = heap_plots::plots(&evidence);
    own.extend(shear_plots::plots(&evidence));
    let mut other = other_plots::plots(&evidence);
    // The density of a gas left to itself is no wave and no bed.
    if setup.is_undriven() { &mut other } else { &mut own }.extend(density);
    body.push_str(&section("What the scenario is about", &plots(&own)));
    body.push_str(&section("Energy and collisions", &plots(&energy_plots::plots(&evidence))));
    body.push_str(&section("Everything else that was recorded", &plots(&other)));
    body.push_str(&section("How it was made", &parameters::html(&evidence)));
    document(&setup.title, &body, log.metadata.get("version").map_or("", String::as_str))
}

/// A page of its own around `body`, in need of nothing else.
pub(super) fn document(title: &str, body: &str, version: &str) -> String {
    let version = if version.is_empty() { String::new() } else { format!(" {}", escape(version)) };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"icon\" href=\"data:,\">\n<title>{} · grainflow</title>\n<style>\n{}</style>\n</head>\n\
         <body>\n<main>\n{body}<footer>Written by grainflow{version}.</footer>\n</main>\n</body>\n</html>\n",
        escape(title),
        include_str!("page.css"),
    )
}

/// A section, or nothing when it has nothing to say.
pub(super) fn section(title: &str, content: &str) -> String {
    if content.is_empty() {
        String::new()
    } else {
        format!("<section>\n<h2>{title}</h2>\n{content}</section>\n")
    }
}

fn plots(plots: &[Plot]) -> String {
    if plots.is_empty() {
        return String::new();
    }
    format!("<div class=\"plots\">\n{}</div>\n", plots.iter().map(Plot::html).collect::<String>())
}

/// The player, and pictures that need no script.
fn grains(frames: &[&Frame], scene: &Scene, setup: &Setup) -> String {
    let shown: Vec<usize> = (0..frames.len()).filter(|k| !frames[*k].positions.is_empty()).collect();
    let [.., last] = shown[..] else {
        return String::new();
    };
    let mut chosen = vec![shown[0], shown[shown.len() / 2], last];
    chosen.dedup();
    // Flat pictures go below each other, the others side by side.
    let is_flat = scene.aspect() > 2.0 || chosen.len() < 3;
    let (class, width) = if is_flat { ("pictures", 1000.0) } else { ("pictures three", 640.0) };
    let mut html = String::new();
    if let Some(way) = way_of_gravity(scene, setup) {
        let _ = writeln!(html, "<p class=\"gravity\">{way}</p>");
    }
    html.push_str(&player::html(frames, scene, setup));
    let _ = writeln!(html, "<div class=\"{class}\">");
    for index in chosen {
        html.push_str(&picture_figure(frames[index], scene, scene.speeds[index], setup, width));
    }
    html.push_str("</div>\n");
    if scene.is_deep {
        html.push_str(
            "<p class=\"note\">Pictures look along the second axis; farther grains are paler.</p>\n",
        );
    }
    if setup.kinds.are_untold() {
        html.push_str(
            "<p class=\"note\">Grains differ in size, but no saved state says which is which: all are drawn alike.</p>\n",
        );
    }
    if figures::is_floor_untouched(setup) {
        html.push_str(
            "<p class=\"note\">HSMC keeps cells from overfilling, not grains from overlapping: inside a cell they may \
             settle in the same corner, so that dots hide behind each other and stand in rows. That is the method, \
             not the picture.</p>\n",
        );
    }
    let across = if scene.is_turned { scene.span(1) } else { scene.span(0) };
    if 0.5 * setup.diameter * width / across < picture::LEAST_RADIUS {
        html.push_str("<p class=\"note\">Grains are drawn larger than they are; at their size they could not be seen.</p>\n");
    }
    html
}

/// Which way grains fall on the pictures.
fn way_of_gravity(scene: &Scene, setup: &Setup) -> Option<String> {
    let axis = setup.gravity_axis()?;
    let falls_up = setup.gravity[axis] > 0.0;
    let (arrow, words) = match (axis, scene.is_deep, scene.is_turned) {
        (1, false, true) if falls_up => ("⟶", "Gravity points to the right: the box lies on its side."),
        (1, false, true) => ("⟵", "Gravity points to the left: the box lies on its side."),
        (0, _, false) if falls_up => ("⟶", "Gravity points to the right."),
        (0, _, false) => ("⟵", "Gravity points to the left."),
        (1, false, false) | (2, true, _) if falls_up => ("↑", "Gravity points up."),
        (1, false, false) | (2, true, _) => ("↓", "Gravity points down."),
        _ => return None,
    };
    Some(format!("<b>{arrow} g</b> {words}"))
}

fn picture_figure(frame: &Frame, scene: &Scene, fastest: f64, setup: &Setup, width: f64) -> String {
    let raster = picture::picture(frame, scene, fastest, &setup.kinds, width);
    let time = if setup.units[2] == "time" { "" } else { &setup.units[2] };
    let moment = format!("t = {} {time}", number(frame.time, 4));
    let moment = moment.trim_end();
    let shown = frame.positions.len() as u64;
    let grains = match frame.grains.max(shown) {
        all if all > shown => format!("{} of {} grains", count(shown as f64), count(all as f64)),
        1 => "1 grain".to_owned(),
        all => format!("{} grains", count(all as f64)),
    };
    let speed = setup.with_unit("speed", Dimension { mass: 0, length: 1, time: -1 });
    format!(
        "<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption>{}</figure>\n",
        raster.address(),
        escape(&format!("The grains at {moment}, coloured by speed")),
        escape(&format!("{moment} · {grains}")),
        colour_bar(ColourMap::Speed, "0", &number(fastest, 3), &speed),
    )
}

/// The table of references, with what it does not hold.
fn references(evidence: &Evidence<'_>) -> String {
    let rows = reference::references(evidence);
    let missing = missing_theory(evidence.setup);
    if rows.is_empty() {
        return missing;
    }
    let mut html = String::from(
        "<div class=\"references\"><table>\n<thead><tr><th>Figure</th><th>This run</th><th>Reference</th>\
         <th>Agreement</th><th>Source</th></tr></thead>\n<tbody>\n",
    );
    for row in &rows {
        let class = match row.agreement() {
            reference::Agreement::Holds => "holds",
            reference::Agreement::Borderline | reference::Agreement::NotSteady => "borderline",
            reference::Agreement::Differs => "differs",
        };
        let _ = writeln!(
            html,
            "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"{class}\"><b>{}</b></td>\
             <td class=\"source\">{}</td></tr>",
            escape(&crate::number::in_words(&row.figure)),
            escape(&row.measured_text()),
            escape(&row.expected.text()),
            escape(&row.words()),
            escape(&row.source),
        );
    }
    html.push_str("</tbody>\n</table></div>\n");
    let _ = writeln!(html, "<p class=\"note\">{}</p>", reference::REMARK);
    html.push_str(&missing);
    html
}

/// Why there is no theory where a reader would look for it.
fn missing_theory(setup: &Setup) -> String {
    let sentence = match (&setup.known, &setup.unreadable) {
        (Some(known), _) => laws::obstacle(&known.scenario).map(|obstacle| {
            format!(
                "No law of a homogeneous gas is shown: theory as it is used here does not know {obstacle}."
            )
        }),
        (None, Some(reason)) => Some(format!(
            "The scenario in the log cannot be read by this version ({}). So nothing is said of theory, of walls that move and \
             of what is poured, and grains are drawn with a diameter of {}.",
            reason.trim().replace('\n', " "),
            number(setup.diameter, 4)
        )),
        (None, None) => None,
    };
    sentence.map_or_else(String::new, |sentence| format!("<p class=\"note\">{}</p>\n", escape(&sentence)))
}
