//! `density-contrast`: how uneven the density along a pipe is.

use super::layout;
use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_mean};
use super::setting::Setting;
use super::slices;
use super::units::{PURE, column};
use crate::matter::gas::Gas;
use crate::space::Vector;
use crate::statistics::{mean, standard_deviation};

/// Standard deviation of the counts of slices one cell high, divided by their mean; also in units of
/// what independent grains would show, 1/√(mean count).
///
/// The variance has n − 1 in its denominator, so that independent grains give the variance of Poisson exactly
/// although their total is fixed.
#[derive(Clone, Debug)]
pub struct DensityContrast {
    axis: usize,
    samples: Samples,
}

impl DensityContrast {
    /// The measure for `setting`, if grains fall for ever along a periodic axis of several cells.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let axis = layout::pipe_axis(setting).filter(|&axis| setting.grid.cells()[axis] > 1)?;
        Some(DensityContrast { axis, samples: Samples::new(2) })
    }

    /// The contrast, and the contrast over that of independent grains; NaN without grains.
    fn contrast<V: Vector>(&self, gas: &Gas<V>) -> [f64; 2] {
        let counts: Vec<f64> = slices::counts(gas, self.axis).into_iter().map(f64::from).collect();
        let average = mean(&counts).unwrap_or(f64::NAN);
        let contrast = standard_deviation(&counts).unwrap_or(f64::NAN) / average;
        [contrast, contrast * average.sqrt()]
    }
}

impl<V: Vector> Measure<V> for DensityContrast {
    fn name(&self) -> &'static str {
        "density-contrast"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.samples.push(snapshot.gas.time(), &self.contrast(snapshot.gas));
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("density_contrast", PURE)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        vec![self.contrast(snapshot.gas)[0]]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &self.contrast(snapshot.gas));
        let rows = samples.since(from);
        let figures = vec![
            figure("density_contrast", steady_mean(&rows, |row| row[1])),
            figure("contrast_over_poisson", steady_mean(&rows, |row| row[2])),
        ];
        (Vec::new(), figures)
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
    use crate::observe::testing::{Bed, assert_resumes, figure_of, setting_of, show};
    use glam::{DVec2, DVec3};

    fn pipe<V: Vector>(size: V, cells: [u32; 3]) -> Bed<V> {
        let mut bed = setting_of(size, cells);
        bed.setting.gravity = V::along(1, -1.0);
        bed
    }

    #[test]
    fn independent_grains_have_the_contrast_of_poisson() {
        let bed = pipe(DVec3::new(4.0, 80.0, 4.0), [2, 40, 2]);
        let states = bed.random_states(101, 1000);
        let mut measure = DensityContrast::new(&bed.setting).unwrap();
        let (ratio, error) = figure_of(&mut measure, &states, 1.0, "contrast_over_poisson");
        let (ratio, error) = (ratio.unwrap(), error.unwrap());
        // ⟨s⟩ of 40 slices lies 1/(4·39) below σ; s scatters by 1/√78 each time, 100 times.
        let scatter = 1.0 / 78.0_f64.sqrt() / 10.0;
        assert!((ratio - (1.0 - 1.0 / 156.0)).abs() < 4.0 * scatter, "{ratio}");
        assert!(error > 0.3 * scatter && error < 2.0 * scatter, "{error}");
        let (contrast, _) = figure_of(&mut measure, &states, 1.0, "density_contrast");
        assert!((contrast.unwrap() * 5.0 - ratio).abs() < 1e-12);
    }

    #[test]
    fn a_wave_has_a_known_contrast() {
        let bed = pipe(DVec2::new(2.0, 40.0), [1, 20, 1]);
        // 1000 + 500 sin grains in slice k, rounded: contrast 0.5/√2 · √(20/19).
        let mut positions = Vec::new();
        for k in 0..20 {
            let phase = std::f64::consts::TAU * f64::from(k) / 20.0;
            let count = (1000.0 + 500.0 * phase.sin()).round() as usize;
            positions.extend(vec![DVec2::new(1.0, f64::from(2 * k + 1)); count]);
        }
        let velocities = vec![DVec2::ZERO; positions.len()];
        let state = (bed.gas(0.0, positions, velocities), Totals::default());
        let values = show(&mut DensityContrast::new(&bed.setting).unwrap(), &state);
        let expected = 0.5 / 2.0_f64.sqrt() * (20.0_f64 / 19.0).sqrt();
        assert!((values[0] - expected).abs() < 5e-4, "{values:?}");
    }

    #[test]
    fn without_grains_there_is_none() {
        let bed = pipe(DVec2::splat(4.0), [2, 2, 1]);
        let states = [(bed.gas(0.0, vec![], vec![]), Totals::default())];
        let mut measure = DensityContrast::new(&bed.setting).unwrap();
        assert_eq!(figure_of(&mut measure, &states, 0.0, "density_contrast"), (None, None));
        assert!(DensityContrast::new(&setting_of(DVec2::splat(4.0), [2, 2, 1]).setting).is_none());
    }

    #[test]
    fn it_resumes() {
        let bed = pipe(DVec2::splat(20.0), [10, 10, 1]);
        let make = || Box::new(DensityContrast::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 100));
    }
}
