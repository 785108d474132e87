//! The box and its cells.

use crate::space::Vector;

/// A box cut into equal cells, numbered with the first axis running fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<V> {
    origin: V,
    size: V,
    end: V,
    side: V,
    inverse_side: V,
    /// Centre of the first cell, a hair lower: a position on a face counts to the upper cell.
    first_centre: V,
    /// Cells from the centre of the first to that of the last.
    last_place: V,
    cells: [u32; 3],
    strides: [u32; 3],
    periodic: [bool; 3],
}

/// How near to a face a position counts as on it, in sides of a cell.
const FACE_WIDTH: f64 = 1e-9;

/// The nearest integer of a number that is between −1/2 and 2³².
///
/// The sum with 3/2 · 2⁵² has no room for a fraction, so that it rounds, and the integer stands in its lower bits.
#[inline(always)]
fn nearest_integer(x: f64) -> u32 {
    (x + 6_755_399_441_055_744.0).to_bits() as u32
}

impl<V: Vector> Grid<V> {
    /// A box of `size` with its lower corner at `origin`, cut into `cells` along each axis.
    ///
    /// # Panics
    /// When an axis has no cell or the product exceeds 2³² − 2: the scenario reader refuses both.
    pub fn new(origin: V, size: V, cells: &[u32], periodic: &[bool]) -> Self {
        let mut counts = [1; 3];
        let mut wraps = [false; 3];
        counts[..V::DIMENSION].copy_from_slice(&cells[..V::DIMENSION]);
        wraps[..V::DIMENSION].copy_from_slice(&periodic[..V::DIMENSION]);
        let total = counts.iter().try_fold(1_u32, |n, &c| n.checked_mul(c));
        assert!(total.is_some_and(|n| n > 0 && n < u32::MAX), "a grid has 1 … 2³² − 2 cells");
        Grid {
            origin,
            size,
            end: origin + size,
            side: V::from_fn(|a| size[a] / f64::from(counts[a])),
            inverse_side: V::from_fn(|a| f64::from(counts[a]) / size[a]),
            first_centre: V::from_fn(|a| origin[a] + size[a] / f64::from(counts[a]) * (0.5 - FACE_WIDTH)),
            last_place: V::from_fn(|a| f64::from(counts[a] - 1)),
            cells: counts,
            strides: [1, counts[0], counts[0] * counts[1]],
            periodic: wraps,
        }
    }

