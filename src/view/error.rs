//! Why a log could not be shown.

use std::path::PathBuf;

use crate::record::error::LogError;

/// Why a log could not be shown.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// A log could not be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The address is not free.
    #[error("cannot listen on 127.0.0.1:{port}: {source}; without --port a free one is chosen")]
    Listen {
        /// The port that was asked for.
        port: u16,
        /// What the system says.
        source: std::io::Error,
    },
    /// The system gives no random numbers.
    #[error("the system gives no random numbers for the token of the page: {0}")]
    Entropy(getrandom::Error),
    /// There is a file already.
    #[error("{} exists; --force replaces it", .0.display())]
    Exists(PathBuf),
    /// The page could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The page.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

impl ViewError {
    /// Whether what was asked for cannot be had, rather than that it failed.
    pub fn is_bad_input(&self) -> bool {
        matches!(self, ViewError::Log(_) | ViewError::Exists(_) | ViewError::Listen { .. })
    }
}
