//! Amplitudes of the density waves that fit into a periodic box, by fast Fourier transform.
//!
//! A grain is spread over the six nearest grid points of each axis by a cardinal B-spline of order six, whose
//! transform sinc⁶(k h/2), h the spacing, is divided out (Essmann et al. 1995). The grid is twice as fine as
//! the shortest wave asks for: what the grid takes for a wave but is a shorter one enters with at most
//! 3⁻⁶ = 0.0014 of its amplitude, and with far less in long waves.

use std::f64::consts::PI;

use super::transform::Transform;
use crate::space::Vector;

/// Order of the spline: grid points per axis that a grain touches.
const ORDER: usize = 6;

/// The waves k = 2π (n_a/L_a) with |n_a| ≤ `highest[a]` in a box.
#[derive(Clone, Debug)]
pub(crate) struct DensityWaves<V> {
    origin: V,
    size: V,
    /// Grid points along each axis; 1 along an axis without waves.
    points: [usize; 3],
}

/// A wave that fits into the box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wave<V> {
    /// k [1/length].
    pub(crate) vector: V,
    /// How many waves it stands for: 2 where −k is meant, too.
    pub(crate) number: f64,
}

impl<V: Vector> DensityWaves<V> {
    /// Waves in the box of `size` at `origin` on a grid of `points`: powers of two from eight on, or 1 along an
    /// axis without waves.
    pub(crate) fn new(origin: V, size: V, points: [usize; 3]) -> Self {
        DensityWaves { origin, size, points }
    }

    /// The highest |n_a| along `axis`: half of what the grid could tell.
    pub(crate) fn highest(&self, axis: usize) -> usize {
        self.points[axis] / 4
    }

    /// The waves of [`DensityWaves::powers`], in its order. k and −k have one power: of every such pair that one
    /// stands here whose first component is above zero, and counts twice; where it is zero both stand here.
    pub(crate) fn waves(&self) -> Vec<Wave<V>> {
        let wave = |n: [i64; 3]| Wave {
            vector: V::from_fn(|axis| 2.0 * PI * n[axis] as f64 / self.size[axis]),
            number: if n[0] == 0 { 1.0 } else { 2.0 },
        };
        self.numbers().map(wave).collect()
    }

    /// |Σ_j exp(−i k·x_j)|² of every wave.
    pub(crate) fn powers(&self, positions: &[V]) -> Vec<f64> {
        let transform = Transform::up_to(self.points, self.highest(0));
        let amplitudes = transform.forward(&self.spread(positions));
        let windows: [Vec<f64>; 3] = std::array::from_fn(|axis| self.windows(axis));
        let power = |n: [i64; 3]| {
            let place = std::array::from_fn(|axis| n[axis].rem_euclid(self.points[axis] as i64) as usize);
            let window: f64 =
                (0..3).map(|axis| windows[axis][(n[axis] + self.highest(axis) as i64) as usize]).product();
            amplitudes[transform.place(place)].norm_sqr() / window
        };
        self.numbers().map(power).collect()
    }

    /// n of every wave, the last axis running fastest.
    fn numbers(&self) -> impl Iterator<Item = [i64; 3]> {
        let [x, y, z] = std::array::from_fn(|axis| self.highest(axis) as i64);
        (0..=x).flat_map(move |nx| (-y..=y).flat_map(move |ny| (-z..=z).map(move |nz| [nx, ny, nz])))
    }

    /// Square of the spline's transform for every n_a along `axis`.
    fn windows(&self, axis: usize) -> Vec<f64> {
        let highest = self.highest(axis) as i64;
        let window = |n: i64| {
            let half = PI * n as f64 / self.points[axis] as f64;
            if n == 0 { 1.0 } else { (half.sin() / half).powi(2 * ORDER as i32) }
        };
        (-highest..=highest).map(window).collect()
    }

    /// The density on the grid, in grains per point, the first axis running fastest.
    fn spread(&self, positions: &[V]) -> Vec<f64> {
        let [nx, ny, nz] = self.points;
        let mut density = vec![0.0; nx * ny * nz];
        for &position in positions {
            let along: [Share; 3] = std::array::from_fn(|axis| self.share(position, axis));
            let of = |axis: usize| {
                along[axis].place.iter().copied().zip(along[axis].weight).take(along[axis].points)
            };
            for (z, of_z) in of(2) {
                for (y, of_y) in of(1) {
                    let line = (z * ny + y) * nx;
                    of(0).for_each(|(x, of_x)| density[line + x] += of_x * of_y * of_z);
                }
            }
        }
        density
    }

