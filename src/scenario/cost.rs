//! What a run will cost, roughly: grains to move, memory, log, time on one core.

use super::estimate::{self, Estimate};
use super::model::{EngineKind, Scenario, Spacing};
use crate::law::boundary::Face;
use crate::observe::field::Quantity;
use crate::simulation::schedule::{Due, ROUNDING, Spread};
use crate::space::Vector;

/// Up to so many grains the columns stay in the caches of a processor.
const CACHED_GRAINS: f64 = 2e5;
/// Recording one grain in full: measures, hash, frame, compression; its part of the sums that every recording has; and what it
/// costs to bring it to the time of the recording where an engine has no steps [s].
const FULL_RECORDING: f64 = 115e-9;
const BRIEF_RECORDING: f64 = 5e-9;
const SYNCHRONISATION: f64 = 200e-9;
/// Grains of which this many full recordings are always made, a fifth of a second altogether; of twice as many half of the recordings
/// and a quarter of the full ones, so that those of a large and short run do not take longer than it.
const ALWAYS_RECORDED: (f64, f64) = (1e4, 210.0);
/// The fewest full recordings.
const FEWEST_RECORDINGS: f64 = 4.0;
/// Full recordings that take as long as one state, with all that happens until it is written.
const RECORDINGS_PER_STATE: f64 = 2.0;
/// Collisions that the event-driven engine makes in a second: at least, and at most.
const FLAT_COLLISIONS: (f64, f64) = (4e5, 1e6);
const DEEP_COLLISIONS: (f64, f64) = (2.5e5, 6e5);
/// What the event-driven engine holds of a grain beside the gas: its events and its cell or list [bytes].
const EVENTS_OF_A_GRAIN: f64 = 275.0;
/// A step without grains [s], and what each empty cell adds to it [s].
const EMPTY_STEP: f64 = 4e-6;
const EMPTY_CELL: f64 = 1.5e-9;
/// How often a run holds the columns of its grains at most: twice for sorting, for the saved state and its way into the log, for
/// measures. Fitted, with the memory of the program, to peaks of 2·10⁵ (2D, 3D) and 10⁶ spheres: 62, 81 and 322 MB.
const COPIES: f64 = 5.2;
/// Memory of the program itself, and of one that writes a report [bytes].
const PROGRAM: f64 = 19e6;
const REPORTING_PROGRAM: f64 = 30e6;
/// Bytes of a point of a frame.
const POINT: f64 = 28.0;
/// Bytes of a recording beside its points.
const RECORD: f64 = 4096.0;

/// Grains at the end, with all that are poured.
pub(super) fn final_grains<V: Vector>(scenario: &Scenario<V>) -> f64 {
    f64::from(scenario.count) + scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count))
}

/// Whether grains come to lie on a face: gravity along an axis that has an end.
pub(super) fn settles<V: Vector>(scenario: &Scenario<V>) -> bool {
    (0..V::DIMENSION).any(|axis| settles_along(scenario, axis))
}

/// The same along `axis`.
pub(super) fn settles_along<V: Vector>(scenario: &Scenario<V>, axis: usize) -> bool {
    let side = usize::from(scenario.gravity[axis] > 0.0);
    let faces = scenario.boundary.faces(axis);
    scenario.gravity[axis] != 0.0 && faces.is_some_and(|faces| matches!(faces[side], Face::Wall(_)))
}

/// How long a run lasts in its own time [time].
pub(super) fn duration<V: Vector>(scenario: &Scenario<V>) -> Option<f64> {
    let by_steps = || {
        if scenario.engine.kind.is_event_driven() {
            return estimate::time_of_collisions(scenario);
        }
        Some(estimate::steps(scenario)?.least * estimate::first_step(scenario)?)
    };
    let limits = [scenario.run.time, estimate::resting_time(scenario)];
    limits.into_iter().flatten().reduce(f64::min).or_else(by_steps)
}

/// Grains on an average over the run.
fn mean_grains<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let present = f64::from(scenario.count);
    let (Some(source), Some(duration)) = (&scenario.source, duration(scenario)) else { return present };
    let (poured, pouring) = (f64::from(source.count), f64::from(source.count) / source.rate);
    let share = if duration < pouring { 0.5 * duration / pouring } else { 1.0 - 0.5 * pouring / duration };
    present + poured * share
}

