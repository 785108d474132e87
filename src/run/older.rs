//! Logs of earlier versions, in which measures remember other things than they do now.

use super::OBSERVATION;

/// Whether a log that says `observation` of itself, or nothing, remembers what this program does.
pub(super) fn observes_alike(observation: &str) -> bool {
    observation == OBSERVATION.to_string()
}
