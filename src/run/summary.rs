//! `summary.json`: one flat object that says what a run was and what came out; its keys stand in
//! [`crate::simulation::figures`].

use serde_json::{Map, Value, json};

use super::{EQUILIBRATION, INITIAL_STATE, NUMERICS, RECORDING, momentum_drift};
use crate::machine::peak_memory_bytes;
use crate::matter::state_hash::state_hash;
use crate::observe::measure::Figure;
use crate::observe::moments;
use crate::record::summary::FAILED;
use crate::simulation::Simulation;
use crate::simulation::figures::{DEGREES_OF_FREEDOM, STANDARD_ERROR, STEADY, TREND, is_of_every_run};
use crate::simulation::limits::EndReason;
use crate::space::Vector;
use crate::statistics::Trend;
use crate::stopwatch::Stopwatch;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending<'a> {
    Reached(EndReason),
    Interrupted,
    /// It could not go on, and why.
    Failed(&'a str),
}

/// Verbs that do not advance the state.
const NOT_ADVANCING: [&str; 5] = [INITIAL_STATE, EQUILIBRATION, RECORDING, "measures", "synchronise"];

/// The summary of a run that has ended. What does not apply is null.
pub(super) fn summary<V: Vector>(
    simulation: &Simulation<'_, V>,
    ending: Ending<'_>,
    watch: &Stopwatch,
    figures: &[Figure],
) -> Map<String, Value> {
    let mut summary = what_ran(simulation);
    summary.append(&mut what_happened(simulation, ending));
    summary.append(&mut what_events_were(simulation));
    summary.append(&mut what_it_cost(simulation, watch));
    summary.insert("state_hash".to_owned(), json!(state_hash(simulation.gas())));
    debug_assert!(summary.keys().all(|key| is_of_every_run(key)), "a key that its table lacks");
    for figure in figures.iter().filter(|figure| !is_of_every_run(&figure.name)) {
        insert_figure(&mut summary, figure);
    }
    summary
}

/// A figure and what stands beside it ([`ATTRIBUTES`](crate::simulation::figures::ATTRIBUTES)).
fn insert_figure(summary: &mut Map<String, Value>, figure: &Figure) {
    let finite = |number: Option<f64>| json!(number.filter(|number| number.is_finite()));
    let unsteady = figure.trend.filter(|trend| *trend != Trend::Steady);
    let mut insert = |ending: &str, value: Value| summary.insert(figure.name.clone() + ending, value);
    insert("", finite(figure.value));
    insert(STANDARD_ERROR, finite(figure.standard_error));
    insert(DEGREES_OF_FREEDOM, finite(figure.degrees_of_freedom));
    insert(STEADY, json!(figure.trend.map(|trend| trend == Trend::Steady)));
    insert(TREND, json!(unsteady.map(Trend::name)));
}

fn what_ran<V: Vector>(simulation: &Simulation<'_, V>) -> Map<String, Value> {
    let scenario = simulation.scenario();
    let (initial, last) = (simulation.beginning().particles, simulation.gas().len() as u64);
    let grains = if initial > 0 { initial } else { last };
    let volume_fraction = grains as f64 * mean_volume(simulation) / scenario.size.product();
    object(json!({
        "scenario": scenario.name,
        "engine": scenario.engine.kind.name(),
        "dimension": V::DIMENSION,
        "particles_initial": initial,
        "particles_final": last,
        "volume_fraction": volume_fraction,
        "seed": scenario.seed,
        "threads": rayon::current_num_threads(),
        "version": env!("CARGO_PKG_VERSION"),
        "numerics": NUMERICS,
    }))
}

/// Mean volume (2D: area) of a grain [lengthᴰ].
fn mean_volume<V: Vector>(simulation: &Simulation<'_, V>) -> f64 {
    let gas = simulation.gas();
    if gas.species.is_empty() || gas.is_empty() {
        return simulation.scenario().grain.volume::<V>();
    }
    moments::volume(gas) / gas.len() as f64
}

