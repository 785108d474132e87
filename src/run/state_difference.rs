//! Where two saved states part: the first grain and field, or the first sum.

use crate::engine::EngineState;
use crate::record::contents::Frame;
use crate::record::state::SavedState;
use crate::space::Vector;

const AXES: [&str; 3] = ["x", "y", "z"];

/// What a log and a re-run say of the same thing.
pub(super) fn said(what: &str, log: impl std::fmt::Debug, rerun: impl std::fmt::Debug) -> String {
    format!("{what} is {log:?} in the log and {rerun:?} in the re-run")
}

/// The first difference between the state `log` and the same one of a `rerun`, bit for bit; `observes_alike` says
/// whether what measures remember and the momentum of walls count, which other releases may observe in other ways.
pub(super) fn first_difference<V: Vector>(
    log: &SavedState<'_, V>,
    rerun: &SavedState<'_, V>,
    observes_alike: bool,
) -> Option<String> {
    let of_grains = grains(log, rerun);
    let of_sums = || sums(log, rerun, observes_alike);
    let of_memories = || if observes_alike { remembered(log, rerun) } else { None };
    of_grains.or_else(of_sums).or_else(of_memories)
}

/// The first grain that differs.
fn grains<V: Vector>(log: &SavedState<'_, V>, rerun: &SavedState<'_, V>) -> Option<String> {
    let (a, b) = (&log.columns, &rerun.columns);
    if a.len() != b.len() {
        return Some(said("the number of grains", a.len(), b.len()));
    }
    let order = (0..a.len()).find(|&row| a.ids[row] != b.ids[row]);
    if let Some(row) = order {
        return Some(said(&format!("the identity of the grain in row {row}"), a.ids[row], b.ids[row]));
    }
    (0..a.len()).find_map(|row| {
        let name = |field: &str| format!("grain {}: {field}", a.ids[row]);
        let vector = |field: &str, a: V, b: V| {
            let axis = (0..V::DIMENSION).find(|&axis| a[axis].to_bits() != b[axis].to_bits())?;
            Some(said(&name(&format!("{field} {}", AXES[axis])), a[axis], b[axis]))
        };
        let spins = || match (&a.spins, &b.spins) {
            (Some(a), Some(b)) if !same(a[row].as_ref(), b[row].as_ref()) => {
                Some(said(&name("spin"), a[row].as_ref(), b[row].as_ref()))
            }
            _ => None,
        };
        let species = || match (&a.species, &b.species) {
            (Some(a), Some(b)) if a[row] != b[row] => Some(said(&name("species"), a[row], b[row])),
            _ => None,
        };
        vector("position", a.positions[row], b.positions[row])
            .or_else(|| vector("velocity", a.velocities[row], b.velocities[row]))
            .or_else(spins)
            .or_else(species)
    })
}

/// The first grain of the picture in a log that is another one in that of a re-run.
pub(super) fn grain_in_picture(log: &Frame, rerun: &Frame) -> Option<String> {
    let mut rows: Vec<(u32, usize)> = rerun.ids.iter().copied().zip(0..).collect();
    rows.sort_unstable();
    log.ids.iter().enumerate().find_map(|(k, id)| {
        let Ok(place) = rows.binary_search_by_key(id, |&(id, _)| id) else {
            return Some(format!("grain {id} is in the log alone"));
        };
        let row = rows[place].1;
        let field = |name: &str, a: [f32; 3], b: [f32; 3]| {
            let axis = (0..3).find(|&axis| a[axis].to_bits() != b[axis].to_bits())?;
            Some(said(&format!("grain {id}: {name} {}", AXES[axis]), a[axis], b[axis]))
        };
        field("position", log.positions[k], rerun.positions[row])
            .or_else(|| field("velocity", log.velocities[k], rerun.velocities[row]))
    })
}

/// The first number beside the grains that differs.
fn sums<V: Vector>(
    log: &SavedState<'_, V>,
    rerun: &SavedState<'_, V>,
    observes_alike: bool,
) -> Option<String> {
    let numbers = [
        ("the time", log.time, rerun.time),
        ("what the clock holds back", log.compensation, rerun.compensation),
        ("the speed that sets the next step", log.engine.largest_speed, rerun.engine.largest_speed),
        ("the collision rate", log.engine.collision_rate, rerun.engine.collision_rate),
        ("the time of the last poured grain", log.last_poured, rerun.last_poured),
        ("the time until which the source is held up", log.held_until, rerun.held_until),
    ];
    let number = numbers.into_iter().find(|(_, a, b)| a.to_bits() != b.to_bits());
    if let Some((what, a, b)) = number {
        return Some(said(what, a, b));
    }
    let counts = [
        ("the next identity", u64::from(log.next_id), u64::from(rerun.next_id)),
        ("the number of the step", log.engine.step, rerun.engine.step),
        ("the number of recordings", log.recordings, rerun.recordings),
        ("the number of states", log.states, rerun.states),
    ];
    if let Some((what, a, b)) = counts.into_iter().find(|(_, a, b)| a != b) {
        return Some(said(what, a, b));
    }
    let totals = |state: &SavedState<'_, V>| {
        let mut totals = state.totals.clone();
        if !observes_alike {
            totals.counts.wall_momentum = Default::default();
        }
        format!("{totals:?}")
    };
    let texts = [
        ("the sum of all steps and events", totals(log), totals(rerun)),
        ("the beginning", format!("{:?}", log.beginning), format!("{:?}", rerun.beginning)),
    ];
    if let Some((what, a, b)) = texts.into_iter().find(|(_, a, b)| a != b) {
        return Some(format!("{what} is {a} in the log and {b} in the re-run"));
    }
    let events = |engine: &EngineState| (bits(&engine.numbers), engine.words.clone());
    (events(&log.engine) != events(&rerun.engine)).then(|| "what grains do next differs".to_owned())
}

/// The first measure whose memory differs, among those that both know.
fn remembered<V: Vector>(log: &SavedState<'_, V>, rerun: &SavedState<'_, V>) -> Option<String> {
    log.memories.iter().find_map(|(name, memory)| {
        let (_, other) = rerun.memories.iter().find(|(other, _)| other == name)?;
        (!same(memory, other)).then(|| format!("what the measure {name} remembers differs"))
    })
}

/// Whether all bits are the same; what is no number has none.
pub(super) fn same(a: &[f64], b: &[f64]) -> bool {
    bits(a) == bits(b)
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| if number.is_nan() { u64::MAX } else { number.to_bits() }).collect()
}
