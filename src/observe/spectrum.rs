//! `spectrum`: the power spectrum of the density fluctuations in a pipe (Müller 2001, section 3.4.1).

use rayon::prelude::*;
use realfft::RealFftPlanner;

use super::layout;
use super::measure::{Cadence, Figure, Measure, Profile, Snapshot};
use super::packing::{pack, unpack};
use super::samples::figure;
use super::setting::Setting;
use super::slices;
use super::units::{PURE, RATE, column};
use crate::space::Vector;
use crate::statistics::{Estimate, straight_line};

/// Time between samples, in units of √(d/g).
const INTERVAL: f64 = 0.05;
/// Frequencies between which the slope is taken, in units of √(g/d).
const RANGE: (f64, f64) = (0.3, 5.0);
/// Bins of equal width in log f in that range.
const BINS: usize = 12;
/// Segments that a series is cut into.
const SEGMENTS: usize = 2;

/// P(f) of the volume fraction in each slice of one cell's height, averaged over slices.
///
/// Of each slice's series the first quarter is dropped and the rest cut into two segments; of each the mean
/// is removed, and P(f_k) = (|C_k|² + |C_{N−k}|²)/N², 0 < k < N/2 (Müller 2001, 3.11 and 3.12). Samples are
/// taken at step ends and treated as equally spaced. `record.from` does not matter here.
#[derive(Clone, Debug)]
pub struct Spectrum {
    axis: usize,
    slices: usize,
    /// √(d/g) [time].
    time_unit: f64,
    /// Volume fraction per grain in a slice.
    share: f64,
    times: Vec<f64>,
    /// `[sample][slice]`, flat.
    counts: Vec<u32>,
}

impl Spectrum {
    /// The measure for `setting`, if grains fall for ever along a periodic axis of several cells.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let axis = layout::pipe_axis(setting).filter(|&axis| setting.grid.cells()[axis] > 1)?;
        let slices = setting.grid.cells()[axis] as usize;
        Some(Spectrum {
            axis,
            slices,
            time_unit: (setting.grain.diameter / setting.gravity.length()).sqrt(),
            share: setting.grain.volume::<V>() * slices as f64 / setting.grid.size().product(),
            times: Vec::new(),
            counts: Vec::new(),
        })
    }

    /// Frequencies [1/time] and power, averaged over slices and segments; `None` of too short a run.
    fn power(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let first = self.times.len() / 4;
        let length = (self.times.len() - first) / SEGMENTS;
        if length < 3 {
            return None;
        }
        let duration = self.times[self.times.len() - 1] - self.times[0];
        let interval = duration / (self.times.len() - 1) as f64;
        let segments = SEGMENTS * self.slices;
        let spectra: Vec<Vec<f64>> = (0..segments)
            .into_par_iter()
            .map(|k| self.periodogram(k / SEGMENTS, first + k % SEGMENTS * length, length))
            .collect();
        let frequencies = (1..=spectra[0].len()).map(|k| k as f64 / (length as f64 * interval)).collect();
        let mean = |k: usize| spectra.iter().map(|spectrum| spectrum[k]).sum::<f64>() / segments as f64;
        Some((frequencies, (0..spectra[0].len()).map(mean).collect()))
    }

    /// P(f_k) of one slice and segment, for 0 < k < N/2.
    fn periodogram(&self, slice: usize, first: usize, length: usize) -> Vec<f64> {
        let samples = self.counts.chunks_exact(self.slices).skip(first).take(length);
        let mut series: Vec<f64> = samples.map(|row| f64::from(row[slice]) * self.share).collect();
        let mean = series.iter().sum::<f64>() / length as f64;
        series.iter_mut().for_each(|x| *x -= mean);
        let transform = RealFftPlanner::new().plan_fft_forward(length);
        let mut amplitudes = transform.make_output_vec();
        transform.process(&mut series, &mut amplitudes).expect("both buffers were made for this length");
        // Of a real series |C_k| = |C_{N−k}|; the sign in the exponent does not matter to it.
        let norm = 2.0 / (length as f64 * length as f64);
        amplitudes[1..length.div_ceil(2)].iter().map(|c| c.norm_sqr() * norm).collect()
    }

    /// Slope of log P on log f through the means of both in each bin; `None` when a bin is empty: the run
    /// was too short for the lowest frequencies, or its steps too long for the highest.
    fn slope(&self, frequencies: &[f64], power: &[f64]) -> Option<Estimate> {
        let (low, high) = (RANGE.0.ln(), RANGE.1.ln());
        let mut bins = [(0.0, 0.0, 0.0); BINS];
        for (f, p) in frequencies.iter().zip(power).filter(|(_, p)| **p > 0.0) {
            let log = (f * self.time_unit).ln();
            let place = (log - low) / (high - low) * BINS as f64;
            if (0.0..BINS as f64).contains(&place) {
                let (count, x, y) = &mut bins[place as usize];
                *count += 1.0;
                *x += log;
                *y += p.ln();
            }
        }
        if bins.iter().any(|bin| bin.0 == 0.0) {
            return None;
        }
        let (x, y): (Vec<f64>, Vec<f64>) = bins.iter().map(|(count, x, y)| (x / count, y / count)).unzip();
        straight_line(&x, &y).map(|line| Estimate { value: line.slope, standard_error: line.slope_error })
    }
}

impl<V: Vector> Measure<V> for Spectrum {
    fn name(&self) -> &'static str {
        "spectrum"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Every(INTERVAL * self.time_unit)
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let time = snapshot.gas.time();
        if self.times.last().is_none_or(|&last| last < time) {
            self.times.push(time);
            self.counts.extend(slices::counts(snapshot.gas, self.axis));
        }
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, _from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let Some((frequencies, power)) = self.power() else {
            return (Vec::new(), vec![figure("spectrum_slope", None::<Estimate>)]);
        };
        let slope = self.slope(&frequencies, &power);
        let profile = Profile {
            name: "spectrum".to_owned(),
            time: snapshot.gas.time(),
            columns: vec![column("frequency", RATE), column("power", PURE)],
            values: vec![frequencies, power],
        };
        (vec![profile], vec![figure("spectrum_slope", slope)])
    }

    fn memory(&self) -> Vec<f64> {
        let mut memory = vec![self.times.len() as f64];
        memory.extend(&self.times);
        memory.extend(pack(&self.counts));
        memory
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        let Some((&samples, rest)) = memory.split_first() else { return false };
        let Some((times, packed)) = rest.split_at_checked(samples as usize) else { return false };
        let counts = unpack(packed);
        let is_one = pack(&counts) == packed
            && counts.len() == times.len() * self.slices
            && times.is_sorted_by(|first, next| first < next);
        if is_one {
            (self.times, self.counts) = (times.to_vec(), counts);
        }
        is_one
    }
}

#[cfg(test)]
#[path = "spectrum_tests.rs"]
mod tests;
