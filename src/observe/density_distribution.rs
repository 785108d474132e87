//! `density-distribution`: how often which density is met (Miller 2004, section 5.2.1).

use std::ops::Range;

use super::last_look::LastLook;
use super::measure::{Cadence, Column, Effort, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_mean};
use super::units::{PURE, column};
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::space::Vector;
use crate::statistics::standard_deviation;

/// Grains in a region on the average, as in Miller's figure 5.9.
const GRAINS: f64 = 40.0;
/// Grains from one bin of the density to the next: a tenth of the mean.
const BIN: f64 = 4.0;
/// Shares of the regions, and the figures below which their densities lie (Miller 2004, figure 5.12).
const QUANTILES: [(f64, &str); 7] = [
    (0.01, "volume_fraction_q01"),
    (0.10, "volume_fraction_q10"),
    (0.25, "volume_fraction_q25"),
    (0.50, "volume_fraction_q50"),
    (0.75, "volume_fraction_q75"),
    (0.90, "volume_fraction_q90"),
    (0.99, "volume_fraction_q99"),
];
/// The last figure.
const VARIANCE: &str = "density_variance_over_poisson";

/// Volume fractions of regions that hold 40 grains on the average: the box is cut into equal parts, as near to
/// squares or cubes as whole numbers allow; grains count where their centres are. While grains are poured,
/// regions become smaller.
///
/// The variance is given over that of independent grains. It has n − 1 in its denominator, so that these give
/// exactly 1 on the average although their total is fixed; for a mixture theirs is Σ V_p²/n, n the number of regions.
#[derive(Clone, Debug)]
pub struct DensityDistribution {
    samples: Samples,
    last: LastLook<Option<Regions>>,
}

/// The regions of one gas.
#[derive(Clone, Debug)]
struct Regions {
    /// Volume of grains in each, over the mean volume of a grain; in rising order.
    contents: Vec<f64>,
    /// Volume fraction per content.
    share: f64,
    /// Σ V_p² over all grains, over the square of the mean volume.
    squares: f64,
}

/// Regions along each axis: 40 grains each, where the box is not too thin for it.
fn partition<V: Vector>(size: V, grains: usize) -> [u32; 3] {
    let mut cells = [1; 3];
    let mut is_thin = [false; 3];
    // An axis that is shorter than a region is not cut, which makes regions of the others shorter.
    for _ in 0..V::DIMENSION {
        let free: Vec<usize> = (0..V::DIMENSION).filter(|&axis| !is_thin[axis]).collect();
        let area: f64 = free.iter().map(|&axis| size[axis]).product();
        let side = (GRAINS * area / grains as f64).powf(1.0 / free.len() as f64);
        for axis in free {
            is_thin[axis] = size[axis] < side;
            cells[axis] = (size[axis] / side * (1.0 + 1e-12)).floor().max(1.0) as u32;
        }
    }
    cells
}

impl Regions {
    /// The regions of `gas`; `None` without grains.
    fn of<V: Vector>(gas: &Gas<V>) -> Option<Self> {
        if gas.is_empty() {
            return None;
        }
        let (origin, size) = (gas.grid().origin(), gas.grid().size());
        let grid = Grid::new(origin, size, &partition(size, gas.len()), &[false; 3]);
        let mut contents = vec![0.0; grid.number_of_cells()];
        let (mut volume, mut squares) = (gas.len() as f64, gas.len() as f64);
        if gas.species.is_empty() {
            gas.positions().iter().for_each(|&place| contents[grid.cell_of(place) as usize] += 1.0);
        } else {
            (volume, squares) = (0.0, 0.0);
            for (row, &place) in gas.positions().iter().enumerate() {
                let grain = gas.grain_at(row).volume::<V>();
                contents[grid.cell_of(place) as usize] += grain;
                volume += grain;
                squares += grain * grain;
            }
        }
        let each = volume / gas.len() as f64;
        contents.iter_mut().for_each(|content| *content /= each);
        contents.sort_unstable_by(f64::total_cmp);
        let unit = if gas.species.is_empty() { gas.grain.volume::<V>() } else { each };
        Some(Regions { contents, share: unit / grid.cell_volume(), squares: squares / (each * each) })
    }

