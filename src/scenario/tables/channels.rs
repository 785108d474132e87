//! `[record]`: how often each kind of thing is recorded, and which fields.

use crate::observe::field::Quantity;
use crate::scenario::reader::{Section, kind};
use crate::scenario::schema;
use crate::scenario::suggest::did_you_mean;

/// The rarest that something is recorded, in recordings.
const RAREST: u64 = 1_000_000;
/// Points of a frame unless the scenario says otherwise.
const USUAL_POINTS: u32 = 20_000;

/// What is recorded at which recordings.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Channels {
    /// Every n-th recording is full.
    pub(super) full_every: u32,
    /// Points of a frame, `None` for all.
    pub(super) points: Option<u32>,
    /// Every so manieth recording has a frame.
    pub(super) frames_every: u32,
    /// Every so manieth recording has profiles.
    pub(super) profiles_every: u32,
    /// Fields.
    pub(super) fields: Vec<Quantity>,
    /// Every so manieth recording has fields.
    pub(super) fields_every: u32,
}

/// Reads `full`, `points`, `particles`, `profiles` and `fields` of `record`.
pub(super) fn read(record: &Section<'_>) -> Option<Channels> {
    let full = record.section("full", schema::RECORD_FULL);
    let particles = record.section("particles", schema::RECORD_PARTICLES);
    let profiles = record.section("profiles", schema::RECORD_PROFILES);
    let sound = [("full", &full), ("particles", &particles), ("profiles", &profiles)]
        .iter()
        .all(|(key, section)| !record.has(key) || section.exists());
    let points = match record.has("points") && particles.has("points") {
        true => {
            record.mistake("points", "stands beside record.particles.points; keep one of the two");
            None
        }
        false => points(if particles.has("points") { &particles } else { record }),
    };
    let (full_every, frames_every, profiles_every) = (every(&full), every(&particles), every(&profiles));
    let (fields, fields_every) = fields(record)?;
    Some(Channels {
        points: points.filter(|_| sound)?,
        full_every: full_every?,
        frames_every: frames_every?,
        profiles_every: profiles_every?,
        fields,
        fields_every,
    })
}

fn every(section: &Section<'_>) -> Option<u32> {
    section.whole("every_nth", 1, RAREST).or(1).map(|every| every as u32)
}

fn points(section: &Section<'_>) -> Option<Option<u32>> {
    match section.item("points").map(|item| item.as_str()) {
        Some(Some("all")) => Some(None),
        Some(Some(text)) => {
            section.mistake("points", format!("\"{text}\" is not known; write a whole number or \"all\""));
            None
        }
        _ => {
            let points = section.whole("points", 1, u64::from(u32::MAX));
            points.or(u64::from(USUAL_POINTS)).map(|points| Some(points as u32))
        }
    }
}

/// A list of names, or a table with one.
fn fields(record: &Section<'_>) -> Option<(Vec<Quantity>, u32)> {
    const KEY: &str = "fields";
    let Some(item) = record.item(KEY) else { return Some((Vec::new(), 1)) };
    let (names, every) = if item.is_array() {
        (names(record, KEY, "a field", &known())?, 1)
    } else if item.as_table_like().is_some() {
        let table = record.section(KEY, schema::RECORD_FIELDS);
        if !table.has("names") {
            table.missing("names", "is missing; write names = [\"density\"]");
            return None;
        }
        (names(&table, "names", "a field", &known())?, every(&table)?)
    } else {
        record.mistake(
            KEY,
            format!("must be a list of names or a table, not {}; write [\"density\"]", kind(item)),
        );
        return None;
    };
    let chosen =
        Quantity::ALL.into_iter().filter(|quantity| names.iter().any(|name| name == quantity.name()));
    Some((chosen.collect(), every))
}

fn known() -> [&'static str; 6] {
    Quantity::ALL.map(Quantity::name)
}

/// The list of names under `key`, each of which is one of the `known`; `what` says what such a name is.
pub(super) fn names(section: &Section<'_>, key: &str, what: &str, known: &[&str]) -> Option<Vec<String>> {
    let item = section.item(key)?;
    let Some(list) = item.as_array() else {
        let example = known.first().unwrap_or(&"");
        let message = format!("must be a list of names, not {}; write [\"{example}\"]", kind(item));
        section.mistake(key, message);
        return None;
    };
    let mut names: Vec<String> = Vec::new();
    let mut sound = true;
    for value in list {
        match value.as_str() {
            Some(name) if known.contains(&name) => {
                if !names.iter().any(|other| other == name) {
                    names.push(name.to_owned());
                }
            }
            _ => {
                let name = value.as_str().map_or_else(|| value.to_string().trim().to_owned(), str::to_owned);
                let choose = format!("choose from {}", known.join(", "));
                let remedy = did_you_mean(&name, known.iter().copied(), &choose);
                section.mistake(key, format!("\"{name}\" is not {what}; {remedy}"));
                sound = false;
            }
        }
    }
    sound.then_some(names)
}
