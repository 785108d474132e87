//! Why a log could not be written or read.

use std::path::{Path, PathBuf};

/// Why a log could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The file could not be created.
    #[error("cannot create the log {}: {source}", path.display())]
    Create {
        /// The log.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Something could not be written; what was flushed before is kept.
    #[error("cannot write to the log {}: {}; what was recorded before stands in the file", path.display(), root(source))]
    Write {
        /// The log.
        path: PathBuf,
        /// What went wrong.
        source: mcap::McapError,
    },
    /// The columns of the series cannot be written as they are.
    #[error("cannot write the log {}: {fault}", path.display())]
    Columns {
        /// The log.
        path: PathBuf,
        /// What is wrong with which column.
        fault: String,
    },
    /// The file could not be opened or read.
    #[error("cannot read the log {}: {source}", path.display())]
    Read {
        /// The log.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A folder, a pipe or a device.
    #[error("{} is not a file but a folder, a pipe or a device; a log is a file, `log.mcap` in the folder of its run", path.display())]
    NotAFile {
        /// What was named.
        path: PathBuf,
    },
    /// The file holds nothing.
    #[error("the log {} is empty: the run that should have written it never began to record", path.display())]
    Empty {
        /// The log.
        path: PathBuf,
    },
    /// The file is something else.
    #[error("{} is not an MCAP file; a run writes its log as `log.mcap` in its folder", path.display())]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
    /// An MCAP file of another program, or one cut off before anything was complete.
    #[error("{} is an MCAP file without the header of a grainflow log: another program wrote it, or it was cut off before anything was complete", path.display())]
    NoHeader {
        /// The file.
        path: PathBuf,
    },
    /// A newer program wrote it.
    #[error("the log {} has format {found}; this is grainflow {}, which reads format {} and older: use the version that wrote it ({writer}) or a later one", path.display(), env!("CARGO_PKG_VERSION"), super::schema::FORMAT)]
    Newer {
        /// The log.
        path: PathBuf,
        /// Its format.
        found: String,
        /// The version that wrote it, as far as it says so.
        writer: String,
    },
    /// Bytes of the file are not the ones that were written.
    #[error("the log {} is damaged near byte {position}: {reason}; copy it again from where it came from", path.display())]
    Damaged {
        /// The log.
        path: PathBuf,
        /// Bytes that had been read when it showed.
        position: u64,
        /// What does not fit.
        reason: String,
    },
    /// The states in it are of the other dimension.
    #[error("the states in the log {} have {found} dimensions, not {wanted}", path.display())]
    Dimension {
        /// The log.
        path: PathBuf,
        /// D in the log.
        found: u32,
        /// D that was asked for.
        wanted: usize,
    },
}

/// What the system said: the last of the reasons that stand one behind the other.
fn root(error: &dyn std::error::Error) -> &dyn std::error::Error {
    let mut root = error;
    while let Some(reason) = root.source() {
        root = reason;
    }
    root
}

impl LogError {
    pub(crate) fn write(path: &Path, source: impl Into<mcap::McapError>) -> Self {
        LogError::Write { path: path.to_owned(), source: source.into() }
    }
}
