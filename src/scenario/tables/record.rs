//! `[record]`.

use crate::scenario::bound::Bound;
use crate::scenario::model::{RecordPlan, RunLimits, Spacing};
use crate::scenario::reader::{Section, kind};
use crate::scenario::schema::{self, MEASURES};
use crate::scenario::suggest::did_you_mean;

/// The most recordings of one run.
const MOST_RECORDINGS: u64 = 1_000_000;
/// The most states of one run, beside the one at its end.
const MOST_STATES: u64 = 10_000;
/// Points of a frame unless `record.points` says otherwise.
const USUAL_POINTS: u32 = 20_000;

/// Reads `[record]`; `limits` of the run as far as they are known.
pub(in crate::scenario) fn read(root: &Section<'_>, limits: Option<RunLimits>) -> Option<RecordPlan> {
    let record = root.section("record", schema::RECORD);
    if root.has("record") && !record.exists() {
        return None;
    }
    let spacing = spacing(&record, limits);
    let points = points(&record);
    let measures = measures(&record);
    let states = record.whole("states", 0, MOST_STATES).or(4);
    let state_every = state_every(&record, limits);
    let from = record.number("from", Bound::NOT_NEGATIVE).optional();
    if let (Some(Some(from)), Some(RunLimits { time: Some(time), .. })) = (from, limits)
        && from >= time
    {
        record.mistake(
            "from",
            format!("{from} is not before the end of the run at {time}; choose an earlier time"),
        );
        return None;
    }
    Some(RecordPlan {
        spacing: spacing?,
        points: points?,
        measures: measures?,
        states: states? as u32,
        state_every: state_every?,
        from: from?,
    })
}

fn spacing(record: &Section<'_>, limits: Option<RunLimits>) -> Option<Spacing> {
    let frames = record.whole("frames", 0, MOST_RECORDINGS).or(200);
    let every = record.number("every", Bound::POSITIVE).optional();
    let logarithmic = record.choice("spacing", &[("even", false), ("log", true)]).or(false);
    for other in ["frames", "spacing"] {
        if record.has("every") && record.has(other) {
            record.mistake(other, "stands beside every; keep one of the two");
            return None;
        }
    }
    if let (Some(Some(every)), Some(RunLimits { time: Some(time), .. })) = (every, limits)
        && time / every > MOST_RECORDINGS as f64
    {
        let least = time / MOST_RECORDINGS as f64;
        record
            .mistake("every", format!("makes more than {MOST_RECORDINGS} recordings; give at least {least}"));
        return None;
    }
    let only_rest = limits.is_some_and(|limits| RunLimits { rest: None, ..limits } == RunLimits::default());
    match (every?, logarithmic?, frames? as u32) {
        (Some(every), _, _) => Some(Spacing::Every(every)),
        (None, _, 0) => Some(Spacing::Ends),
        (None, true, _) if only_rest => {
            record.mistake(
                "spacing",
                "\"log\" needs run.time, run.steps or run.collisions_per_particle; give one",
            );
            None
        }
        (None, true, frames) => Some(Spacing::LogFrames(frames)),
        (None, false, frames) => Some(Spacing::Frames(frames)),
    }
}

fn state_every(record: &Section<'_>, limits: Option<RunLimits>) -> Option<Option<f64>> {
    const KEY: &str = "state_every";
    let every = record.number(KEY, Bound::POSITIVE).optional()?;
    if record.has(KEY) && record.has("states") {
        record.mistake("states", "stands beside state_every; keep one of the two");
        return None;
    }
    if let (Some(every), Some(RunLimits { time: Some(time), .. })) = (every, limits)
        && time / every > MOST_STATES as f64
    {
        let least = time / MOST_STATES as f64;
        record.mistake(KEY, format!("saves more than {MOST_STATES} states; give at least {least}"));
        return None;
    }
    Some(every)
}

fn points(record: &Section<'_>) -> Option<Option<u32>> {
    match record.item("points").map(|item| item.as_str()) {
        Some(Some("all")) => Some(None),
        Some(Some(text)) => {
            record.mistake("points", format!("\"{text}\" is not known; write a whole number or \"all\""));
            None
        }
        _ => {
            let points = record.whole("points", 1, u64::from(u32::MAX));
            points.or(u64::from(USUAL_POINTS)).map(|points| Some(points as u32))
        }
    }
}

fn measures(record: &Section<'_>) -> Option<Option<Vec<String>>> {
    const KEY: &str = "measures";
    let Some(item) = record.item(KEY) else { return Some(None) };
    let Some(list) = item.as_array() else {
        record.mistake(KEY, format!("must be a list of names, not {}; write [\"energy\"]", kind(item)));
        return None;
    };
    let mut names: Vec<String> = Vec::new();
    let mut sound = true;
    for value in list {
        match value.as_str() {
            Some(name) if MEASURES.contains(&name) => {
                if !names.iter().any(|known| known == name) {
                    names.push(name.to_owned());
                }
            }
            _ => {
                let name = value.as_str().map_or_else(|| value.to_string().trim().to_owned(), str::to_owned);
                let choose = format!("choose from {}", MEASURES.join(", "));
                let remedy = did_you_mean(&name, MEASURES.iter().copied(), &choose);
                record.mistake(KEY, format!("\"{name}\" is not a measure; {remedy}"));
                sound = false;
            }
        }
    }
    sound.then_some(Some(names))
}
