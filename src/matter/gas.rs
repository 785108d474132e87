//! The cell-sorted container: the common currency of the program.
//!
//! Initial states make a gas, engines advance it, observers read it, logs store it.

use std::ops::Range;

use super::clock::Clock;
use super::columns::{Columns, Rows};
use super::grain::Grain;
use super::grid::Grid;
use super::scatter::{Labels, Slot};
use super::sort::CountingSort;
use crate::space::Vector;

/// Grains in cell order, with the box that they live in and their time.
#[derive(Clone, Debug, PartialEq)]
pub struct Gas<V: Vector> {
    /// Diameter and mass of every grain; of the first species where there are several.
    pub grain: Grain,
    /// Diameter and mass of each species `[species]`; empty where all grains are alike.
    pub species: Vec<Grain>,
    /// Simulated time [time].
    pub clock: Clock,
    grid: Grid<V>,
    columns: Columns<V>,
    /// `[cell + 1]`: the grains of cell c stand in rows `offsets[c] .. offsets[c + 1]`.
    offsets: Vec<u32>,
    next_id: u32,
}

/// What a sort needs beside the gas: a second set of columns, each grain's cell, counts.
#[derive(Debug, Default)]
pub struct SortSpace<V: Vector> {
    /// Columns that the next sorted state is written to, or read from.
    pub spare: Columns<V>,
    /// `[grain]`: the cell each grain goes to; [`super::sort::REMOVED`] takes it out.
    pub cells: Vec<u32>,
    /// Counts of the grains by the cell they go to.
    pub sort: CountingSort,
}

impl<V: Vector> SortSpace<V> {
    /// Takes the shape of `gas`; contents are unspecified.
    pub fn prepare(&mut self, gas: &Gas<V>) {
        self.spare.match_shape(&gas.columns);
        self.cells.resize(gas.len(), 0);
    }
}

impl<V: Vector> Gas<V> {
    /// An empty box at time 0.
    pub fn empty(grid: Grid<V>, grain: Grain) -> Self {
        let offsets = vec![0; grid.number_of_cells() + 1];
        Gas {
            grain,
            species: Vec::new(),
            clock: Clock::default(),
            grid,
            columns: Columns::default(),
            offsets,
            next_id: 0,
        }
    }

    /// Grains at `positions` with `velocities` `[grain]`, numbered in the given order, at time 0.
    pub fn new(grid: Grid<V>, grain: Grain, positions: Vec<V>, velocities: Vec<V>) -> Self {
        assert_eq!(positions.len(), velocities.len(), "a velocity for every position");
        let next_id = u32::try_from(positions.len()).expect("the scenario reader bounds the count");
        let columns =
            Columns { positions, velocities, ids: (0..next_id).collect(), spins: None, species: None };
        Self::restored(grid, grain, columns, Clock::default(), next_id)
    }

