//! The event-driven engine against a second, simple simulator and against exact solutions.
//!
//! `cargo test --release --test physics_event_driven`

mod bounce;
mod reference;
mod reference_alone;
