//! Saved states as messages: large ones in parts, every number bit for bit.

use std::borrow::Cow;
use std::ops::Range;

use super::schema::grainflow::{
    Beginning as BeginningMessage, Engine, Events, Memory, State, Totals as TotalsMessage,
};
use super::state::{Beginning, SavedState};
use crate::engine::EngineState;
use crate::engine::report::{Counts, EventCounts, Since, Totals};
use crate::matter::columns::Columns;
use crate::space::Vector;

/// Grains in one part: about ten megabytes.
const PART: usize = 1 << 18;
/// Bytes of a grain that such a part is meant for.
const GRAIN_BYTES: usize = 40;

/// The rows of each part of `state`; an empty gas has one part. Where the engine holds much, parts have
/// fewer rows, so that they do not get longer.
pub(crate) fn parts<V: Vector>(state: &SavedState<'_, V>) -> impl Iterator<Item = Range<usize>> + use<V> {
    let grains = state.columns.len();
    let EngineState { numbers, words, .. } = &state.engine;
    let engine_bytes = (8 * numbers.len() + 4 * words.len()) / grains.max(1);
    let length = (PART * GRAIN_BYTES / (GRAIN_BYTES + engine_bytes)).max(1);
    (0..grains.max(1)).step_by(length).map(move |first| first..(first + length).min(grains))
}

/// The share of `rows` out of `grains` in `items`: the shares of all parts make the whole.
fn share<'a, T>(items: &'a [T], rows: &Range<usize>, grains: usize) -> &'a [T] {
    let place = |row: usize| match grains {
        0 => items.len(),
        _ => (items.len() as u128 * row as u128 / grains as u128) as usize,
    };
    let first = if rows.start == 0 { 0 } else { place(rows.start) };
    &items[first..place(rows.end)]
}

/// The part of `state` that holds `rows`.
pub(crate) fn part<V: Vector>(state: &SavedState<'_, V>, rows: Range<usize>) -> State {
    let columns = &state.columns;
    let numbers = share(&state.engine.numbers, &rows, columns.len());
    let engine_words = share(&state.engine.words, &rows, columns.len());
    let mut message = State {
        time: Some(state.time),
        compensation: Some(state.compensation),
        dimension: V::DIMENSION as u32,
        grains: columns.len() as u64,
        first_row: rows.start as u64,
        positions: vector_bytes(&columns.positions[rows.clone()]),
        velocities: vector_bytes(&columns.velocities[rows.clone()]),
        ids: bytes(rows.len(), columns.ids[rows.clone()].iter().copied(), u32::to_le_bytes),
        spins: columns.spins.as_ref().map(|spins| spin_bytes::<V>(&spins[rows.clone()])),
        species: columns.species.as_ref().map(|species| species[rows.clone()].to_vec()),
        engine_numbers: bytes(numbers.len(), numbers.iter().copied(), f64::to_le_bytes),
        engine_words: bytes(engine_words.len(), engine_words.iter().copied(), u32::to_le_bytes),
        ..Default::default()
    };
    if rows.start == 0 {
        add_sums(&mut message, state);
    }
    message
}

