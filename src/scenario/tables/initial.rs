//! `[initial]`.

use crate::scenario::bound::Bound;
use crate::scenario::model::{InitialPositions, InitialVelocities};
use crate::scenario::reader::{Section, kind};
use crate::scenario::schema;
use crate::scenario::suggest::did_you_mean;

/// `[initial]` as read; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct InitialTable {
    pub(in crate::scenario) positions: Option<InitialPositions>,
    /// `Some(None)` where it is not given.
    pub(in crate::scenario) velocities: Option<Option<InitialVelocities>>,
    pub(in crate::scenario) equilibrate: Option<f64>,
}

const POSITION_FORMS: &str = "\"random\", \"lattice\", \"compressed\" or { log = \"other/log.mcap\" }";
const VELOCITY_FORMS: &str = "{ maxwell = 1.0 }, { uniform = 1.0 } or \"rest\"";

/// Reads `[initial]`.
pub(in crate::scenario) fn read(root: &Section<'_>) -> InitialTable {
    let initial = root.section("initial", schema::INITIAL);
    let equilibrate = Bound::within(0.0, 1e6, "a number of collisions per particle from 0 to 1e6");
    InitialTable {
        positions: positions(&initial),
        velocities: velocities(&initial),
        equilibrate: initial.number("equilibrate", equilibrate).or(0.0),
    }
}

fn positions(initial: &Section<'_>) -> Option<InitialPositions> {
    const KEY: &str = "positions";
    let Some(item) = initial.item(KEY) else { return Some(InitialPositions::Random) };
    if item.is_table_like() {
        let table = initial.section(KEY, &["log"]);
        let log = table.text("log", "log = \"other/log.mcap\"");
        let log = log.required(&table, "log", "write { log = \"other/log.mcap\" }")?;
        if log.is_empty() {
            table.mistake("log", "is empty; give the path of a log");
            return None;
        }
        return Some(InitialPositions::Log(table.file("log", log)));
    }
    match item.as_str() {
        Some("random") => Some(InitialPositions::Random),
        Some("lattice") => Some(InitialPositions::Lattice),
        Some("compressed") => Some(InitialPositions::Compressed),
        Some(text) => {
            let remedy =
                did_you_mean(text, ["random", "lattice", "compressed"], &format!("write {POSITION_FORMS}"));
            initial.mistake(KEY, format!("\"{text}\" is not known; {remedy}"));
            None
        }
        None => {
            initial.mistake(KEY, format!("must be {POSITION_FORMS}, not {}", kind(item)));
            None
        }
    }
}

fn velocities(initial: &Section<'_>) -> Option<Option<InitialVelocities>> {
    const KEY: &str = "velocities";
    let Some(item) = initial.item(KEY) else { return Some(None) };
    match item.as_str() {
        Some("rest") => return Some(Some(InitialVelocities::Rest)),
        Some(text) => {
            let remedy = did_you_mean(text, ["rest"], &format!("write {VELOCITY_FORMS}"));
            initial.mistake(KEY, format!("\"{text}\" is not known; {remedy}"));
            return None;
        }
        None => {}
    }
    if !item.is_table_like() {
        initial.mistake(KEY, format!("must be {VELOCITY_FORMS}, not {}", kind(item)));
        return None;
    }
    let table = initial.section(KEY, &["maxwell", "uniform"]);
    let maxwell = table.number("maxwell", Bound::POSITIVE).map(InitialVelocities::Maxwell);
    let uniform = table.number("uniform", Bound::POSITIVE).map(InitialVelocities::Uniform);
    if table.has("maxwell") == table.has("uniform") {
        table.mistake_here(format!("takes exactly one form; write {VELOCITY_FORMS}"));
        return None;
    }
    maxwell.optional()?.or(uniform.optional()?).map(Some)
}
