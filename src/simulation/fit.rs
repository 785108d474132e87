//! Whether a saved state is one that a run of its scenario can have left: what comes from a log may be wrong although all its
//! checksums hold. What only the engine, the source or a measure can tell, they tell themselves.

use crate::engine::report::Totals;
use crate::law::boundary::{Boundary, WallKind};
use crate::observe::moments;
use crate::record::state::SavedState;
use crate::scenario::model::{InitialPositions, Scenario};
use crate::space::Vector;

/// Nothing is counted beyond this.
const MOST: u64 = 1 << 60;
/// What rounding may take from a clock, as a share of its time.
const COMPENSATION: f64 = 1e-9;
/// Rounding of a speed, as a share of it.
const SPEED_ROUNDING: f64 = 1e-12;

/// A saved state that no run of the scenario can have left.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the state of t = {time:?} is none that its scenario comes to: {reason}")]
pub struct Misfit {
    /// Its time [time].
    pub time: f64,
    /// What does not fit.
    pub reason: String,
}

/// Checks clock, grains and sums of `saved`.
pub(super) fn check<V: Vector>(scenario: &Scenario<V>, saved: &SavedState<'_, V>) -> Result<(), String> {
    let is_time = |time: f64| (0.0..f64::INFINITY).contains(&time);
    if !(is_time(saved.time) && saved.compensation.abs() <= COMPENSATION * saved.time) {
        return Err("its clock shows no time".to_owned());
    }
    check_identities(scenario, saved)?;
    check_grains(scenario, saved)?;
    check_sums(scenario, saved)
}

/// Each identity is there once, and as many were given as grains came.
fn check_identities<V: Vector>(scenario: &Scenario<V>, saved: &SavedState<'_, V>) -> Result<(), String> {
    let mut ids = saved.columns.ids.clone();
    ids.sort_unstable();
    if let Some(pair) = ids.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(format!("the identity {} is there twice", pair[0]));
    }
    if let Some(last) = ids.last().filter(|&&last| last >= saved.next_id) {
        return Err(format!("a grain has the identity {last}, and the next one is {}", saved.next_id));
    }
    let came = u64::from(scenario.count).saturating_add(saved.totals.poured);
    // Grains from another log keep identities of which some may be gone.
    let from_log = matches!(scenario.initial.positions, InitialPositions::Log(_));
    let given = u64::from(saved.next_id);
    if given < came || given > came && !from_log {
        return Err(format!("{given} identities were given, and {came} grains came"));
    }
    let here = ids.len() as u64;
    if saved.totals.counts.removed.checked_add(here) != Some(came) {
        return Err(format!(
            "of {came} grains {here} are here and {} have left",
            saved.totals.counts.removed
        ));
    }
    Ok(())
}

/// Every grain is in the box, moves at a speed that can be, and is of a kind that there is.
fn check_grains<V: Vector>(scenario: &Scenario<V>, saved: &SavedState<'_, V>) -> Result<(), String> {
    let (columns, grid) = (&saved.columns, scenario.grid());
    let kinds = scenario.species.len();
    let has_kinds = match &columns.species {
        None => kinds == 0,
        Some(species) => kinds > 0 && species.iter().all(|&kind| usize::from(kind) < kinds),
    };
    if !has_kinds {
        return Err("its grains are of other species".to_owned());
    }
    if columns.spins.is_some() != scenario.roughness.is_some() {
        return Err("its grains do not spin where they should, or the other way round".to_owned());
    }
    let beyond =
        if scenario.engine.kind.is_event_driven() { reach_of_walls(&scenario.boundary) } else { V::ZERO };
    let (low, high) = (grid.origin() - beyond, grid.end() + beyond);
    for (row, id) in columns.ids.iter().enumerate() {
        let position = columns.positions[row];
        if !(0..V::DIMENSION).all(|axis| (low[axis]..=high[axis]).contains(&position[axis])) {
            return Err(format!("grain {id} is outside the box"));
        }
        let spin = columns.spins.as_ref().map(|spins| spins[row]);
        let spins = spin.is_none_or(|spin| spin.as_ref().iter().all(|component| component.is_finite()));
        if !(columns.velocities[row].length_squared().is_finite() && spins) {
            return Err(format!("grain {id} moves at no finite speed"));
        }
    }
    check_largest_speed(saved)
}

