//! `impact-parameter`: how far from head-on collisions are (Müller 2001, equation 3.18).

use super::measure::{Cadence, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure};
use super::setting::Setting;
use super::units::{PURE, column};
use crate::engine::report::IMPACT_BINS;
use crate::space::Vector;
use crate::statistics::Estimate;

/// Width of a bin of |b|/d.
const WIDTH: f64 = 1.0 / IMPACT_BINS as f64;
/// Between these the parameter c is looked for; it must stay below 1.
const RANGE: (f64, f64) = (-20.0, 1.0 - 1e-9);
/// Steps of the golden section: enough to shorten the range to the rounding of the likelihood.
const STEPS: usize = 60;

/// The density of |b|/d in [0, 1] over the collisions of pairs. Under molecular chaos it is 1 for disks and
/// 2|b|/d for spheres; a dense gas of inelastic grains prefers glancing collisions, p ∝ 1/(1 − c b²) for disks
/// and b/(1 − c b²) for spheres. The parameter c is that of maximum likelihood over the bins.
#[derive(Clone, Debug)]
pub struct ImpactParameter {
    /// ∫ p from 0 to b without its norm, of c and b.
    integral: fn(f64, f64) -> f64,
    /// `[sample][collisions in each bin since the start]`.
    samples: Samples,
}

impl ImpactParameter {
    /// The measure for `setting`, if its collisions are known one by one.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let samples = Samples::new(IMPACT_BINS);
        setting.counts_impacts.then_some(ImpactParameter { integral: V::impact_integral, samples })
    }
}

/// The most likely c of `counts` `[bin]` of |b|/d over [0, 1], and its error from the curvature of the likelihood;
/// `None` without collisions or where c would leave its range.
pub fn most_likely_c<V: Vector>(counts: &[f64]) -> Option<Estimate> {
    fit(V::impact_integral, counts)
}

/// Logarithm of the probability of `counts` `[bin]`.
fn log_likelihood(integral: fn(f64, f64) -> f64, counts: &[f64], c: f64) -> f64 {
    let whole = integral(c, 1.0);
    let term = |(bin, count): (usize, &f64)| {
        let inside = integral(c, (bin + 1) as f64 * WIDTH) - integral(c, bin as f64 * WIDTH);
        count * libm::log(inside / whole)
    };
    counts.iter().enumerate().filter(|(_, count)| **count > 0.0).map(term).sum()
}

fn fit(integral: fn(f64, f64) -> f64, counts: &[f64]) -> Option<Estimate> {
    let likelihood = |c: f64| log_likelihood(integral, counts, c);
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = RANGE;
    for _ in 0..STEPS {
        let reach = ratio * (high - low);
        let (left, right) = (high - reach, low + reach);
        (low, high) = if likelihood(left) > likelihood(right) { (low, right) } else { (left, high) };
    }
    let c = 0.5 * (low + high);
    let margin = 1e-3 * (1.0 - c).min(1.0);
    let is_inside = c - margin > RANGE.0 && c + margin < RANGE.1;
    if !is_inside || counts.iter().sum::<f64>() < 1.0 {
        return None;
    }
    let bend = likelihood(c - margin) - 2.0 * likelihood(c) + likelihood(c + margin);
    let curvature = -bend / (margin * margin);
    Some(Estimate { value: c, standard_error: (curvature > 0.0).then(|| 1.0 / curvature.sqrt()) })
}

fn row<V: Vector>(snapshot: &Snapshot<'_, V>) -> [f64; IMPACT_BINS] {
    snapshot.totals.events.impacts.map(|count| count as f64)
}

