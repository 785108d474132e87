//! What a log holds, in words.

use std::path::Path;

use super::bad_input;
use crate::cli::{Exit, print_text};
use crate::number::exact;
use crate::record::overview::{Overview, overview};

/// Metadata that the first lines tell, in this order.
const HEAD: [(&str, &str); 6] = [
    ("title", "title"),
    ("scenario", "scenario"),
    ("engine", "engine"),
    ("dimension", "dimension"),
    ("seed", "seed"),
    ("version", "written by grainflow"),
];

pub(super) fn info(log: &Path) -> Exit {
    match overview(log) {
        Ok(found) => print_text(&told(log, &found)),
        Err(error) => bad_input(&error.to_string()),
    }
}

fn told(log: &Path, found: &Overview) -> String {
    let mut lines = vec![line("log", format!("{}, {}", log.display(), size(found.bytes)))];
    for (key, name) in HEAD {
        lines.extend(found.metadata.get(key).map(|value| line(name, value.clone())));
    }
    let rest = found.metadata.iter().filter(|(key, _)| HEAD.iter().all(|(known, _)| known != key));
    lines.extend(rest.map(|(key, value)| line(key, value.clone())));
    lines.push(line(
        "condition",
        found.cut_off.clone().unwrap_or_else(|| "whole, every checksum holds".to_owned()),
    ));
    for part in &found.resumptions {
        let value = |key: &str| part.get(key).map_or("?", String::as_str);
        lines.push(line("gone on", format!("at t = {}, with {}", value("time"), value("changes"))));
    }
    if found.lost > 0 {
        lines.push(line("lost before a recovery", format!("{} messages", found.lost)));
    }
    lines.push(line("recordings", recordings(found)));
    lines.push(line("frames", frames(found)));
    lines.push(line("saved states", states(found)));
    for (name, number) in &found.profiles {
        lines.push(line(&format!("profile {name}"), number.to_string()));
    }
    for (topic, channel) in &found.channels {
        let told = format!("{} messages, {} before compression", channel.messages, size(channel.bytes));
        lines.push(line(&format!("channel {topic}"), told));
    }
    let columns: Vec<&str> = found.columns.iter().map(|column| column.name.as_str()).collect();
    lines.push(line("columns", columns.join(", ")));
    lines.concat()
}

fn line(name: &str, value: String) -> String {
    format!("{name:<32} {value}\n")
}

fn recordings(found: &Overview) -> String {
    match (found.times.first(), found.times.last()) {
        (Some(first), Some(last)) => {
            format!("{}, from t = {} to {}", found.times.len(), exact(*first), exact(*last))
        }
        _ => "none".to_owned(),
    }
}

fn frames(found: &Overview) -> String {
    let most = format!("{} of up to {} grains", found.frames, found.most_grains);
    match found.thinned {
        0 => format!("{most}, all of them shown"),
        thinned => format!("{most}; {thinned} show up to {} points", found.most_points),
    }
}

fn states(found: &Overview) -> String {
    match found.states.len() {
        0 => "none".to_owned(),
        number => {
            let times: Vec<String> = found.states.iter().map(|(time, _)| exact(*time)).collect();
            format!("{number}, at t = {}", times.join(", "))
        }
    }
}

/// A size in bytes, or in a unit that makes it readable.
fn size(bytes: u64) -> String {
    const UNITS: [(f64, &str); 3] = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let value = bytes as f64;
    match UNITS.iter().find(|(unit, _)| value >= *unit) {
        Some((unit, name)) => format!("{:.1} {name}", value / unit),
        None => format!("{bytes} bytes"),
    }
}
