//! The stochastic engines against kinetic theory.
//!
//! Every comparison goes through [`claim::Claim`]: a tolerance bounds the bias, replicas give the error,
//! and the same comparison rejects a law that is spoiled by twice the tolerance.
//! All runs are functions of their seeds: a test passes always or never.
//!
//! `cargo test --release --test physics_gas -- --nocapture` prints what was measured.

#![expect(clippy::print_stdout, reason = "what was measured, for those who ask for it")]

mod bed;
mod claim;

mod capacity;
mod collision_frequency;
mod conservation;
mod cooling_in_time;
mod cooling_per_collision;
mod homogeneous_cooling;
mod pressure;
mod transfer;
mod wall_pressure;
