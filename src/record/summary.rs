//! The summary of a run, which stands beside its log.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

/// What the summary of a run is called in the run's folder.
pub const SUMMARY: &str = "summary.json";

/// The `end_reason` of a run that could not go on.
pub const FAILED: &str = "failed";

/// Why the run of `summary` could not go on; `None` where it could.
pub fn failure(summary: &Map<String, Value>) -> Option<&str> {
    let has_failed = summary.get("end_reason").and_then(Value::as_str) == Some(FAILED);
    has_failed
        .then(|| summary.get("failure").and_then(Value::as_str).unwrap_or("the summary does not say why"))
}

/// A summary that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct SummaryError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub reason: String,
}

/// The summary in a run's `folder`; `None` where there is none.
pub fn summary_in(folder: &Path) -> Result<Option<Map<String, Value>>, SummaryError> {
    let path = folder.join(SUMMARY);
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(SummaryError { path, reason: error.to_string() }),
    };
    serde_json::from_str(&text).map(Some).map_err(|error| SummaryError { path, reason: error.to_string() })
}

/// The summary beside `log`.
pub fn summary_beside(log: &Path) -> Result<Option<Map<String, Value>>, SummaryError> {
    summary_in(log.parent().unwrap_or(Path::new("")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_that_is_none_is_told_and_one_that_is_missing_is_not() {
        let place = tempfile::tempdir().unwrap();
        let log = place.path().join("log.mcap");
        assert_eq!(summary_beside(&log), Ok(None));
        std::fs::write(place.path().join(SUMMARY), "{\"steps\": 3").unwrap();
        let said = summary_beside(&log).unwrap_err().to_string();
        assert!(said.contains("summary.json: EOF"), "{said}");
        std::fs::write(place.path().join(SUMMARY), "{\"steps\": 3}").unwrap();
        assert_eq!(summary_in(place.path()).unwrap().unwrap()["steps"], 3);
    }
}
