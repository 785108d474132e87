//! Series of which everything is known, for tests: their true mean is zero and their variance one.

use crate::random::{Phase, Stream, Streams};

/// How values follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Independent Gaussian values.
    White,
    /// Gaussian values with correlation exp(−k/τ) k values apart.
    Remembering(f64),
    /// The same and white noise, each with half of the variance.
    Noisy(f64),
    /// So many periods in the whole series, of any phase, and white noise with a tenth of the variance.
    Oscillating(f64),
}

/// A source of series of one kind.
pub(super) struct Series {
    kind: Kind,
    random: Stream,
}

impl Series {
    /// The series of that kind with number `seed`.
    pub(super) fn new(seed: u64, kind: Kind) -> Self {
        Series { kind, random: Streams::new(seed).at(0, Phase::Collisions).stream(0) }
    }

    /// A random number in [0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        self.random.uniform()
    }

    /// So many consecutive values.
    pub(super) fn take(&mut self, count: usize) -> Vec<f64> {
        match self.kind {
            Kind::White => (0..count).map(|_| self.random.gaussian()).collect(),
            Kind::Remembering(time) => self.remembering(time, count),
            Kind::Noisy(time) => {
                let slow = self.remembering(time, count);
                slow.into_iter().map(|x| (x + self.random.gaussian()) * 0.5_f64.sqrt()).collect()
            }
            Kind::Oscillating(periods) => {
                let start = self.uniform();
                let place =
                    |k: usize| std::f64::consts::TAU * ((k as f64 + 0.5) / count as f64 * periods + start);
                let wave = |k: usize| libm::sin(place(k)) * 1.8_f64.sqrt();
                (0..count).map(|k| wave(k) + 0.1_f64.sqrt() * self.random.gaussian()).collect()
            }
        }
    }

    fn remembering(&mut self, time: f64, count: usize) -> Vec<f64> {
        let kept = libm::exp(-1.0 / time);
        let new = (1.0 - kept * kept).sqrt();
        let mut value = self.random.gaussian();
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            values.push(value);
            value = kept * value + new * self.random.gaussian();
        }
        values
    }
}
