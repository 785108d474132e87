//! `pair-correlation`: g(r), how much oftener than in an ideal gas two grains are a distance apart
//! (Miller 2004, 5.10).

use std::ops::Range;

use rayon::prelude::*;

use super::measure::{Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, steady_means};
use super::setting::Setting;
use super::units::{LENGTH, PURE, column};
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// Largest distance, in diameters.
const REACH: f64 = 5.0;
/// Width of a bin, in diameters.
const WIDTH: f64 = 0.05;
/// Cells to a reach, where grains are dense enough.
const CELLS: f64 = 4.0;
/// Cells that a thread looks through at a time; part of the definition of every sum.
const BLOCK: usize = 256;

/// g(r) up to 5 d in bins of 0.05 d, but no further than half the shortest side of the box.
///
/// Every pair counts with the weight Π 1/(1 − |s_a|/L_a) over the axes with walls, where s is its separation and L
/// the sides of the space that centres have: two independent places in a box are s apart with a density that falls
/// as Π (1 − |s_a|/L_a), so that the mean of g of an ideal gas is exactly 1 in every bin, near walls too (the
/// translation correction of Ohser 1983). Periodic axes need no weight. The norm is ½ N (N − 1) times the share
/// of a bin's shell in the volume. Where grains are hard, walls keep centres half a diameter away.
///
/// Of a mixture all grains count alike, and d is that of the first species. Averages are taken over recordings.
#[derive(Clone, Debug)]
pub struct PairCorrelation<V> {
    /// Sides of the space of centres [length].
    size: V,
    /// Which axes have an end.
    is_bounded: [bool; 3],
    /// Width of a bin [length].
    width: f64,
    bins: usize,
    /// `[sample][g of each bin]`.
    samples: Samples,
}

impl<V: Vector> PairCorrelation<V> {
    /// The measure for `setting`, unless the box has no room for a bin.
    pub fn new(setting: &Setting<V>) -> Option<Self> {
        let diameter = setting.grain.diameter;
        let is_bounded =
            std::array::from_fn(|axis| axis < V::DIMENSION && !setting.boundary.is_periodic(axis));
        let kept_off = if setting.counts_impacts { diameter } else { 0.0 };
        let box_size = setting.grid.size();
        let size =
            V::from_fn(|axis| if is_bounded[axis] { box_size[axis] - kept_off } else { box_size[axis] });
        let reach = (0..V::DIMENSION).fold(REACH * diameter, |reach, axis| reach.min(0.5 * size[axis]));
        let width = WIDTH * diameter;
        let bins = (reach / width * (1.0 + 1e-12)).max(0.0) as usize;
        (bins > 0).then(|| PairCorrelation { size, is_bounded, width, bins, samples: Samples::new(bins) })
    }

    /// The largest distance [length].
    fn reach(&self) -> f64 {
        self.bins as f64 * self.width
    }

    /// g and its error of so many independent pairs `[bin]`; NaN without a pair.
    fn look(&self, gas: &Gas<V>) -> [Vec<f64>; 2] {
        let grains = gas.len() as f64;
        let pairs = 0.5 * grains * (grains - 1.0);
        let sphere = |bin: usize| V::sphere_volume(2.0 * bin as f64 * self.width);
        let expected = |bin: usize| pairs * (sphere(bin + 1) - sphere(bin)) / self.size.product();
        let sums = self.weights(gas);
        let g = (0..self.bins).map(|bin| if pairs > 0.0 { sums[bin][0] / expected(bin) } else { f64::NAN });
        let error = |bin: usize| if pairs > 0.0 { sums[bin][1].sqrt() / expected(bin) } else { f64::NAN };
        [g.collect(), (0..self.bins).map(error).collect()]
    }

