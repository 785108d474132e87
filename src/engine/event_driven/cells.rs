//! Cells in which the grains that may meet are found.

use super::body::{Body, Face, NONE, Plan};
use crate::law::boundary::Boundary;
use crate::matter::fetch::fetch;
use crate::space::Vector;

/// Slack of a cell against the largest contact distance: rounding must not hide a contact.
pub(super) const SLACK: f64 = 1.0 + 1e-9;

/// A box cut into cells, each with a chain of its grains.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cells<V> {
    size: V,
    side: V,
    inverse_side: V,
    counts: [u32; 3],
    strides: [u32; 3],
    periodic: [bool; 3],
    /// `[cell]`: its first grain, or [`NONE`].
    heads: Vec<u32>,
    /// Cells around one that is not at the edge of the box, as differences of cell numbers: on every side
    /// with itself, and on each of its six sides alone.
    inside: Layers,
}

/// Differences of cell numbers.
#[derive(Clone, Debug, Default, PartialEq)]
struct Layers {
    all: Vec<u32>,
    /// Those of `all` that lie straight across the first axis: their neighbours along it share their memory.
    lines: Vec<u32>,
    /// `[axis][side]`.
    sides: [[Vec<u32>; 2]; 3],
}

/// Cells next to a cell along one axis, itself among them.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// Part of the cell number, and where its periodic image stands [length].
    places: [(u32, f64); 3],
    number: usize,
}

/// The cells around a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    rows: [Row; 3],
}

impl<V: Vector> Cells<V> {
    /// Empty cells of at least `reach`, and of about `wish`, on each side, in the box of `size` [length].
    pub(super) fn new(size: V, boundary: &Boundary<V>, reach: f64, wish: f64) -> Self {
        let periodic = [0, 1, 2].map(|axis| axis < V::DIMENSION && boundary.is_periodic(axis));
        Self::with_counts(size, Self::counts_of(size, reach, wish), periodic)
    }

    /// How many cells of at least `reach`, and of about `wish`, on each side there are along each axis of `size` [length].
    pub(super) fn counts_of(size: V, reach: f64, wish: f64) -> [u32; 3] {
        let mut counts = [1; 3];
        for axis in 0..V::DIMENSION {
            let most = (size[axis] / (reach * SLACK)).floor();
            counts[axis] = (size[axis] / wish).round().min(most).clamp(1.0, 1e9) as u32;
        }
        counts
    }

    /// Empty cells, `counts` along each axis.
    pub(super) fn with_counts(size: V, counts: [u32; 3], periodic: [bool; 3]) -> Self {
        let total: usize = counts.iter().map(|&count| count as usize).product();
        let strides = [1, counts[0], counts[0] * counts[1]];
        Cells {
            size,
            side: V::from_fn(|axis| size[axis] / f64::from(counts[axis])),
            inverse_side: V::from_fn(|axis| f64::from(counts[axis]) / size[axis]),
            counts,
            strides,
            periodic,
            heads: vec![NONE; total],
            inside: Layers::new(V::DIMENSION, strides),
        }
    }

    /// Cells along each axis.
    pub(super) fn counts(&self) -> [u32; 3] {
        self.counts
    }

    /// Number of all cells.
    pub(super) fn number(&self) -> usize {
        self.heads.len()
    }

    /// Sides of a cell [length].
    pub(super) fn side(&self) -> V {
        self.side
    }

    /// Whether `cell` has a neighbour beyond `face`.
    pub(super) fn has_beyond(&self, cell: u32, face: Face) -> bool {
        let axis = face.axis();
        let last = if face.upper { self.counts[axis] - 1 } else { 0 };
        self.periodic[axis] || self.coordinates(cell)[axis] != last
    }

    /// Empties all cells.
    pub(super) fn clear(&mut self) {
        self.heads.fill(NONE);
    }

    /// The cell of `position`; a position outside counts to the nearest cell.
    pub(super) fn cell_of(&self, position: V) -> u32 {
        (0..V::DIMENSION).map(|axis| self.coordinate(position, axis) * self.strides[axis]).sum()
    }

    /// The coordinate along `axis` of the cell of `position`.
    pub(super) fn coordinate(&self, position: V, axis: usize) -> u32 {
        ((position[axis] * self.inverse_side[axis]) as u32).min(self.counts[axis] - 1)
    }

    #[inline(always)]
    fn coordinates(&self, cell: u32) -> [u32; 3] {
        let (mut coordinates, mut rest) = ([0; 3], cell);
        for axis in (1..V::DIMENSION).rev() {
            coordinates[axis] = rest / self.strides[axis];
            rest -= coordinates[axis] * self.strides[axis];
        }
        coordinates[0] = rest;
        coordinates
    }

    /// Lower and upper corner of `cell`; infinite where the box has a face that is no cell's [length].
    #[inline(always)]
    pub(super) fn bounds(&self, cell: u32) -> (V, V) {
        let at = self.coordinates(cell);
        let low = V::from_fn(|axis| match at[axis] {
            0 if !self.periodic[axis] => f64::NEG_INFINITY,
            k => f64::from(k) * self.side[axis],
        });
        let high = V::from_fn(|axis| match at[axis] + 1 {
            k if k == self.counts[axis] && !self.periodic[axis] => f64::INFINITY,
            k => f64::from(k) * self.side[axis],
        });
        (low, high)
    }

