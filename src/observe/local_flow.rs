//! The flow of a gas near each place, and the temperature about it.
//!
//! The box is cut into bins, blocks of whole cells of the grid, of a mean number of grains that the caller states. In each
//! bin c the flow is u(x) = v̄ + Σ_k β_k φ_k(x): the velocity v̄ of its centre of mass and, along every axis across which there
//! is more than one bin or no period, a constant gradient, fitted with the masses as weights. φ_k are the coordinates about
//! the centre of mass, made orthonormal: Σ m φ_k φ_l = δ_kl. Then
//!
//! T = Σ_c [Σ m|v − v̄_c|² − Σ_k β_k²] / (D Σ_c (N_c − 1 − r_c)), r_c the number of the φ_k,
//!
//! whose expectation is T where grains of any masses have one temperature T about a flow that is linear in each bin: of a
//! fit with weights m_i to velocities of variance T/m_i each, Σ m|v − u|² is D T (N_c − 1 − r_c). Without the gradient a
//! bin of width Δ in a flow of gradient γ would add m (γΔ)²/12 along the flow, a temperature that depends on the bin (Glasser
//! and Goldhirsch 2001). What is left of a flow of curvature u″ is of order m (u″Δ²)²/720.
//!
//! A bin of fewer than r_c + 2 grains says nothing. Each bin is summed by one thread, in the order of its cells, and the sums
//! of the bins are added in order: the bits do not depend on the number of threads.

use std::ops::Range;

use rayon::prelude::*;

use crate::matter::gas::Gas;
use crate::space::Vector;

/// A coordinate of which the fit leaves less than this share of its square is a combination of others, up to rounding.
const DEPENDENT: f64 = 1e-9;

/// Mean number of grains in the bins of temperatures: 20 in 2D, 40 in 3D, about 4 mean distances of grains across.
pub(crate) const fn grains_of_a_bin<V: Vector>() -> f64 {
    (5 << V::DIMENSION) as f64
}

/// Blocks of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bins {
    /// Along each axis.
    counts: [u32; 3],
    /// Along which axes the flow may have a gradient.
    has_gradient: [bool; 3],
}

impl Bins {
    /// Cubes, as far as the box and its cells allow, of `grains` grains on the average over the box of `gas`.
    fn of<V: Vector>(gas: &Gas<V>, grains: f64) -> Self {
        let (grid, size) = (gas.grid(), gas.grid().size());
        let mut counts = [1; 3];
        let mut volume = size.product() * grains / gas.len().max(1) as f64;
        let mut free: Vec<usize> = (0..V::DIMENSION).collect();
        let mut side = volume.powf(1.0 / free.len() as f64);
        // Bins reach through the whole box along axes that are shorter than their sides, and are wider along the others.
        while let Some(place) = free.iter().position(|&axis| size[axis] < side) {
            volume /= size[free.remove(place)];
            side = if free.is_empty() { side } else { volume.powf(1.0 / free.len() as f64) };
        }
        for axis in free {
            counts[axis] = ((size[axis] / side) as u32).clamp(1, grid.cells()[axis]);
        }
        let has_gradient =
            [0, 1, 2].map(|axis| axis < V::DIMENSION && (counts[axis] > 1 || !grid.is_periodic(axis)));
        Bins { counts, has_gradient }
    }

    fn number(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).product()
    }

    /// The slices of one cell across `axis`, in which the flow may have a gradient along it.
    fn slices<V: Vector>(gas: &Gas<V>, axis: usize) -> Self {
        let mut bins = Bins { counts: [1; 3], has_gradient: [false; 3] };
        bins.counts[axis] = gas.grid().cells()[axis];
        bins.has_gradient[axis] = true;
        bins
    }

    /// The rows of bin `number`, in runs of neighbouring ones.
    fn rows<V: Vector>(self, gas: &Gas<V>, number: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        let mut rest = number;
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let (count, cells) = (self.counts[axis] as usize, gas.grid().cells()[axis] as usize);
            let place = rest % count;
            rest /= count;
            (place * cells / count) as u32..((place + 1) * cells / count) as u32
        });
        z.flat_map(move |z| y.clone().map(move |y| (y, z))).map(move |(y, z)| {
            let [first, last] = [x.start, x.end - 1].map(|x| gas.grid().cell_at([x, y, z]));
            gas.rows(first).start..gas.rows(last).end
        })
    }
}

