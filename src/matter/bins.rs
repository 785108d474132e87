//! Points in bins, to find those near a place.

use super::grid::Grid;
use crate::space::Vector;

/// Ends a list.
const END: u32 = u32::MAX;

/// Points in bins with sides of at least a reach: whatever lies within it is in the bins around.
#[derive(Clone, Debug)]
pub struct Bins<V: Vector> {
    grid: Grid<V>,
    /// `[bin]`: the point that came last, or [`END`].
    heads: Vec<u32>,
    /// `[point]`: the one before it in its bin, or [`END`].
    next: Vec<u32>,
    positions: Vec<V>,
}

impl<V: Vector> Bins<V> {
    /// No points yet, in the box of `grid`, for about `expected` of them; `reach` [length].
    pub fn new(grid: &Grid<V>, reach: f64, expected: usize) -> Self {
        // Bins without points are no use: at most about one per point.
        let volume_each = grid.size().product() / (expected.max(1) as f64);
        let side = reach.max(volume_each.powf(1.0 / V::DIMENSION as f64));
        let mut bins = [1; 3];
        let mut periodic = [false; 3];
        for axis in 0..V::DIMENSION {
            bins[axis] = (grid.size()[axis] / side).floor().max(1.0) as u32;
            periodic[axis] = grid.is_periodic(axis);
        }
        let grid = Grid::new(grid.origin(), grid.size(), &bins, &periodic);
        Bins { heads: vec![END; grid.number_of_cells()], next: Vec::new(), positions: Vec::new(), grid }
    }

    /// Adds a point [length]; points are numbered in the order in which they come.
    pub fn insert(&mut self, position: V) {
        let head = &mut self.heads[self.grid.cell_of(position) as usize];
        self.next.push(std::mem::replace(head, self.positions.len() as u32));
        self.positions.push(position);
    }

    /// Whether `is_one` holds for a point in the bins around `position`; it is told the point's number and its
    /// squared distance over periodic images [length²], and asked once for each.
    pub fn any_near(&self, position: V, mut is_one: impl FnMut(usize, f64) -> bool) -> bool {
        let centre = self.grid.coordinates(self.grid.cell_of(position));
        let around: [(usize, [u32; 3]); 3] = std::array::from_fn(|axis| self.around(axis, centre[axis]));
        let of = |axis: usize| around[axis].1[..around[axis].0].iter().copied();
        for z in of(2) {
            for y in of(1) {
                for x in of(0) {
                    let mut point = self.heads[self.grid.cell_at([x, y, z]) as usize];
                    while point != END {
                        let there = self.positions[point as usize];
                        let distance = self.grid.separation(position, there).length_squared();
                        if is_one(point as usize, distance) {
                            return true;
                        }
                        point = self.next[point as usize];
                    }
                }
            }
        }
        false
    }

    /// The coordinates at most one bin away from `here`, each once, and how many.
    fn around(&self, axis: usize, here: u32) -> (usize, [u32; 3]) {
        let bins = self.grid.cells()[axis];
        let wraps = axis < V::DIMENSION && self.grid.is_periodic(axis);
        let (mut found, mut number) = ([here; 3], 1);
        let below = if here > 0 { Some(here - 1) } else { wraps.then(|| bins - 1) };
        let above = if here + 1 < bins { Some(here + 1) } else { wraps.then_some(0) };
        for neighbour in [below, above].into_iter().flatten() {
            if !found[..number].contains(&neighbour) {
                found[number] = neighbour;
                number += 1;
            }
        }
        (number, found)
    }
}
