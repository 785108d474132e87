//! The record of a run: what a log holds, how it is written and read.
//!
//! A log is an MCAP file that viewers open as it is. Topics: `/measures` (the series, a field per
//! column), `/particles` (`foxglove.PointCloud`), `/fields/…` (`foxglove.Grid`, in space
//! `foxglove.VoxelGrid`), `/profiles`, `/walls` (`foxglove.SceneUpdate`) and `/state` (saved states). Metadata `grainflow` and the attachment `scenario.toml` stand
//! before the first message. A message of `/particles` or `/fields/…` belongs to the message of `/measures` with its
//! sequence number, where its exact time stands.

mod background;
pub(crate) mod checkpoints;
pub mod contents;
pub(crate) mod continuation;
pub mod error;
pub mod frame;
mod grids;
pub mod history;
pub mod index;
pub mod overview;
pub mod reader;
pub mod recover;
mod saved;
mod scan;
mod schema;
pub mod state;
pub mod summary;
pub mod time_scale;
pub mod walk;
mod walls;
pub mod writer;

pub(crate) use schema::RECOVERED_KEY;

use std::path::{Path, PathBuf};

/// What the log of a run is called in the run's folder.
pub const LOG: &str = "log.mcap";

/// Whether an MCAP file stands at `path`: nothing else may take its place.
pub fn is_log(path: &Path) -> bool {
    use std::io::Read;
    let mut start = [0; mcap::MAGIC.len()];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut start));
    read.is_ok() && start == *mcap::MAGIC
}

/// The log that `path` means: itself, or the one of a run folder.
pub fn log_at(path: &Path) -> PathBuf {
    if path.is_dir() { path.join(LOG) } else { path.to_owned() }
}
