//! `clusters`: grains that stand close together (Miller 2004, section 5.2.3).

use super::measure::{Column, Measure, Profile, Snapshot};
use super::setting::Setting;
use super::units::{PURE, column};
use crate::matter::bins::Bins;
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::space::Vector;

mod forest;

use forest::Forest;

/// δ/d: surfaces closer than this share of the diameter link two grains (Miller 2004, 5.11).
const LINK: f64 = 0.1;

/// Clusters of linked grains at every recording: two grains are linked when the distance of their surfaces is
/// less than 0.1 of their contact distance, over periodic images. A grain alone is a cluster of size 1.
#[derive(Clone, Debug)]
pub struct Clusters {
    /// Which axes are periodic.
    periodic: [bool; 3],
    /// When the clusters were last looked for [time], and what was found: for the profile of the same moment.
    latest: Option<(f64, Census)>,
}

/// The clusters of one state.
#[derive(Clone, Debug, PartialEq)]
struct Census {
    /// s of every cluster, in the order of their first grains.
    sizes: Vec<u32>,
    /// Whether a cluster meets its own periodic image along an axis.
    percolates: [bool; 3],
}

impl Clusters {
    /// The measure for `setting`; every one has it.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Self {
        let is_periodic = |axis| axis < V::DIMENSION && setting.boundary.is_periodic(axis);
        Clusters { periodic: std::array::from_fn(is_periodic), latest: None }
    }
}

impl Census {
    /// Finds the clusters in time proportional to the number of grains, if no place is overcrowded.
    fn of<V: Vector>(gas: &Gas<V>) -> Self {
        let diameters: Vec<f64> = (0..gas.len()).map(|row| gas.grain_at(row).diameter).collect();
        let forest = linked(gas.grid(), gas.positions(), &diameters);
        Census { sizes: forest.sizes(), percolates: forest.winds() }
    }

    fn grains(&self) -> usize {
        self.sizes.iter().map(|&size| size as usize).sum()
    }

    fn largest(&self) -> f64 {
        self.sizes.iter().copied().max().map_or(f64::NAN, f64::from)
    }

    /// M_k = Σ s^k n_s/n_tot (Miller 2004, 5.12); NaN without grains.
    fn moment(&self, order: i32) -> f64 {
        self.sizes.iter().map(|&size| f64::from(size).powi(order)).sum::<f64>() / self.sizes.len() as f64
    }

    /// M′_k = M_k − N_x^k/n_tot (Miller 2004, 5.14, right-hand form): one largest cluster is left out;
    /// the sum up to N_x − 1 would leave out all of that size.
    fn reduced_moment(&self, order: i32) -> f64 {
        self.moment(order) - self.largest().powi(order) / self.sizes.len() as f64
    }

    /// Clusters of sizes 2^k … 2^(k+1) − 1 and the grains in them, `[k]`.
    fn distribution(&self) -> Vec<(f64, f64)> {
        let mut bins = Vec::new();
        for &size in &self.sizes {
            let bin = size.ilog2() as usize;
            if bins.len() <= bin {
                bins.resize(bin + 1, (0.0, 0.0));
            }
            bins[bin].0 += 1.0;
            bins[bin].1 += f64::from(size);
        }
        bins
    }
}

/// The size of the cluster that each grain belongs to `[grain]`, of grains at `positions` [length] with `diameters` [length]
/// in the box of `grid`; links are those of [`Clusters`].
pub fn cluster_sizes<V: Vector>(grid: &Grid<V>, positions: &[V], diameters: &[f64]) -> Vec<u32> {
    let mut forest = linked(grid, positions, diameters);
    (0..positions.len()).map(|grain| forest.size_with(grain)).collect()
}

/// Joins all grains that are linked.
fn linked<V: Vector>(grid: &Grid<V>, positions: &[V], diameters: &[f64]) -> Forest {
    let reach = (1.0 + LINK) * diameters.iter().copied().fold(0.0, f64::max);
    let mut bins = Bins::new(grid, reach, positions.len());
    let mut forest = Forest::new(positions.len());
    for (row, &position) in positions.iter().enumerate() {
        bins.any_near(position, |other, distance_squared| {
            let link = (1.0 + LINK) * 0.5 * (diameters[row] + diameters[other]);
            if distance_squared < link * link {
                forest.join(row, other, turns(grid, position, positions[other]));
            }
            false
        });
        bins.insert(position);
    }
    forest
}

/// How many boxes away the image of `b` is that is nearest to `a`, along every axis.
fn turns<V: Vector>(grid: &Grid<V>, a: V, b: V) -> [i32; 3] {
    let beyond = grid.separation(a, b) - (b - a);
    std::array::from_fn(|axis| {
        if axis < V::DIMENSION { (beyond[axis] / grid.size()[axis]).round() as i32 } else { 0 }
    })
}

impl<V: Vector> Measure<V> for Clusters {
    fn name(&self) -> &'static str {
        "clusters"
    }

    fn is_costly(&self) -> bool {
        true
    }

    fn columns(&self) -> Vec<Column> {
        let names = [
            "clusters",
            "largest_cluster_share",
            "cluster_moment_1",
            "cluster_moment_2",
            "reduced_cluster_moment_1",
            "reduced_cluster_moment_2",
        ];
        let mut columns: Vec<Column> = names.into_iter().map(|name| column(name, PURE)).collect();
        let periodic = V::AXIS_NAMES.iter().zip(self.periodic).filter(|(_, periodic)| *periodic);
        columns.extend(periodic.map(|(axis, _)| column(&format!("percolates_{axis}"), PURE)));
        columns
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let census = Census::of(snapshot.gas);
        let mut values = vec![
            census.sizes.len() as f64,
            census.largest() / snapshot.gas.len() as f64,
            census.moment(1),
            census.moment(2),
            census.reduced_moment(1),
            census.reduced_moment(2),
        ];
        let periodic = census.percolates.iter().zip(self.periodic).filter(|(_, periodic)| *periodic);
        values.extend(periodic.map(|(percolates, _)| f64::from(u8::from(*percolates))));
        self.latest = Some((snapshot.gas.time(), census));
        values
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let time = snapshot.gas.time();
        let latest = self
            .latest
            .take()
            .filter(|(when, census)| *when == time && census.grains() == snapshot.gas.len());
        let census = latest.map_or_else(|| Census::of(snapshot.gas), |(_, census)| census);
        let bins = census.distribution();
        if bins.is_empty() {
            return Vec::new();
        }
        let smallest: Vec<f64> = (0..bins.len()).map(|k| (1_u64 << k) as f64).collect();
        let (clusters, grains): (Vec<f64>, Vec<f64>) = bins.into_iter().unzip();
        let per_size = clusters.iter().zip(&smallest).map(|(number, width)| number / width).collect();
        let share = grains.iter().map(|number| number / snapshot.gas.len() as f64).collect();
        vec![Profile {
            name: "clusters".to_owned(),
            time,
            columns: ["size", "clusters_per_size", "clusters", "share_of_grains"]
                .map(|name| column(name, PURE))
                .to_vec(),
            values: vec![smallest, per_size, clusters, share],
        }]
    }
}

#[cfg(test)]
#[path = "clusters_tests.rs"]
mod tests;
