//! How far from head-on pairs collide: p(b) ∝ bᴰ⁻²/(1 − c b²), b in diameters (Müller 2001, 3.18).
//!
//! c = 0 is molecular chaos: b uniform on [−1, 1] for disks, uniform in the disc for spheres. Grains that have
//! learnt of each other through many inelastic collisions prefer glancing ones: c > 0. c < 0 means more head-on
//! collisions than chaos has.

use super::piecewise::PiecewiseLinear;
use crate::random::Stream;
use crate::space::Vector;

/// Below this |c| mean values are taken from their neighbours: 1/c loses digits.
const SMALL: f64 = 1e-4;

/// c as a function of collisions per particle since the start of the run (Müller 2001, figure 3.36).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactLaw(Option<PiecewiseLinear>);

impl ImpactLaw {
    /// Molecular chaos at all times.
    pub const UNIFORM: Self = ImpactLaw(None);

    /// c of collisions per particle; every value below 1.
    pub fn of(c: PiecewiseLinear) -> Self {
        assert!(c.points().all(|[_, c]| c < 1.0), "1 − c b² must not vanish");
        ImpactLaw(Some(c))
    }

    /// Impact parameters after so many `collisions_per_particle`.
    pub fn at(&self, collisions_per_particle: f64) -> Impacts {
        self.0.as_ref().map_or(Impacts::UNIFORM, |table| Impacts { c: table.at(collisions_per_particle) })
    }

    /// The table behind it; `None` for molecular chaos.
    pub fn table(&self) -> Option<&PiecewiseLinear> {
        self.0.as_ref()
    }
}

/// Impact parameters at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impacts {
    c: f64,
}

impl Impacts {
    /// Molecular chaos.
    pub const UNIFORM: Self = Impacts { c: 0.0 };

    /// Those of this c < 1.
    pub fn new(c: f64) -> Self {
        assert!(c < 1.0, "1 − c b² must not vanish");
        Impacts { c }
    }

    /// c of p(b).
    pub fn c(self) -> f64 {
        self.c
    }

    /// −(g·n)n of two equal elastic grains of relative velocity g = `relative`, as [`Vector::exchange`]; with the
    /// very numbers of that where c = 0.
    #[inline(always)]
    pub fn exchange<V: Vector>(self, relative: V, random: &mut Stream) -> V {
        if self.c == 0.0 { V::exchange(relative, random) } else { self.glance(relative, random) }
    }

    #[cold]
    #[inline(never)]
    fn glance<V: Vector>(self, relative: V, random: &mut Stream) -> V {
        let b = V::impact_quantile(self.c, random.symmetric());
        V::exchange_at(relative, b, random)
    }

    /// ⟨b²⟩ = (1 − I(0)/I(c))/c with I(c) = ∫ bᴰ⁻²/(1 − c b²) from 0 to 1: 1/3 for disks, 1/2 for spheres at c = 0.
    pub fn mean_square<V: Vector>(self) -> f64 {
        let mean = |c: f64| (1.0 - V::impact_integral(0.0, 1.0) / V::impact_integral(c, 1.0)) / c;
        if self.c.abs() >= SMALL {
            return mean(self.c);
        }
        let (low, high) = (mean(-SMALL), mean(SMALL));
        low + (high - low) * 0.5 * (1.0 + self.c / SMALL)
    }