impl<V: Vector> Measure<V> for ImpactParameter {
    fn name(&self) -> &'static str {
        "impact-parameter"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.samples.push(snapshot.gas.time(), &row(snapshot));
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &row(snapshot));
        let rows = samples.since(from);
        let counts: Vec<f64> = match (rows.first(), rows.last()) {
            (Some(first), Some(last)) => last[1..].iter().zip(&first[1..]).map(|(b, a)| b - a).collect(),
            _ => Vec::new(),
        };
        let collisions: f64 = counts.iter().sum();
        if collisions == 0.0 {
            return (Vec::new(), vec![figure("impact_c", None::<Estimate>)]);
        }
        let norm = 1.0 / (collisions * WIDTH);
        let columns = ["impact_parameter", "probability_density", "standard_error"];
        let profile = Profile {
            name: "impact-parameter".to_owned(),
            time: snapshot.gas.time(),
            columns: columns.into_iter().map(|name| column(name, PURE)).collect(),
            values: vec![
                (0..IMPACT_BINS).map(|bin| (bin as f64 + 0.5) * WIDTH).collect(),
                counts.iter().map(|count| count * norm).collect(),
                counts.iter().map(|count| count.sqrt() * norm).collect(),
            ],
        };
        (vec![profile], vec![figure("impact_c", fit(self.integral, &counts))])
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::observe::testing::{Bed, State, assert_resumes, figure_of, setting_of};
    use crate::random::{Phase, Streams};
    use glam::{DVec2, DVec3};

    const COLLISIONS: usize = 100_000;

    fn counting<V: Vector>() -> Bed<V> {
        let mut bed = setting_of(V::from_fn(|_| 4.0), [2, 2, 2]);
        bed.setting.counts_impacts = true;
        bed
    }

    /// Collisions of p ∝ bᴰ⁻²/(1 − c b²) from time 1 on; all of them head-on before.
    fn collided<V: Vector>(bed: &Bed<V>, c: f64) -> Vec<State<V>> {
        let mut random = Streams::new(5).at(0, Phase::Collisions).stream(0);
        let mut totals = Totals::default();
        let mut states = vec![(bed.gas(0.0, vec![], vec![]), totals.clone())];
        totals.events.impacts[0] = 5000;
        states.push((bed.gas(1.0, vec![], vec![]), totals.clone()));
        let largest = 1.0 / (1.0 - c.max(0.0));
        let mut count = 0;
        while count < COLLISIONS {
            let b = random.uniform().powf(1.0 / (V::DIMENSION - 1) as f64);
            if random.uniform() * largest < 1.0 / (1.0 - c * b * b) {
                totals.events.impacts[((b / WIDTH) as usize).min(IMPACT_BINS - 1)] += 1;
                count += 1;
            }
        }
        states.push((bed.gas(2.0, vec![], vec![]), totals));
        states
    }

    fn finds<V: Vector>(c: f64) {
        let bed = counting::<V>();
        let mut measure = ImpactParameter::new(&bed.setting).unwrap();
        let (value, error) = figure_of(&mut measure, &collided(&bed, c), 1.0, "impact_c");
        let (value, error) = (value.unwrap(), error.unwrap());
        assert!((value - c).abs() < 4.0 * error, "{c}: {value} ± {error}");
        // 1/σ² = N Var ∂ₑ ln p, and at c = 0 the variance of b² is 4/45 for disks and 1/12 for spheres.
        if c == 0.0 {
            let variance: f64 = [4.0 / 45.0, 1.0 / 12.0][V::DIMENSION - 2];
            let expected = 1.0 / (variance * COLLISIONS as f64).sqrt();
            assert!((error / expected - 1.0).abs() < 0.05, "{error} beside {expected}");
        }
    }

    #[test]
    fn the_parameter_of_a_known_distribution_is_found() {
        for c in [-0.5, 0.0, 0.3, 0.9] {
            finds::<DVec2>(c);
            finds::<DVec3>(c);
        }
    }

    #[test]
    fn molecular_chaos_is_flat_for_disks_and_linear_for_spheres() {
        fn density<V: Vector>() -> Vec<Vec<f64>> {
            let bed = counting::<V>();
            let mut measure = ImpactParameter::new(&bed.setting).unwrap();
            let states = collided(&bed, 0.0);
            figure_of(&mut measure, &states, 1.0, "impact_c");
            let (gas, totals) = &states[2];
            measure.conclusion(&Snapshot::new(gas, totals), 1.0).0.remove(0).values
        }
        let (flat, deep) = (density::<DVec2>(), density::<DVec3>());
        for bin in 0..IMPACT_BINS {
            assert!((flat[1][bin] - 1.0).abs() < 4.5 * flat[2][bin]);
            assert!((deep[1][bin] - 2.0 * deep[0][bin]).abs() < 4.5 * deep[2][bin]);
        }
    }

    #[test]
    fn both_forms_of_the_integral_meet() {
        for integral in [DVec2::impact_integral, DVec3::impact_integral] {
            for c in [1e-7, -1e-7] {
                assert!((integral(0.999 * c, 0.7) - integral(1.001 * c, 0.7)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn it_needs_single_collisions() {
        let mut bed = counting::<DVec2>();
        let state = (bed.gas(0.0, vec![], vec![]), Totals::default());
        let mut measure = ImpactParameter::new(&bed.setting).unwrap();
        assert_eq!(figure_of(&mut measure, &[state], 0.0, "impact_c"), (None, None));
        bed.setting.counts_impacts = false;
        assert!(ImpactParameter::new(&bed.setting).is_none());
    }

    #[test]
    fn it_resumes() {
        let bed = counting::<DVec2>();
        let make = || Box::new(ImpactParameter::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 20));
    }
}
