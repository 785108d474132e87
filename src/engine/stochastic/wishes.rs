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

/// A displacement that a collision asks for, and what has been done about it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wish<V> {
    pub(crate) asked: Displaced<V>,
    is_granted: bool,
    /// Positions of the partners before [length].
    before: [V; 2],
    /// The cells that they have entered, or [`NO_CELL`].
    entered: [u32; 2],
}

/// No cell has this number.
const NO_CELL: u32 = u32::MAX;

impl<V: Vector> Wish<V> {
    /// One that nobody has looked at.
    pub(crate) fn new(asked: Displaced<V>) -> Self {
        Wish { asked, is_granted: false, before: [V::ZERO; 2], entered: [NO_CELL; 2] }
    }

    /// Takes back what was granted last.
    fn take_back(&self, positions: &mut [V]) {
        if self.is_granted {
            let (i, j) = self.asked.pair;
            [positions[i], positions[j]] = self.before;
        }
    }
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
    pub(crate) fn grant(&self, wishes: &mut [Wish<V>], block: &mut Block<'_, V>) -> Granted {
        for cell in block.cells.clone() {
            let rows = block.rows_of(cell, self.places.offsets);
            block.targets[rows].fill(cell);
        }
        let mut granted = Granted::default();
        let mut home = (NO_CELL, [0; 3]);
        for wish in wishes {
            let cell = wish.asked.cell;
            if self.places.occupancy(cell) >= self.places.capacity {
                continue;
            }
            if home.0 != cell {
                home = (cell, self.places.grid.coordinates(cell));
            }
            self.displace(home.1, wish, block.positions, block.targets);
            if wish.is_granted {
                granted.carried += wish.asked.carried;
            }
            for &entered in wish.entered.iter().filter(|&&entered| entered != NO_CELL) {
                let before = self.visitors[entered as usize].fetch_add(1, Relaxed);
                granted.crowded |= self.places.occupancy(entered) + before + 1 >= self.places.capacity;
            }
        }
        granted
    }

    /// Displaces both partners, if no wall is in the way.
    #[inline(always)]
    fn displace(&self, home: [u32; 3], wish: &mut Wish<V>, positions: &mut [V], cells: &mut [u32]) {
        let Displaced { pair: (i, j), shift, .. } = wish.asked;
        let first = self.places.place(home, positions[i] + shift);
        let second = self.places.place(home, positions[j] - shift);
        let (Some((first, cell_i)), Some((second, cell_j))) = (first, second) else { return };
        wish.is_granted = true;
        wish.before = [positions[i], positions[j]];
        wish.entered = [(i, cell_i), (j, cell_j)].map(|(row, cell)| {
            let is_new = std::mem::replace(&mut cells[row], cell) != cell;
            if is_new { cell } else { NO_CELL }
        });
        (positions[i], positions[j]) = (first, second);
    }

    /// Where cells have turned out crowded: what has been granted to calm cells stays, and `occupancy` `[cell]` follows;
    /// other cells get their grains back to where they were and are added to `contested`. Returns what the
    /// displacements of calm cells carry.
    pub(crate) fn keep_calm(
        &self,
        wishes: &[Wish<V>],
        block: &mut Block<'_, V>,
        occupancy: &[AtomicU32],
        contested: &mut Vec<u32>,
    ) -> f64 {
        let mut carried = 0.0;
        for wishes in wishes.chunk_by(|a, b| a.asked.cell == b.asked.cell) {
            let cell = wishes[0].asked.cell;
            let rows = block.rows_of(cell, self.places.offsets);
            if self.places.occupancy(cell) >= self.places.capacity {
                continue;
            }
            if !self.is_calm(wishes) {
                wishes.iter().rev().for_each(|wish| wish.take_back(block.positions));
                block.targets[rows].fill(cell);
                contested.push(cell);
                continue;
            }
            let granted = wishes.iter().filter(|wish| wish.is_granted);
            carried += granted.map(|wish| wish.asked.carried).sum::<f64>();
            for &now in block.targets[rows].iter().filter(|&&now| now != cell) {
                occupancy[cell as usize].fetch_sub(1, Relaxed);
                occupancy[now as usize].fetch_add(1, Relaxed);
            }
        }
        carried
    }

    /// Whether these wishes of one cell are granted in every order of all cells.
    fn is_calm(&self, wishes: &[Wish<V>]) -> bool {
        let most = |cell: u32| self.places.occupancy(cell) + self.visitors[cell as usize].load(Relaxed);
        let is_bounded = self.places.rule != DisplacementRule::Thesis;
        let mut entered = wishes.iter().flat_map(|wish| wish.entered).filter(|&cell| cell != NO_CELL);
        most(wishes[0].asked.cell) < self.places.capacity
            && !(is_bounded && entered.any(|cell| most(cell) > self.places.capacity))
    }
}

#[cfg(test)]
#[path = "wishes_tests.rs"]
mod tests;
