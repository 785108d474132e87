//! The last state of a run that cannot go on: the one before the step that failed.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::initial_gas;
use super::rerun::Running;
use super::resume::go_on_with;
use super::timetable::Timetable;
use crate::engine::{Horizon, NoLaps};
use crate::observe::measure::Place;
use crate::record::reader::last_state;
use crate::scenario::model::Scenario;
use crate::simulation::Simulation;
use crate::space::Vector;

/// Comes to the state at `place` once more, from the last one in the `log` or from the start where there is none: a step
/// changes the grains where they stand, and one that fails leaves no way back. `None` where `stop` turned true on the way, or
/// where the way does not lead there.
pub(super) fn last_good<'s, V: Vector>(
    scenario: &'s Scenario<V>,
    log: &Path,
    place: Place,
    stop: &AtomicBool,
) -> Option<Simulation<'s, V>> {
    let mut run = begin(scenario, log)?;
    let there = Horizon { time: place.time, ..Horizon::NONE };
    loop {
        // The first run was looked at: its measures remember that.
        if run.timetable.wants_recording(&run.simulation) {
            run.recording(false);
        }
        if run.timetable.wants_state(&run.simulation) {
            run.timetable.state_saved(&run.simulation);
        }
        let is_before =
            run.simulation.totals().steps < place.steps || run.simulation.gas().time() < place.time;
        if !is_before {
            break;
        }
        if stop.load(Relaxed) {
            return None;
        }
        let horizon = run.timetable.horizon(&run.simulation).min(there);
        run.simulation.advance(&mut NoLaps, horizon).ok()?;
    }
    let mut simulation = run.simulation;
    let is_there = simulation.observation().1.place() == place;
    is_there.then_some(simulation)
}

fn begin<'s, V: Vector>(scenario: &'s Scenario<V>, log: &Path) -> Option<Running<'s, V>> {
    let (simulation, timetable) = match last_state::<V>(log).ok()? {
        Some(state) => go_on_with(scenario, state, false).ok()?,
        None => {
            let gas = initial_gas(scenario).ok()?;
            let simulation = Simulation::start(scenario, gas, &mut NoLaps).ok()?;
            (simulation, Timetable::new(&scenario.record))
        }
    };
    Some(Running::new(simulation, timetable))
}
