//! Collisions counted in the cells of the gas, where somebody asks for that.

use super::world::World;
use crate::engine::cell_counts::CellCount;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// The cells of the gas and what has happened in them.
#[derive(Clone, Debug)]
pub(super) struct CellTally<V> {
    pub(super) grid: Grid<V>,
    /// `[cell]`.
    pub(super) counts: Vec<CellCount>,
}

impl<V: Vector> World<V> {
    /// A grain at `position` has collided with one that is `separation` away [length]: that counts half-way.
    #[inline]
    pub(super) fn count_in_its_cell(&mut self, position: V, separation: V) {
        if let Some(CellTally { grid, counts }) = &mut self.cell_tally {
            let place = grid.wrapped(position + separation * 0.5);
            counts[grid.cell_of(place) as usize].collisions += 1;
        }
    }
}
