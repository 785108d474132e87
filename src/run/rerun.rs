//! The run of a log once more, from one moment of the log to the next.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::looks::Looks;
use super::resume::{go_on_with, unfit};
use super::shown::Shown;
use super::timetable::Timetable;
use super::{Listener, RunError, initial_gas, status};
use crate::engine::{Horizon, NoLaps};
use crate::matter::gas::Gas;
use crate::record::contents::EarlierPart;
use crate::record::state::SavedState;
use crate::scenario::model::{InitialPositions, Scenario};
use crate::simulation::Simulation;
use crate::simulation::fit::Misfit;
use crate::space::Vector;

/// A run that follows a log.
pub(super) struct Rerun<'s, V: Vector> {
    log: &'s Path,
    /// The scenarios of the parts of the run; the last one goes on to its end.
    parts: &'s [Scenario<V>],
    /// Where the parts end, but for the last.
    ends: &'s [EarlierPart],
    /// The part that runs.
    part: usize,
    running: Option<Running<'s, V>>,
    stop: &'s AtomicBool,
    tell: Listener<'s>,
}

/// A run that is looked at when the first one was, so that its measures remember the same.
pub(super) struct Running<'s, V: Vector> {
    pub(super) simulation: Simulation<'s, V>,
    pub(super) timetable: Timetable,
    looks: Looks,
}

/// Whether a moment was reached.
pub(super) enum Reached {
    /// Exactly.
    Here,
    /// The run has no such moment, and why.
    Not(String),
    /// Somebody stopped it.
    Interrupted,
}

impl<'s, V: Vector> Running<'s, V> {
    pub(super) fn new(mut simulation: Simulation<'s, V>, timetable: Timetable) -> Self {
        Running { looks: Looks::of(&mut simulation), simulation, timetable }
    }

    /// Takes a recording, the one that is due if one is, a full one if that is or if the first run made it one, as it does with its
    /// last: its values, and whether it is a full one.
    pub(super) fn recording(&mut self, was_full: bool) -> (Vec<f64>, bool) {
        let Running { simulation, timetable, looks } = self;
        let mut shown = Shown::ALL;
        if timetable.is_recording_due(simulation) {
            shown = Shown::at(timetable.due(simulation), &simulation.scenario().record);
            timetable.recorded(simulation);
        }
        shown.full |= was_full;
        let (measures, snapshot) = simulation.observation();
        let (values, _) = looks.take(measures, &snapshot, shown);
        if shown.fields {
            simulation.restart_cell_counts();
        }
        (values, shown.full)
    }
}

impl<'s, V: Vector> Rerun<'s, V> {
    /// A run of these `parts`, which has not begun, beside its `log`.
    pub(super) fn new(
        log: &'s Path,
        parts: &'s [Scenario<V>],
        ends: &'s [EarlierPart],
        stop: &'s AtomicBool,
        tell: Listener<'s>,
    ) -> Self {
        Rerun { log, parts, ends, part: 0, running: None, stop, tell }
    }

    /// Begins, unless it has begun: with the grains of `state` where the scenario takes them from another log.
    pub(super) fn begin(&mut self, state: Option<&SavedState<'static, V>>) -> Result<(), RunError> {
        if self.running.is_some() {
            return Ok(());
        }
        let scenario = &self.parts[0];
        let simulation = match (&scenario.initial.positions, state) {
            (InitialPositions::Log(_), Some(state)) if state.recordings == 0 => {
                Simulation::resume(scenario, state.clone()).map_err(|misfit| unfit(self.log, &misfit))?
            }
            _ => {
                let gas = initial_gas(scenario)?;
                Simulation::start(scenario, gas, &mut NoLaps).map_err(RunError::Equilibration)?
            }
        };
        self.running = Some(Running::new(simulation, Timetable::new(&scenario.record)));
        Ok(())
    }

    /// Parts of the run that have begun.
    pub(super) fn parts_begun(&self) -> usize {
        self.part + 1
    }

