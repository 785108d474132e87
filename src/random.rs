//! Random numbers as a pure function of (seed, step, phase, place): nothing to carry around.
//!
//! A generator is made where it is needed, used and dropped. Results therefore do not
//! depend on the number of threads, on what was recorded, or on where a run was interrupted.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// What a stream is used for; streams of different phases are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Candidate pairs, acceptance and impact parameters of one cell.
    Collisions = 1,
    /// Impact parameters and heat of cell–cell collisions.
    CellCollisions = 2,
    /// Ranking of arrivals at a full cell; who gets into a cell by chance.
    Admission = 3,
    /// Order of the colours of the displacement pass.
    Colours = 4,
    /// Reversals at a statistically rough wall.
    Wall = 5,
    /// Places of poured grains.
    Source = 6,
    /// Positions of an initial state.
    InitialPositions = 7,
    /// Velocities of an initial state.
    InitialVelocities = 8,
    /// The seed of the equilibration that precedes a run.
    Equilibration = 9,
    /// Turns of relative velocities that prevent inelastic collapse.
    Rotation = 10,
    /// Seeds of independent repetitions of a run.
    Replica = 11,
    /// Places in the course of a run at which measures sample.
    Samples = 12,
}

/// All streams of one seed.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    seed: u64,
}

/// The streams of one seed, step and phase; one for every place.
#[derive(Clone, Copy, Debug)]
pub struct PhaseStreams {
    key: u64,
}

/// One stream of random numbers: xoshiro256++ (Blackman and Vigna 2021).
#[derive(Clone, Debug)]
pub struct Stream(Xoshiro256PlusPlus);

impl Streams {
    /// The streams of `seed`.
    pub fn new(seed: u64) -> Self {
        Streams { seed }
    }

    /// The streams of `phase` in step number `step`.
    pub fn at(self, step: u64, phase: Phase) -> PhaseStreams {
        let key = mix(self.seed ^ mix(step.wrapping_add(GOLDEN)));
        PhaseStreams { key: mix(key ^ (phase as u64).wrapping_mul(GOLDEN)) }
    }

    /// The seed of repetition number `replica`, below 2⁶³ as seeds of scenarios are.
    pub fn replica_seed(self, replica: u32) -> u64 {
        self.at(u64::MAX, Phase::Replica).hash(u64::from(replica)) >> 1
    }

    /// A seed for a dependent computation, independent of all streams of this one.
    pub fn derived_seed(self, phase: Phase) -> u64 {
        self.at(u64::MAX, phase).hash(0)
    }
}

impl PhaseStreams {
    /// The stream of `place`: a cell, a grain's id, a serial number.
    #[inline]
    pub fn stream(self, place: u64) -> Stream {
        Stream(Xoshiro256PlusPlus::seed_from_u64(self.hash(place)))
    }

    /// One well-mixed number for `place`, for rankings.
    #[inline]
    pub fn hash(self, place: u64) -> u64 {
        mix(self.key ^ place.wrapping_mul(GOLDEN))
    }
}

impl Stream {
    /// 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1): 53 random bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        unit_interval(self.bits())
    }

    /// Uniform in [−1, 1).
    #[inline]
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.uniform() - 1.0
    }

    /// Uniform integer in 0 … `n` − 1, for `n` ≤ 2³²; the bias is below n/2⁶⁴.
    #[inline]
    pub fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(n)) >> 64) as u64
    }

    /// An ordered pair of different indices below `n` ≥ 2 and a number uniform in [0, 1), all from one draw:
    /// what one choice leaves of the 64 bits, as a fraction, serves the next. Each bias is below n²/2⁶⁴.
    #[inline(always)]
    pub fn pair_and_uniform(&mut self, n: u32) -> ((usize, usize), f64) {
        let (first, rest) = split(self.bits(), n);
        let (second, rest) = split(rest, n - 1);
        ((first, second + usize::from(second >= first)), unit_interval(rest))
    }

    /// The nearest integers on either side of `x` ≥ 0, drawn so that the mean is `x`.
    #[inline]
    pub fn round(&mut self, x: f64) -> u64 {
        (x + self.uniform()) as u64
    }

    /// A point uniform in the unit disc and its squared distance from the centre.
    #[inline]
    pub fn in_disc(&mut self) -> (f64, f64, f64) {
        loop {
            let p = self.symmetric();
            let q = self.symmetric();
            let square = p * p + q * q;
            if square < 1.0 {
                return (p, q, square);
            }
        }
    }

    /// A Gaussian number of mean 0 and variance 1 (polar Box–Muller, Marsaglia and Bray 1964).
    ///
    /// The logarithm is `libm`'s, so that every machine draws the same number.
    pub fn gaussian(&mut self) -> f64 {
        loop {
            let (p, _, square) = self.in_disc();
            if square > 0.0 {
                return p * (-2.0 * libm::log(square) / square).sqrt();
            }
        }
    }
}

