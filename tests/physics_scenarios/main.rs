//! The built-in scenarios do what they are there to show.
//!
//! Every claim is a function from figures to a verdict. The same function must refuse what a
//! spoiled law gives, so that no claim is one that cannot fail. Runs are the same on every machine.
//!
//! Those that take longer run with
//! `cargo test --release --test physics_scenarios -- --ignored`.

mod heap;
mod pipe;
mod sedimentation;
mod shear;
mod shipped;
mod three_dimensions;
mod trial;
