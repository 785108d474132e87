//! What is made of stored runs: tables, pictures, exports; and logs of every format that are still read.

#![expect(clippy::unwrap_used, reason = "functions that tests call stop the test like the tests themselves")]

mod boxes;
mod export;
mod golden;
mod mint;
#[path = "../place/mod.rs"]
mod place;
mod replay;
mod times;

use place::{Place, code, error, text};

impl Place {
    /// A place with the run folder `run`: a small gas of 200 disks, 8 recordings and their states.
    fn with_run(sets: &[&str]) -> Self {
        let place = Place::new();
        let mut arguments =
            vec!["run", "cooling", "--engine", "hsmc", "--out", "run", "--quiet", "--threads", "1"];
        let usual = [
            "particles.count=200",
            "run.collisions_per_particle=3",
            "record.frames=7",
            "record.spacing=even",
            "record.states=3",
        ];
        for set in usual.iter().chain(sets) {
            arguments.extend(["--set", set]);
        }
        let output = place.grainflow(&arguments);
        assert_eq!(code(&output), 0, "{}", error(&output));
        place
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Asserts that `arguments` are obeyed; returns what was printed.
    fn obeyed(&self, arguments: &[&str]) -> String {
        let output = self.grainflow(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}: {}", error(&output));
        text(&output)
    }

    /// Asserts that `arguments` are refused as wrong input and leave no new file; returns what was said.
    fn refused(&self, arguments: &[&str]) -> String {
        let before = self.names();
        let output = self.grainflow(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", error(&output));
        assert_eq!(text(&output), "", "{arguments:?}");
        assert_eq!(self.names(), before, "{arguments:?}");
        error(&output)
    }

    /// Names of everything in the place and in its run folder.
    fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        for folder in [self.path("."), self.path("run")] {
            let entries = std::fs::read_dir(&folder).into_iter().flatten();
            names.extend(entries.map(|entry| entry.unwrap().path().display().to_string()));
        }
        names.sort();
        names
    }
}
