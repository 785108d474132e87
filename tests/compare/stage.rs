//! Scenarios that are done in no time, and what they leave.

use std::fs;
use std::path::Path;

use grainflow::record::contents::RunLog;
use grainflow::record::reader::read_log;
use serde_json::{Map, Value};

use super::place::{Place, code, error, text};

/// A hundred and fifty disks that cool.
pub(crate) const GAS: &str = "title = \"A small gas\"
dimension = 2
[engine]
kind = \"hsmc\"
cell_size = 5.0
[domain]
size = [20.0, 20.0]
[particles]
volume_fraction = 0.3
restitution = 0.9
[initial]
velocities = { maxwell = 1.0 }
equilibrate = 2.0
[run]
time = 4.0
[record]
frames = 20
";

/// Twenty spheres poured between two walls; nobody is there at the start.
pub(crate) const HEAP: &str = "title = \"A small heap\"
dimension = 3
gravity = [0.0, 0.0, -1.0]
[engine]
kind = \"hsmc\"
time_step = { fixed = 0.05 }
[engine.event_driven]
collapse = { elastic_below = 0.05 }
[domain]
size = [16.0, 16.0, 24.0]
[boundary]
x = \"open\"
y = { lower = { wall = \"smooth\" }, upper = { wall = \"smooth\" } }
z.lower = { wall = \"rough\" }
z.upper = \"open\"
[particles]
count = 0
restitution = 0.7
[source]
count = 20
rate = 4.0
width = 4.0
[run]
rest = 3.0
[record]
frames = 20
";

impl Place {
    /// A new folder with these files.
    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let place = Place::new();
        for (name, text) in files {
            fs::write(place.path(name), text).unwrap();
        }
        place
    }

    pub(crate) fn summary(&self, run: &str) -> Map<String, Value> {
        summary(&self.path(run))
    }

    pub(crate) fn log(&self, run: &str) -> RunLog {
        read_log(&self.path(run).join("log.mcap")).unwrap()
    }

    /// Asserts that `arguments` are refused as wrong input and nothing is written; returns what was said.
    pub(crate) fn refused(&self, arguments: &[&str]) -> String {
        let output = self.grainflow(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", error(&output));
        assert_eq!(text(&output), "", "{arguments:?}");
        assert!(!self.path("out").exists(), "{arguments:?} wrote something");
        error(&output)
    }
}

pub(crate) fn summary(run: &Path) -> Map<String, Value> {
    serde_json::from_str(&fs::read_to_string(run.join("summary.json")).unwrap()).unwrap()
}

/// Whether a line of `said` judges `engine` by `reference`.
pub(crate) fn is_judged(said: &str, engine: &str, reference: &str) -> bool {
    said.lines().any(|line| line.starts_with(engine) && line.contains(&format!("with {reference}")))
}