    /// Where a grain at `position` goes along `axis`.
    fn share(&self, position: V, axis: usize) -> Share {
        let points = self.points[axis];
        if points == 1 {
            let mut weight = [0.0; ORDER];
            weight[0] = 1.0;
            return Share { points: 1, place: [0; ORDER], weight };
        }
        let place = (position[axis] - self.origin[axis]) / self.size[axis] * points as f64;
        let first = place.floor();
        let below = first.rem_euclid(points as f64) as usize + points;
        Share {
            points: ORDER,
            // Points are a power of two from eight on.
            place: std::array::from_fn(|k| (below - k) & (points - 1)),
            weight: spline(place - first),
        }
    }
}

/// Grid points of one axis and what they get of a grain.
struct Share {
    points: usize,
    place: [usize; ORDER],
    weight: [f64; ORDER],
}

/// M(f + k) for k = 0 … 5 of the cardinal B-spline M of order six, by its recurrence.
fn spline(fraction: f64) -> [f64; ORDER] {
    let mut values = [0.0; ORDER];
    values[0] = 1.0;
    for order in 2..=ORDER {
        let norm = 1.0 / (order - 1) as f64;
        for k in (0..order).rev() {
            let u = fraction + k as f64;
            let before = if k > 0 { values[k - 1] } else { 0.0 };
            values[k] = (u * values[k] + (order as f64 - u) * before) * norm;
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::testing::random_positions;
    use glam::{DVec2, DVec3};

    /// Largest difference from the sum over grains, over N: of waves up to a quarter of the highest, and of all.
    fn differences<V: Vector>(size: V, points: [usize; 3]) -> [f64; 2] {
        let origin = V::from_fn(|axis| -1.5 * axis as f64);
        let positions: Vec<V> = random_positions(9, 300, size).into_iter().map(|p| p + origin).collect();
        let waves = DensityWaves::new(origin, size, points);
        let mut largest = [0.0_f64; 2];
        let powers = waves.powers(&positions);
        let (all, of_axis) = (waves.waves(), |axis| 2 * waves.highest(axis) + 1);
        assert_eq!(powers.len(), all.len());
        assert_eq!(
            all.iter().map(|wave| wave.number).sum::<f64>(),
            (0..3).map(of_axis).product::<usize>() as f64
        );
        for (k, power) in all.into_iter().map(|wave| wave.vector).zip(powers) {
            let sum = |f: fn(f64) -> f64| positions.iter().map(|x| f(k.dot(*x))).sum::<f64>();
            let difference = (power - sum(f64::cos).powi(2) - sum(f64::sin).powi(2)).abs() / 300.0;
            let share = |axis: usize| k[axis].abs() * size[axis] / (2.0 * PI * waves.highest(axis) as f64);
            let is_long = (0..V::DIMENSION).all(|axis| points[axis] == 1 || share(axis) < 0.26);
            largest[0] = largest[0].max(if is_long { difference } else { 0.0 });
            largest[1] = largest[1].max(difference);
        }
        largest
    }

    #[test]
    fn powers_are_those_of_the_true_positions() {
        // Two waves that the grid cannot tell from each other have amplitudes of about √N, seldom above 3 √N:
        // 2 · 3 · 3 · 3⁻⁶ = 0.025 for each axis; at a quarter of that wavenumber 15⁻⁶ for 3⁻⁶.
        for [long, all] in [
            differences(DVec2::new(11.0, 23.0), [32, 64, 1]),
            differences(DVec3::new(5.0, 7.0, 16.0), [16, 16, 32]),
        ] {
            assert!(long < 5e-6 && all < 0.075, "{long} {all}");
        }
        // No component along the first axis.
        let [long, all] = differences(DVec2::new(11.0, 23.0), [1, 64, 1]);
        assert!(long < 5e-6 && all < 0.025, "{long} {all}");
    }

    #[test]
    fn a_spline_is_a_partition() {
        for fraction in [0.0, 0.3, 0.999] {
            assert!((spline(fraction).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
        // 1/120, 26/120, 66/120 at whole numbers.
        let whole = spline(0.0).map(|x| (x * 120.0).round());
        assert_eq!(whole, [0.0, 1.0, 26.0, 66.0, 26.0, 1.0]);
    }
}
