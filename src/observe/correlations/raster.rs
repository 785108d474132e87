//! Cyclic correlations of real fields on a raster, by Fourier transforms along one axis after another.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// A raster of two or three axes, the first one running fastest.
pub(super) struct Raster {
    cells: Vec<usize>,
}

impl Raster {
    /// The raster of so many `cells` along each axis.
    pub(super) fn new(cells: &[u32]) -> Self {
        Raster { cells: cells.iter().map(|&number| number as usize).collect() }
    }

    /// Σ_x f(x) exp(−ik·x) of a real field.
    pub(super) fn forward(&self, field: &[f64]) -> Vec<Complex<f64>> {
        self.transformed(field.iter().map(|&value| Complex::new(value, 0.0)).collect())
    }

    /// Σ_x ½ (f(x) g(x + r) + g(x) f(x + r)) for every raster vector r, from the transforms of f and g.
    pub(super) fn correlation(&self, f: &[Complex<f64>], g: &[Complex<f64>]) -> Vec<f64> {
        let spectrum = f.iter().zip(g).map(|(f, g)| Complex::new((f * g.conj()).re, 0.0)).collect();
        // Real and even: forwards and backwards are the same.
        let number = f.len() as f64;
        self.transformed(spectrum).into_iter().map(|value| value.re / number).collect()
    }

    fn transformed(&self, mut values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        let mut stride = 1;
        for &length in &self.cells {
            along(&mut values, stride, length);
            stride *= length;
        }
        values
    }
}

/// Transforms every line of `length` values that lie `stride` apart.
fn along(values: &mut [Complex<f64>], stride: usize, length: usize) {
    let plan = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let (mut line, mut parts) = (plan.make_input_vec(), [plan.make_output_vec(), plan.make_output_vec()]);
    for block in values.chunks_exact_mut(stride * length) {
        for first in 0..stride {
            for (is_imaginary, part) in [false, true].into_iter().zip(&mut parts) {
                for (x, value) in line.iter_mut().zip(block[first..].iter().step_by(stride)) {
                    *x = if is_imaginary { value.im } else { value.re };
                }
                plan.process(&mut line, part).expect("both buffers were made for this length");
            }
            let [re, im] = &parts;
            for (k, value) in block[first..].iter_mut().step_by(stride).enumerate() {
                // The upper half of a real line's transform is the conjugate of the lower one.
                let (re, im) = if k < re.len() {
                    (re[k], im[k])
                } else {
                    (re[length - k].conj(), im[length - k].conj())
                };
                *value = Complex::new(re.re - im.im, re.im + im.re);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};

    #[test]
    fn correlations_agree_with_the_sums() {
        let mut random = Streams::new(5).at(0, Phase::Collisions).stream(0);
        for cells in [[5, 4, 1], [4, 3, 2], [1, 6, 5]] {
            let [nx, ny, nz] = cells.map(|n: u32| n as usize);
            let mut field = || (0..nx * ny * nz).map(|_| random.gaussian()).collect::<Vec<f64>>();
            let (f, g) = (field(), field());
            let raster = Raster::new(&cells);
            let found = raster.correlation(&raster.forward(&f), &raster.forward(&g));
            let place = |x: usize, y: usize, z: usize| x % nx + nx * (y % ny + ny * (z % nz));
            for (r, found) in found.into_iter().enumerate() {
                let (rx, ry, rz) = (r % nx, r / nx % ny, r / nx / ny);
                let expected: f64 = (0..f.len())
                    .map(|a| {
                        let b = place(a % nx + rx, a / nx % ny + ry, a / nx / ny + rz);
                        0.5 * (f[a] * g[b] + g[a] * f[b])
                    })
                    .sum();
                assert!((found - expected).abs() < 1e-12, "{r}: {found} {expected}");
            }
        }
    }
}
