//! Fourier transforms of real fields on a raster of up to three axes, on all threads.
//!
//! Lines are transformed where they lie in one piece; between two axes the raster is turned, so that those of the
//! next one do. Every line is a sum of its own: the number of threads changes no bit.

use std::sync::Arc;

use rayon::prelude::*;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

/// Numbers that a thread takes at a time.
const TASK: usize = 1 << 14;
/// Columns that are turned together: those of one row share a piece of memory.
const BAND: usize = 16;

/// The transforms of fields on a raster of `points`, the first axis running fastest.
///
/// Of the first axis only wavenumbers n = 0 … `kept` − 1 are held: those below zero belong to the conjugate
/// amplitudes of a real field. The others have n = 0 … points − 1, where n and n − points are one.
pub(crate) struct Transform {
    points: [usize; 3],
    kept: usize,
    real: Arc<dyn RealToComplex<f64>>,
    back_to_real: Arc<dyn ComplexToReal<f64>>,
    /// `[axis]`, from the second on: there and back.
    complex: [[Arc<dyn Fft<f64>>; 2]; 2],
}

impl Transform {
    /// All wavenumbers of a raster of `points`.
    pub(crate) fn new(points: [usize; 3]) -> Self {
        Self::up_to(points, points[0] / 2)
    }

    /// Those of them with n ≤ `highest` along the first axis.
    pub(crate) fn up_to(points: [usize; 3], highest: usize) -> Self {
        let (mut reals, mut planner) = (RealFftPlanner::new(), FftPlanner::new());
        let complex = [1, 2]
            .map(|axis| [planner.plan_fft_forward(points[axis]), planner.plan_fft_inverse(points[axis])]);
        Transform {
            points,
            kept: highest.min(points[0] / 2) + 1,
            real: reals.plan_fft_forward(points[0]),
            back_to_real: reals.plan_fft_inverse(points[0]),
            complex,
        }
    }

    /// Where the amplitude of the wavenumbers `n` stands.
    pub(crate) fn place(&self, n: [usize; 3]) -> usize {
        let [_, ny, nz] = self.points;
        if nz == 1 { n[0] * ny + n[1] } else { (n[1] * self.kept + n[0]) * nz + n[2] }
    }

    /// Σ_x f(x) exp(−2πi Σ_a n_a x_a/points_a), at [`Transform::place`].
    pub(crate) fn forward(&self, field: &[f64]) -> Vec<Complex<f64>> {
        let [nx, ny, nz] = self.points;
        let half = nx / 2 + 1;
        let mut amplitudes = vec![Complex::default(); half * ny * nz];
        let rows = TASK.div_ceil(nx);
        amplitudes.par_chunks_mut(rows * half).zip(field.par_chunks(rows * nx)).for_each(|(out, lines)| {
            let (mut line, mut scratch) = (self.real.make_input_vec(), self.real.make_scratch_vec());
            for (out, values) in out.chunks_exact_mut(half).zip(lines.chunks_exact(nx)) {
                line.copy_from_slice(values);
                self.real.process_with_scratch(&mut line, out, &mut scratch).expect("buffers of this length");
            }
        });
        let mut amplitudes = turned(&amplitudes, half, self.kept);
        lines(&mut amplitudes, &*self.complex[0][0]);
        if nz > 1 {
            amplitudes = turned(&amplitudes, ny, ny);
            lines(&mut amplitudes, &*self.complex[1][0]);
        }
        amplitudes
    }

    /// The field whose transform stands in `amplitudes`, all of them kept.
    pub(crate) fn backward(&self, mut amplitudes: Vec<Complex<f64>>) -> Vec<f64> {
        let [nx, ny, nz] = self.points;
        assert_eq!(self.kept, nx / 2 + 1, "only a whole transform has a way back");
        if nz > 1 {
            lines(&mut amplitudes, &*self.complex[1][1]);
            let others = self.kept * nz;
            amplitudes = turned(&amplitudes, others, others);
        }
        lines(&mut amplitudes, &*self.complex[0][1]);
        let mut amplitudes = turned(&amplitudes, ny * nz, ny * nz);
        let mut field = vec![0.0; nx * ny * nz];
        let norm = 1.0 / field.len() as f64;
        let rows = TASK.div_ceil(nx);
        field.par_chunks_mut(rows * nx).zip(amplitudes.par_chunks_mut(rows * self.kept)).for_each(
            |(out, lines)| {
                let mut scratch = self.back_to_real.make_scratch_vec();
                for (out, line) in out.chunks_exact_mut(nx).zip(lines.chunks_exact_mut(self.kept)) {
                    // Of a real line these are real but for rounding, which the library would object to.
                    line[0].im = 0.0;
                    if nx.is_multiple_of(2) {
                        line[nx / 2].im = 0.0;
                    }
                    self.back_to_real
                        .process_with_scratch(line, out, &mut scratch)
                        .expect("buffers of this length");
                    out.iter_mut().for_each(|value| *value *= norm);
                }
            },
        );
        field
    }
}

