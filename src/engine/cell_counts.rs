//! What happens in each cell, for engines that are asked to count it.

/// What has happened in one cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellCount {
    /// Collisions of pairs of grains.
    pub collisions: u64,
    /// Candidate pairs that were looked at; 0 where an engine draws none.
    pub attempts: u64,
    /// The bound on relative speeds that the last step drew its candidates with; 0 of a cell that drew none
    /// [length/time].
    pub bound: f64,
}

/// The largest number up to which all integers are told apart: 2⁵³.
const MOST: f64 = (1_u64 << 53) as f64;

/// `counts` as numbers that can be saved, each below 2⁵³.
pub fn memory(counts: &[CellCount]) -> Vec<f64> {
    counts.iter().flat_map(|count| [count.collisions as f64, count.attempts as f64, count.bound]).collect()
}

/// What [`memory`] made numbers of; `None` for what it cannot have made of so many `cells`.
pub fn recalled(memory: &[f64], cells: usize) -> Option<Vec<CellCount>> {
    let (triples, rest) = memory.as_chunks::<3>();
    let is_count = |count: f64| (0.0..=MOST).contains(&count);
    let is_one = |&[collisions, attempts, bound]: &[f64; 3]| {
        is_count(collisions) && is_count(attempts) && (0.0..f64::INFINITY).contains(&bound)
    };
    if triples.len() != cells || !rest.is_empty() || !triples.iter().all(is_one) {
        return None;
    }
    let count = |&[collisions, attempts, bound]: &[f64; 3]| CellCount {
        collisions: collisions as u64,
        attempts: attempts as u64,
        bound,
    };
    Some(triples.iter().map(count).collect())
}