/// Puts states together again, part by part.
#[derive(Debug)]
pub(crate) struct Assembly<V: Vector> {
    /// The state so far and the grains that it will have.
    unfinished: Option<(SavedState<'static, V>, u64)>,
}

impl<V: Vector> Default for Assembly<V> {
    fn default() -> Self {
        Assembly { unfinished: None }
    }
}

impl<V: Vector> Assembly<V> {
    /// Takes one part; gives the state when it was the last one. A state of which a part was lost to
    /// damage is passed over.
    pub(crate) fn add(&mut self, part: &State) -> Result<Option<SavedState<'static, V>>, &'static str> {
        if part.dimension as usize != V::DIMENSION {
            return Err("a state has another dimension");
        }
        if part.first_row == 0 {
            self.unfinished = Some((sums_of(part).ok_or("a state lacks a field")?, part.grains));
        }
        let follows = |(state, grains): &(SavedState<'_, V>, u64)| {
            part.first_row == state.columns.len() as u64 && part.grains == *grains
        };
        let Some((state, grains)) = self.unfinished.as_mut().filter(|unfinished| follows(unfinished)) else {
            self.unfinished = None;
            return Ok(None);
        };
        append(state.columns.to_mut(), part).ok_or("the columns of a state do not fit together")?;
        append_engine(&mut state.engine, part).ok_or("what the engine held is cut off")?;
        if (state.columns.len() as u64) < *grains {
            return Ok(None);
        }
        Ok(self.unfinished.take().map(|(state, _)| state))
    }
}

fn add_sums<V: Vector>(message: &mut State, state: &SavedState<'_, V>) {
    message.next_id = state.next_id;
    message.largest_speed = state.largest_speed;
    message.engine = Some(Engine {
        step: state.engine.step,
        largest_speed: Some(state.engine.largest_speed),
        collision_rate: Some(state.engine.collision_rate),
    });
    message.totals = Some(totals_message(&state.totals));
    message.last_poured = Some(state.last_poured);
    message.held_until = Some(state.held_until);
    message.recordings = state.recordings;
    message.states = state.states;
    message.invalid_states = state.invalid_states;
    message.beginning = Some(BeginningMessage {
        particles: state.beginning.particles,
        kinetic_energy: Some(state.beginning.kinetic_energy),
        momentum: components(state.beginning.momentum).collect(),
        momentum_scale: Some(state.beginning.momentum_scale),
    });
    message.samples.clone_from(&state.samples);
    let memory = |(name, values): &(String, Vec<f64>)| Memory { name: name.clone(), values: values.clone() };
    message.memories = state.memories.iter().map(memory).collect();
}

/// The state that a first part holds, without its columns.
fn sums_of<V: Vector>(part: &State) -> Option<SavedState<'static, V>> {
    let engine = part.engine.as_ref()?;
    Some(SavedState {
        time: part.time?,
        compensation: part.compensation?,
        columns: Cow::Owned(Columns {
            spins: part.spins.is_some().then(Vec::new),
            species: part.species.is_some().then(Vec::new),
            ..Columns::default()
        }),
        largest_speed: part.largest_speed,
        next_id: part.next_id,
        engine: EngineState {
            step: engine.step,
            largest_speed: engine.largest_speed?,
            collision_rate: engine.collision_rate?,
            ..EngineState::default()
        },
        totals: totals_of(part.totals.as_ref()?)?,
        last_poured: part.last_poured?,
        // Older logs have none: their sources were never held up.
        held_until: part.held_until.unwrap_or(0.0),
        recordings: part.recordings,
        states: part.states,
        beginning: beginning_of(part.beginning.as_ref()?)?,
        samples: part.samples.clone(),
        memories: part.memories.iter().map(|memory| (memory.name.clone(), memory.values.clone())).collect(),
        invalid_states: part.invalid_states,
    })
}

fn beginning_of<V: Vector>(message: &BeginningMessage) -> Option<Beginning<V>> {
    if message.momentum.len() != V::DIMENSION {
        return None;
    }
    Some(Beginning {
        particles: message.particles,
        kinetic_energy: message.kinetic_energy?,
        momentum: V::from_fn(|axis| message.momentum[axis]),
        momentum_scale: message.momentum_scale?,
    })
}

fn totals_message<V: Vector>(totals: &Totals<V>) -> TotalsMessage {
    let counts = &totals.counts;
    TotalsMessage {
        steps: totals.steps,
        steps_capped: totals.steps_capped,
        poured: totals.poured,
        collisions_per_particle: Some(totals.collisions_per_particle),
        particle_steps: totals.particle_steps,
        collisions: counts.collisions,
        candidates: counts.candidates,
        cell_collisions: counts.cell_collisions,
        rejected_moves: counts.rejected_moves,
        removed: counts.removed,
        wall_momentum: counts.wall_momentum.iter().flatten().flat_map(|&vector| components(vector)).collect(),
        carried_momentum: Some(counts.carried_momentum),
        events: Some(events_message(&totals.events)),
        since_grains: totals.since.grains,
        since_collisions: totals.since.collisions,
        since_collisions_per_particle: Some(totals.since.collisions_per_particle),
    }
}

