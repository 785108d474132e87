//! Signals to a program that a test has started.

use std::process::{Child, Command};

/// Sends a signal, such as `-INT`, with the `kill` that every shell has: a program of that name may be missing.
pub(crate) fn send(signal: &str, child: &Child) {
    let script = ["-c", "kill \"$0\" \"$1\"", signal];
    let status = Command::new("sh").args(script).arg(child.id().to_string()).status();
    assert!(status.is_ok_and(|status| status.success()), "{signal} was not sent");
}
