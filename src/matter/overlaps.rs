//! The audit of a state of hard grains: who is where somebody else is.

use rayon::prelude::*;

use super::bins::Bins;
use super::gas::Gas;
use crate::space::Vector;

/// Grains count as overlapping when they are closer than their contact distance by more than this share.
pub const TOLERANCE: f64 = 1e-9;

/// Pairs of grains that are closer than their contact distance, and grains that are closer to a fixed wall than
/// their radius or beyond it, each by more than a share of [`TOLERANCE`].
///
/// `fixed_walls[axis][side]` says which faces of the box are walls at rest, side 0 the lower one. The time that
/// this takes is proportional to the number of grains, for any box and any mixture of similar sizes.
pub fn overlaps<V: Vector>(gas: &Gas<V>, fixed_walls: [[bool; 2]; 3]) -> u64 {
    let grid = gas.grid();
    let diameters: Vec<f64> = (0..gas.len()).map(|row| gas.grain_at(row).diameter).collect();
    let largest = diameters.iter().copied().fold(0.0, f64::max);
    let mut bins = Bins::new(grid, largest, gas.len());
    gas.positions().iter().for_each(|&position| bins.insert(position));
    let of_grain = |(row, &position): (usize, &V)| {
        let mut number = 0;
        // Those that come later: every pair once.
        bins.any_near_since(row + 1, position, |other, distance_squared| {
            let contact = 0.5 * (diameters[row] + diameters[other]) * (1.0 - TOLERANCE);
            number += u64::from(distance_squared < contact * contact);
            false
        });
        let reach = 0.5 * diameters[row] * (1.0 - TOLERANCE);
        for (axis, [lower, upper]) in fixed_walls.into_iter().enumerate().take(V::DIMENSION) {
            number += u64::from(lower && position[axis] - grid.origin()[axis] < reach);
            number += u64::from(upper && grid.end()[axis] - position[axis] < reach);
        }
        number
    };
    gas.positions().par_iter().enumerate().map(of_grain).sum()
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::matter::clock::Clock;
    use crate::matter::columns::Columns;
    use crate::matter::grain::Grain;
    use crate::matter::grid::Grid;
    use crate::random::{Phase, Streams};

    const WALLS: [[bool; 2]; 3] = [[true; 2]; 3];
    const NONE: [[bool; 2]; 3] = [[false; 2]; 3];

    fn gas<V: Vector>(size: V, periodic: bool, diameters: &[f64], positions: Vec<V>) -> Gas<V> {
        let grid = Grid::new(V::ZERO, size, &[1; 3], &[periodic; 3]);
        let species = diameters.iter().map(|&diameter| Grain { diameter, mass: 1.0 }).collect();
        let number = positions.len();
        let columns = Columns {
            velocities: vec![V::ZERO; number],
            ids: (0..number as u32).collect(),
            spins: None,
            species: Some((0..number).map(|k| (k % diameters.len()) as u8).collect()),
            positions,
        };
        let grain = Grain { diameter: diameters[0], mass: 1.0 };
        let mut gas = Gas::restored(grid, grain, columns, Clock::default(), number as u32);
        gas.species = species;
        gas
    }

    /// Every pair, image by image.
    fn counted_one_by_one<V: Vector>(gas: &Gas<V>) -> u64 {
        let mut number = 0;
        for a in 0..gas.len() {
            for b in 0..a {
                let contact = 0.5 * (gas.grain_at(a).diameter + gas.grain_at(b).diameter);
                let apart = gas.grid().separation(gas.positions()[a], gas.positions()[b]).length();
                number += u64::from(apart < contact * (1.0 - TOLERANCE));
            }
        }
        number
    }

    fn scattered<V: Vector>(number: u64, size: V) -> Vec<V> {
        let streams = Streams::new(4).at(0, Phase::InitialPositions);
        let one = |id| {
            let mut random = streams.stream(id);
            V::from_fn(|axis| size[axis] * random.uniform())
        };
        (0..number).map(one).collect()
    }

    #[test]
    fn as_many_overlaps_as_a_count_of_all_pairs_finds() {
        // Tiny boxes of one, two and three bins a side among them.
        for side in [1.0, 1.3, 2.1, 3.2, 7.9, 20.0] {
            for periodic in [false, true] {
                for diameters in [&[1.0][..], &[0.4, 1.0, 0.7]] {
                    let flat = DVec2::new(side, 1.7 * side);
                    let flat = gas(flat, periodic, diameters, scattered(150, flat));
                    let deep = DVec3::new(side, 1.2 * side, 2.0 * side);
                    let deep = gas(deep, periodic, diameters, scattered(150, deep));
                    assert_eq!(overlaps(&flat, NONE), counted_one_by_one(&flat), "{side}");
                    assert_eq!(overlaps(&deep, NONE), counted_one_by_one(&deep), "{side}");
                    assert!(overlaps(&deep, NONE) > 0 || side > 8.0);
                }
            }
        }
    }

    #[test]
    fn touching_is_not_overlapping() {
        let side = DVec2::splat(4.0);
        let apart = |distance: f64| {
            let positions = vec![DVec2::ONE, DVec2::new(1.0 + distance, 1.0)];
            overlaps(&gas(side, false, &[0.6, 1.0], positions), NONE)
        };
        assert_eq!((apart(0.8), apart(0.8 * (1.0 - 1e-10)), apart(0.8 * (1.0 - 1e-8))), (0, 0, 1));
        let height = |y: f64| overlaps(&gas(side, false, &[1.0], vec![DVec2::new(2.0, y)]), WALLS);
        let found = [0.5, 0.5 - 1e-8, 3.5, 3.5 + 1e-8, -1.0, 5.0].map(height);
        assert_eq!(found, [0, 1, 0, 1, 1, 1]);
        assert_eq!(overlaps(&gas(side, true, &[1.0], vec![DVec2::new(2.0, 0.1)]), NONE), 0);
    }
}
