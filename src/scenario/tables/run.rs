//! `[run]`.

use crate::scenario::bound::Bound;
use crate::scenario::model::RunLimits;
use crate::scenario::reader::Section;
use crate::scenario::schema;

/// Reads `[run]`.
pub(in crate::scenario) fn read(root: &Section<'_>) -> Option<RunLimits> {
    let run = root.section("run", schema::RUN);
    if root.has("run") && !run.exists() {
        return None;
    }
    let limits = RunLimits {
        time: run.number("time", Bound::POSITIVE).optional()?,
        steps: run.whole("steps", 1, 1_000_000_000_000_000).optional()?,
        collisions_per_particle: run.number("collisions_per_particle", Bound::POSITIVE).optional()?,
        rest: run.number("rest", Bound::NOT_NEGATIVE).optional()?,
    };
    if !schema::RUN.iter().any(|key| run.has(key)) {
        root.missing("run", "never ends; give at least one of time, steps, collisions_per_particle, rest");
        return None;
    }
    if limits.rest.is_some() && !root.has("source") {
        run.mistake("rest", "counts from the last poured grain, but there is no [source]; use time instead");
        return None;
    }
    Some(limits)
}