    /// A gas from saved columns. Rows that already are in cell order keep their order.
    pub fn restored(grid: Grid<V>, grain: Grain, columns: Columns<V>, clock: Clock, next_id: u32) -> Self {
        let mut gas = Gas { clock, next_id, ..Gas::empty(grid, grain) };
        gas.columns = columns;
        let mut space = SortSpace::default();
        space.prepare(&gas);
        for (cell, &position) in space.cells.iter_mut().zip(&gas.columns.positions) {
            *cell = gas.grid.cell_of(position);
        }
        gas.sort_through(&mut space);
        gas
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.columns.len()
    }
    /// Whether there are no grains.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }
    /// Diameter and mass of the grain in `row`.
    pub fn grain_at(&self, row: usize) -> Grain {
        match &self.columns.species {
            Some(species) if !self.species.is_empty() => self.species[species[row] as usize],
            _ => self.grain,
        }
    }
    /// Simulated time [time].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }
    /// The box and its cells.
    pub fn grid(&self) -> &Grid<V> {
        &self.grid
    }
    /// Positions [length], `[grain]` in cell order.
    pub fn positions(&self) -> &[V] {
        &self.columns.positions
    }
    /// Velocities [length/time], `[grain]` in cell order.
    pub fn velocities(&self) -> &[V] {
        &self.columns.velocities
    }
    /// Identities `[grain]` in cell order.
    pub fn ids(&self) -> &[u32] {
        &self.columns.ids
    }
    /// All columns, in cell order.
    pub fn columns(&self) -> &Columns<V> {
        &self.columns
    }
    /// The identity that the next new grain will get; also how many there ever were.
    pub fn next_id(&self) -> u32 {
        self.next_id
    }
    /// Where each cell's rows begin, `[cell + 1]`.
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }
    /// The rows of `cell`.
    pub fn rows(&self, cell: u32) -> Range<usize> {
        self.offsets[cell as usize] as usize..self.offsets[cell as usize + 1] as usize
    }
    /// Number of grains in `cell`.
    pub fn occupancy(&self, cell: u32) -> u32 {
        self.offsets[cell as usize + 1] - self.offsets[cell as usize]
    }
    /// The largest number of grains in any cell.
    pub fn largest_occupancy(&self) -> u32 {
        self.offsets.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0)
    }

    /// Velocities to be changed in place; positions and cells stay.
    pub fn velocities_mut(&mut self) -> &mut [V] {
        &mut self.columns.velocities
    }

    /// The grid, the offsets, and the columns to be changed by an engine, which then
    /// owes a sort ([`Gas::sort_through`] or [`Gas::sort_counted`]).
    pub fn parts_mut(&mut self) -> (&Grid<V>, &[u32], &mut Columns<V>) {
        (&self.grid, &self.offsets, &mut self.columns)
    }

    /// Adds a grain at the end of its cell and returns its identity.
    pub fn insert(&mut self, position: V, velocity: V) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        let cell = self.grid.cell_of(position) as usize;
        self.columns.insert(self.offsets[cell + 1] as usize, position, velocity, id);
        for offset in &mut self.offsets[cell + 1..] {
            *offset += 1;
        }
        id
    }

    /// Brings the own columns into the order of `space.cells`, through the spare ones.
    pub fn sort_through(&mut self, space: &mut SortSpace<V>) {
        space.sort.count(&space.cells[..self.columns.len()], self.grid.number_of_cells());
        self.sort_counted(space, copy);
    }

    /// [`Gas::sort_through`] after an engine has counted `space.cells` with `space.sort`; `put` brings the grain of a
    /// row of the columns into its slot, and may move it on the way.
    pub fn sort_counted(
        &mut self,
        space: &mut SortSpace<V>,
        put: impl Fn(Rows<'_, V>, usize, Slot<'_, V>) + Copy + Sync,
    ) {
        let kept = space.sort.accumulate(&mut self.offsets);
        space.spare.match_shape(&self.columns);
        space.spare.truncate(kept);
        let rows = self.columns.rows();
        let cells = &space.cells[..self.columns.len()];
        let labels = self.columns.labels();
        space.sort.fill(cells, &mut space.spare, labels, move |row, slot| put(rows, row, slot));
        std::mem::swap(&mut self.columns, &mut space.spare);
    }

    /// Replaces all grains by those that `grain` makes for each row of `space.cells`: position, velocity,
    /// identity, with their `labels`. They come into the order of `space.cells`.
    pub fn refill(
        &mut self,
        space: &mut SortSpace<V>,
        labels: Labels<'_, V>,
        grain: impl Fn(&Grid<V>, usize) -> (V, V, u32) + Copy + Sync,
    ) {
        space.sort.count(&space.cells, self.grid.number_of_cells());
        let kept = space.sort.accumulate(&mut self.offsets);
        self.columns.resize(kept, &labels);
        let grid = &self.grid;
        space.sort.fill(&space.cells, &mut self.columns, labels, |row, slot| {
            let (position, velocity, id) = grain(grid, row);
            slot.put(position, velocity, id);
        });
    }
}

/// Brings the grain of a row into its slot as it is.
#[inline(always)]
pub fn copy<V: Vector>(rows: Rows<'_, V>, row: usize, slot: Slot<'_, V>) {
    slot.put(rows.positions[row], rows.velocities[row], rows.ids[row]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn gas() -> Gas<DVec2> {
        let grid = Grid::new(DVec2::ZERO, DVec2::splat(4.0), &[4, 4], &[true, true]);
        let positions =
            vec![DVec2::new(3.5, 3.5), DVec2::new(0.5, 0.5), DVec2::new(1.5, 0.5), DVec2::new(0.6, 0.6)];
        let velocities = (0..4).map(|k| DVec2::splat(f64::from(k))).collect();
        Gas::new(grid, Grain { diameter: 1.0, mass: 1.0 }, positions, velocities)
    }

    #[test]
    fn grains_stand_in_cell_order() {
        let gas = gas();
        assert_eq!(gas.ids(), [1, 3, 2, 0]);
        assert_eq!(gas.rows(0), 0..2);
        assert_eq!(gas.occupancy(15), 1);
        assert_eq!(gas.velocities()[1], DVec2::splat(3.0));
    }

    #[test]
    fn an_inserted_grain_stands_last_in_its_cell() {
        let mut gas = gas();
        let id = gas.insert(DVec2::new(0.1, 0.1), DVec2::ZERO);
        assert_eq!((id, gas.next_id()), (4, 5));
        assert_eq!(gas.ids(), [1, 3, 4, 2, 0]);
        assert_eq!(gas.rows(1), 3..4);
    }
}
