//! The event-driven engine against what is known of hard grains.
//!
//! Comparisons with closed forms go through [`claim::Claim`] or [`claim::Claim::check`]'s rule: a tolerance
//! bounds the bias, replicas give the error, and the same comparison rejects a spoiled law. What holds for every
//! trajectory is asserted of every one. All runs are functions of their seeds.
//!
//! The full statements take minutes and run with
//! `cargo test --release --test physics_hard_grains -- --ignored`; `--nocapture` prints what was measured.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "all of this is test code; figures are printed for those who run with --nocapture"
)]

mod beds;
#[path = "../physics_gas/claim.rs"]
mod claim;
mod compressed;
mod cooling;
mod cures;
mod equation_of_state;
mod fourth_moment;
mod freezing;
mod impacts;
mod trial;
