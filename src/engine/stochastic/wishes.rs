//! Displacements that collisions of HSMC ask for, and which of them nobody can object to.
//!
//! A displacement needs room, and room depends on who was displaced before. Collisions do not depend on it: so
//! they all come first, and their displacements are wishes. A cell is calm when its wishes find room in
//! whatever order they are granted, because even with all visitors that others wish to send, and with nobody leaving,
//! no cell that they enter gets too full. Calm cells are served at once, in parallel; the others wait for their
//! turn ([`super::coloured_pass`]).

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::blocks::Block;
use super::cell_pairs::Displaced;
use super::laws::Room;
use super::rules::DisplacementRule;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// What displaced grains have to respect.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    pub(crate) offsets: &'a [u32],
    pub(crate) room: Room<V>,
    pub(crate) capacity: u32,
    pub(crate) rule: DisplacementRule,
}

/// What came of the wishes of a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Granted {
    /// What the displacements carry.
    pub(crate) carried: f64,
    /// Whether some cell comes near its capacity.
    pub(crate) crowded: bool,
}

/// The wishes of a step are granted or put off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wishes<'a, V: Vector> {
    pub(crate) places: Places<'a, V>,
    /// `[cell]`: grains that would enter if every wish came true.
    pub(crate) visitors: &'a [AtomicU32],
}

impl<V: Vector> Places<'_, V> {
    /// Grains in `cell` before any displacement.
    #[inline(always)]
    pub(crate) fn occupancy(&self, cell: u32) -> u32 {
        self.offsets[cell as usize + 1] - self.offsets[cell as usize]
    }

    /// A displaced position and its cell; `None` behind a wall or beyond the cells beside `home`.
    #[inline(always)]
    pub(crate) fn place(&self, home: [u32; 3], position: V) -> Option<(V, u32)> {
        if !self.room.holds(position) {
            return None;
        }
        let position = self.grid.wrapped(position);
        let mut cell = 0;
        for (axis, home) in home.into_iter().enumerate().take(V::DIMENSION) {
            let there = self.grid.coordinate_of(position, axis);
            let distance = there.abs_diff(home);
            if distance > 1 && !(self.grid.is_periodic(axis) && distance == self.grid.cells()[axis] - 1) {
                return None;
            }
            cell += there * self.grid.stride(axis);
        }
        Some((position, cell))
    }
}

impl<V: Vector> Wishes<'_, V> {
    /// Grants all wishes of a block, in their order, as if nobody else had any, and counts the visitors that
    /// this sends to other cells.
    pub(crate) fn grant(&self, wishes: &[Displaced<V>], block: &mut Block<'_, V>) -> Granted {
        for cell in block.cells.clone() {
            let rows = block.rows_of(cell, self.places.offsets);
            block.targets[rows].fill(cell);
        }
        let mut granted = Granted::default();
        let mut home = (u32::MAX, [0; 3]);
        for &wish in wishes {
            if self.places.occupancy(wish.cell) >= self.places.capacity {
                continue;
            }
            if home.0 != wish.cell {
                home = (wish.cell, self.places.grid.coordinates(wish.cell));
            }
            let enter = |cell: u32| {
                let before = self.visitors[cell as usize].fetch_add(1, Relaxed);
                granted.crowded |= self.places.occupancy(cell) + before + 1 >= self.places.capacity;
            };
            if self.displace(home.1, wish, block.positions, block.targets, enter) {
                granted.carried += wish.carried;
            }
        }
        granted
    }

    /// Displaces both partners, if no wall is in the way; `enter` is told of cells that a partner enters.
    #[inline(always)]
    fn displace(
        &self,
        home: [u32; 3],
        wish: Displaced<V>,
        positions: &mut [V],
        cells: &mut [u32],
        mut enter: impl FnMut(u32),
    ) -> bool {
        let (i, j) = wish.pair;
        let first = self.places.place(home, positions[i] + wish.shift);
        let second = self.places.place(home, positions[j] - wish.shift);
        let (Some((first, cell_i)), Some((second, cell_j))) = (first, second) else { return false };
        for (row, cell) in [(i, cell_i), (j, cell_j)] {
            if cell != cells[row] {
                cells[row] = cell;
                enter(cell);
            }
        }
        (positions[i], positions[j]) = (first, second);
        true
    }

    /// Where cells have turned out crowded: what has been granted to calm cells stays, and `occupancy` `[cell]` follows;
    /// other cells get their `original` positions back and are added to `contested`. Returns what the displacements of
    /// calm cells carry.
    pub(crate) fn keep_calm(
        &self,
        wishes: &[Displaced<V>],
        block: &mut Block<'_, V>,
        original: &[V],
        occupancy: &[AtomicU32],
        contested: &mut Vec<u32>,
    ) -> f64 {
        let mut carried = 0.0;
        let mut draft = original.to_vec();
        for wishes in wishes.chunk_by(|a, b| a.cell == b.cell) {
            let cell = wishes[0].cell;
            let rows = block.rows_of(cell, self.places.offsets);
            block.targets[rows.clone()].fill(cell);
            if self.places.occupancy(cell) >= self.places.capacity {
                continue;
            }
            let Some(granted) = self.calm(wishes, &mut draft, block.targets) else {
                block.positions[rows.clone()].copy_from_slice(&original[rows]);
                contested.push(cell);
                continue;
            };
            carried += granted;
            for &now in block.targets[rows].iter().filter(|&&now| now != cell) {
                occupancy[cell as usize].fetch_sub(1, Relaxed);
                occupancy[now as usize].fetch_add(1, Relaxed);
            }
        }
        carried
    }

    /// What the displacements of one cell carry, if its wishes are granted in every order of all cells.
    fn calm(&self, wishes: &[Displaced<V>], positions: &mut [V], cells: &mut [u32]) -> Option<f64> {
        let most = |cell: u32| self.places.occupancy(cell) + self.visitors[cell as usize].load(Relaxed);
        let home = wishes[0].cell;
        let mut calm = most(home) < self.places.capacity;
        let coordinates = self.places.grid.coordinates(home);
        let mut carried = 0.0;
        for &wish in wishes {
            let enter = |entered| {
                calm &= self.places.rule == DisplacementRule::Thesis || most(entered) <= self.places.capacity;
            };
            if self.displace(coordinates, wish, positions, cells, enter) {
                carried += wish.carried;
            }
        }
        calm.then_some(carried)
    }
}