/// The flow in one bin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow<V> {
    grains: usize,
    mass: f64,
    /// Centre of mass and its velocity.
    centre: V,
    velocity: V,
    /// φ_k = basis_k · (x − centre), and β_k, for k < `rank`.
    basis: [V; 3],
    slopes: [V; 3],
    rank: usize,
    /// Σ m (v − u)² of each component.
    squares: V,
}

/// Sums over the grains of a bin, of places and velocities about those of its first grain.
struct Sums<V> {
    grains: usize,
    mass: f64,
    place: V,
    momentum: V,
    /// `[axis]`: Σ m x_axis x, Σ m x_axis v.
    places: [V; 3],
    products: [V; 3],
    /// Σ m v² of each component.
    squares: V,
}

impl<V: Vector> Sums<V> {
    fn new() -> Self {
        let none = [V::ZERO; 3];
        let (place, momentum, squares) = (V::ZERO, V::ZERO, V::ZERO);
        Sums { grains: 0, mass: 0.0, place, momentum, places: none, products: none, squares }
    }

    #[inline]
    fn add(&mut self, mass: f64, place: V, velocity: V) {
        let momentum = velocity * mass;
        self.grains += 1;
        self.mass += mass;
        self.place += place * mass;
        self.momentum += momentum;
        for axis in 0..V::DIMENSION {
            self.places[axis] += place * (mass * place[axis]);
            self.products[axis] += momentum * place[axis];
            self.squares[axis] += momentum[axis] * velocity[axis];
        }
    }

    /// The flow, of places and velocities about `origin`, with gradients along the axes that have them.
    fn flow(self, origin: [V; 2], has_gradient: [bool; 3]) -> Flow<V> {
        let (place, velocity) = (self.place * (1.0 / self.mass), self.momentum * (1.0 / self.mass));
        // About the centre of mass.
        let moments: [V; 3] = std::array::from_fn(|axis| match axis < V::DIMENSION {
            true => self.places[axis] - place * (self.mass * place[axis]),
            false => V::ZERO,
        });
        let products: [V; 3] = std::array::from_fn(|axis| match axis < V::DIMENSION {
            true => self.products[axis] - velocity * (self.mass * place[axis]),
            false => V::ZERO,
        });
        let mut flow = Flow {
            grains: self.grains,
            mass: self.mass,
            centre: origin[0] + place,
            velocity: origin[1] + velocity,
            basis: [V::ZERO; 3],
            slopes: [V::ZERO; 3],
            rank: 0,
            squares: V::from_fn(|a| self.squares[a] - self.mass * velocity[a] * velocity[a]),
        };
        for axis in (0..V::DIMENSION).filter(|&axis| has_gradient[axis]) {
            flow.add_gradient(axis, &moments, &products);
        }
        flow.squares = V::from_fn(|axis| flow.squares[axis].max(0.0));
        flow
    }
}

