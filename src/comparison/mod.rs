//! What several runs have in common and where they part: read from their logs, with errors.

pub mod csv;
pub mod json;
pub mod model;
mod stability;
#[cfg(test)]
mod testing;
pub mod theory;
#[cfg(test)]
mod theory_tests;
