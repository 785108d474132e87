//! What a log says of the run that it holds: where it comes from, its parts, what is missing.

use std::collections::BTreeMap;
use std::path::Path;

use super::contents::EarlierPart;
use super::error::LogError;
use super::scan::{Event, Fault, scan};
use super::schema;

/// What a log says of its run, once all its checksums are seen to hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Version, numerics, seed, engine, units and the like, as `key = value`.
    pub metadata: BTreeMap<String, String>,
    /// The scenario as TOML text.
    pub scenario: String,
    /// What ran by other scenarios before, in the order of time.
    pub earlier: Vec<EarlierPart>,
    /// What is missing, as a sentence, where the file was cut off.
    pub cut_off: Option<String>,
    /// Whether messages in between are missing, as in some recovered logs.
    pub has_holes: bool,
}

impl History {
    /// Reads the log at `path` to its end.
    pub fn read(path: &Path) -> Result<Self, LogError> {
        let mut history = History::default();
        let mut earlier_scenarios = Vec::new();
        history.cut_off = scan(path, &mut |event| {
            match event {
                Event::Metadata(metadata) => history.metadata = metadata,
                Event::Scenario(text) => history.scenario = text,
                Event::Resumption(metadata) => history.earlier.push(
                    earlier(&metadata).ok_or_else(|| Fault::damage("a resumption says not where it was"))?,
                ),
                Event::EarlierScenario(text) => earlier_scenarios.push(text),
                Event::Hole { .. } => history.has_holes = true,
                Event::Channel { .. } | Event::Message { .. } => {}
            }
            Ok(())
        })?;
        if earlier_scenarios.len() != history.earlier.len() {
            let reason = "it has not one scenario for each of its parts".to_owned();
            return Err(LogError::Damaged { path: path.to_owned(), position: 0, reason });
        }
        for (part, text) in history.earlier.iter_mut().zip(earlier_scenarios) {
            part.scenario = text;
        }
        Ok(history)
    }

    /// The value of `key` in the metadata, or nothing.
    pub fn value(&self, key: &str) -> &str {
        self.metadata.get(key).map_or("", String::as_str)
    }

    /// Ticks of `log_time` per unit of simulated time.
    pub fn time_scale(&self) -> Option<u64> {
        self.value(schema::TIME_SCALE_KEY).parse().ok()
    }

    /// Whether the scenario is the one that the log was begun with; older logs cannot tell.
    pub fn has_own_scenario(&self) -> bool {
        let known = self.metadata.get(schema::DIGEST_KEY);
        known.is_none_or(|digest| *digest == schema::digest(&self.scenario))
    }
}

/// The part that ended at a resumption, without its scenario.
fn earlier(metadata: &BTreeMap<String, String>) -> Option<EarlierPart> {
    Some(EarlierPart {
        scenario: String::new(),
        time: metadata.get("time")?.parse().ok()?,
        steps: metadata.get("steps")?.parse().ok()?,
        events: metadata.get("events")?.parse().ok()?,
        changes: metadata.get("changes")?.clone(),
    })
}
