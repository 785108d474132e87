//! `correlations`: density and velocity at two places of a periodic box (Müller 2001, 3.19 to 3.22).

use realfft::num_complex::Complex;

use super::measure::{Column, Dimension, Measure, Profile, Snapshot};
use super::moments::mean_velocity;
use super::setting::Setting;
use super::transform::Transform;
use super::units::{LENGTH, PURE, column};
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::space::Vector;

/// G_nn(r)/n̄², G_∥(r) and G_⊥(r) at every recording, averaged over directions, up to half the shortest side.
///
/// Grains are counted in a raster with sides of about one diameter, so many that they have no prime factor above 5. The density is n = N_raster/V_raster; the
/// velocity is the momentum field per mean density, u = Σ(v − v̄)/(n̄ V_raster), which empty places have too.
/// Of every product the share of a grain with itself is left out, so that independent grains give
/// −1/N for G_nn/n̄² and −T/(mN) for G_∥ and G_⊥ with T about v̄. G_⊥ is the mean over the D − 1 directions
/// across r; at r = 0, where there is no direction, both are a third (2D: half) of G_αα. Each row averages the
/// raster vectors whose length rounds to the same number of raster sides.
#[derive(Clone, Copy, Debug)]
pub struct Correlations {
    diameter: f64,
}

/// Sums over the raster vectors of one row.
#[derive(Clone, Copy, Debug, Default)]
struct Shell {
    vectors: f64,
    distance: f64,
    density: f64,
    parallel: f64,
    across: f64,
}

impl Correlations {
    /// The measure for `setting`, if its box is periodic everywhere.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        setting.boundary.is_fully_periodic().then_some(Correlations { diameter: setting.grain.diameter })
    }

    /// The shells of `gas`, `[row]`.
    fn shells<V: Vector>(self, gas: &Gas<V>) -> Vec<Shell> {
        let raster = raster_of(gas.grid(), self.diameter);
        let products = Products::of(gas, &raster);
        let side = (0..V::DIMENSION).map(|axis| raster.side()[axis]).fold(0.0, f64::max);
        let half = (0..V::DIMENSION).map(|axis| 0.5 * raster.size()[axis]).fold(f64::INFINITY, f64::min);
        let mut shells = vec![Shell::default(); (half / side) as usize + 1];
        for place in 0..raster.number_of_cells() {
            let coordinates = raster.coordinates(place as u32);
            let corner = V::from_fn(|axis| f64::from(coordinates[axis]) * raster.side()[axis]);
            let way = raster.separation(V::ZERO, corner);
            if let Some(shell) = shells.get_mut((way.length() / side).round() as usize) {
                let (density, tensor) = products.at(place);
                shell.add(way, density, tensor);
            }
        }
        shells
    }
}

impl Shell {
    /// Adds the raster vector `way` with G_nn and the components of G_αβ there.
    fn add<V: Vector>(&mut self, way: V, density: f64, tensor: impl Iterator<Item = f64>) {
        let length = way.length();
        let (mut trace, mut along) = (0.0, 0.0);
        for ((a, b), component) in components::<V>().zip(tensor) {
            if a == b {
                trace += component;
                along += way[a] * way[a] * component;
            } else {
                along += 2.0 * way[a] * way[b] * component;
            }
        }
        let parallel = if length > 0.0 { along / (length * length) } else { trace / V::DIMENSION as f64 };
        self.vectors += 1.0;
        self.distance += length;
        self.density += density;
        self.parallel += parallel;
        self.across += (trace - parallel) / (V::DIMENSION - 1) as f64;
    }
}

/// Correlations at every raster vector.
struct Products {
    density: Vec<f64>,
    /// `[component][place]`, in the order of [`components`].
    velocity: Vec<Vec<f64>>,
}