    /// The first grains of the cells around `cell`, or of those on the side `only` of it, and how many
    /// there are; `None` for a cell at the edge of the box.
    #[inline]
    pub(super) fn firsts_around(&self, cell: u32, only: Option<Face>) -> Option<([u32; 27], usize)> {
        let at = self.coordinates(cell);
        if (0..V::DIMENSION).any(|axis| at[axis] == 0 || at[axis] + 1 == self.counts[axis]) {
            return None;
        }
        let layer = match only {
            None => &self.inside.all,
            Some(face) => &self.inside.sides[face.axis()][face.side()],
        };
        let (mut firsts, mut number) = ([0; 27], 0);
        for &step in layer {
            let first = self.heads[cell.wrapping_add(step) as usize];
            firsts[number] = first;
            number += usize::from(first != NONE);
        }
        Some((firsts, number))
    }

    /// Sends for the memory of the cells around `cell`.
    #[inline]
    pub(super) fn send_for(&self, cell: u32) {
        for &step in &self.inside.lines {
            if let Some(head) = self.heads.get(cell.wrapping_add(step) as usize) {
                fetch(head);
            }
        }
    }

    /// The cells around `cell`, itself among them; with `only`, those that lie on that side of it.
    #[inline]
    pub(super) fn around(&self, cell: u32, only: Option<Face>) -> Around {
        let at = self.coordinates(cell);
        let mut rows = [Row { places: [(0, 0.0); 3], number: 1 }; 3];
        for axis in 0..V::DIMENSION {
            rows[axis] = match only {
                Some(face) if face.axis() == axis => {
                    self.row(at[axis], axis, [face.upper, !face.upper], false)
                }
                _ => self.row(at[axis], axis, [true, true], true),
            };
        }
        Around { rows }
    }

    /// The place along `axis` above and below `here`, as far as `[above, below]` asks for them, and itself.
    #[inline]
    fn row(&self, here: u32, axis: usize, wanted: [bool; 2], itself: bool) -> Row {
        let (stride, last) = (self.strides[axis], self.counts[axis] - 1);
        let mut row = Row::default();
        let mut add = |place: u32, shift: f64| {
            row.places[row.number] = (place * stride, shift);
            row.number += 1;
        };
        if wanted[1] {
            if here > 0 {
                add(here - 1, 0.0);
            } else if self.periodic[axis] {
                add(last, -self.size[axis]);
            }
        }
        if itself {
            add(here, 0.0);
        }
        if wanted[0] {
            if here < last {
                add(here + 1, 0.0);
            } else if self.periodic[axis] {
                add(0, self.size[axis]);
            }
        }
        row
    }

    /// The neighbour of `cell` beyond `face`, and how far a grain is moved that enters it there [length].
    pub(super) fn beyond(&self, cell: u32, face: Face) -> (u32, f64) {
        let axis = face.axis();
        let here = self.coordinates(cell)[axis];
        let row = self.row(here, axis, [face.upper, !face.upper], false);
        debug_assert_eq!(row.number, 1, "no grain crosses a face of the box that is not periodic");
        let (part, shift) = row.places[0];
        (cell - here * self.strides[axis] + part, -shift)
    }

    /// The first grain of `cell`.
    #[inline(always)]
    pub(super) fn first(&self, cell: u32) -> u32 {
        self.heads[cell as usize]
    }

    /// Puts the grain in `row` into `cell`.
    pub(super) fn insert(&mut self, cell: u32, row: u32, bodies: &mut [Body<V>], plans: &mut [Plan]) {
        bodies[row as usize].next = std::mem::replace(&mut self.heads[cell as usize], row);
        plans[row as usize].cell = cell;
    }

    /// Takes the grain in `row` out of its cell.
    pub(super) fn remove(&mut self, row: u32, bodies: &mut [Body<V>], plans: &mut [Plan]) {
        let cell = std::mem::replace(&mut plans[row as usize].cell, NONE);
        let after = bodies[row as usize].next;
        let head = &mut self.heads[cell as usize];
        if *head == row {
            *head = after;
            return;
        }
        let mut before = *head as usize;
        while bodies[before].next != row {
            before = bodies[before].next as usize;
        }
        bodies[before].next = after;
    }
}

impl Layers {
    fn new(dimension: usize, strides: [u32; 3]) -> Self {
        let steps = |axis: usize| if axis < dimension { -1..=1 } else { 0..=0 };
        let mut layers = Layers::default();
        for z in steps(2) {
            for (y, x) in steps(1).flat_map(|y| steps(0).map(move |x| (y, x))) {
                let at: [i32; 3] = [x, y, z];
                let step = |axis: usize| (at[axis] as u32).wrapping_mul(strides[axis]);
                let sum = step(0).wrapping_add(step(1)).wrapping_add(step(2));
                layers.all.push(sum);
                if x == 0 {
                    layers.lines.push(sum);
                }
                for (sides, at) in layers.sides.iter_mut().zip(at) {
                    match at {
                        -1 => sides[0].push(sum),
                        1 => sides[1].push(sum),
                        _ => {}
                    }
                }
            }
        }
        layers
    }
}

impl Around {
    /// Calls `look` with each cell and the shift of its periodic image.
    #[inline(always)]
    pub(super) fn for_each<V: Vector>(&self, mut look: impl FnMut(u32, V)) {
        for &(layer, z) in &self.rows[2].places[..self.rows[2].number] {
            for &(line, y) in &self.rows[1].places[..self.rows[1].number] {
                for &(place, x) in &self.rows[0].places[..self.rows[0].number] {
                    look(layer + line + place, V::from_fn(|axis| [x, y, z][axis]));
                }
            }
        }
    }
}
