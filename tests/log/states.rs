//! Saved states come back bit for bit, whatever is in them.

use glam::{DVec2, DVec3};
use grainflow::matter::columns::Columns;
use grainflow::record::reader::last_state;
use grainflow::record::state::SavedState;
use grainflow::record::writer::LogWriter;
use grainflow::space::Vector;
use proptest::prelude::*;

use crate::{folder, header};

/// Any bits of a float, NaNs with payloads and −0 among them.
fn any_bits() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        Just(-0.0),
        Just(f64::from_bits(0x7ff4_dead_beef_0001)),
        Just(f64::from_bits(0xfff8_0000_0000_0042)),
    ]
}

fn any_vector<V: Vector>() -> impl Strategy<Value = V> {
    [any_bits(), any_bits(), any_bits()].prop_map(|components| V::from_fn(|axis| components[axis]))
}

/// Position, velocity, identity, spin, of which as much is taken as the space has, and species.
type AnyGrain<V> = (V, V, u32, DVec3, u8);

/// Writes `grains` into `columns`, with spins and species if these columns are there.
fn fill<V: Vector>(columns: &mut Columns<V>, grains: Vec<AnyGrain<V>>) {
    for (row, (position, velocity, id, spin, species)) in grains.into_iter().enumerate() {
        columns.insert(row, position, velocity, id);
        if let Some(spins) = &mut columns.spins {
            let components = spin.to_array();
            let width = spins[row].as_ref().len();
            spins[row].as_mut().copy_from_slice(&components[..width]);
        }
        if let Some(all) = &mut columns.species {
            all[row] = species;
        }
    }
}

fn any_state<V: Vector<Spin: AsMut<[f64]>>>() -> impl Strategy<Value = SavedState<'static, V>> {
    let grain = (any_vector::<V>(), any_vector::<V>(), any::<u32>(), any_vector::<DVec3>(), any::<u8>());
    let columns = (prop::collection::vec(grain, 0..20), any::<bool>(), any::<bool>());
    let numbers = (prop::array::uniform7(any_bits()), prop::array::uniform12(any::<u64>()));
    let momentum = prop::array::uniform3([any_vector::<V>(), any_vector::<V>()]);
    let memories = prop::collection::vec(("[a-z-]{0,8}", prop::collection::vec(any_bits(), 0..5)), 0..4);
    (columns, numbers, momentum, prop::collection::vec(any::<u64>(), 0..4), memories).prop_map(
        |((grains, rough, mixed), (floats, counts), momentum, samples, memories)| {
            let mut state = SavedState::<'static, V> { samples, memories, ..Default::default() };
            state.columns.to_mut().spins = rough.then(Vec::new);
            state.columns.to_mut().species = mixed.then(Vec::new);
            fill(state.columns.to_mut(), grains);
            [state.time, state.compensation, state.engine.largest_speed, state.engine.collision_rate, ..] =
                floats;
            [
                ..,
                state.last_poured,
                state.totals.collisions_per_particle,
                state.totals.counts.carried_momentum,
            ] = floats;
            state.next_id = counts[0] as u32;
            let totals = &mut state.totals;
            [
                _,
                state.engine.step,
                state.recordings,
                totals.steps,
                totals.steps_capped,
                totals.poured,
                totals.particle_steps,
                ..,
            ] = counts;
            let counted = &mut totals.counts;
            [
                ..,
                counted.collisions,
                counted.candidates,
                counted.cell_collisions,
                counted.rejected_moves,
                counted.removed,
            ] = counts;
            counted.wall_momentum = momentum;
            state.held_until = floats[2];
            state.largest_speed = (counts[5] % 2 == 0).then_some(floats[4]);
            state.invalid_states = (counts[3] % 2 == 0).then_some(counts[4]);
            state.engine.numbers = floats.repeat(counts[7] as usize % 5);
            state.engine.words = counts.map(|count| count as u32).repeat(counts[8] as usize % 3);
            state.totals.since.grains = counts[9];
            state.totals.since.collisions = counts[10];
            state.totals.since.collisions_per_particle = floats[3];
            state.totals.events.all = counts[0].max(1);
            state.totals.events.cured = counts[1];
            state.totals.events.impacts[39] = counts[2];
            state
        },
    )
}

/// All numbers of a state as text that tells any two bit patterns apart.
fn bits<V: Vector>(state: &SavedState<'_, V>) -> String {
    let vector = |v: V| (0..V::DIMENSION).map(|axis| v[axis].to_bits()).collect::<Vec<_>>();
    let spin = |spin: &V::Spin| spin.as_ref().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    let columns = &state.columns;
    let memory = |(name, values): &(String, Vec<f64>)| {
        (name.clone(), values.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
    };
    let totals = &state.totals;
    let counts = &totals.counts;
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        [
            state.held_until,
            totals.since.collisions_per_particle,
            state.time,
            state.compensation,
            state.last_poured,
            state.engine.largest_speed,
            state.engine.collision_rate
        ]
        .map(f64::to_bits),
        [totals.collisions_per_particle, counts.carried_momentum].map(f64::to_bits),
        (state.next_id, state.engine.step, state.recordings, &state.samples),
        [totals.steps, totals.steps_capped, totals.poured, totals.particle_steps],
        [counts.collisions, counts.candidates, counts.cell_collisions, counts.rejected_moves, counts.removed],
        counts.wall_momentum.map(|sides| sides.map(vector)),
        columns.positions.iter().chain(&columns.velocities).map(|&v| vector(v)).collect::<Vec<_>>(),
        (&columns.ids, &columns.species),
        columns.spins.as_ref().map(|spins| spins.iter().map(spin).collect::<Vec<_>>()),
        state.memories.iter().map(memory).collect::<Vec<_>>(),
        state.engine.numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>(),
        &state.engine.words,
        (totals.events, totals.since.grains, totals.since.collisions, state.invalid_states),
        state.largest_speed.map(f64::to_bits),
    )
}

fn comes_back<V: Vector>(state: &SavedState<'_, V>) {
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let mut log = LogWriter::create(&path, &header()).unwrap();
    log.state(state).unwrap();
    log.finish().unwrap();
    let back = last_state::<V>(&path).unwrap().unwrap();
    assert_eq!(bits(&back), bits(state));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn states_in_2d_come_back_bit_for_bit(state in any_state::<DVec2>()) {
        comes_back(&state);
    }

    #[test]
    fn states_in_3d_come_back_bit_for_bit(state in any_state::<DVec3>()) {
        comes_back(&state);
    }
}
