//! Random places without overlap: one grain after another wherever there is room.

use super::super::model::Scenario;
use crate::matter::bins::Bins;
use crate::random::{Phase, Streams};
use crate::space::Vector;

/// Up to this volume fraction grains are put in one by one; above it they grow.
const DENSEST_BY_INSERTION: [f64; 4] = [0.0, 0.0, 0.4, 0.3];
/// A grain that has found no room after so many draws never will.
const DRAWS: u32 = 20_000;

/// Whether the grains of `scenario` are few enough to be put in one by one.
pub(in crate::scenario) fn has_room<V: Vector>(scenario: &Scenario<V>) -> bool {
    // The number of grains is rounded: the last one is not counted.
    let share = 1.0 - 1.0 / f64::from(scenario.count.max(1));
    scenario.volume_fraction() * share <= DENSEST_BY_INSERTION[V::DIMENSION]
}

/// Places `[id]` for grains of these `diameters` `[id]` in the domain, no two of them overlapping and each a
/// radius away from every face that is not periodic; `None` where a grain finds no room.
///
/// Large grains go first. Every grain draws from a stream of its own.
pub(super) fn places<V: Vector>(scenario: &Scenario<V>, diameters: &[f64]) -> Option<Vec<V>> {
    let streams = Streams::new(scenario.seed).at(0, Phase::InitialPositions);
    let mut order: Vec<usize> = (0..diameters.len()).collect();
    order.sort_by(|&a, &b| diameters[b].total_cmp(&diameters[a]));
    let largest = order.first().map_or(0.0, |&id| diameters[id]);
    let mut bins = Bins::new(&scenario.grid(), largest, diameters.len());
    let mut places = vec![V::ZERO; diameters.len()];
    for &id in &order {
        let (low, room) = room_of_centres(scenario, diameters[id])?;
        let mut random = streams.stream(id as u64);
        let is_free = |position: V| {
            !bins.any_near(position, |other, distance_squared| {
                let contact = 0.5 * (diameters[id] + diameters[order[other]]);
                distance_squared < contact * contact
            })
        };
        let place = (0..DRAWS)
            .map(|_| V::from_fn(|axis| low[axis] + random.uniform() * room[axis]))
            .find(|&place| is_free(place))?;
        bins.insert(place);
        places[id] = place;
    }
    Some(places)
}

/// Lower corner and size of the box that centres of grains of `diameter` may be in; `None` where there is none.
///
/// Open faces count as walls: they are closed while a gas equilibrates.
fn room_of_centres<V: Vector>(scenario: &Scenario<V>, diameter: f64) -> Option<(V, V)> {
    let kept = |axis: usize| if scenario.boundary.is_periodic(axis) { 0.0 } else { 0.5 * diameter };
    let low = V::from_fn(kept);
    let room = V::from_fn(|axis| scenario.size[axis] - 2.0 * kept(axis));
    (0..V::DIMENSION).all(|axis| room[axis] >= 0.0).then_some((low, room))
}
