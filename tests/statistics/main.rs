//! What the figures of a run are worth: means are means over time, intervals hold, and steady is steady.
//!
//! Runs are the same on every machine. The full statements run with
//! `cargo test --release --test statistics -- --ignored --nocapture`.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "all of this is test code; figures are printed for those who run with --nocapture"
)]

mod intervals;
mod shaker;
mod steadiness;
mod trial;
