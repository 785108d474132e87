//! Time, memory and disk that a run takes and that are not there.

use crate::machine::Machine;
use crate::scenario::check::{bytes, count_of, spoken};
use crate::scenario::cost::{self, Recordings};
use crate::scenario::estimate;
use crate::scenario::model::{Scenario, Spacing};
use crate::space::Vector;

/// Logs above this size are seldom meant [bytes].
const LARGE_LOG: f64 = 1e10;
/// Nobody waits longer for a run [s].
const LONGEST_WAIT: f64 = 30.0 * 86_400.0;

/// More recordings, or larger ones, than anybody wants.
pub(super) fn recordings<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let mut warnings = Vec::new();
    let recordings = cost::recordings(scenario);
    let key = if matches!(scenario.record.spacing, Spacing::Every(_)) { "every" } else { "frames" };
    // The number of steps is an estimate, and may be a little short.
    let is_thinned = scenario.affordable_frames().is_some();
    let too_few = |steps: &estimate::Estimate| !steps.open && recordings.wanted > 1.2 * (steps.most + 1.0);
    if let Some(steps) = estimate::steps(scenario).filter(|steps| !is_thinned && too_few(steps)) {
        warnings.push(format!(
            "record.{key} asks for {} recordings of about {} steps: every step will be recorded, none more often",
            count_of(recordings.wanted),
            count_of(steps.most)
        ));
    }
    warnings.extend(thinned(scenario, recordings));
    let size = cost::log_size(scenario);
    if size > LARGE_LOG {
        let remedy = if key == "every" { "a larger record.every" } else { "fewer record.frames" };
        warnings.push(format!(
            "the log takes about {} before compression; {remedy}, record.points or record.states make it smaller",
            bytes(size)
        ));
    }
    warnings
}

/// Records that are fewer than is asked for.
fn thinned<V: Vector>(scenario: &Scenario<V>, recordings: Recordings) -> Option<String> {
    let states = scenario.affordable_states();
    let is_less = scenario.affordable_frames().is_some()
        || scenario.affordable_full_every() > scenario.record.full_every
        || states < scenario.record.states;
    is_less.then(|| {
        format!(
            "so that its records do not take longer than the run, there are about {} recordings, {} of them full (with frame, \
             profiles, state hash and all columns), and {} before the end; record.share = \"all\" makes all that is asked for",
            count_of(recordings.made),
            count_of(recordings.full),
            match states {
                0 => "no state".to_owned(),
                1 => "one state".to_owned(),
                states => format!("{states} states"),
            }
        )
    })
}

/// More time than anybody has.
pub(super) fn patience<V: Vector>(scenario: &Scenario<V>) -> Vec<String> {
    let long = cost::seconds(scenario).filter(|seconds| seconds.least > LONGEST_WAIT);
    let warning = |seconds: estimate::Estimate| {
        format!(
            "the run takes about {} on one core; fewer grains, a longer step or a lower limit of [run] make it shorter",
            spoken(seconds.least)
        )
    };
    long.map(warning).into_iter().collect()
}

/// More memory than there is.
pub(super) fn memory<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    lacking(cost::memory(scenario), machine.memory, |needed, free| {
        format!(
            "the run takes about {needed} of memory, and {free} are free; take fewer grains, cells, frames or points"
        )
    })
}

/// A larger log than there is room for.
pub(super) fn disk<V: Vector>(scenario: &Scenario<V>, machine: Machine) -> Vec<String> {
    lacking(cost::log_size(scenario), machine.disk, |needed, free| {
        format!(
            "the log takes about {needed} before compression, and the disk has room for {free}; free some, choose another \
             --out, or take fewer record.frames, record.points or record.states"
        )
    })
}

/// What to say where more is needed than there is, if that is known [bytes].
fn lacking(needed: f64, there: Option<u64>, words: impl Fn(String, String) -> String) -> Vec<String> {
    let there = there.map(|bytes| bytes as f64).filter(|&there| needed > there);
    there.map(|there| words(bytes(needed), bytes(there))).into_iter().collect()
}
