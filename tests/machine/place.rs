//! A place to work in, and the program started there.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

pub(crate) struct Place(tempfile::TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Place(tempfile::tempdir().expect("a temporary folder can be made"))
    }

    pub(crate) fn folder(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        command
    }

    pub(crate) fn grainflow(&self, arguments: &[&str]) -> Said {
        Said::of(&self.command(arguments).output().expect("the program can be started"))
    }

    /// A shell that does `script`, in which "$G" is the program.
    pub(crate) fn shell(&self, script: &str) -> Said {
        let mut command = Command::new("sh");
        command.current_dir(self.0.path()).args(["-c", script]).stdin(Stdio::null());
        command.env("G", assert_cmd::cargo::cargo_bin!("grainflow"));
        Said::of(&command.output().expect("a shell can be started"))
    }

    /// A run into `run` that would take very long, once it has begun to record.
    pub(crate) fn begun(&self) -> Child {
        let endless = ["run", "cooling", "--out", "run", "--set", "run.collisions_per_particle=1e9"];
        let small = [
            "--set",
            "particles.count=500",
            "--set",
            "particles.restitution=1.0",
            "--set",
            "record.every=0.5",
        ];
        let mut command = self.command(&[&endless[..], &small].concat());
        let child =
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a program to start");
        let since = Instant::now();
        while std::fs::metadata(self.path("run/log.mcap")).map_or(0, |log| log.len()) < 20_000 {
            assert!(since.elapsed() < Duration::from_secs(60), "the run does not begin");
            std::thread::sleep(Duration::from_millis(20));
        }
        child
    }
}

/// How the program ended, and what it said.
#[derive(Debug)]
pub(crate) struct Said {
    /// The exit code; `None` where a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) text: String,
    pub(crate) error: String,
}

impl Said {
    pub(crate) fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let said =
            Said { code: output.status.code(), text: text(&output.stdout), error: text(&output.stderr) };
        assert!(!said.error.contains("panicked"), "{}", said.error);
        said
    }

    /// Asserts the exit code, and that the error text has all of `words`.
    pub(crate) fn failed(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{self:?}");
        for word in words {
            assert!(self.error.contains(word), "no {word:?} in {self:?}");
        }
    }
}