    /// The volume fraction below which a `share` of the regions lies: straight lines between the middles of equal
    /// contents in their order (the mid-quantile of Ma, Genton and Parzen 2011). Contents are whole numbers of
    /// grains, and quantiles that could only be such would jump where the gas changes evenly.
    fn quantile(&self, share: f64) -> f64 {
        let place = share * self.contents.len() as f64;
        let here = self.equals((place as usize).min(self.contents.len() - 1));
        let (near, own) = (middle(&here), self.contents[here.start]);
        let next = if place < near {
            here.start.checked_sub(1).map(|row| self.equals(row))
        } else {
            (here.end < self.contents.len()).then(|| self.equals(here.end))
        };
        let content = next.map_or(own, |next| {
            own + (self.contents[next.start] - own) * (place - near) / (middle(&next) - near)
        });
        content * self.share
    }

    /// The rows with the content of `row`.
    fn equals(&self, row: usize) -> Range<usize> {
        let content = self.contents[row];
        let first = self.contents.partition_point(|&other| other < content);
        first..self.contents.partition_point(|&other| other <= content)
    }

    /// The variance over that of independent grains; NaN of a single region.
    fn variance(&self) -> f64 {
        let deviation = standard_deviation(&self.contents).unwrap_or(f64::NAN);
        deviation * deviation * self.contents.len() as f64 / self.squares
    }

    /// Middles of bins, density of regions in them and its error from their number, `[bin]`.
    fn distribution(&self) -> Vec<Vec<f64>> {
        // Bins end half-way between whole numbers of grains, so that each holds as many of these.
        let bin_of = |content: f64| ((content + 0.5) / BIN) as usize;
        let bins = self.contents.last().map_or(0, |&most| bin_of(most) + 1);
        let mut counts = vec![0.0; bins];
        self.contents.iter().for_each(|&content| counts[bin_of(content)] += 1.0);
        let regions = self.contents.len() as f64;
        let width = BIN * self.share;
        let middle = |bin: usize| (bin as f64 * BIN + 0.5 * (BIN - 1.0)) * self.share;
        let error = |count: &f64| (count * (1.0 - count / regions)).sqrt() / (regions * width);
        vec![
            (0..bins).map(middle).collect(),
            counts.iter().map(|count| count / (regions * width)).collect(),
            counts.iter().map(error).collect(),
        ]
    }
}

/// The middle of a range of rows.
fn middle(rows: &Range<usize>) -> f64 {
    0.5 * (rows.start + rows.end) as f64
}

/// The figures of `regions`; NaN without grains.
fn figures(regions: Option<&Regions>) -> Vec<f64> {
    let Some(regions) = regions else { return vec![f64::NAN; QUANTILES.len() + 1] };
    let quantiles = QUANTILES.iter().map(|(share, _)| regions.quantile(*share));
    quantiles.chain([regions.variance()]).collect()
}

/// Their names.
fn names() -> impl Iterator<Item = &'static str> {
    QUANTILES.iter().map(|(_, name)| *name).chain([VARIANCE])
}

impl DensityDistribution {
    /// The measure; every setting has it.
    pub fn new() -> Self {
        DensityDistribution { samples: Samples::new(QUANTILES.len() + 1), last: LastLook::default() }
    }
}

impl DensityDistribution {
    /// The regions of the gas of `snapshot`.
    fn look<V: Vector>(&mut self, snapshot: &Snapshot<'_, V>) -> Option<&Regions> {
        self.last.of(snapshot, || Regions::of(snapshot.gas)).as_ref()
    }
}

impl Default for DensityDistribution {
    fn default() -> Self {
        Self::new()
    }
}

impl<V: Vector> Measure<V> for DensityDistribution {
    fn name(&self) -> &'static str {
        "density-distribution"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn effort(&self) -> Effort {
        Effort::Table
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let row = figures(self.look(snapshot));
        self.samples.push(snapshot.gas.time(), &row);
    }

    fn columns(&self) -> Vec<Column> {
        names().map(|name| column(name, PURE)).collect()
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        figures(self.look(snapshot))
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let Some(regions) = self.look(snapshot) else { return Vec::new() };
        let columns = ["volume_fraction", "probability_density", "standard_error"];
        vec![Profile {
            name: "density-distribution".to_owned(),
            time: snapshot.gas.time(),
            columns: columns.into_iter().map(|name| column(name, PURE)).collect(),
            values: regions.distribution(),
        }]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &figures(Regions::of(snapshot.gas).as_ref()));
        let rows = samples.since(from);
        let mean = |(k, name)| figure(name, steady_mean(&rows, |row| row[1 + k]));
        (Vec::new(), names().enumerate().map(mean).collect())
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
#[path = "density_distribution_tests.rs"]
mod tests;