/// Seconds of a run on one core, its recordings and its equilibration included. The constants are fitted
/// to processor times of short single-threaded runs on one machine; another may differ by a factor of two.
pub(super) fn seconds<V: Vector>(scenario: &Scenario<V>) -> Option<Estimate> {
    let recording = recording_seconds(scenario);
    let running = running_seconds(scenario)?;
    Some(Estimate { least: running.least + recording, most: running.most + recording, ..running })
}

/// The same without the recordings.
fn running_seconds<V: Vector>(scenario: &Scenario<V>) -> Option<Estimate> {
    if let Some(collisions) = estimate::collisions(scenario) {
        let (slow, fast) = if V::DIMENSION == 2 { FLAT_COLLISIONS } else { DEEP_COLLISIONS };
        let (least, most) = (collisions.least / fast, collisions.most / slow);
        return Some(Estimate { least, most, ..collisions });
    }
    let steps = estimate::steps(scenario)?;
    let before = estimate::steps_before_the_start(scenario);
    let cost = |steps: f64| (steps + before) * seconds_per_step(scenario);
    Some(Estimate { least: cost(steps.least), most: cost(steps.most), ..steps })
}

/// What all recordings take [s].
fn recording_seconds<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let Recordings { made, full, .. } = recordings(scenario);
    mean_grains(scenario) * (full * FULL_RECORDING + made * brief_recording(scenario))
}

/// What every grain costs in a recording that is not full [s].
fn brief_recording<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let is_event_driven = scenario.engine.kind.is_event_driven();
    BRIEF_RECORDING + if is_event_driven { SYNCHRONISATION } else { 0.0 }
}

/// What is affordable of the recordings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affordable {
    /// Recordings, full or not.
    pub(super) recordings: f64,
    /// Those of them that are full.
    pub(super) full: f64,
    /// States inside the run.
    pub(super) states: f64,
}

/// What takes no more than this `share` of the time of the run, or than is never too much: all recordings by what each of them
/// costs; half as much more for what full ones cost beside that, and a quarter for states. Anything where that time cannot be told.
pub(super) fn affordable<V: Vector>(scenario: &Scenario<V>, share: f64) -> Affordable {
    let grains = mean_grains(scenario).max(1.0);
    let (few, always) = ALWAYS_RECORDED;
    let brief = brief_recording(scenario);
    let always = always * (few / grains) * (FULL_RECORDING + brief);
    let seconds = running_seconds(scenario).map_or(f64::INFINITY, |running| share * running.least / grains);
    let of = |part: f64, always: f64, each: f64| always.max(part * seconds) / each;
    let fewer = always * (few / grains);
    let full = of(0.5, fewer, FULL_RECORDING + brief).max(FEWEST_RECORDINGS);
    Affordable {
        recordings: of(1.0, always, brief).max(full),
        full,
        states: of(0.25, fewer, RECORDINGS_PER_STATE * FULL_RECORDING),
    }
}

fn seconds_per_step<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let (grains, cells) = (mean_grains(scenario), scenario.grid().number_of_cells() as f64);
    let cached = grains <= CACHED_GRAINS;
    let by_dimension = |flat: f64, deep: f64| if V::DIMENSION == 2 { flat } else { deep };
    let hybrid = scenario.engine.kind == EngineKind::Hsmc;
    let moving = match (hybrid, cached) {
        (false, true) => by_dimension(25e-9, 28e-9),
        (false, false) => by_dimension(36e-9, 50e-9),
        (true, true) => by_dimension(33e-9, 48e-9),
        (true, false) => by_dimension(55e-9, 83e-9),
    };
    // Grains that lie in full cells are refused, and collide as cells.
    let packed = match settles(scenario) {
        true if hybrid => 175e-9 + 25e-9 * f64::from(scenario.engine.hsmc.sweeps),
        true => 160e-9,
        false => 0.0,
    };
    // In cells with few grains the cell itself is the work.
    let thin = if hybrid { 35e-9 } else { 20e-9 } * cells.min(grains);
    grains * packed.max(moving) + thin + EMPTY_CELL * cells + EMPTY_STEP
}

