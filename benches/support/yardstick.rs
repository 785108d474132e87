//! The yardstick: a plain cell method of the right layout, one thread, nothing else.
//!
//! Move, wrap, cell index, histogram, prefix sum, stable scatter to sorted structure-of-arrays,
//! then collisions with a loose majorant. No walls, no displacement, no Enskog factor, no
//! reproducible streams. Engines are judged by their ratio to it in the same run.

use grainflow::law::kinetic_theory::collision_frequency;
use grainflow::matter::grain::Grain;
use grainflow::space::Vector;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::cases::{VOLUME_FRACTION, geometry};

/// Bound on relative speeds in units of the thermal speed: about three candidates per collision.
const MAJORANT: f64 = 5.4;

/// The kernel on the state `gas`, with so many collisions per particle and step, as a closure that makes one.
pub(crate) fn yardstick<V: Vector, const D: usize>(grains: usize, collisions: f64) -> impl FnMut() {
    let (side, cells) = geometry::<V>(grains, VOLUME_FRACTION);
    let grain = Grain { diameter: 1.0, mass: 1.0 };
    let (sigma, g) = (V::cross_section(1.0), V::contact_correlation(VOLUME_FRACTION));
    let duration = collisions / collision_frequency::<V>(grain, VOLUME_FRACTION, 1.0, g);
    let mut kernel = Yardstick::<D>::new(grains, side, cells, duration);
    move || kernel.step(sigma, g)
}

/// A periodic elastic gas of grains of unit diameter and mass at unit temperature, D = 2 or 3.
pub(crate) struct Yardstick<const D: usize> {
    positions: [Vec<f64>; D],
    velocities: [Vec<f64>; D],
    ids: Vec<u32>,
    spare: [Vec<f64>; D],
    spare_velocities: [Vec<f64>; D],
    spare_ids: Vec<u32>,
    cells: Vec<u32>,
    offsets: Vec<u32>,
    cursors: Vec<u32>,
    side: f64,
    cells_per_axis: usize,
    duration: f64,
    random: Xoshiro256PlusPlus,
    /// Collisions so far.
    pub(crate) collisions: u64,
}

impl<const D: usize> Yardstick<D> {
    /// `grains` in a box of side `side` with `cells_per_axis`, moving for `duration` a step.
    pub(crate) fn new(grains: usize, side: f64, cells_per_axis: usize, duration: f64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        // Twelve uniform numbers make a fair Gaussian.
        let positions = std::array::from_fn(|_| (0..grains).map(|_| side * uniform()).collect());
        let velocities = std::array::from_fn(|_| {
            (0..grains).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
        });
        let cells = cells_per_axis.pow(D as u32);
        Yardstick {
            positions,
            velocities,
            ids: (0..grains as u32).collect(),
            spare: std::array::from_fn(|_| vec![0.0; grains]),
            spare_velocities: std::array::from_fn(|_| vec![0.0; grains]),
            spare_ids: vec![0; grains],
            cells: vec![0; grains],
            offsets: vec![0; cells + 1],
            cursors: vec![0; cells],
            side,
            cells_per_axis,
            duration,
            random,
            collisions: 0,
        }
    }

    /// One step. `cross_section` σ and the `enskog_factor` χ set the collision rate.
    pub(crate) fn step(&mut self, cross_section: f64, enskog_factor: f64) {
        self.advect();
        self.sort();
        self.collide(cross_section, enskog_factor);
    }

    fn advect(&mut self) {
        let per_side = self.cells_per_axis as f64 / self.side;
        self.cells.fill(0);
        let mut stride = 1;
        for (positions, velocities) in self.positions.iter_mut().zip(&self.velocities) {
            for ((x, v), cell) in positions.iter_mut().zip(velocities).zip(&mut self.cells) {
                let mut there = *x + v * self.duration;
                if there < 0.0 {
                    there += self.side;
                }
                if there >= self.side {
                    there -= self.side;
                }
                *x = there;
                *cell += ((there * per_side) as u32).min(self.cells_per_axis as u32 - 1) * stride;
            }
            stride *= self.cells_per_axis as u32;
        }
    }

    fn sort(&mut self) {
        self.cursors.fill(0);
        for &cell in &self.cells {
            self.cursors[cell as usize] += 1;
        }
        let mut place = 0;
        for (cursor, offset) in self.cursors.iter_mut().zip(&mut self.offsets) {
            *offset = place;
            place += std::mem::replace(cursor, place);
        }
        *self.offsets.last_mut().expect("one more than cells") = place;
        for (row, &cell) in self.cells.iter().enumerate() {
            let place = self.cursors[cell as usize] as usize;
            self.cursors[cell as usize] += 1;
            for axis in 0..D {
                self.spare[axis][place] = self.positions[axis][row];
                self.spare_velocities[axis][place] = self.velocities[axis][row];
            }
            self.spare_ids[place] = self.ids[row];
        }
        std::mem::swap(&mut self.positions, &mut self.spare);
        std::mem::swap(&mut self.velocities, &mut self.spare_velocities);
        std::mem::swap(&mut self.ids, &mut self.spare_ids);
    }

    fn collide(&mut self, cross_section: f64, enskog_factor: f64) {
        let cell_volume = (self.side / self.cells_per_axis as f64).powi(D as i32);
        let per_pair = enskog_factor * cross_section * MAJORANT * self.duration / (2.0 * cell_volume);
        for cell in 0..self.cursors.len() {
            let (first, last) = (self.offsets[cell] as usize, self.offsets[cell + 1] as usize);
            let grains = (last - first) as u64;
            if grains < 2 {
                continue;
            }
            let candidates = (per_pair * (grains * (grains - 1)) as f64 + self.uniform()) as u64;
            for _ in 0..candidates {
                let i = first + self.below(grains);
                let mut j = first + self.below(grains - 1);
                j += usize::from(j >= i);
                self.try_pair(i, j);
            }
        }
    }

    fn try_pair(&mut self, i: usize, j: usize) {
        let relative: [f64; D] = std::array::from_fn(|a| self.velocities[a][i] - self.velocities[a][j]);
        let speed = relative.iter().map(|v| v * v).sum::<f64>().sqrt();
        if self.uniform() * MAJORANT >= speed {
            return;
        }
        self.collisions += 1;
        let direction = self.direction();
        for axis in 0..D {
            let change = 0.5 * (speed * direction[axis] - relative[axis]);
            self.velocities[axis][i] += change;
            self.velocities[axis][j] -= change;
        }
    }

    /// A direction uniform on the unit sphere: elastic spheres scatter so.
    fn direction(&mut self) -> [f64; D] {
        loop {
            let point: [f64; D] = std::array::from_fn(|_| 2.0 * self.uniform() - 1.0);
            let square = point.iter().map(|x| x * x).sum::<f64>();
            if square > 1e-12 && square < 1.0 {
                let scale = 1.0 / square.sqrt();
                return point.map(|x| x * scale);
            }
        }
    }

    fn uniform(&mut self) -> f64 {
        (self.random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: u64) -> usize {
        ((u128::from(self.random.next_u64()) * u128::from(n)) >> 64) as usize
    }
}
