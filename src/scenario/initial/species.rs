//! Which grain is of which species.

use super::super::model::Scenario;
use crate::random::{Phase, Streams};
use crate::space::Vector;

/// Names the streams that rank grains for their species, beside step 0 which places them.
const RANKING: u64 = 1;

/// The species of every grain `[id]`: exact numbers of each, in an order drawn from the seed; `None` where all
/// grains are alike.
pub(super) fn species<V: Vector>(scenario: &Scenario<V>) -> Option<Vec<u8>> {
    if scenario.species.is_empty() {
        return None;
    }
    let streams = Streams::new(scenario.seed).at(RANKING, Phase::InitialPositions);
    let mut ranking: Vec<(u64, u32)> = (0..scenario.count).map(|id| (streams.hash(id.into()), id)).collect();
    ranking.sort_unstable();
    let mut species = vec![0; scenario.count as usize];
    let mut ids = ranking.into_iter().map(|(_, id)| id);
    for (number, &count) in scenario.species_counts.iter().enumerate() {
        for id in ids.by_ref().take(count as usize) {
            species[id as usize] = number as u8;
        }
    }
    Some(species)
}