    /// Sums of the weights of all pairs and of their squares `[bin]`, block by block of small cells.
    fn weights(&self, gas: &Gas<V>) -> Vec<[f64; 2]> {
        let sorted =
            Gas::new(self.cells(gas), gas.grain, gas.positions().to_vec(), gas.velocities().to_vec());
        let cells = sorted.grid().number_of_cells();
        let blocks: Vec<Vec<[f64; 2]>> = (0..cells.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let mut sums = vec![[0.0; 2]; self.bins];
                for cell in block * BLOCK..cells.min((block + 1) * BLOCK) {
                    self.weigh_pairs(&sorted, cell as u32, &mut sums);
                }
                sums
            })
            .collect();
        let mut total = vec![[0.0; 2]; self.bins];
        for sums in blocks {
            total.iter_mut().zip(sums).for_each(|(total, part)| {
                total[0] += part[0];
                total[1] += part[1];
            });
        }
        total
    }

    /// Cells a quarter of the reach wide; wider where there would be more of them than grains.
    fn cells(&self, gas: &Gas<V>) -> Grid<V> {
        let grid = gas.grid();
        let each = (grid.size().product() / gas.len().max(1) as f64).powf(1.0 / V::DIMENSION as f64);
        let side = (self.reach() / CELLS).max(each);
        let mut cells = [1; 3];
        let mut periodic = [false; 3];
        for axis in 0..V::DIMENSION {
            cells[axis] = (grid.size()[axis] / side).floor().max(1.0) as u32;
            periodic[axis] = grid.is_periodic(axis);
        }
        Grid::new(grid.origin(), grid.size(), &cells, &periodic)
    }

    /// Adds the pairs of grains of `cell` with those in later rows.
    fn weigh_pairs(&self, sorted: &Gas<V>, cell: u32, sums: &mut [[f64; 2]]) {
        if sorted.occupancy(cell) == 0 {
            return;
        }
        let spans = self.surroundings(sorted, cell);
        let positions = sorted.positions();
        // Touching grains belong to the bin that begins at contact, whichever way their distance was rounded.
        let (reach, per_width) = (self.reach(), (1.0 + 1e-12) / self.width);
        for row in sorted.rows(cell) {
            for span in &spans {
                for there in &positions[span.start.max(row + 1)..span.end.max(row + 1)] {
                    let separation = self.separation(positions[row], *there);
                    let square = separation.length_squared();
                    if square < reach * reach {
                        let weight = self.weight(separation);
                        let bin = (square.sqrt() * per_width) as usize;
                        // Rounding may put a pair at the very end one bin too far.
                        let sum = &mut sums[bin.min(self.bins - 1)];
                        sum[0] += weight;
                        sum[1] += weight * weight;
                    }
                }
            }
        }
    }

    /// Rows of `sorted` that hold whatever is within reach of `cell`, each once.
    fn surroundings(&self, sorted: &Gas<V>, cell: u32) -> Vec<Range<usize>> {
        let grid = sorted.grid();
        let centre = grid.coordinates(cell);
        let along: [Vec<Range<u32>>; 3] =
            std::array::from_fn(|axis| around(grid, axis, centre[axis], self.reach()));
        let mut spans = Vec::new();
        for z in along[2].iter().cloned().flatten() {
            for y in along[1].iter().cloned().flatten() {
                for x in &along[0] {
                    let first = sorted.rows(grid.cell_at([x.start, y, z])).start;
                    let end = sorted.rows(grid.cell_at([x.end - 1, y, z])).end;
                    spans.push(first..end);
                }
            }
        }
        spans
    }

    /// The shortest vector between two places of the box over periodic images [length].
    #[inline]
    fn separation(&self, a: V, b: V) -> V {
        V::from_fn(|axis| {
            let (x, side) = (b[axis] - a[axis], self.size[axis]);
            let image = x - side.copysign(x);
            if !self.is_bounded[axis] && image.abs() < x.abs() { image } else { x }
        })
    }

    /// Π 1/(1 − |s_a|/L_a) over the axes with walls.
    #[inline]
    fn weight(&self, separation: V) -> f64 {
        (0..V::DIMENSION)
            .filter(|&axis| self.is_bounded[axis])
            .fold(1.0, |weight, axis| weight * self.size[axis] / (self.size[axis] - separation[axis].abs()))
    }

    fn profile(&self, name: &str, time: f64, g: Vec<f64>, errors: Vec<f64>) -> Profile {
        let middles = (0..self.bins).map(|bin| (bin as f64 + 0.5) * self.width).collect();
        Profile {
            name: name.to_owned(),
            time,
            columns: vec![
                column("distance", LENGTH),
                column("pair_correlation", PURE),
                column("standard_error", PURE),
            ],
            values: vec![middles, g, errors],
        }
    }
}

/// Coordinates along `axis` of cells within `reach` of those at `here`, each once; two ranges where they wrap.
fn around<V: Vector>(grid: &Grid<V>, axis: usize, here: u32, reach: f64) -> Vec<Range<u32>> {
    let cells = grid.cells()[axis];
    if axis >= V::DIMENSION {
        return vec![Range { start: 0, end: cells }];
    }
    let far = (reach / grid.side()[axis] * (1.0 + 1e-9)).ceil() as u32;
    if grid.is_periodic(axis) {
        if 2 * far + 1 >= cells {
            return vec![Range { start: 0, end: cells }];
        }
        if here < far {
            return vec![0..here + far + 1, cells + here - far..cells];
        }
        if here + far >= cells {
            return vec![0..here + far + 1 - cells, here - far..cells];
        }
    }
    vec![Range { start: here.saturating_sub(far), end: cells.min(here + far + 1) }]
}

impl<V: Vector> Measure<V> for PairCorrelation<V> {
    fn name(&self) -> &'static str {
        "pair-correlation"
    }

    fn is_costly(&self) -> bool {
        true
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let time = snapshot.gas.time();
        let [g, errors] = self.look(snapshot.gas);
        self.samples.push(time, &g);
        vec![self.profile("pair-correlation", time, g, errors)]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let (g, errors) = steady_means(&self.samples.since(from), 0..self.bins);
        (vec![self.profile("pair-correlation-mean", snapshot.gas.time(), g, errors)], Vec::new())
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
#[path = "pair_correlation_tests.rs"]
mod tests;
