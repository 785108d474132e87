//! The record of a run: what a log holds, how it is written and read.
//!
//! A log is an MCAP file that viewers open as it is. Topics: `/measures` (the series, a field per
//! column), `/particles` (`foxglove.PointCloud`), `/profiles`, `/walls` (`foxglove.SceneUpdate`)
//! and `/state` (saved states). Metadata `grainflow` and the attachment `scenario.toml` stand
//! before the first message. Message n of `/particles` belongs to message n of `/measures`.

mod background;
pub mod contents;
pub mod error;
pub mod frame;
pub mod reader;
pub mod recover;
mod saved;
mod scan;
mod schema;
pub mod state;
pub mod time_scale;
mod walls;
pub mod writer;
