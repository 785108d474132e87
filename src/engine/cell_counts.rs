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

/// `counts` as numbers that can be saved, each below 2⁵³.
pub fn memory(counts: &[CellCount]) -> Vec<f64> {
    counts.iter().flat_map(|count| [count.collisions as f64, count.attempts as f64, count.bound]).collect()
}

/// What [`memory`] made numbers of.
pub fn recalled(memory: &[f64]) -> Vec<CellCount> {
    let (triples, _) = memory.as_chunks::<3>();
    let count = |&[collisions, attempts, bound]: &[f64; 3]| CellCount {
        collisions: collisions as u64,
        attempts: attempts as u64,
        bound,
    };
    triples.iter().map(count).collect()
}