impl Products {
    fn of<V: Vector>(gas: &Gas<V>, raster: &Grid<V>) -> Self {
        let grains = gas.len() as f64;
        let cells = raster.number_of_cells() as f64;
        let mean = mean_velocity(gas);
        let mut fields = vec![vec![0.0; raster.number_of_cells()]; V::DIMENSION + 1];
        for (&position, &velocity) in gas.positions().iter().zip(gas.velocities()) {
            let place = raster.cell_of(raster.wrapped(position)) as usize;
            fields[V::DIMENSION][place] += 1.0;
            (0..V::DIMENSION).for_each(|k| fields[k][place] += (velocity - mean)[k]);
        }
        let transform = Transform::new(raster.cells().map(|cells| cells as usize));
        let spectra: Vec<_> = fields.iter().map(|field| transform.forward(field)).collect();
        // Σ over places, per pair of grains, to ⟨…⟩ per n̄²: V/N² · 1/V_raster = cells/N².
        let scale = cells / (grains * grains);
        // Σ_x ½ (f(x) g(x + r) + g(x) f(x + r)) for every raster vector r: its transform is the real part of f g*.
        let product = |a: usize, b: usize, itself: f64| {
            let pairs = spectra[a].iter().zip(&spectra[b]);
            let mut values =
                transform.backward(pairs.map(|(f, g)| Complex::new((f * g.conj()).re, 0.0)).collect());
            values[0] -= itself;
            values.iter_mut().for_each(|value| *value *= scale);
            values
        };
        let itself =
            |a: usize, b: usize| gas.velocities().iter().map(|&v| (v - mean)[a] * (v - mean)[b]).sum::<f64>();
        let velocity = components::<V>().map(|(a, b)| product(a, b, itself(a, b))).collect();
        let mut density = product(V::DIMENSION, V::DIMENSION, grains);
        density.iter_mut().for_each(|value| *value -= 1.0);
        Products { density, velocity }
    }

    /// G_nn and the components of G_αβ at `place`.
    fn at(&self, place: usize) -> (f64, impl Iterator<Item = f64> + '_) {
        (self.density[place], self.velocity.iter().map(move |component| component[place]))
    }
}

/// αβ = xx, xy, (xz,) yy, …: the components of a symmetric tensor, each once.
fn components<V: Vector>() -> impl Iterator<Item = (usize, usize)> {
    (0..V::DIMENSION).flat_map(|a| (a..V::DIMENSION).map(move |b| (a, b)))
}

/// The box in cells with sides of about `diameter`.
fn raster_of<V: Vector>(grid: &Grid<V>, diameter: f64) -> Grid<V> {
    let mut cells = [1; 3];
    for (axis, cells) in cells.iter_mut().enumerate().take(V::DIMENSION) {
        *cells = smooth(grid.size()[axis] / diameter);
    }
    Grid::new(grid.origin(), grid.size(), &cells, &[true; 3])
}

/// The whole number nearest to `wish` without prime factors above 5: what Fourier transforms are fast for.
fn smooth(wish: f64) -> u32 {
    let is_smooth = |number: u32| {
        let rest = [2, 3, 5].into_iter().fold(number, |mut rest, prime| {
            while rest.is_multiple_of(prime) {
                rest /= prime;
            }
            rest
        });
        rest == 1
    };
    let nearest = wish.round().max(1.0) as u32;
    (0..)
        .flat_map(|far| [nearest.saturating_sub(far), nearest + far])
        .find(|&n| n > 0 && is_smooth(n))
        .unwrap_or(1)
}

impl<V: Vector> Measure<V> for Correlations {
    fn name(&self) -> &'static str {
        "correlations"
    }

    fn is_costly(&self) -> bool {
        true
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        if snapshot.gas.is_empty() {
            return Vec::new();
        }
        let shells: Vec<Shell> =
            self.shells(snapshot.gas).into_iter().filter(|shell| shell.vectors > 0.0).collect();
        let mean = |sum: fn(&Shell) -> f64| shells.iter().map(|s| sum(s) / s.vectors).collect::<Vec<_>>();
        vec![Profile {
            name: "correlations".to_owned(),
            time: snapshot.gas.time(),
            columns: columns(),
            values: vec![mean(|s| s.distance), mean(|s| s.density), mean(|s| s.parallel), mean(|s| s.across)],
        }]
    }
}

fn columns() -> Vec<Column> {
    let square = Dimension { mass: 0, length: 2, time: -2 };
    vec![
        column("distance", LENGTH),
        column("density_correlation", PURE),
        column("parallel_correlation", square),
        column("perpendicular_correlation", square),
    ]
}

#[cfg(test)]
#[path = "correlations_tests.rs"]
mod tests;
