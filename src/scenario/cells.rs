//! How the box is cut into cells.

use crate::matter::grid::Grid;
use crate::space::Vector;

/// The most cells of a grid.
const MOST_CELLS: f64 = 1_073_741_824.0;
/// Whole cells are counted with this much slack, so that 0.3/0.1 is three.
const SLACK: f64 = 1e-9;

/// What decides the cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellPlan<V> {
    /// `engine.cell_size`, or `None` for the default.
    pub(super) wish: Option<f64>,
    /// The box that is cut.
    pub(super) grid_origin: V,
    pub(super) grid_size: V,
    /// `domain.size`, where the grains start.
    pub(super) size: V,
    pub(super) periodic: [bool; 3],
    /// Diameter of the largest grain.
    pub(super) diameter: f64,
    /// Mean volume of a grain.
    pub(super) grain_volume: f64,
    /// Grains at the start with those that a source adds.
    pub(super) final_count: u64,
    /// For HSMC ν_max, `None` for the other engines.
    pub(super) maximum_volume_fraction: Option<f64>,
    /// Whether there is gravity or a source.
    pub(super) settling: bool,
}

impl<V: Vector> CellPlan<V> {
    /// Cells along each axis, or what is wrong with the cell size.
    pub(super) fn cells(&self) -> Result<[u32; 3], String> {
        let mut counts = [1.0; 3];
        for (axis, count) in counts.iter_mut().enumerate().take(V::DIMENSION) {
            *count = self.along(axis);
        }
        let total: f64 = counts.iter().product();
        if total > MOST_CELLS {
            let longer = self.wished_size() * (total / MOST_CELLS).powf(1.0 / V::DIMENSION as f64);
            return Err(format!(
                "makes {total:.3e} cells, more than {MOST_CELLS}; give at least {longer:.3}"
            ));
        }
        let cells = counts.map(|count| count as u32);
        self.check_capacity(cells)?;
        Ok(cells)
    }

    fn along(&self, axis: usize) -> f64 {
        let ratio = self.grid_size[axis] / self.wished_size();
        // A default is the smallest size that will do, so cells may only grow; a wish is met as nearly as possible.
        let shrink = self.wish.is_none() && self.settles_in_full_cells();
        let whole = |ratio: f64| if shrink { (ratio * (1.0 + SLACK)).floor() } else { ratio.round() };
        if self.maximum_volume_fraction.is_some() && self.periodic[axis] {
            (2.0 * whole(0.5 * ratio)).max(4.0)
        } else {
            whole(ratio).max(1.0)
        }
    }

    fn settles_in_full_cells(&self) -> bool {
        self.maximum_volume_fraction.is_some() && self.settling
    }

    /// The wish, or the default in its place [length].
    pub(super) fn wished_size(&self) -> f64 {
        if let Some(wish) = self.wish {
            return wish;
        }
        let grain_volume = self.grain_volume;
        let root = |volume: f64| volume.powf(1.0 / V::DIMENSION as f64);
        if let Some(maximum) = self.maximum_volume_fraction.filter(|_| self.settling) {
            return root(4.0 * grain_volume / maximum).max(2.0 * self.diameter);
        }
        let volume_per_grain = self.size.product() / self.final_count.max(1) as f64;
        let dense = grain_volume / volume_per_grain >= 0.25;
        root(if dense { 20.0 } else { 10.0 } * volume_per_grain)
    }

