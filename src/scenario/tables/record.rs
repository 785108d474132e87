//! `[record]`.

use crate::scenario::bound::Bound;
use crate::scenario::model::{RecordPlan, RunLimits, Spacing};
use crate::scenario::reader::{Section, number_of};
use crate::scenario::schema::{self, MEASURES};
use crate::scenario::tables::channels::{self, Channels, names};
use crate::simulation::schedule::ROUNDING;

/// The most recordings of one run.
const MOST_RECORDINGS: u64 = 1_000_000;
/// The most states of one run, beside the one at its end.
const MOST_STATES: u64 = 10_000;
/// The share of the time of a run that its recordings may take.
const USUAL_SHARE: f64 = 0.04;

/// Reads `[record]`; `limits` of the run as far as they are known.
pub(in crate::scenario) fn read(root: &Section<'_>, limits: Option<RunLimits>) -> Option<RecordPlan> {
    let record = root.section("record", schema::RECORD);
    if root.has("record") && !record.exists() {
        return None;
    }
    let spacing = spacing(&record, limits);
    let share = share(&record);
    let channels = channels::read(&record);
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
    let Channels { full_every, points, frames_every, profiles_every, fields, fields_every } = channels?;
    Some(RecordPlan {
        spacing: spacing?,
        share: share?,
        full_every,
        usual_full: !record.has("full"),
        points,
        frames_every,
        profiles_every,
        fields,
        fields_every,
        measures: measures?,
        states: states? as u32,
        usual_states: !record.has("states") && !record.has("state_every"),
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
        && time / every * (1.0 - ROUNDING) > MOST_RECORDINGS as f64
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

/// A number, or "all".
fn share(record: &Section<'_>) -> Option<Option<f64>> {
    const KEY: &str = "share";
    match record.item(KEY).map(|item| item.as_str()) {
        Some(Some("all")) => Some(None),
        Some(Some(text)) => {
            record.mistake(KEY, format!("\"{text}\" is not known; write a number from 0 to 1, or \"all\""));
            None
        }
        Some(None) if number_of(record.item(KEY)?).is_err() => {
            record.mistake(KEY, "is no number; write one from 0 to 1, or \"all\"");
            None
        }
        _ => record.number(KEY, Bound::SHARE).or(USUAL_SHARE).map(Some),
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
        && time / every * (1.0 - ROUNDING) > MOST_STATES as f64
    {
        let least = time / MOST_STATES as f64;
        record.mistake(KEY, format!("saves more than {MOST_STATES} states; give at least {least}"));
        return None;
    }
    Some(every)
}

fn measures(record: &Section<'_>) -> Option<Option<Vec<String>>> {
    const KEY: &str = "measures";
    if !record.has(KEY) {
        return Some(None);
    }
    names(record, KEY, "a measure", &MEASURES).map(Some)
}
