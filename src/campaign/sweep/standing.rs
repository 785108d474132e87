//! What the folder of a case holds already: judged by what stands in it, not by its name.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value};

use crate::record::LOG;
use crate::record::error::LogError;
use crate::record::reader::{Origin, read_origin};
use crate::record::summary::{failure, summary_in};
use crate::run::{NUMERICS, OBSERVATION, OBSERVATION_KEY};
use crate::scenario::model::AnyScenario;

/// The version that writes.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What a folder holds of a case.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Standing {
    /// Nothing.
    Missing,
    /// The whole run, with its summary.
    Finished(Map<String, Value>),
    /// The beginning of the same run, which was interrupted or failed.
    Unfinished,
    /// The same run, which was finished; its log is no longer whole, and what is missing.
    Cut(String),
    /// Something else, and what tells so.
    Foreign(String),
}

/// What `folder` holds of the run of `scenario`.
pub(super) fn standing(folder: &Path, scenario: &AnyScenario) -> Standing {
    if !folder.is_dir() {
        return if folder.exists() { Standing::Foreign("is a file".to_owned()) } else { Standing::Missing };
    }
    match fs::read_dir(folder).map(|mut entries| entries.next().is_none()) {
        Ok(true) => return Standing::Missing,
        Ok(false) => {}
        Err(error) => return Standing::Foreign(format!("cannot be read: {error}")),
    }
    let Origin { metadata, scenario: text, last_hash, cut_off } = match read_origin(&folder.join(LOG)) {
        Ok(Origin { scenario, cut_off: Some(cut_off), .. }) if scenario.is_empty() => {
            return Standing::Foreign(format!("does not say which run it is of: {cut_off}"));
        }
        Ok(origin) => origin,
        Err(LogError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            return Standing::Foreign("holds no log".to_owned());
        }
        Err(error) => return Standing::Foreign(format!("has a log that cannot be used: {error}")),
    };
    let wanted = scenario.clone().with_affordable_recordings();
    if let Some(difference) = difference(&text, wanted.source_text()) {
        return Standing::Foreign(difference);
    }
    let of_log = |key: &str| metadata.get(key).map_or("?", String::as_str);
    if let Some(other) = other_program(of_log("version"), of_log("numerics")) {
        return Standing::Foreign(other);
    }
    let observation = metadata.get(OBSERVATION_KEY).map_or("1", String::as_str);
    if observation != OBSERVATION.to_string() {
        return Standing::Foreign(format!(
            "was written by a release whose figures mean other things: observation {observation}, this is {OBSERVATION}"
        ));
    }
    let summary = match summary_in(folder) {
        Ok(Some(summary)) => summary,
        Ok(None) => return Standing::Unfinished,
        Err(error) => return Standing::Foreign(format!("has a summary that cannot be used: {error}")),
    };
    let of_summary = |key: &str| summary.get(key).map(ToString::to_string).unwrap_or_default();
    if let Some(other) = other_program(of_summary("version").trim_matches('"'), &of_summary("numerics")) {
        return Standing::Foreign(other);
    }
    if summary.get("interrupted") != Some(&Value::Bool(false)) || failure(&summary).is_some() {
        return Standing::Unfinished;
    }
    if let Some(cut_off) = cut_off {
        return Standing::Cut(cut_off);
    }
    if summary.get("state_hash").and_then(Value::as_str) != Some(&last_hash) {
        return Standing::Foreign("has a summary and a log that end in different states".to_owned());
    }
    Standing::Finished(summary)
}

/// Says so where another program wrote a run.
fn other_program(version: &str, numerics: &str) -> Option<String> {
    let is_same = version == VERSION && numerics == NUMERICS.to_string();
    (!is_same).then(|| {
        format!(
            "was written by version {version} with numerics {numerics}, this is {VERSION} with {NUMERICS}"
        )
    })
}

/// The first line in which a stored scenario differs from the one that is wanted.
fn difference(stored: &str, wanted: &str) -> Option<String> {
    if stored == wanted {
        return None;
    }
    let lines = |text: &'_ str| text.lines().map(str::trim_end).map(str::to_owned).collect::<Vec<_>>();
    let (stored, wanted) = (lines(stored), lines(wanted));
    let line = (0..stored.len().max(wanted.len())).find(|&k| stored.get(k) != wanted.get(k)).unwrap_or(0);
    let shown =
        |lines: &[String]| lines.get(line).map_or("nothing".to_owned(), |line| format!("`{}`", line.trim()));
    Some(format!(
        "holds a run of another scenario: line {} has {} where {} is wanted",
        line + 1,
        shown(&stored),
        shown(&wanted)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_shown() {
        assert_eq!(difference("a\nb\n", "a\nb\n"), None);
        let said = difference("a\nb = 1\n", "a\nb = 2\n").unwrap();
        assert!(said.ends_with("line 2 has `b = 1` where `b = 2` is wanted"), "{said}");
        assert!(difference("a\n", "a\nb\n").unwrap().contains("has nothing where `b`"));
    }

    #[test]
    fn other_versions_are_named() {
        assert_eq!(other_program(VERSION, &NUMERICS.to_string()), None);
        assert!(other_program(VERSION, "0").unwrap().contains("numerics 0"));
    }
}