fn what_happened<V: Vector>(simulation: &Simulation<'_, V>, ending: Ending<'_>) -> Map<String, Value> {
    let (gas, totals) = (simulation.gas(), simulation.totals());
    let end_reason = match ending {
        Ending::Reached(reason) => reason.name(),
        Ending::Interrupted => "interrupted",
        Ending::Failed(_) => FAILED,
    };
    let failure = match ending {
        Ending::Failed(why) => Some(why),
        _ => None,
    };
    object(json!({
        "steps": totals.steps,
        "steps_capped": totals.steps_capped,
        "events": simulation.is_event_driven().then_some(totals.events.all),
        "collisions": totals.counts.collisions,
        "candidates": (!simulation.is_event_driven()).then_some(totals.counts.candidates),
        "cell_collisions": simulation.capacity().map(|_| totals.counts.cell_collisions),
        "rejected_moves": simulation.capacity().map(|_| totals.counts.rejected_moves),
        "cell_capacity": simulation.capacity(),
        "largest_occupancy": gas.largest_occupancy(),
        "poured": simulation.scenario().source.as_ref().map(|_| totals.poured),
        "removed": totals.counts.removed,
        "collisions_per_particle": totals.collisions_per_particle,
        "simulated_time": gas.time(),
        "end_reason": end_reason,
        "interrupted": ending == Ending::Interrupted,
        "failure": failure,
        "kinetic_energy_initial": simulation.beginning().kinetic_energy,
        "kinetic_energy_final": moments::kinetic_energy(gas),
        "temperature": moments::temperature(gas),
        "momentum_drift": momentum_drift(simulation),
    }))
}

/// What an event-driven engine counts beside collisions; null for others.
fn what_events_were<V: Vector>(simulation: &Simulation<'_, V>) -> Map<String, Value> {
    let totals = simulation.totals();
    let events = simulation.is_event_driven().then_some(totals.events);
    let cured_share = events.and_then(|events| {
        let contacts = totals.counts.collisions + events.wall_hits;
        (contacts > 0).then(|| events.cured as f64 / contacts as f64)
    });
    object(json!({
        "wall_hits": events.map(|events| events.wall_hits),
        "cell_crossings": events.map(|events| events.crossings),
        "list_renewals": events.map(|events| events.list_renewals),
        "annulled_events": events.map(|events| events.annulled),
        "cured_share": cured_share,
        "invalid_states": simulation.invalid_states(),
    }))
}

fn what_it_cost<V: Vector>(simulation: &Simulation<'_, V>, watch: &Stopwatch) -> Map<String, Value> {
    let advancing: f64 = watch
        .laps()
        .iter()
        .filter(|(verb, _)| !NOT_ADVANCING.contains(verb))
        .map(|(_, seconds)| seconds)
        .sum();
    let equilibration = watch.laps().iter().find(|(verb, _)| *verb == EQUILIBRATION);
    // Of a run that was resumed, only the work after that was done here.
    let totals = simulation.totals();
    let resumed = simulation.resumed();
    let (earlier_steps, earlier_events) = resumed.map_or((0, 0), |at| (at.particle_steps, at.events));
    let per_second = |count: u64| Some(count as f64 / advancing).filter(|rate| rate.is_finite());
    let (steps, events) = match simulation.is_event_driven() {
        true => (None, per_second(totals.events.all - earlier_events)),
        false => (per_second(totals.particle_steps - earlier_steps), None),
    };
    object(json!({
        "resumed_at": resumed.map(|at| at.time),
        "wall_seconds": watch.seconds(),
        "equilibration_seconds": equilibration.map(|(_, seconds)| seconds),
        "advancing_seconds": advancing,
        "particle_steps_per_second": steps,
        "events_per_second": events,
        "peak_memory_bytes": peak_memory_bytes(),
    }))
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}
