//! Printing where nobody may be listening: what the usual macros do with a panic. A reader that has gone (`| head`)
//! is no fault; a text that cannot be written for another reason is told at the end, and never ends a run.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::sync::OnceLock;

use super::{Exit, complain};

/// The first reason why a text could not be written.
static FAILURE: OnceLock<String> = OnceLock::new();

/// Prints `text` to the standard output.
pub(super) fn put(text: Arguments<'_>) {
    note(stdout().write_fmt(text));
}

/// Prints `text` to the standard error; where that is impossible nobody can be told.
pub(super) fn put_aside(text: Arguments<'_>) {
    let _ = stderr().write_fmt(text);
}

/// How the program ends, once everything is written that can be.
pub(super) fn ended(exit: Exit) -> Exit {
    note(stdout().flush());
    match FAILURE.get() {
        Some(failure) => {
            complain(&format!("cannot write to the standard output: {failure}"));
            if exit == Exit::Done { Exit::RunFailed } else { exit }
        }
        None => exit,
    }
}

fn note(result: std::io::Result<()>) {
    if let Err(error) = result
        && error.kind() != ErrorKind::BrokenPipe
    {
        // Only the first is told.
        let _ = FAILURE.set(error.to_string());
    }
}