    /// By how much less energy a collision takes than under molecular chaos: ⟨1 − b²⟩ over its value at c = 0,
    /// since it takes (1 − r²) m g² (1 − b²)/4 of relative speed g.
    pub fn cooling_factor<V: Vector>(self) -> f64 {
        (1.0 - self.mean_square::<V>()) / (1.0 - Impacts::UNIFORM.mean_square::<V>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    const BINS: usize = 40;
    const DRAWS: usize = 200_000;

    /// |b| and the velocity exchanged, for a relative velocity of length 1.
    fn draws<V: Vector>(c: f64) -> impl Iterator<Item = (f64, V)> {
        let mut random = Streams::new(17).at(3, Phase::Collisions).stream(5);
        let direction = V::from_fn(|axis| [0.6, -0.48, 0.64][axis]);
        let direction = direction * (1.0 / direction.length());
        (0..DRAWS).map(move |_| {
            let exchange = Impacts::new(c).exchange(direction, &mut random);
            let cosine_squared = exchange.length_squared();
            // −(g·n)n of |g| = 1: its part along −g is its squared length.
            assert!((cosine_squared + exchange.dot(direction)).abs() < 1e-12);
            ((1.0 - cosine_squared).max(0.0).sqrt(), exchange)
        })
    }

    /// χ² of drawn |b| against the density of `expected` c; one degree less than there are bins.
    fn chi_squared<V: Vector>(drawn: f64, expected: f64) -> f64 {
        let mut counts = [0.0_f64; BINS];
        for (b, _) in draws::<V>(drawn) {
            counts[((b * BINS as f64) as usize).min(BINS - 1)] += 1.0;
        }
        let whole = V::impact_integral(expected, 1.0);
        let below = |bin: usize| V::impact_integral(expected, bin as f64 / BINS as f64) / whole;
        (0..BINS)
            .map(|bin| {
                let mean = DRAWS as f64 * (below(bin + 1) - below(bin));
                (counts[bin] - mean) * (counts[bin] - mean) / mean
            })
            .sum()
    }

    fn follows_the_density<V: Vector>() {
        // 39 degrees of freedom: mean 39, standard deviation √78 = 8.8.
        let limit = 39.0 + 4.0 * 78.0_f64.sqrt();
        for c in [-3.0, -0.4, 1e-9, 1e-5, 0.3, 0.95] {
            let chi = chi_squared::<V>(c, c);
            assert!(chi < limit, "c = {c}: χ² = {chi}");
            // A law that is off by 0.1 is found out.
            assert!(chi_squared::<V>(c - 0.1 * (1.0 + c.abs()), c) > limit, "c = {c} has no power");
        }
    }

    #[test]
    fn impact_parameters_of_disks_follow_the_density() {
        follows_the_density::<DVec2>();
    }

    #[test]
    fn impact_parameters_of_spheres_follow_the_density() {
        follows_the_density::<DVec3>();
    }

    fn has_the_mean_square<V: Vector>() {
        for c in [-2.0, -1e-5, 0.0, 3e-5, 0.5, 0.9] {
            let (mut first, mut second) = (0.0, 0.0);
            for (b, _) in draws::<V>(c) {
                first += b * b;
                second += b * b * b * b;
            }
            let (mean, square) = (first / DRAWS as f64, second / DRAWS as f64);
            let error = ((square - mean * mean) / DRAWS as f64).sqrt();
            let expected = Impacts::new(c).mean_square::<V>();
            assert!((mean - expected).abs() < 4.0 * error, "c = {c}: {mean} ± {error}, not {expected}");
        }
    }

    #[test]
    fn the_mean_square_is_that_of_the_density() {
        has_the_mean_square::<DVec2>();
        has_the_mean_square::<DVec3>();
        assert!((Impacts::UNIFORM.mean_square::<DVec2>() - 1.0 / 3.0).abs() < 1e-9);
        assert!((Impacts::UNIFORM.mean_square::<DVec3>() - 0.5).abs() < 1e-9);
        assert!(Impacts::new(0.5).cooling_factor::<DVec2>() < 1.0);
    }

    /// Both sides alike in two dimensions, all directions across alike in three: no mean across, and the same
    /// mean square along every axis across.
    #[test]
    fn no_side_is_preferred() {
        fn across<V: Vector>(axes: &[V]) {
            let mut sums = vec![[0.0; 3]; axes.len()];
            for (_, exchange) in draws::<V>(0.8) {
                for (sum, axis) in sums.iter_mut().zip(axes) {
                    let part = exchange.dot(*axis);
                    sum[0] += part;
                    sum[1] += part * part;
                    sum[2] += part * part * part * part;
                }
            }
            let draws = DRAWS as f64;
            let squares: Vec<f64> = sums.iter().map(|sum| sum[1] / draws).collect();
            for sum in &sums {
                assert!((sum[0] / draws).abs() < 4.0 * (sum[1] / draws / draws).sqrt());
                let error = (sum[2] / draws / draws).sqrt();
                assert!((sum[1] / draws - squares[0]).abs() < 6.0 * error);
            }
        }
        let flat = DVec2::new(0.48, 0.6) * (1.0 / f64::hypot(0.48, 0.6));
        across(&[flat]);
        let deep = DVec3::new(0.6, -0.48, 0.64);
        let (first, second) = deep.any_orthonormal_pair();
        across(&[first, second]);
    }

    #[test]
    fn without_a_table_the_numbers_are_those_of_chaos() {
        let streams = Streams::new(2).at(1, Phase::Collisions);
        let (mut mine, mut theirs) = (streams.stream(4), streams.stream(4));
        let relative = DVec3::new(0.3, 0.1, -2.0);
        let impacts = ImpactLaw::UNIFORM.at(12.0);
        assert_eq!(impacts.exchange(relative, &mut mine), DVec3::exchange(relative, &mut theirs));
        assert_eq!(mine.bits(), theirs.bits());
    }

    #[test]
    fn c_follows_the_table() {
        let law = ImpactLaw::of(PiecewiseLinear::through(vec![10.0, 30.0], vec![0.0, 0.6]));
        assert_eq!(law.at(0.0), Impacts::UNIFORM);
        assert!((law.at(20.0).c() - 0.3).abs() < 1e-15);
        assert_eq!(law.at(1e6).c(), 0.6);
    }
}