/// The fastest grain is as fast as the state says.
fn check_largest_speed<V: Vector>(saved: &SavedState<'_, V>) -> Result<(), String> {
    let Some(said) = saved.largest_speed else { return Ok(()) };
    let found = moments::largest_speed(&saved.columns.velocities);
    if (found - said).abs() <= SPEED_ROUNDING * found {
        return Ok(());
    }
    Err(format!("its fastest grain moves at {found:?}, and the largest speed is {said:?}"))
}

/// How far walls that vibrate come out of the box along each axis [length].
fn reach_of_walls<V: Vector>(boundary: &Boundary<V>) -> V {
    let mut reach = V::ZERO;
    for (axis, _, wall) in boundary.walls() {
        if let WallKind::Vibrating { amplitude, .. } = wall.kind {
            reach[axis] = amplitude.max(reach[axis]);
        }
    }
    reach
}

/// Everything that was summed up is a number, and what belongs together agrees.
fn check_sums<V: Vector>(scenario: &Scenario<V>, saved: &SavedState<'_, V>) -> Result<(), String> {
    let SavedState { totals, beginning, engine, .. } = saved;
    let is_finite = totals.counts.wall_momentum.iter().flatten().all(|momentum| momentum.is_finite())
        && totals.counts.carried_momentum.is_finite()
        && beginning.momentum.is_finite()
        && [beginning.kinetic_energy, beginning.momentum_scale].iter().all(|sum| sum.is_finite());
    if !(is_finite && counted(totals).into_iter().all(|count| count < MOST)) {
        return Err("its sums are beyond what can be counted".to_owned());
    }
    if scenario.source.is_none() && totals.poured > 0 {
        return Err("grains were poured, and there is no source".to_owned());
    }
    if !has_collisions_per_particle(totals, saved.columns.len()) {
        return Err("its collisions and its collisions per particle do not agree".to_owned());
    }
    if saved.memories.len() < saved.samples.len() {
        return Err("more measures have sampled than remember anything".to_owned());
    }
    let is_event_driven = scenario.engine.kind.is_event_driven();
    if saved.invalid_states.is_some() != is_event_driven
        || saved.invalid_states.is_some_and(|count| count >= MOST)
    {
        return Err("its overlaps were counted by another engine".to_owned());
    }
    let begins = engine.numbers.is_empty() && engine.words.is_empty();
    match is_event_driven {
        true if begins && totals.events.all > 0 => Err("what the engine held is missing".to_owned()),
        false if engine.step != totals.steps => {
            Err(format!("the engine has made {} steps, and {} are counted", engine.step, totals.steps))
        }
        _ => Ok(()),
    }
}

fn counted<V: Vector>(totals: &Totals<V>) -> Vec<u64> {
    let Totals { counts, events, since, .. } = totals;
    let steps = [totals.steps, totals.steps_capped, totals.poured, totals.particle_steps];
    let happened =
        [counts.collisions, counts.candidates, counts.cell_collisions, counts.rejected_moves, counts.removed];
    let kinds =
        [events.all, events.wall_hits, events.crossings, events.list_renewals, events.annulled, events.cured];
    let places = [since.grains, since.collisions];
    [&steps[..], &happened, &kinds, &places, &events.impacts].concat()
}

/// Whether collisions per particle follow from collisions, where these are counted since the number of grains changed.
fn has_collisions_per_particle<V: Vector>(totals: &Totals<V>, grains: usize) -> bool {
    let is_sum = |sum: f64| (0.0..f64::INFINITY).contains(&sum);
    is_sum(totals.collisions_per_particle)
        && is_sum(totals.since.collisions_per_particle)
        && totals.since.collisions <= totals.counts.collisions
        && (totals.since.grains != grains as u64
            || grains == 0
            || totals.per_particle_after(0, grains) == totals.collisions_per_particle)
}
