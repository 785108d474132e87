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
    /// There is a file where a new log should stand.
    #[error("{} exists already and is left as it is; choose another file with --out", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
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
    #[error("the log {} is damaged near byte {position}: {reason}; copy it again from where it came from, or save what is sound with `grainflow recover`", path.display())]
    Damaged {
        /// The log.
        path: PathBuf,
        /// Bytes that had been read when it showed.
        position: u64,
        /// What does not fit.
        reason: String,
    },
    /// Its chunks are compressed in a way that is not read here.
    #[error("the log {} has chunks compressed by {compression:?}, and this program reads zstd and chunks without compression: write it again with `mcap compress {} --compression zstd --output NEW.mcap`", path.display(), path.display())]
    Compression {
        /// The log.
        path: PathBuf,
        /// What the chunks say.
        compression: String,
    },
    /// A state in it is none of the run.
    #[error("the log {}: {reason}; its checksums hold, so that somebody has changed it and made them anew: copy the log again from where it came from", path.display())]
    Unfit {
        /// The log.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },
    /// Messages were taken out of it.
    #[error("the log {} is not whole: {} missing, though all the bytes around are sound: a part was taken out of the file; copy it again from where it came from, or save what is there with `grainflow recover`", path.display(), numbers(topic, *first, *last))]
    Missing {
        /// The log.
        path: PathBuf,
        /// Where the messages belong.
        topic: String,
        /// The first that is missing, counted from 0.
        first: u32,
        /// The last one.
        last: u32,
    },
    /// Messages of a kind that nobody knows here.
    #[error("the log {} has messages on {topic}, which this is too old to copy: use the version that wrote it, or a later one", path.display())]
    UnknownTopic {
        /// The log.
        path: PathBuf,
        /// Where the messages belong.
        topic: String,
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

/// The messages of `topic` from `first` to `last` as the subject of a sentence.
pub(crate) fn numbers(topic: &str, first: u32, last: u32) -> String {
    match last.saturating_sub(first) {
        0 => format!("message {first} of {topic} is"),
        _ => format!("messages {first} to {last} of {topic} are"),
    }
}