    fn now(&self) -> &Running<'s, V> {
        self.running.as_ref().expect("it begins with the first thing that is checked")
    }

    fn now_mut(&mut self) -> &mut Running<'s, V> {
        self.running.as_mut().expect("it begins with the first thing that is checked")
    }

    /// The grains now.
    pub(super) fn gas(&self) -> &Gas<V> {
        self.now().simulation.gas()
    }

    /// Particle-steps and events so far.
    pub(super) fn work(&self) -> (u64, u64) {
        let totals = self.now().simulation.totals();
        (totals.particle_steps, totals.events.all)
    }

    /// Goes on to exactly `time` [time], where something is due, or where a run was interrupted that `stops` there.
    pub(super) fn advance_to(&mut self, time: f64, stops: bool) -> Reached {
        // Where collisions are counted, a time does not say which of them have happened.
        let there = Horizon { time: if stops { time } else { f64::INFINITY }, ..Horizon::NONE };
        loop {
            let (stop, tell) = (self.stop, &mut self.tell);
            let running = self.running.as_mut().expect("it begins with the first thing that is checked");
            let Running { simulation, timetable, .. } = running;
            tell(&status(simulation));
            let now = simulation.gas().time();
            if now == time {
                return Reached::Here;
            }
            if now > time || time.is_nan() {
                return Reached::Not(format!("the log has t = {time:?}, where the re-run has no step end"));
            }
            if let Some(reason) = simulation.end_reason() {
                let reason = reason.name();
                return Reached::Not(format!(
                    "the re-run ends at t = {now:?} by its limit on {reason}, and the log goes on to t = {time:?}"
                ));
            }
            if stop.load(Relaxed) {
                return Reached::Interrupted;
            }
            // What is due but is not in the log is passed over.
            timetable.pass_over(simulation);
            let horizon = timetable.horizon(simulation).min(there);
            if let Err(error) = simulation.advance(&mut NoLaps, horizon) {
                return Reached::Not(format!("the re-run ends at t = {now:?}, and the log goes on: {error}"));
            }
        }
    }

    /// Whether a run was interrupted at `state`: nothing is due there, and no end.
    pub(super) fn is_interruption(&self, state: &SavedState<'static, V>) -> Result<bool, Misfit> {
        let Running { simulation, timetable, .. } = self.now();
        let there = Simulation::resume(simulation.scenario(), state.clone())?;
        Ok(there.end_reason().is_none() && !timetable.is_state_due(&there))
    }

    /// Takes the recording that is due: names of the columns, their values, and whether it is a full one.
    pub(super) fn recording(&mut self, was_full: bool) -> (Vec<String>, Vec<f64>, bool) {
        let (values, is_full) = self.now_mut().recording(was_full);
        (self.now().looks.columns.iter().map(|column| column.name.clone()).collect(), values, is_full)
    }

    /// Saves the state that is due after so many `steps` and `events`, and lets `judge` look at it. Where a part of the run
    /// ends there, the next one begins with it.
    pub(super) fn state<R>(
        &mut self,
        steps: u64,
        events: u64,
        judge: impl FnOnce(&SavedState<'_, V>) -> R,
    ) -> Result<R, Misfit> {
        while self
            .ends
            .get(self.part)
            .is_some_and(|end| end.time == self.gas().time() && end.steps == steps && end.events == events)
        {
            self.part += 1;
            let Running { simulation, timetable, .. } = self.now();
            let state = simulation.saved_state(timetable.recordings, timetable.saved);
            let (simulation, timetable) = go_on_with(&self.parts[self.part], state, true)?;
            self.running = Some(Running::new(simulation, timetable));
        }
        let Running { simulation, timetable, .. } = self.now_mut();
        let verdict = judge(&simulation.saved_state(timetable.recordings, timetable.saved));
        if timetable.is_state_due(simulation) {
            timetable.state_saved(simulation);
        }
        Ok(verdict)
    }
}