/// Transforms all lines of `values`, which follow each other.
fn lines(values: &mut [Complex<f64>], plan: &dyn Fft<f64>) {
    let length = plan.len();
    values.par_chunks_mut(TASK.div_ceil(length) * length).for_each(|lines| {
        let mut scratch = vec![Complex::default(); plan.get_inplace_scratch_len()];
        plan.process_with_scratch(lines, &mut scratch);
    });
}

/// The first `kept` columns of a matrix with rows of `columns`, as rows.
fn turned(values: &[Complex<f64>], columns: usize, kept: usize) -> Vec<Complex<f64>> {
    let rows = values.len() / columns;
    let mut turned = vec![Complex::default(); kept * rows];
    turned.par_chunks_mut(BAND * rows).enumerate().for_each(|(band, out)| {
        let (first, width) = (band * BAND, out.len() / rows);
        for (row, line) in values.chunks_exact(columns).enumerate() {
            for (column, &value) in line[first..first + width].iter().enumerate() {
                out[column * rows + row] = value;
            }
        }
    });
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use std::f64::consts::TAU;

    fn field(points: [usize; 3]) -> Vec<f64> {
        let mut random = Streams::new(5).at(0, Phase::Collisions).stream(0);
        (0..points.iter().product()).map(|_| random.gaussian()).collect()
    }

    /// Σ_x f(x) exp(−2πi Σ_a n_a x_a/points_a), term by term.
    fn sum(field: &[f64], points: [usize; 3], n: [usize; 3]) -> Complex<f64> {
        let [nx, ny, _] = points;
        let place = |k: usize| [k % nx, k / nx % ny, k / nx / ny];
        let turns = |k: usize| -> f64 {
            (0..3).map(|axis| (n[axis] * place(k)[axis]) as f64 / points[axis] as f64).sum()
        };
        field.iter().enumerate().map(|(k, f)| f * Complex::cis(-TAU * turns(k))).sum()
    }

    #[test]
    fn amplitudes_agree_with_their_sums_and_lead_back() {
        for points in [[6, 5, 1], [5, 4, 1], [1, 6, 1], [4, 3, 2], [3, 5, 4], [1, 4, 6], [40, 18, 1]] {
            let (field, transform) = (field(points), Transform::new(points));
            let amplitudes = transform.forward(&field);
            let mut seen = vec![false; amplitudes.len()];
            for n in (0..points[0] / 2 + 1)
                .flat_map(|x| (0..points[1]).flat_map(move |y| (0..points[2]).map(move |z| [x, y, z])))
            {
                let place = transform.place(n);
                assert!(!std::mem::replace(&mut seen[place], true));
                let difference = (amplitudes[place] - sum(&field, points, n)).norm();
                assert!(difference < 1e-11, "{points:?} {n:?}: {difference}");
            }
            assert!(seen.into_iter().all(|seen| seen));
            for (found, expected) in transform.backward(amplitudes).into_iter().zip(field) {
                assert!((found - expected).abs() < 1e-13, "{points:?}");
            }
        }
    }

    #[test]
    fn what_is_not_kept_changes_nothing_else() {
        for points in [[64, 20, 1], [8, 6, 5]] {
            let field = field(points);
            let (all, some) = (Transform::new(points), Transform::up_to(points, 2));
            let (whole, part) = (all.forward(&field), some.forward(&field));
            assert_eq!(part.len(), 3 * points[1] * points[2]);
            for n in [[0, 0, 0], [2, 3, 0], [1, 5, points[2] - 1]] {
                assert_eq!(whole[all.place(n)], part[some.place(n)]);
            }
        }
    }
}