/// Uniform in [0, 1) from the upper 53 of uniform `bits`.
#[inline(always)]
fn unit_interval(bits: u64) -> f64 {
    // The detour over i64 spares the case of the highest bit, which is never set.
    (bits >> 11) as i64 as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// A uniform index below `n` from the fraction `bits`/2⁶⁴, and what remains of the fraction.
#[inline(always)]
fn split(bits: u64, n: u32) -> (usize, u64) {
    let product = u128::from(bits) * u128::from(n);
    ((product >> 64) as usize, product as u64)
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014), variant 13 of Stafford.
#[inline]
fn mix(z: u64) -> u64 {
    let z = z.wrapping_add(GOLDEN);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_is_a_function_of_its_four_names() {
        let draw = |seed, step, phase, cell| Streams::new(seed).at(step, phase).stream(cell).bits();
        let base = draw(1, 2, Phase::Collisions, 3);
        assert_eq!(base, draw(1, 2, Phase::Collisions, 3));
        assert_ne!(base, draw(2, 2, Phase::Collisions, 3));
        assert_ne!(base, draw(1, 3, Phase::Collisions, 3));
        assert_ne!(base, draw(1, 2, Phase::Wall, 3));
        assert_ne!(base, draw(1, 2, Phase::Collisions, 4));
    }

    #[test]
    fn replicas_have_seeds_of_their_own() {
        let seeds = |seed| (1..=1000).map(move |k| Streams::new(seed).replica_seed(k));
        let mut all: Vec<u64> = seeds(1).chain(seeds(2)).collect();
        assert!(all.iter().all(|&seed| i64::try_from(seed).is_ok()));
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 2000);
    }

    #[test]
    fn neighbouring_streams_are_uncorrelated() {
        let streams = Streams::new(5).at(9, Phase::Collisions);
        let n = 100_000;
        let correlation: f64 =
            (0..n).map(|c| streams.stream(c).symmetric() * streams.stream(c + 1).symmetric()).sum::<f64>()
                / n as f64;
        // The standard error of a product of two uniforms on [−1, 1] is 1/(3√n).
        assert!(correlation.abs() < 4.0 / (3.0 * (n as f64).sqrt()), "{correlation}");
    }

    #[test]
    fn gaussian_moments() {
        let mut random = Streams::new(3).at(0, Phase::InitialVelocities).stream(0);
        let n = 400_000;
        let (mut second, mut fourth) = (0.0, 0.0);
        for _ in 0..n {
            let x = random.gaussian();
            second += x * x;
            fourth += x * x * x * x;
        }
        let n = f64::from(n);
        assert!((second / n - 1.0).abs() < 4.0 * (2.0 / n).sqrt());
        assert!((fourth / n - 3.0).abs() < 4.0 * (96.0 / n).sqrt());
    }

    #[test]
    fn pairs_are_different_and_uniform() {
        let mut random = Streams::new(1).at(0, Phase::Collisions).stream(0);
        let mut counts = [[0_u32; 3]; 3];
        for _ in 0..60_000 {
            let ((i, j), _) = random.pair_and_uniform(3);
            counts[i][j] += 1;
        }
        for (i, row) in counts.iter().enumerate() {
            for (j, &count) in row.iter().enumerate() {
                // Each of six pairs: 10000 ± 91.
                assert!(if i == j { count == 0 } else { count.abs_diff(10_000) < 370 });
            }
        }
    }

    #[test]
    fn rounding_keeps_the_mean() {
        let mut random = Streams::new(1).at(0, Phase::Collisions).stream(1);
        let n = 100_000;
        let sum: u64 = (0..n).map(|_| random.round(2.3)).sum();
        assert!((sum as f64 / n as f64 - 2.3).abs() < 4.0 * (0.21 / n as f64).sqrt());
    }
}
