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
use super::tally::Tally;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// One collision's wish to displace its partners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wish<V> {
    pub(crate) displaced: Displaced<V>,
    /// Whether it is possible where all wishes of its cell before it have come true: no wall is in the way.
    possible: bool,
}

/// What displaced grains have to respect.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places<'a, V: Vector> {
    pub(crate) grid: &'a Grid<V>,
    pub(crate) offsets: &'a [u32],
    pub(crate) room: Room<V>,
    pub(crate) capacity: u32,
    pub(crate) rule: DisplacementRule,
}

/// The wishes of a step are recorded, granted or put off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wishes<'a, V: Vector> {
    pub(crate) places: Places<'a, V>,
    /// `[cell]`: grains that would enter if every wish came true.
    pub(crate) visitors: &'a [AtomicU32],
}

/// Positions and cells of the grains of a block, as far as wishes have come true.
#[derive(Debug)]
pub(crate) struct Draft<V> {
    positions: Vec<V>,
    cells: Vec<u32>,
    /// The last cell looked at and its coordinates.
    home: (u32, [u32; 3]),
}

impl<V> Default for Draft<V> {
    fn default() -> Self {
        Draft { positions: Vec::new(), cells: Vec::new(), home: (u32::MAX, [0; 3]) }
    }
}

impl<V: Vector> Draft<V> {
    /// Everybody in `block` is where he is.
    pub(crate) fn begin(&mut self, block: &Block<'_, V>, offsets: &[u32]) {
        self.positions.clear();
        self.positions.extend_from_slice(block.positions);
        self.cells.clear();
        for cell in block.cells.clone() {
            self.cells.resize(block.rows_of(cell, offsets).end, cell);
        }
    }
}

impl<V: Vector> Places<'_, V> {
    /// Grains in `cell` before any displacement.
    #[inline(always)]
    pub(crate) fn occupancy(&self, cell: u32) -> u32 {
        self.offsets[cell as usize + 1] - self.offsets[cell as usize]
    }

    /// A displaced position and its cell; `None` behind a wall or beyond the cells beside `home`.
    #[inline]
    pub(crate) fn place(&self, home: [u32; 3], mut position: V) -> Option<(V, u32)> {
        if !self.room.holds(position) {
            return None;
        }
        let mut there = [0; 3];
        for axis in 0..V::DIMENSION {
            self.grid.wrap(&mut position, axis);
            there[axis] = self.grid.coordinate_of(position, axis);
            let distance = there[axis].abs_diff(home[axis]);
            if distance > 1 && !(self.grid.is_periodic(axis) && distance == self.grid.cells()[axis] - 1) {
                return None;
            }
        }
        Some((position, self.grid.cell_at(there)))
    }
}

impl<V: Vector> Wishes<'_, V> {
    /// Notes a wish. Returns whether it brings some cell near its capacity.
    #[inline]
    pub(crate) fn record(&self, displaced: Displaced<V>, draft: &mut Draft<V>, wishes: &mut Vec<Wish<V>>) -> bool {
        if self.places.occupancy(displaced.cell) >= self.places.capacity {
            return false;
        }
        let mut crowded = false;
        let possible = self.grant(displaced, draft, |cell| {
            let before = self.visitors[cell as usize].fetch_add(1, Relaxed);
            crowded |= self.places.occupancy(cell) + before + 1 >= self.places.capacity;
        });
        wishes.push(Wish { displaced, possible });
        crowded
    }

    /// Lets a wish come true in the draft, if no wall is in the way; `enter` is told of cells that a partner enters.
    #[inline(always)]
    fn grant(&self, displaced: Displaced<V>, draft: &mut Draft<V>, mut enter: impl FnMut(u32)) -> bool {
        let Displaced { cell, pair: (i, j), shift, .. } = displaced;
        if draft.home.0 != cell {
            draft.home = (cell, self.places.grid.coordinates(cell));
        }
        let home = draft.home.1;
        let first = self.places.place(home, draft.positions[i] + shift);
        let second = self.places.place(home, draft.positions[j] - shift);
        let (Some(first), Some(second)) = (first, second) else { return false };
        for (row, (position, cell)) in [(i, first), (j, second)] {
            if cell != draft.cells[row] {
                enter(cell);
            }
            (draft.positions[row], draft.cells[row]) = (position, cell);
        }
        true
    }

    /// Grants all wishes of a block: no cell is crowded anywhere.
    pub(crate) fn grant_all(&self, wishes: &[Wish<V>], block: &mut Block<'_, V>, tally: &mut Tally<V>) {
        for wish in wishes.iter().filter(|wish| wish.possible) {
            let Displaced { pair: (i, j), shift, carried, .. } = wish.displaced;
            for (row, shift) in [(i, shift), (j, -shift)] {
                let mut position = block.positions[row] + shift;
                (0..V::DIMENSION).for_each(|axis| self.places.grid.wrap(&mut position, axis));
                block.positions[row] = position;
            }
            tally.counts.carried_momentum += carried;
        }
    }

    /// Grants the wishes of calm cells, and keeps `occupancy` `[cell]` up to date; the others are added to `contested`.
    pub(crate) fn grant_calm(
        &self,
        wishes: &[Wish<V>],
        block: &mut Block<'_, V>,
        draft: &mut Draft<V>,
        occupancy: &[AtomicU32],
        contested: &mut Vec<u32>,
    ) -> Tally<V> {
        let mut tally = Tally::default();
        draft.begin(block, self.places.offsets);
        for wishes in wishes.chunk_by(|a, b| a.displaced.cell == b.displaced.cell) {
            let cell = wishes[0].displaced.cell;
            if !self.is_calm(cell, wishes, draft) {
                contested.push(cell);
                continue;
            }
            for row in block.rows_of(cell, self.places.offsets) {
                block.positions[row] = draft.positions[row];
                if draft.cells[row] != cell {
                    occupancy[cell as usize].fetch_sub(1, Relaxed);
                    occupancy[draft.cells[row] as usize].fetch_add(1, Relaxed);
                }
            }
            let granted = wishes.iter().filter(|wish| wish.possible);
            tally.counts.carried_momentum += granted.map(|wish| wish.displaced.carried).sum::<f64>();
        }
        tally
    }

    /// Whether the wishes of `cell` are granted in every order of all cells; the draft tells where they lead.
    fn is_calm(&self, cell: u32, wishes: &[Wish<V>], draft: &mut Draft<V>) -> bool {
        let most = |cell: u32| self.places.occupancy(cell) + self.visitors[cell as usize].load(Relaxed);
        let mut calm = most(cell) < self.places.capacity;
        for wish in wishes {
            self.grant(wish.displaced, draft, |entered| {
                calm &= self.places.rule == DisplacementRule::Thesis || most(entered) <= self.places.capacity;
            });
        }
        calm
    }
}