/// Bytes of one grain's full-precision state.
fn grain_bytes<V: Vector>() -> f64 {
    (2 * 8 * V::DIMENSION + 4) as f64
}

/// The most memory that a run holds [bytes]: grains twice over for sorting and again for the saved
/// state, and cells; or, when it is over, all frames and fields for its report.
pub(super) fn memory<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let cells = scenario.grid().number_of_cells() as f64;
    let per_cell = if V::DIMENSION == 2 { 24.0 } else { 32.0 };
    let events = if scenario.engine.kind.is_event_driven() { EVENTS_OF_A_GRAIN } else { 0.0 };
    let per_grain = COPIES * grain_bytes::<V>() + 30.0 + events;
    let running = PROGRAM + final_grains(scenario) * per_grain + cells * per_cell;
    let reporting = REPORTING_PROGRAM + pictures(scenario);
    running.max(reporting)
}

/// Points of a frame, on an average over the run.
fn mean_points<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let grains = mean_grains(scenario);
    scenario.record.points.map_or(grains, |points| f64::from(points).min(grains))
}

/// Bytes of the fields of a recording that has them.
fn field_bytes<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let values = |field: Quantity| field.components(V::DIMENSION).len();
    let values = scenario.fields().map(values).sum::<usize>();
    (values * size_of::<f32>() * scenario.grid().number_of_cells()) as f64
}

/// Bytes of all frames and fields of a run.
fn pictures<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let full = recordings(scenario).full;
    let of_every = |every: u32| (full / f64::from(every)).ceil();
    of_every(scenario.record.frames_every) * POINT * mean_points(scenario)
        + of_every(scenario.record.fields_every) * field_bytes(scenario)
}

/// Recordings of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recordings {
    /// As many as `[record]` asks for.
    pub(super) wanted: f64,
    /// As many as there can be, and are affordable: one at the start and one per step.
    pub(super) made: f64,
    /// Those of them that are full.
    pub(super) full: f64,
}

pub(super) fn recordings<V: Vector>(scenario: &Scenario<V>) -> Recordings {
    let wanted = match scenario.record.spacing {
        Spacing::Frames(frames) | Spacing::LogFrames(frames) => f64::from(frames) + 1.0,
        Spacing::Every(every) => duration(scenario).map_or(1.0, |duration| pauses(duration, every)) + 1.0,
        Spacing::Ends => 2.0,
    };
    let taken = scenario.affordable_frames().map_or(wanted, |frames| f64::from(frames) + 1.0);
    let most =
        estimate::steps(scenario).filter(|steps| !steps.open).map_or(f64::INFINITY, |steps| steps.most);
    let made = match scenario.record.spacing {
        Spacing::LogFrames(_) if most.is_finite() => 1.0 + different_steps((taken - 1.0) as u32, most),
        _ => taken.min(most + 1.0),
    };
    // Numbers are spread over the run and not over the recordings that can be made.
    let full = made.min((taken / f64::from(scenario.affordable_full_every())).ceil());
    Recordings { wanted, made, full }
}

/// How many steps of so many end at one of the places of `frames` logarithmically spaced recordings.
fn different_steps(frames: u32, steps: f64) -> f64 {
    let spread = Spread::Logarithmic(frames);
    let step = |number: u32| match spread.due(u64::from(number)) {
        Due::Progress(place) => (place * steps).ceil(),
        _ => f64::NAN,
    };
    let ends: Vec<f64> = (1..=frames).map(step).collect();
    1.0 + ends.windows(2).filter(|pair| pair[0] < pair[1]).count() as f64
}

/// Pauses of a run that is recorded at every multiple of `every` [time] and at its end: 0.9 is three times 0.3, though not so
/// for their quotient.
fn pauses(duration: f64, every: f64) -> f64 {
    (duration / every * (1.0 - ROUNDING)).ceil()
}

/// Size of the log before compression [bytes].
pub(super) fn log_size<V: Vector>(scenario: &Scenario<V>) -> f64 {
    let spread = f64::from(scenario.affordable_states());
    let every = scenario.record.state_every;
    let states =
        every.zip(duration(scenario)).map_or(spread, |(every, duration)| pauses(duration, every)) + 1.0;
    recordings(scenario).made * RECORD
        + pictures(scenario)
        + states * final_grains(scenario) * grain_bytes::<V>()
}
