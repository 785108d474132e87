//! Points in bins, to find those near a place.

use super::fetch::fetch;
use super::grid::Grid;
use crate::space::Vector;

/// No point.
const NONE: u32 = u32::MAX;

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
    /// `[bin]`: the point that came last, if any.
    last: Vec<Point<V>>,
    /// Those that came before another one of their bin.
    earlier: Vec<Point<V>>,
    number: usize,
}

/// One point.
#[derive(Clone, Copy, Debug)]
struct Point<V> {
    position: V,
    /// In the order in which they come; [`NONE`] where a bin is empty.
    number: u32,
    /// Where the one before it in its bin stands among the earlier ones, or [`NONE`].
    before: u32,
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
        let empty = Point { position: V::ZERO, number: NONE, before: NONE };
        Bins { last: vec![empty; grid.number_of_cells()], earlier: Vec::new(), number: 0, grid }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.number
    }

    /// Whether there is no point yet.
    pub fn is_empty(&self) -> bool {
        self.number == 0
    }

    /// Adds a point [length]; points are numbered in the order in which they come.
    pub fn insert(&mut self, position: V) {
        let last = &mut self.last[self.grid.cell_of(position) as usize];
        let mut point = Point { position, number: self.number as u32, before: NONE };
        if last.number != NONE {
            point.before = self.earlier.len() as u32;
            self.earlier.push(*last);
        }
        *last = point;
        self.number += 1;
    }

    /// Sends for the last points of the bins around `position`, which [`Bins::any_near`] would wait for one after another.
    pub fn fetch_around(&self, position: V) {
        let centre = self.grid.coordinates(self.grid.cell_of(position));
        let [across, up, high]: [(usize, [u32; 3]); 3] =
            std::array::from_fn(|axis| self.around(axis, centre[axis]));
        for z in &high.1[..high.0] {
            for y in &up.1[..up.0] {
                // Neighbours along the first axis stand beside each other.
                for x in &across.1[across.0.min(2) - 1..across.0] {
                    fetch(&self.last[self.grid.cell_at([*x, *y, *z]) as usize]);
                }
            }
        }
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
            let mut point = self.last[self.grid.cell_at(bin) as usize];
            while point.number != NONE && point.number as usize >= first {
                let separation = match is_inside {
                    true => point.position - position,
                    false => self.grid.separation(position, point.position),
                };
                if is_one(point.number as usize, separation.length_squared()) {
                    return true;
                }
                if point.before == NONE {
                    break;
                }
                point = self.earlier[point.before as usize];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    /// Every point within the reach of each of some places is found once, with its distance, and nothing is missed; with bins
    /// that are few, and with bins that hold several points.
    fn assert_finds<V: Vector>(size: V, periodic: [bool; 3], reach: f64, points: usize) {
        let grid = Grid::new(V::ZERO, size, &[1; 3], &periodic);
        let mut random = Streams::new(8).at(0, Phase::InitialPositions).stream(points as u64);
        let mut place = || V::from_fn(|axis| size[axis] * random.uniform());
        let mut bins = Bins::new(&grid, reach, points);
        assert!(bins.is_empty());
        let positions: Vec<V> = (0..points).map(|_| place()).collect();
        positions.iter().for_each(|&position| bins.insert(position));
        assert_eq!(bins.len(), points);
        for first in [0, points / 2] {
            for here in (0..50).map(|_| place()) {
                let mut found = Vec::new();
                bins.fetch_around(here);
                let all = |number: usize, distance: f64| {
                    found.push((number, distance));
                    false
                };
                assert!(!bins.any_near_since(first, here, all));
                found.retain(|(_, distance)| *distance < reach * reach);
                found.sort_by_key(|(number, _)| *number);
                let near = |number: usize| {
                    let distance = grid.separation(here, positions[number]).length_squared();
                    (distance < reach * reach).then_some((number, distance))
                };
                let expected: Vec<(usize, f64)> = (first..points).filter_map(near).collect();
                assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn what_is_near_is_found() {
        assert_finds(DVec2::new(20.0, 9.0), [true; 3], 1.0, 150);
        assert_finds(DVec2::new(20.0, 9.0), [false, true, false], 1.0, 40);
        assert_finds(DVec3::splat(7.0), [true; 3], 1.0, 500);
        // Three, two and one bin across.
        for size in [3.1, 2.1, 1.1] {
            assert_finds(DVec3::splat(size), [true; 3], 1.0, 60);
            assert_finds(DVec2::splat(size), [false; 3], 1.0, 20);
        }
    }
}
