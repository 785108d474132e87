//! Why an export could not be made.

use std::path::PathBuf;

use super::target::TargetError;
use crate::record::error::LogError;
use crate::replay::ScenarioUnknown;

/// Why an export could not be made. Nothing is left of it.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The scenario in the log is not understood.
    #[error(transparent)]
    Scenario(#[from] ScenarioUnknown),
    /// The place cannot be used or written to.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// There is nothing to export.
    #[error("{} has no {what} {words}: {span}", log.display())]
    Nothing {
        /// The log.
        log: PathBuf,
        /// What was looked for.
        what: &'static str,
        /// The span that was asked for.
        words: String,
        /// What there is.
        span: String,
    },
    /// Sizes of grains are not known.
    #[error("{} holds a mixture and no complete state, and only states say which grain is of which species: its radii cannot be told", log.display())]
    UnknownSpecies {
        /// The log.
        log: PathBuf,
    },
    /// The grid of fields would be too fine.
    #[error("--cell-size {side} makes more than {most} cells; give a larger one")]
    TooManyCells {
        /// The wished side [length].
        side: f64,
        /// The most cells.
        most: usize,
    },
    /// Somebody stopped it.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

impl ExportError {
    /// Whether the input is at fault, rather than the disk.
    pub fn is_bad_input(&self) -> bool {
        match self {
            ExportError::Target(error) => error.is_bad_input(),
            ExportError::Interrupted => false,
            _ => true,
        }
    }
}
