//! Points in bins, to find those near a place.

use super::grid::Grid;
use crate::space::Vector;

/// Ends a list.
const END: u32 = u32::MAX;

/// The bin of a place and those around it, by their numbers along each axis in what [`Bins::around`] finds, of which the
/// first is the bin itself: that bin, those beyond its faces, its edges, its corners.
const NEAREST_FIRST: [[usize; 3]; 27] = nearest_first();

const fn nearest_first() -> [[usize; 3]; 27] {
    let mut order = [[0; 3]; 27];
    let (mut length, mut away) = (0, 0);
    while away <= 3 {
        let mut number = 0;
        while number < 27 {
            let places = [number % 3, number / 3 % 3, number / 9];
            if (places[0] > 0) as usize + (places[1] > 0) as usize + (places[2] > 0) as usize == away {
                order[length] = places;
                length += 1;
            }
            number += 1;
        }
        away += 1;
    }
    order
}

/// Points in bins with sides of at least a reach: whatever lies within it is in the bins around.
#[derive(Clone, Debug)]
pub struct Bins<V: Vector> {
    grid: Grid<V>,
    /// `[bin]`: the point that came last, or [`END`].
    heads: Vec<u32>,
    points: Vec<Point<V>>,
}

/// One point.
#[derive(Clone, Copy, Debug)]
struct Point<V> {
    position: V,
    /// The one before it in its bin, or [`END`].
    next: u32,
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
        Bins { heads: vec![END; grid.number_of_cells()], points: Vec::new(), grid }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is no point yet.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds a point [length]; points are numbered in the order in which they come.
    pub fn insert(&mut self, position: V) {
        let head = &mut self.heads[self.grid.cell_of(position) as usize];
        let next = std::mem::replace(head, self.points.len() as u32);
        self.points.push(Point { position, next });
    }

    /// Whether `is_one` holds for a point in the bins around `position`; it is told the point's number and its
    /// squared distance over periodic images [length²], and asked once for each. The nearest bins come first.
    pub fn any_near(&self, position: V, is_one: impl FnMut(usize, f64) -> bool) -> bool {
        self.any_near_since(0, position, is_one)
    }

    /// The same for points from number `first` on.
    pub fn any_near_since(
        &self,
        first: usize,
        position: V,
        mut is_one: impl FnMut(usize, f64) -> bool,
    ) -> bool {
        let centre = self.grid.coordinates(self.grid.cell_of(position));
        let around: [(usize, [u32; 3]); 3] = std::array::from_fn(|axis| self.around(axis, centre[axis]));
        // Away from the ends of the box, and two bins being at most half of it, no image is nearer than the point itself.
        let is_inside = (0..V::DIMENSION).all(|axis| {
            let bins = self.grid.cells()[axis];
            bins > 3 && 0 < centre[axis] && centre[axis] + 1 < bins
        });
        for places in NEAREST_FIRST {
            if (0..3).any(|axis| places[axis] >= around[axis].0) {
                continue;
            }
            let bin = std::array::from_fn(|axis| around[axis].1[places[axis]]);
            let mut point = self.heads[self.grid.cell_at(bin) as usize];
            // The last point of a bin is the first of its list.
            while point != END && point as usize >= first {
                let there = self.points[point as usize];
                let separation = match is_inside {
                    true => there.position - position,
                    false => self.grid.separation(position, there.position),
                };
                let distance = separation.length_squared();
                if is_one(point as usize, distance) {
                    return true;
                }
                point = there.next;
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
