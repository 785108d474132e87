//! A place to work in, the program started there, and what it says.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A temporary folder. Tests give it methods of their own.
pub(crate) struct Place(tempfile::TempDir);

impl Place {
    /// An empty folder.
    pub(crate) fn new() -> Self {
        Place(tempfile::tempdir().expect("a temporary folder can be made"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        command
    }

    pub(crate) fn grainflow(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the program can be started")
    }
}

pub(crate) fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal has ended it")
}

pub(crate) fn text(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("the program prints text")
}

pub(crate) fn error(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("the program prints text")
}