impl<V: Vector> Flow<V> {
    /// Adds the coordinate along `axis`, made orthonormal to those before (Gram and Schmidt), to the fit; `moments` are
    /// Σ m x_a x, `products` Σ m x_a v, both about the centre of mass.
    fn add_gradient(&mut self, axis: usize, moments: &[V; 3], products: &[V; 3]) {
        let product =
            |one: V, other: V| -> f64 { (0..V::DIMENSION).map(|a| one[a] * moments[a].dot(other)).sum() };
        let coordinate = V::along(axis, 1.0);
        let mut rest = coordinate;
        for one in &self.basis[..self.rank] {
            rest -= *one * product(*one, coordinate);
        }
        let norm = product(rest, rest);
        if norm.is_nan() || norm <= DEPENDENT * moments[axis][axis] {
            return;
        }
        let one = rest * (1.0 / norm.sqrt());
        let slope = (0..V::DIMENSION).fold(V::ZERO, |sum, a| sum + products[a] * one[a]);
        self.basis[self.rank] = one;
        self.slopes[self.rank] = slope;
        self.rank += 1;
        for a in 0..V::DIMENSION {
            self.squares[a] -= slope[a] * slope[a];
        }
    }

    /// Temperature about the flow [mass·length²/time²].
    pub(crate) fn temperature(&self) -> f64 {
        let squares: f64 = (0..V::DIMENSION).map(|axis| self.squares[axis]).sum();
        squares / (V::DIMENSION * self.freedom()) as f64
    }

    /// Degrees of freedom that the fit leaves to each component; 0 where it leaves none.
    fn freedom(&self) -> usize {
        self.grains.saturating_sub(1 + self.rank)
    }

    /// φ_k at `position` for k ≥ 1; 0 beyond the rank.
    #[inline]
    fn coordinates(&self, position: V) -> [f64; 3] {
        let place = position - self.centre;
        // Along an axis that the space does not have nothing is to be multiplied.
        std::array::from_fn(|k| if k < V::DIMENSION { self.basis[k].dot(place) } else { 0.0 })
    }

    /// The same behind φ₀ = 1/√M.
    #[inline]
    pub(super) fn all_coordinates(&self, position: V) -> [f64; 4] {
        let [x, y, z] = self.coordinates(position);
        [(1.0 / self.mass).sqrt(), x, y, z]
    }

    /// `velocity` about the flow at `position` [length/time].
    #[inline]
    pub(super) fn rest(&self, position: V, velocity: V) -> V {
        self.rest_at(self.coordinates(position), velocity)
    }

    /// The same, of the coordinates of the position.
    #[inline]
    fn rest_at(&self, coordinates: [f64; 3], velocity: V) -> V {
        (0..V::DIMENSION).fold(velocity - self.velocity, |rest, k| rest - self.slopes[k] * coordinates[k])
    }

    /// The velocity of a grain about the flow, enlarged by what the grain itself moves the flow: of variance T/m in a
    /// Maxwell gas, (v − u)/√(1 − h) with h = m Σ φ_k².
    #[inline]
    pub(crate) fn peculiar(&self, mass: f64, position: V, velocity: V) -> V {
        let coordinates = self.coordinates(position);
        let squares: f64 = coordinates.into_iter().map(|coordinate| coordinate * coordinate).sum();
        let free = 1.0 - mass * (1.0 / self.mass + squares);
        let rest = self.rest_at(coordinates, velocity);
        if free > DEPENDENT { rest * (1.0 / free.sqrt()) } else { V::ZERO }
    }
}

/// The flow of a gas, bin by bin.
#[derive(Clone, Debug)]
pub(crate) struct LocalFlow<V> {
    bins: Bins,
    /// `[bin]`; `None` where a bin holds too few grains to say anything.
    flows: Vec<Option<Flow<V>>>,
}

impl<V: Vector> LocalFlow<V> {
    /// The flow of `gas` in bins of `grains` grains on the average.
    pub(crate) fn of(gas: &Gas<V>, grains: f64) -> Self {
        Self::in_bins(gas, Bins::of(gas, grains))
    }

    /// The flow of `gas` in slices of one cell across `axis`, with a gradient along it.
    pub(crate) fn in_slices(gas: &Gas<V>, axis: usize) -> Self {
        Self::in_bins(gas, Bins::slices(gas, axis))
    }

    fn in_bins(gas: &Gas<V>, bins: Bins) -> Self {
        let flows = (0..bins.number()).into_par_iter().map(|bin| flow(gas, bins, bin));
        LocalFlow { bins, flows: flows.collect() }
    }

