//! Random places without overlap: one grain after another wherever there is room.

use rayon::prelude::*;

use super::super::model::Scenario;
use crate::matter::bins::Bins;
use crate::random::{Phase, Stream, Streams};
use crate::space::Vector;

/// Up to this volume fraction grains are put in one by one; above it they grow.
const DENSEST_BY_INSERTION: [f64; 4] = [0.0, 0.0, 0.4, 0.3];
/// A grain that has found no room after so many draws never will.
const DRAWS: u32 = 20_000;
/// Grains that look for places at the same time.
const BATCH: usize = 1024;
/// So many draws ahead a grain sends for those that it may meet.
const AHEAD: usize = 2;

/// Whether the grains of `scenario` are few enough to be put in one by one.
pub(in crate::scenario) fn has_room<V: Vector>(scenario: &Scenario<V>) -> bool {
    // The number of grains is rounded: the last one is not counted.
    let share = 1.0 - 1.0 / f64::from(scenario.count.max(1));
    scenario.volume_fraction() * share <= DENSEST_BY_INSERTION[V::DIMENSION]
}

/// Places `[id]` for grains of these `diameters` `[id]` in the domain, no two of them overlapping and each a
/// radius away from every face that is not periodic; `None` where a grain finds no room.
///
/// Large grains go first. Every grain draws from a stream of its own, so that the next [`BATCH`] grains can look for places in
/// parallel, each beside those before all of them; who then finds that another one of them has come there goes on to draw.
pub(super) fn places<V: Vector>(scenario: &Scenario<V>, diameters: &[f64]) -> Option<Vec<V>> {
    let mut order: Vec<usize> = (0..diameters.len()).collect();
    order.sort_by(|&a, &b| diameters[b].total_cmp(&diameters[a]));
    let sizes: Vec<f64> = order.iter().map(|&id| diameters[id]).collect();
    let (largest, smallest) =
        (sizes.first().map_or(0.0, |size| *size), sizes.last().map_or(0.0, |size| *size));
    let mut bins = Bins::new(&scenario.grid(), largest, diameters.len());
    let overlaps = |bins: &Bins<V>, since: usize, id: usize, place: V| {
        let touches = |other: f64, distance_squared: f64| {
            let contact = 0.5 * (diameters[id] + other);
            distance_squared < contact * contact
        };
        // Which grain it is matters only between the contacts with the smallest and the largest.
        bins.any_near_since(since, place, |other, distance_squared| {
            touches(smallest, distance_squared)
                || touches(largest, distance_squared) && touches(sizes[other], distance_squared)
        })
    };
    let mut places = vec![V::ZERO; diameters.len()];
    for batch in order.chunks(BATCH) {
        let before = bins.len();
        let search = |&id: &usize| {
            let mut draws = Draws::of(scenario, id, diameters[id])?;
            let mut ahead = draws.clone().skip(AHEAD);
            let place = draws.find(|&place| {
                ahead.next().into_iter().for_each(|place| bins.fetch_around(place));
                !overlaps(&bins, 0, id, place)
            })?;
            Some((draws, place))
        };
        let found: Vec<_> = batch.par_iter().map(search).collect();
        for (&id, found) in batch.iter().zip(found) {
            let (mut draws, mut place) = found?;
            if overlaps(&bins, before, id, place) {
                place = draws.find(|&place| !overlaps(&bins, 0, id, place))?;
            }
            bins.insert(place);
            places[id] = place;
        }
    }
    Some(places)
}

/// Places that one grain draws, uniformly over the room of its centre, until it gives up.
#[derive(Clone)]
struct Draws<V> {
    low: V,
    room: V,
    random: Stream,
    left: u32,
}

impl<V: Vector> Draws<V> {
    /// The draws of grain `id`; `None` where no place in the box has room for it.
    fn of(scenario: &Scenario<V>, id: usize, diameter: f64) -> Option<Self> {
        let (low, room) = room_of_centres(scenario, diameter)?;
        let random = Streams::new(scenario.seed).at(0, Phase::InitialPositions).stream(id as u64);
        Some(Draws { low, room, random, left: DRAWS })
    }
}

impl<V: Vector> Iterator for Draws<V> {
    type Item = V;

    fn next(&mut self) -> Option<V> {
        self.left = self.left.checked_sub(1)?;
        Some(V::from_fn(|axis| self.low[axis] + self.random.uniform() * self.room[axis]))
    }
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
