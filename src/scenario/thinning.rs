//! Fewer recordings, where those that are asked for would take more than their share of the time of a run.
//!
//! How many there are follows from the scenario alone, by what [`super::cost`] tells of its time, and is written into the
//! scenario that goes into the log: a run that goes on, and one that is repeated, is recorded as the first one was.

use toml_edit::DocumentMut;

use super::cost::{self, Affordable};
use super::model::{AnyScenario, Scenario, Spacing};
use super::overrides::Overrides;
use crate::space::Vector;

/// The rarest that recordings are full, in recordings.
const RAREST: f64 = 1e6;

impl<V: Vector> Scenario<V> {
    /// What is affordable; `None` where everything is to be recorded.
    fn affordable(&self) -> Option<Affordable> {
        Some(cost::affordable(self, self.record.share?))
    }

    /// Recordings beside the one at the start, where they are fewer than `record.frames`.
    pub fn affordable_frames(&self) -> Option<u32> {
        let (Spacing::Frames(frames) | Spacing::LogFrames(frames)) = self.record.spacing else { return None };
        let affordable = (self.affordable()?.recordings - 1.0) as u32;
        (affordable < frames).then_some(affordable)
    }

    /// n, where every n-th recording is full: what the scenario says, or what is affordable where it says nothing.
    pub fn affordable_full_every(&self) -> u32 {
        let Some(affordable) = self.affordable().filter(|_| self.record.usual_full) else {
            return self.record.full_every;
        };
        let wanted = match self.record.spacing {
            Spacing::Frames(frames) | Spacing::LogFrames(frames) => {
                f64::from(self.affordable_frames().unwrap_or(frames))
            }
            Spacing::Every(interval) => self.expected_duration().map_or(1.0, |duration| duration / interval),
            Spacing::Ends => 1.0,
        };
        // One of the full recordings is at the start, and rounding adds none.
        ((wanted - 0.5) / (affordable.full - 1.0)).ceil().clamp(1.0, RAREST) as u32
    }

    /// States inside the run: `record.states`, or where it does not say how many, as many of the usual ones as are affordable.
    pub fn affordable_states(&self) -> u32 {
        match self.affordable().filter(|_| self.record.usual_states) {
            Some(affordable) => self.record.states.min(affordable.states as u32),
            None => self.record.states,
        }
    }

    /// This scenario with as many recordings as take no more than `record.share` of the time of its run; its text says so.
    #[must_use]
    pub fn with_affordable_recordings(mut self) -> Self {
        let mut sets = Vec::new();
        let (frames, full_every, states) =
            (self.affordable_frames(), self.affordable_full_every(), self.affordable_states());
        if let Some(frames) = frames {
            sets.push(format!("record.frames={frames}"));
            self.record.spacing = match self.record.spacing {
                Spacing::LogFrames(_) => Spacing::LogFrames(frames),
                _ => Spacing::Frames(frames),
            };
        }
        if full_every > self.record.full_every {
            sets.push(format!("record.full.every_nth={full_every}"));
            (self.record.full_every, self.record.usual_full) = (full_every, false);
        }
        if states < self.record.states {
            sets.push(format!("record.states={states}"));
            (self.record.states, self.record.usual_states) = (states, false);
        }
        if !sets.is_empty() {
            sets.push("record.share=all".to_owned());
            self.record.share = None;
            self.source_text = changed(&self.source_text, sets);
        }
        self
    }
}

/// The `text` of a scenario with these `sets`.
fn changed(text: &str, sets: Vec<String>) -> String {
    let mut document: DocumentMut = text.parse().expect("a scenario was read from this text");
    let (_, mistakes) = Overrides { sets, ..Overrides::default() }.apply(&mut document);
    debug_assert!(mistakes.is_empty(), "{mistakes:?}");
    document.to_string()
}

impl AnyScenario {
    /// [`Scenario::with_affordable_recordings`].
    #[must_use]
    pub fn with_affordable_recordings(self) -> Self {
        match self {
            AnyScenario::Two(scenario) => AnyScenario::Two(scenario.with_affordable_recordings()),
            AnyScenario::Three(scenario) => AnyScenario::Three(scenario.with_affordable_recordings()),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scenario::model::{AnyScenario, Spacing};
    use crate::scenario::{Overrides, load, parse};

    fn recorded(name: &str, sets: &[&str]) -> AnyScenario {
        load(name, &overrides(sets)).unwrap().with_affordable_recordings()
    }

    fn overrides(sets: &[&str]) -> Overrides {
        Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Overrides::default() }
    }

    fn spacing(scenario: &AnyScenario) -> Spacing {
        match scenario {
            AnyScenario::Two(scenario) => scenario.record.spacing,
            AnyScenario::Three(scenario) => scenario.record.spacing,
        }
    }

    const LARGE: [&str; 2] = ["particles.count=100000", "domain.size=[560.5,560.5]"];

    #[test]
    fn a_small_run_is_recorded_as_it_asks_for_and_keeps_its_text() {
        let scenario = recorded("cooling", &[]);
        assert_eq!(spacing(&scenario), Spacing::LogFrames(200));
        assert_eq!(scenario, load("cooling", &Overrides::default()).unwrap());
    }

    #[test]
    fn a_large_and_short_one_has_fewer_full_recordings_and_states_and_says_so_in_its_text() {
        let scenario = recorded("cooling", &LARGE);
        assert_eq!(spacing(&scenario), Spacing::LogFrames(200));
        let text = scenario.source_text().to_owned();
        for line in ["frames = 200", "share = \"all\"", "full = { every_nth = ", "states = "] {
            assert!(text.contains(line), "{line}: {text}");
        }
        let stored = parse("cooling", &text, &Overrides::default()).unwrap();
        assert_eq!(stored.clone().with_affordable_recordings(), stored);
        let AnyScenario::Two(scenario) = stored else { panic!("the scenario is flat") };
        assert!((20..=100).contains(&scenario.record.full_every), "{}", scenario.record.full_every);
    }

    #[test]
    fn an_engine_without_steps_stops_for_fewer_recordings() {
        let sets = ["domain.size=[120.4,120.4,120.4]", "run.collisions_per_particle=1.0"];
        let scenario = recorded("hard-spheres", &sets);
        let Spacing::Frames(frames) = spacing(&scenario) else { panic!("they are spread evenly") };
        assert!((2..=30).contains(&frames), "{frames}");
    }

    #[test]
    fn a_long_one_or_one_that_asks_for_all_is_recorded_as_it_asks_for() {
        for more in ["run.collisions_per_particle=5000.0", "record.share=all"] {
            let asked = load("cooling", &overrides(&[&LARGE[..], &[more]].concat())).unwrap();
            assert_eq!(asked.clone().with_affordable_recordings(), asked, "{more}");
        }
        let scenario = recorded("cooling", &[&LARGE[..], &["record.states=7"]].concat());
        assert!(scenario.source_text().contains("states = 7"));
        let scenario = recorded("cooling", &[&LARGE[..], &["record.state_every=1.0"]].concat());
        let text = scenario.source_text();
        assert!(text.contains("state_every = 1.0") && !text.contains("states ="), "{text}");
    }
}
