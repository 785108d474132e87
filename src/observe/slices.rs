//! The box in slices of one cell's height, counted through the container's offsets.

use rayon::prelude::*;

use crate::matter::gas::Gas;
use crate::space::Vector;

/// Cells a thread sums at a time.
const SPAN: usize = 1024;

/// Grains in each slice across `axis`, `[slice]`.
pub(crate) fn counts<V: Vector>(gas: &Gas<V>, axis: usize) -> Vec<u32> {
    let mut counts = vec![0; gas.grid().cells()[axis] as usize];
    // As many neighbouring cells as the stride share a slice.
    let stride = gas.grid().stride(axis) as usize;
    let starts = gas.offsets().iter().step_by(stride);
    for (k, (start, end)) in starts.clone().zip(starts.skip(1)).enumerate() {
        let slice = k % counts.len();
        counts[slice] += end - start;
    }
    counts
}

/// Volume of the grains in each slice across `axis` [lengthᴰ], `[slice]`.
pub(crate) fn volumes<V: Vector>(gas: &Gas<V>, axis: usize) -> Vec<f64> {
    let mut volumes = vec![0.0; gas.grid().cells()[axis] as usize];
    for (cell, slice) in slices_of_cells(gas, axis).enumerate() {
        volumes[slice] += gas.rows(cell as u32).map(|row| gas.grain_at(row).volume::<V>()).sum::<f64>();
    }
    volumes
}

/// Sum of `value` over the velocities in each slice across `axis`, `[slice]`; in the order of cells
/// for any number of threads.
pub(crate) fn velocity_sums<V: Vector>(
    gas: &Gas<V>,
    axis: usize,
    value: impl Fn(V) -> f64 + Sync,
) -> Vec<f64> {
    sums(gas, axis, |row| value(gas.velocities()[row]))
}

/// Sum of `term` over the rows in each slice across `axis`, `[slice]`; in the order of cells for any number
/// of threads.
pub(crate) fn sums<V: Vector>(gas: &Gas<V>, axis: usize, term: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
    let by_cell: Vec<f64> = (0..gas.grid().number_of_cells())
        .into_par_iter()
        .with_min_len(SPAN)
        .map(|cell| gas.rows(cell as u32).map(&term).sum())
        .collect();
    let mut sums = vec![0.0; gas.grid().cells()[axis] as usize];
    for (slice, sum) in slices_of_cells(gas, axis).zip(by_cell) {
        sums[slice] += sum;
    }
    sums
}

/// Where the middle of each slice lies on `axis` [length], `[slice]`.
pub(crate) fn centres<V: Vector>(gas: &Gas<V>, axis: usize) -> Vec<f64> {
    let grid = gas.grid();
    (0..grid.cells()[axis])
        .map(|slice| grid.origin()[axis] + (f64::from(slice) + 0.5) * grid.side()[axis])
        .collect()
}

/// The slice of every cell, in the order of cells.
fn slices_of_cells<V: Vector>(gas: &Gas<V>, axis: usize) -> impl Iterator<Item = usize> {
    let (stride, count) = (gas.grid().stride(axis) as usize, gas.grid().cells()[axis] as usize);
    (0..gas.grid().number_of_cells()).map(move |cell| cell / stride % count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::testing::{random_positions, random_velocities, setting_of};
    use glam::DVec3;

    #[test]
    fn slices_agree_with_the_positions() {
        let size = DVec3::new(4.0, 6.0, 10.0);
        let bed = setting_of(size, [2, 3, 5]);
        let gas = bed.gas(0.0, random_positions(3, 500, size), random_velocities(4, 500));
        for axis in 0..3 {
            let mut expected = vec![(0, 0.0); bed.setting.grid.cells()[axis] as usize];
            for (position, velocity) in gas.positions().iter().zip(gas.velocities()) {
                let slice = &mut expected[(position[axis] / 2.0) as usize];
                slice.0 += 1;
                slice.1 += velocity.y;
            }
            let (counts, sums) = (counts(&gas, axis), velocity_sums(&gas, axis, |v| v.y));
            for (slice, (count, sum)) in expected.into_iter().enumerate() {
                assert_eq!(counts[slice], count);
                assert!((sums[slice] - sum).abs() < 1e-12);
            }
        }
        assert_eq!(centres(&gas, 2), [1.0, 3.0, 5.0, 7.0, 9.0]);
    }
}
