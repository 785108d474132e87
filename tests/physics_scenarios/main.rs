//! The built-in scenarios do what they are there to show.
//!
//! Every claim is a function from figures to a verdict. The same function must refuse what a
//! spoiled law gives, so that no claim is one that cannot fail. Runs are the same on every machine.
//!
//! Those that take longer run with
//! `cargo test --release --test physics_scenarios -- --ignored`.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "all of this is test code; figures are printed for those who run with --nocapture"
)]

mod heap;
mod pipe;
mod sedimentation;
mod shear;
mod shipped;
mod three_dimensions;
mod trial;
