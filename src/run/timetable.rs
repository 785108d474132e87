//! When a run is recorded and when its states are saved.

use std::ops::Range;

use crate::engine::Horizon;
use crate::scenario::model::{RecordPlan, Spacing};
use crate::simulation::Simulation;
use crate::simulation::schedule::{ROUNDING, Spread};
use crate::space::Vector;

/// Time and progress that schedules are asked with. Where a step ends at a multiple of an interval but for rounding, what is
/// due there is due at that step and not at the next one; an engine without steps stops at exactly the times of the schedules.
fn reached<V: Vector>(simulation: &Simulation<'_, V>) -> (f64, f64) {
    let stretched = if simulation.is_event_driven() { 1.0 } else { 1.0 + ROUNDING };
    let (time, progress) = (simulation.gas().time(), simulation.progress());
    (time * stretched, (progress * stretched).min(1.0))
}

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
        let (time, progress) = reached(simulation);
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

    /// Whether a recording is to be made. One that is due at the end but for rounding waits for the end, which comes at once.
    pub(super) fn wants_recording<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        self.is_recording_due(simulation) && !simulation.ends_within_rounding()
    }

    /// Whether a recording that is made now is the one that is due.
    pub(super) fn is_recording_due<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        let (time, progress) = reached(simulation);
        self.frames.is_due(self.recordings, time, progress)
    }

    /// The numbers of the recordings that one made now stands for: several where a step was longer than the pause.
    pub(super) fn due<V: Vector>(&self, simulation: &Simulation<'_, V>) -> Range<u64> {
        let (time, progress) = reached(simulation);
        let next = self.frames.next(time, progress);
        self.recordings..next.max(self.recordings + 1)
    }

    /// Notes that it was made.
    pub(super) fn recorded<V: Vector>(&mut self, simulation: &Simulation<'_, V>) {
        self.recordings = self.due(simulation).end;
    }

    /// Whether a state is to be saved. The one of the end is saved whether it is due or not.
    pub(super) fn wants_state<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        let is_last = simulation.ends_within_rounding() || simulation.end_reason().is_some();
        self.is_state_due(simulation) && !is_last
    }

    /// Whether a state that is saved now is the one that is due.
    pub(super) fn is_state_due<V: Vector>(&self, simulation: &Simulation<'_, V>) -> bool {
        let (time, progress) = reached(simulation);
        self.states.is_due(self.saved, time, progress)
    }

    /// Notes that what was due before now is in no log. Something that is due now but for rounding may still be: earlier
    /// versions recorded it a step later.
    pub(super) fn pass_over<V: Vector>(&mut self, simulation: &Simulation<'_, V>) {
        let (time, progress) = (simulation.gas().time(), simulation.progress());
        if self.frames.is_due(self.recordings, time, progress) && !simulation.ends_within_rounding() {
            self.recorded(simulation);
        }
        if self.states.is_due(self.saved, time, progress) && !simulation.ends_within_rounding() {
            self.state_saved(simulation);
        }
    }

    /// Notes that it was saved.
    pub(super) fn state_saved<V: Vector>(&mut self, simulation: &Simulation<'_, V>) {
        let (time, progress) = reached(simulation);
        self.saved = self.states.next(time, progress);
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