    /// The flow of each bin, in order; `None` where a bin holds too few grains to say anything.
    pub(crate) fn flows(&self) -> &[Option<Flow<V>>] {
        &self.flows
    }

    /// D Σ (N_c − 1 − r_c).
    pub(crate) fn freedom(&self) -> f64 {
        let each: usize = self.flows.iter().flatten().map(Flow::freedom).sum();
        (each * V::DIMENSION) as f64
    }

    /// Grains in bins that say something.
    pub(crate) fn grains(&self) -> usize {
        self.flows.iter().flatten().map(|flow| flow.grains).sum()
    }

    /// Temperature about the flow [mass·length²/time²]; `None` where no bin holds enough grains.
    pub(crate) fn temperature(&self) -> Option<f64> {
        let squares = self.squares();
        let all: f64 = (0..V::DIMENSION).map(|axis| squares[axis]).sum();
        let freedom = self.freedom();
        (freedom > 0.0).then(|| all / freedom)
    }

    /// Temperature about the flow of each component over the temperature.
    pub(crate) fn anisotropy(&self, axis: usize) -> f64 {
        let squares = self.squares();
        let all: f64 = (0..V::DIMENSION).map(|axis| squares[axis]).sum();
        squares[axis] * V::DIMENSION as f64 / all
    }

    /// Mean speed about the flow of the grains in bins that say something [length/time]; zero where none does.
    pub(crate) fn mean_speed(&self, gas: &Gas<V>) -> f64 {
        let bins = self.each_bin(gas, |flow, rows| {
            let speed = |row: usize| {
                let (position, velocity) = (gas.positions()[row], gas.velocities()[row]);
                flow.peculiar(gas.grain_at(row).mass, position, velocity).length()
            };
            rows.fold(0.0, |sum, rows| rows.fold(sum, |sum, row| sum + speed(row)))
        });
        let grains = self.grains();
        if grains == 0 { 0.0 } else { bins.into_iter().flatten().sum::<f64>() / grains as f64 }
    }

    /// Σ m (v − u)² of each component.
    fn squares(&self) -> V {
        self.flows.iter().flatten().fold(V::ZERO, |sum, flow| sum + flow.squares)
    }

    /// What `fold` makes of each bin, with its flow and its rows, in runs of neighbouring ones; `None` where a bin says nothing.
    pub(crate) fn each_bin<S: Send>(
        &self,
        gas: &Gas<V>,
        fold: impl Fn(&Flow<V>, &mut dyn Iterator<Item = Range<usize>>) -> S + Sync,
    ) -> Vec<Option<S>> {
        let bins = self.flows.par_iter().enumerate();
        bins.map(|(bin, flow)| {
            let mut rows = self.bins.rows(gas, bin);
            flow.as_ref().map(|flow| fold(flow, &mut rows))
        })
        .collect()
    }
}

/// The flow in one bin of `gas`; `None` where it holds too few grains.
fn flow<V: Vector>(gas: &Gas<V>, bins: Bins, bin: usize) -> Option<Flow<V>> {
    let first = bins.rows(gas, bin).find(|rows| !rows.is_empty())?.start;
    let origin = [gas.positions()[first], gas.velocities()[first]];
    let alike = gas.species.is_empty().then_some(gas.grain.mass);
    let mut sums = Sums::new();
    for rows in bins.rows(gas, bin) {
        let grains = gas.positions()[rows.clone()].iter().zip(&gas.velocities()[rows.clone()]);
        for (row, (place, velocity)) in rows.zip(grains) {
            let mass = alike.unwrap_or_else(|| gas.grain_at(row).mass);
            sums.add(mass, *place - origin[0], *velocity - origin[1]);
        }
    }
    Some(sums.flow(origin, bins.has_gradient)).filter(|flow| flow.freedom() > 0)
}

#[cfg(test)]
#[path = "local_flow_tests.rs"]
mod tests;