    /// HSMC: a cell holds a grain, and a displacement ends in a neighbour. Cells may start above their capacity.
    fn check_capacity(&self, cells: [u32; 3]) -> Result<(), String> {
        let Some(maximum) = self.maximum_volume_fraction else { return Ok(()) };
        let grid = Grid::new(self.grid_origin, self.grid_size, &cells, &self.periodic);
        let diameter = self.diameter;
        let sides: Vec<String> = grid.side().components().iter().map(|side| format!("{side:.4}")).collect();
        let cell = sides.join(" × ");
        if grid.shortest_side() < diameter {
            return Err(format!(
                "gives cells of {cell}, shorter than a displacement by one diameter {diameter}; hsmc needs sides of \
                 at least a diameter (and 4 cells along a periodic axis): enlarge it or domain.size"
            ));
        }
        let capacity = grid.capacity(diameter, maximum);
        if capacity < 1 {
            return Err(format!(
                "gives cells of {cell} that hold no whole grain at maximum_volume_fraction {maximum}; give at least {}",
                2.0 * diameter
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    fn plan(size: f64, count: u32) -> CellPlan<DVec2> {
        CellPlan {
            wish: None,
            grid_origin: DVec2::ZERO,
            grid_size: DVec2::splat(size),
            size: DVec2::splat(size),
            periodic: [true; 3],
            diameter: 1.0,
            grain_volume: std::f64::consts::FRAC_PI_4,
            final_count: count.into(),
            maximum_volume_fraction: None,
            settling: false,
        }
    }

    #[test]
    fn the_default_holds_ten_grains_or_twenty() {
        // ν = 0.0785: 100 cells of 10 grains; ν = 0.314: 50 cells of 20.
        assert_eq!(plan(100.0, 1000).cells(), Ok([10, 10, 1]));
        assert_eq!(plan(50.0, 1000).cells(), Ok([7, 7, 1]));
    }

    /// The rule of defaults, over a range of boxes, densities and boundaries.
    #[test]
    fn every_default_obeys_its_rule() {
        for &(size, count) in
            &[(30.0, 50), (64.0, 700), (100.0, 3100), (100.0, 3200), (47.0, 2000), (300.0, 90_000)]
        {
            let gas = plan(size, count);
            let per_cell = |cells: [u32; 3]| f64::from(count) / f64::from(cells[0] * cells[1]);
            let fraction = f64::from(count) * std::f64::consts::FRAC_PI_4 / (size * size);
            let aim = if fraction >= 0.25 { 20.0 } else { 10.0 };
            // Rounding to whole cells changes a side by less than half a cell.
            let side = (aim * size * size / f64::from(count)).sqrt();
            let slack =
                |steps: f64| (1.0 - 0.5 * steps * side / size).powi(-2).max(1.0 + steps * side / size);
            let cells = gas.cells().unwrap();
            assert!((per_cell(cells) / aim).ln().abs() <= 2.0 * slack(1.0).ln(), "{size} {count}: {cells:?}");
            let hsmc = CellPlan { maximum_volume_fraction: Some(0.82), ..gas };
            let cells = hsmc.cells().unwrap();
            assert!(cells[..2].iter().all(|cells| cells % 2 == 0 && *cells >= 4), "{cells:?}");
            if cells[0] > 4 {
                assert!(
                    (per_cell(cells) / aim).ln().abs() <= 2.0 * slack(2.0).ln(),
                    "{size} {count}: {cells:?}"
                );
            }
        }
    }

    /// Gravity or a source: sides from 2 d on, a capacity from 4 on, and nothing much larger.
    #[test]
    fn cells_of_a_settling_box_are_the_smallest_that_will_do() {
        for size in [8.0, 21.0, 40.0, 41.9, 133.0] {
            for maximum in [0.3, 0.5, 0.79, 0.82, 0.9] {
                for periodic in [[false; 3], [true; 3]] {
                    let heap = CellPlan {
                        maximum_volume_fraction: Some(maximum),
                        settling: true,
                        periodic,
                        ..plan(size, 30)
                    };
                    let cells = heap.cells().unwrap();
                    let side = size / f64::from(cells[0]);
                    let grid = Grid::<DVec2>::new(heap.grid_origin, heap.grid_size, &cells, &periodic);
                    let smallest = (4.0 * std::f64::consts::FRAC_PI_4 / maximum).sqrt().max(2.0);
                    if periodic[0] {
                        assert!(cells[0] >= 4 && cells[0] % 2 == 0, "{cells:?}");
                    }
                    if !periodic[0] || size >= 4.0 * smallest {
                        assert!(side >= smallest * (1.0 - 1e-9), "{size} {maximum}: {cells:?}");
                        assert!(grid.capacity(1.0, maximum) >= 4, "{size} {maximum}: {cells:?}");
                    }
                    // One cell, or a pair of them, more would be too many.
                    let more = cells[0] + if periodic[0] { 2 } else { 1 };
                    assert!(size / f64::from(more) < smallest, "{size} {maximum}: {cells:?}");
                }
            }
        }
    }

    #[test]
    fn a_wish_is_rounded_to_whole_cells() {
        let plan = CellPlan { wish: Some(2.4), ..plan(10.0, 20) };
        assert_eq!(plan.cells(), Ok([4, 4, 1]));
        assert_eq!(CellPlan { wish: Some(99.0), ..plan }.cells(), Ok([1, 1, 1]));
    }

    #[test]
    fn periodic_axes_of_hsmc_have_an_even_number_of_cells_from_four_on() {
        let plan = CellPlan { maximum_volume_fraction: Some(0.82), wish: Some(2.0), ..plan(22.0, 20) };
        assert_eq!(plan.cells(), Ok([12, 12, 1]));
        assert_eq!(CellPlan { wish: Some(11.0), ..plan }.cells(), Ok([4, 4, 1]));
        assert_eq!(CellPlan { periodic: [false; 3], ..plan }.cells(), Ok([11, 11, 1]));
    }

    #[test]
    fn a_heap_gets_the_smallest_cells_with_a_capacity_of_four() {
        let flat = CellPlan {
            maximum_volume_fraction: Some(0.82),
            settling: true,
            periodic: [false; 3],
            ..plan(41.0, 5)
        };
        assert_eq!(flat.cells(), Ok([20, 20, 1]));
        let deep = CellPlan {
            wish: None,
            grid_origin: DVec3::ZERO,
            grid_size: DVec3::splat(20.0),
            size: DVec3::splat(20.0),
            periodic: [false; 3],
            diameter: 1.0,
            grain_volume: std::f64::consts::FRAC_PI_6,
            final_count: 5,
            maximum_volume_fraction: Some(0.2),
            settling: true,
        };
        // 4 · 0.5236/0.2 = 10.47 = 2.188³.
        assert_eq!(deep.cells(), Ok([9, 9, 9]));
    }

    #[test]
    fn cells_too_small_and_too_many_are_refused() {
        let hsmc = CellPlan { maximum_volume_fraction: Some(0.82), ..plan(40.0, 20) };
        assert!(
            CellPlan { wish: Some(0.5), ..hsmc }.cells().unwrap_err().contains("shorter than a displacement")
        );
        assert!(CellPlan { wish: Some(1e-6), ..hsmc }.cells().unwrap_err().contains("more than"));
        assert_eq!(CellPlan { wish: Some(2.0), ..plan(40.0, 1700) }.cells(), Ok([20, 20, 1]));
    }
}
