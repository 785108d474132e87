//! What several runs have in common and where they part: read from their logs, with errors.
//!
//! How errors and verdicts are made stands in `docs/comparison.md`.

mod assemble;
pub mod csv;
mod difference;
mod errors;
mod extent;
mod figures;
mod interpolate;
pub mod json;
mod judge;
pub(crate) mod laws;
mod memory;
pub mod model;
mod profiles;
mod read;
mod same_runs;
mod scatter;
mod series;
mod stability;
#[cfg(test)]
mod testing;
pub mod theory;
#[cfg(test)]
mod theory_tests;
mod walk;
mod words;

pub use assemble::{Entry, Head, Replica, assemble};
pub(crate) use figures::unit_of;
pub use read::{LogsError, read};