fn events_message(events: &EventCounts) -> Events {
    Events {
        all: events.all,
        wall_hits: events.wall_hits,
        crossings: events.crossings,
        list_renewals: events.list_renewals,
        annulled: events.annulled,
        cured: events.cured,
        impacts: events.impacts.to_vec(),
    }
}

fn events_of(message: &Events) -> EventCounts {
    let mut events = EventCounts {
        all: message.all,
        wall_hits: message.wall_hits,
        crossings: message.crossings,
        list_renewals: message.list_renewals,
        annulled: message.annulled,
        cured: message.cured,
        ..EventCounts::default()
    };
    for (count, &stored) in events.impacts.iter_mut().zip(&message.impacts) {
        *count = stored;
    }
    events
}

fn totals_of<V: Vector>(message: &TotalsMessage) -> Option<Totals<V>> {
    if message.wall_momentum.len() != 6 * V::DIMENSION {
        return None;
    }
    let mut wall_momentum = [[V::ZERO; 2]; 3];
    let numbers = message.wall_momentum.chunks_exact(V::DIMENSION);
    for (vector, numbers) in wall_momentum.iter_mut().flatten().zip(numbers) {
        *vector = V::from_fn(|axis| numbers[axis]);
    }
    Some(Totals {
        steps: message.steps,
        steps_capped: message.steps_capped,
        poured: message.poured,
        collisions_per_particle: message.collisions_per_particle?,
        particle_steps: message.particle_steps,
        counts: Counts {
            collisions: message.collisions,
            candidates: message.candidates,
            cell_collisions: message.cell_collisions,
            rejected_moves: message.rejected_moves,
            removed: message.removed,
            wall_momentum,
            carried_momentum: message.carried_momentum?,
        },
        // Older logs know neither events nor when the number of grains changed.
        events: message.events.as_ref().map(events_of).unwrap_or_default(),
        since: Since {
            grains: message.since_grains,
            collisions: message.since_collisions,
            collisions_per_particle: message.since_collisions_per_particle.unwrap_or(0.0),
        },
    })
}

/// Appends the rows of `part`; `None` where its columns have different lengths.
fn append<V: Vector>(columns: &mut Columns<V>, part: &State) -> Option<()> {
    columns.positions.extend(vectors_of::<V>(&part.positions)?);
    columns.velocities.extend(vectors_of::<V>(&part.velocities)?);
    columns.ids.extend(words::<4>(&part.ids)?.map(u32::from_le_bytes));
    if let Some(spins) = &mut columns.spins {
        spins.extend(spins_of::<V>(part.spins.as_ref()?)?);
    }
    if let Some(species) = &mut columns.species {
        species.extend(part.species.as_ref()?);
    }
    let n = columns.len();
    let whole = columns.positions.len() == n
        && columns.velocities.len() == n
        && columns.spins.as_ref().is_none_or(|spins| spins.len() == n)
        && columns.species.as_ref().is_none_or(|species| species.len() == n)
        && n as u64 <= part.grains;
    whole.then_some(())
}

/// Appends the share of `part` in what the engine held.
fn append_engine(engine: &mut EngineState, part: &State) -> Option<()> {
    engine.numbers.extend(words::<8>(&part.engine_numbers)?.map(f64::from_le_bytes));
    engine.words.extend(words::<4>(&part.engine_words)?.map(u32::from_le_bytes));
    Some(())
}

fn components<V: Vector>(vector: V) -> impl Iterator<Item = f64> {
    (0..V::DIMENSION).map(move |axis| vector[axis])
}

