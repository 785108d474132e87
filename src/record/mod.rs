//! The record of a run: what a log holds, how it is written and read.

pub mod contents;
pub mod state;
