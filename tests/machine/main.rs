//! The program on a machine that fails it, and with input that is wrong: exit codes, messages, what is left.

#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod failures;
mod place;
mod refusals;
#[path = "../signal/mod.rs"]
mod signal;