fn vector_bytes<V: Vector>(vectors: &[V]) -> Vec<u8> {
    bytes(
        vectors.len() * V::DIMENSION,
        vectors.iter().flat_map(|&vector| components(vector)),
        f64::to_le_bytes,
    )
}

fn spin_bytes<V: Vector>(spins: &[V::Spin]) -> Vec<u8> {
    let components = spins.iter().flat_map(|spin| spin.as_ref()).copied();
    bytes(spins.len() * V::DIMENSION, components, f64::to_le_bytes)
}

/// The bytes of `words`, about `expected` of them.
fn bytes<T, const W: usize>(
    expected: usize,
    words: impl Iterator<Item = T>,
    to_bytes: impl Fn(T) -> [u8; W],
) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(expected * W);
    words.for_each(|word| bytes.extend_from_slice(&to_bytes(word)));
    bytes
}

/// `bytes` as words of W bytes; `None` where some are left over.
fn words<const W: usize>(bytes: &[u8]) -> Option<impl Iterator<Item = [u8; W]>> {
    let (words, rest) = bytes.as_chunks::<W>();
    rest.is_empty().then(|| words.iter().copied())
}

fn vectors_of<V: Vector>(bytes: &[u8]) -> Option<Vec<V>> {
    let numbers: Vec<f64> = words::<8>(bytes)?.map(f64::from_le_bytes).collect();
    let vectors = numbers.chunks_exact(V::DIMENSION);
    vectors.remainder().is_empty().then(|| vectors.map(|numbers| V::from_fn(|axis| numbers[axis])).collect())
}

fn spins_of<V: Vector>(bytes: &[u8]) -> Option<Vec<V::Spin>> {
    let numbers: Vec<f64> = words::<8>(bytes)?.map(f64::from_le_bytes).collect();
    let width = V::Spin::default().as_ref().len();
    let spins = numbers.chunks_exact(width);
    let spin = |numbers: &[f64]| {
        let mut spin = V::Spin::default();
        spin.as_mut().copy_from_slice(numbers);
        spin
    };
    spins.remainder().is_empty().then(|| spins.map(spin).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn what_an_engine_holds_is_shared_among_the_parts() {
        let grains = 3 * PART + 5;
        let numbers: Vec<f64> = (0..10 * grains + 3).map(|k| k as f64).collect();
        let words: Vec<u32> = (0..17).collect();
        let mut state = SavedState::<DVec2>::default();
        let columns = state.columns.to_mut();
        columns.positions.resize(grains, DVec2::ONE);
        columns.velocities.resize(grains, DVec2::X);
        columns.ids.extend(0..grains as u32);
        state.engine = EngineState { numbers, words, ..EngineState::default() };
        let mut assembly = Assembly::<DVec2>::default();
        let mut whole = None;
        for rows in parts(&state) {
            assert!(whole.is_none());
            let part = part(&state, rows);
            assert!(prost::Message::encoded_len(&part) < 20_000_000);
            whole = assembly.add(&part).unwrap();
        }
        assert_eq!(whole.unwrap(), state);
    }

    #[test]
    fn an_engine_without_grains_keeps_what_it_holds() {
        let mut state = SavedState::<DVec2>::default();
        state.engine.words = vec![1, 2, 3];
        assert_eq!(parts(&state).collect::<Vec<_>>(), vec![Range { start: 0, end: 0 }]);
        let whole = Assembly::<DVec2>::default().add(&part(&state, 0..0)).unwrap();
        assert_eq!(whole.unwrap(), state);
    }

    #[test]
    fn older_states_have_no_events() {
        let state = SavedState::<DVec2>::default();
        let mut old = part(&state, 0..0);
        old.held_until = None;
        let totals = old.totals.as_mut().unwrap();
        (totals.events, totals.since_collisions_per_particle) = (None, None);
        assert_eq!(Assembly::<DVec2>::default().add(&old).unwrap().unwrap(), state);
    }
}
