//! When a run is recorded and when its states are saved.

use std::ops::Range;

use crate::engine::Horizon;
use crate::scenario::model::{RecordPlan, Spacing};
use crate::simulation::Simulation;
use crate::simulation::schedule::Spread;
use crate::space::Vector;

/// What is due next.
#[derive(Clone, Debug)]
pub(super) struct Timetable {
    frames: Spread,
    states: Spread,
    /// Recordings that are no longer due.
    pub(super) recordings: u64,
    /// States that are no longer due.
    pub(super) saved: u64,
}

impl Timetable {
    /// The timetable of a run that begins.
    pub(super) fn new(plan: &RecordPlan) -> Self {
        let states = plan.state_every.map_or(Spread::Inside(plan.states), Spread::Every);
        Timetable { frames: spread(plan), states, recordings: 0, saved: 0 }
    }

    /// The timetable after so many recordings and states.
    pub(super) fn after(plan: &RecordPlan, recordings: u64, saved: u64) -> Self {
        Timetable { recordings, saved, ..Self::new(plan) }
    }

    /// The timetable of a run that goes on by another plan or to another end: what would have been is past.
    pub(super) fn from_now<V: Vector>(simulation: &Simulation<'_, V>) -> Self {
        let (time, progress) = (simulation.gas().time(), simulation.progress());
        let mut timetable = Self::new(&simulation.scenario().record);
        timetable.recordings = timetable.frames.next(time, progress);
        timetable.saved = timetable.states.next(time, progress);
        timetable
    }

    /// Where the next recording or saved state is due, for an engine that can stop there.
    pub(super) fn horizon<V: Vector>(&self, simulation: &Simulation<'_, V>) -> Horizon {
        let recording = simulation.horizon_of(self.frames, self.recordings);
        recording.min(simulation.horizon_of(self.states, self.saved))
    }

    /// Whether a recording is due.
    pub(super) fn wants_recording<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        self.frames.is_due(self.recordings, simulation.gas().time(), simulation.progress())
    }

    /// The numbers of the recordings that one made now stands for: several where a step was longer than the pause.
    pub(super) fn due<V: Vector>(&self, simulation: &Simulation<'_, V>) -> Range<u64> {
        let next = self.frames.next(simulation.gas().time(), simulation.progress());
        self.recordings..next.max(self.recordings + 1)
    }

    /// Notes that it was made.
    pub(super) fn recorded<V: Vector>(&mut self, simulation: &Simulation<'_, V>) {
        self.recordings = self.due(simulation).end;
    }

    /// Whether a state is to be saved.
    pub(super) fn wants_state<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        self.states.is_due(self.saved, simulation.gas().time(), simulation.progress())
    }

    /// Notes that it was saved.
    pub(super) fn state_saved<V: Vector>(&mut self, simulation: &Simulation<'_, V>) {
        self.saved = self.states.next(simulation.gas().time(), simulation.progress());
    }
}

fn spread(plan: &RecordPlan) -> Spread {
    match plan.spacing {
        Spacing::Frames(number) => Spread::Even(number),
        Spacing::LogFrames(number) => Spread::Logarithmic(number),
        Spacing::Every(interval) => Spread::Every(interval),
        Spacing::Ends => Spread::Start,
    }
}
