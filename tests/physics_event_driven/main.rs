//! The event-driven engine against a second, simple simulator and against exact solutions.
//!
//! `cargo test --release --test physics_event_driven`

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "what was measured, for those who ask for it")]

mod against_reference;
mod bits;
mod bounce;
mod by_hand;
mod collapse;
mod corners;
mod drive;
mod elastic_gas;
mod mixtures;
mod one_bouncing_grain;
mod reference;
mod reference_alone;
mod walls_by_hand;