    /// The lower corner [length].
    pub fn origin(&self) -> V {
        self.origin
    }
    /// The upper corner [length].
    pub fn end(&self) -> V {
        self.end
    }
    /// Sides of the box [length].
    pub fn size(&self) -> V {
        self.size
    }
    /// Sides of a cell [length].
    pub fn side(&self) -> V {
        self.side
    }
    /// The shortest side of a cell [length].
    pub fn shortest_side(&self) -> f64 {
        (0..V::DIMENSION).map(|a| self.side[a]).fold(f64::INFINITY, f64::min)
    }
    /// Cells along each axis; 1 along an axis that does not exist.
    pub fn cells(&self) -> [u32; 3] {
        self.cells
    }
    /// Number of all cells.
    pub fn number_of_cells(&self) -> usize {
        self.cells.iter().map(|&c| c as usize).product()
    }
    /// Volume (2D: area) of one cell [lengthᴰ].
    pub fn cell_volume(&self) -> f64 {
        self.side.product()
    }
    /// Whether `axis` is periodic.
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.periodic[axis]
    }
    /// Difference of cell numbers between neighbours along `axis`.
    pub fn stride(&self, axis: usize) -> u32 {
        self.strides[axis]
    }

    /// The cell that holds `position`; a position outside counts to the nearest cell.
    #[inline(always)]
    pub fn cell_of(&self, position: V) -> u32 {
        let mut cell = 0;
        for axis in 0..V::DIMENSION {
            cell += self.coordinate_of(position, axis) * self.strides[axis];
        }
        cell
    }

    /// The same for a position that is known to be inside the box: a shorter way to the same answer.
    #[inline(always)]
    pub fn cell_inside(&self, position: V) -> u32 {
        let mut cell = 0;
        for axis in 0..V::DIMENSION {
            cell += nearest_integer(self.place(position, axis)) * self.strides[axis];
        }
        cell
    }

    /// The coordinate along `axis` of the cell that holds `position`.
    #[inline(always)]
    pub fn coordinate_of(&self, position: V, axis: usize) -> u32 {
        let place = self.place(position, axis);
        nearest_integer(if place > 0.0 { place } else { 0.0 })
    }

    /// Where `position` lies along `axis`, in cells from the centre of the first one; at most at the centre of the last.
    #[inline(always)]
    fn place(&self, position: V, axis: usize) -> f64 {
        let place = (position[axis] - self.first_centre[axis]) * self.inverse_side[axis];
        let last = self.last_place[axis];
        if place < last { place } else { last }
    }

    /// The coordinates of `cell` along each axis.
    #[inline]
    pub fn coordinates(&self, cell: u32) -> [u32; 3] {
        let (mut coordinates, mut rest) = ([0; 3], cell);
        for axis in (1..V::DIMENSION).rev() {
            coordinates[axis] = rest / self.strides[axis];
            rest -= coordinates[axis] * self.strides[axis];
        }
        coordinates[0] = rest;
        coordinates
    }

    /// The number of the cell at `coordinates`.
    #[inline]
    pub fn cell_at(&self, coordinates: [u32; 3]) -> u32 {
        coordinates[0] + coordinates[1] * self.strides[1] + coordinates[2] * self.strides[2]
    }

    /// The face neighbour of the cell at `coordinates` along `axis`, upwards or downwards;
    /// `None` beyond a boundary that is not periodic.
    #[inline]
    pub fn neighbour(&self, coordinates: [u32; 3], axis: usize, upwards: bool) -> Option<u32> {
        let last = self.cells[axis] - 1;
        let here = coordinates[axis];
        let there = match (upwards, self.periodic[axis]) {
            (true, _) if here < last => here + 1,
            (false, _) if here > 0 => here - 1,
            (true, true) => 0,
            (false, true) => last,
            _ => return None,
        };
        let mut target = coordinates;
        target[axis] = there;
        Some(self.cell_at(target))
    }

    /// Centre of `cell` [length].
    pub fn centre(&self, cell: u32) -> V {
        let coordinates = self.coordinates(cell);
        V::from_fn(|a| self.origin[a] + (f64::from(coordinates[a]) + 0.5) * self.side[a])
    }

    /// `position` brought back into the box along `axis` if that is periodic.
    #[inline(always)]
    pub fn wrap(&self, position: &mut V, axis: usize) {
        if !self.periodic[axis] {
            return;
        }
        let x = position[axis];
        if x < self.origin[axis] || x >= self.end[axis] {
            position[axis] = self.wrapped_along(x, axis);
        }
    }

    /// `position` brought back into the box along all periodic axes.
    #[inline(always)]
    pub fn wrapped(&self, position: V) -> V {
        V::from_fn(|axis| {
            let x = position[axis];
            let inside = x >= self.origin[axis] && x < self.end[axis];
            if inside || !self.periodic[axis] { x } else { self.wrapped_along(x, axis) }
        })
    }

    #[cold]
    #[inline(never)]
    fn wrapped_along(&self, x: f64, axis: usize) -> f64 {
        let turns = ((x - self.origin[axis]) / self.size[axis]).floor();
        let x = x - turns * self.size[axis];
        // Rounding may leave the result on the far edge, or a hair outside.
        if x >= self.origin[axis] && x < self.end[axis] { x } else { self.origin[axis] }
    }

    /// The shortest vector from `a` to `b` over periodic images [length].
    pub fn separation(&self, a: V, b: V) -> V {
        V::from_fn(|axis| {
            let x = b[axis] - a[axis];
            let turns = if self.periodic[axis] { (x / self.size[axis]).round() } else { 0.0 };
            x - turns * self.size[axis]
        })
    }

    /// Grains that fit into one cell at `maximum_volume_fraction`: K = ⌊ν_max V_c/V_p⌋.
    pub fn capacity(&self, diameter: f64, maximum_volume_fraction: f64) -> u32 {
        // A hair of slack, so that a cell of exactly K grains' volume holds K.
        let places = maximum_volume_fraction * self.cell_volume() / V::sphere_volume(diameter);
        (places * (1.0 + 1e-12)) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    #[test]
    fn every_cell_finds_itself() {
        let grid = Grid::new(
            DVec3::new(-1.0, 0.0, 2.0),
            DVec3::new(3.0, 4.0, 5.0),
            &[3, 2, 7],
            &[true, false, true],
        );
        for cell in 0..grid.number_of_cells() as u32 {
            assert_eq!(grid.cell_of(grid.centre(cell)), cell);
            assert_eq!(grid.cell_at(grid.coordinates(cell)), cell);
        }
    }

    #[test]
    fn the_short_way_finds_the_same_cell_and_faces_count_to_the_upper_one() {
        let grid = Grid::new(DVec2::new(-0.7, 3.0), DVec2::new(1.1, 7.0), &[11, 70], &[true, false]);
        let mut random = Streams::new(4).at(0, Phase::InitialPositions).stream(0);
        for _ in 0..10_000 {
            let share = DVec2::new(random.uniform(), random.uniform());
            let position = grid.origin() + grid.size() * share;
            let cell = grid.cell_inside(position);
            assert_eq!(cell, grid.cell_of(position));
            let distance = position - grid.centre(cell);
            assert!(distance.abs().cmple(grid.side() * (0.5 + 1e-8)).all());
        }
        for k in 0..70_u32 {
            let face = DVec2::new(-0.7, 3.0 + 0.1 * f64::from(k));
            assert_eq!(grid.cell_inside(face), 11 * k);
        }
        let end = DVec2::new(0.4_f64.next_down(), 10.0_f64.next_down());
        assert_eq!(grid.cell_inside(end), 11 * 70 - 1);
        assert_eq!(grid.cell_of(DVec2::new(-1e300, 1e300)), 11 * 69);
    }

    #[test]
    fn wrapping_is_robust_at_the_edges() {
        let grid = Grid::new(DVec2::ZERO, DVec2::new(0.3, 1.0), &[3, 4], &[true, true]);
        for x in [-1e-18, -1e-300, 0.3, 0.3 + 1e-16, -0.3, 0.6, 1e3 * 0.3] {
            let mut p = DVec2::new(x, 0.5);
            grid.wrap(&mut p, 0);
            assert!(p.x >= 0.0 && p.x < 0.3, "{x} became {}", p.x);
        }
    }

    #[test]
    fn capacity_of_two_diameters_is_four_and_nine() {
        let flat = Grid::new(DVec2::ZERO, DVec2::splat(20.0), &[10, 10], &[true, true]);
        let deep = Grid::new(DVec3::ZERO, DVec3::splat(20.0), &[10, 10, 10], &[true; 3]);
        assert_eq!(flat.capacity(1.0, 0.82), 4);
        assert_eq!(deep.capacity(1.0, 0.64), 9);
    }

    #[test]
    fn neighbours_end_at_walls_and_wrap_elsewhere() {
        let grid = Grid::new(DVec2::ZERO, DVec2::splat(4.0), &[4, 4], &[true, false]);
        assert_eq!(grid.neighbour([0, 0, 0], 0, false), Some(3));
        assert_eq!(grid.neighbour([0, 0, 0], 1, false), None);
        assert_eq!(grid.neighbour([0, 0, 0], 1, true), Some(4));
    }
}
