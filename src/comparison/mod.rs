//! What several runs have in common and where they part: read from their logs, with errors.

pub mod model;
