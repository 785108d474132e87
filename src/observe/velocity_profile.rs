//! `velocity-profile`: the mean velocity across a shear cell (Müller 2001, section 3.3).

use super::layout::{self, Shear};
use super::measure::{Cadence, Column, Effort, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, weights};
use super::setting::Setting;
use super::slices;
use super::units::{LENGTH, VELOCITY, column};
use crate::space::Vector;
use crate::statistics::{Estimate, SteadyEstimate, StraightLine, straight_line};

/// Share of the height, at either wall, that the straight line leaves out.
const MARGIN: f64 = 0.1;

/// Mean velocity along the moving walls in slices of one cell between them.
#[derive(Clone, Debug)]
pub struct VelocityProfile<V> {
    shear: Shear<V>,
    /// H [length].
    height: f64,
    slices: usize,
    /// `[sample][Σ v of each slice, grains of each slice]`.
    samples: Samples,
}

impl<V: Vector> VelocityProfile<V> {
    /// The measure for `setting`, if its walls move past each other.
    pub fn new(setting: &Setting<V>) -> Option<Self> {
        let shear = layout::shear(setting)?;
        let slices = setting.grid.cells()[shear.axis] as usize;
        let height = setting.size[shear.axis];
        Some(VelocityProfile { shear, height, slices, samples: Samples::new(2 * slices) })
    }

    /// Σ v and grains of a slice times the time that each row stands for, `[row]`.
    fn sums_of(&self, rows: &[&[f64]], slice: usize) -> Vec<[f64; 2]> {
        let weights = weights(rows).into_iter();
        let sums =
            |(row, weight): (&&[f64], f64)| [row[1 + slice] * weight, row[1 + self.slices + slice] * weight];
        rows.iter().zip(weights).map(sums).collect()
    }

    /// Whether a slice belongs to the central part that the straight line goes through.
    fn is_central(&self, height: f64) -> bool {
        (MARGIN..=1.0 - MARGIN).contains(&(height / self.height))
    }

    /// The straight line through the central part, in units of v and H.
    fn line(&self, heights: &[f64], velocities: &[f64]) -> Option<StraightLine> {
        let places = heights.iter().zip(velocities).filter(|(h, v)| self.is_central(**h) && v.is_finite());
        let (x, y): (Vec<f64>, Vec<f64>) =
            places.map(|(h, v)| (h / self.height, v / self.shear.speed)).unzip();
        straight_line(&x, &y)
    }

    /// The slope of that line. It is a sum of the velocities of slices, Σ c V with c = (x − x̄)/Σ(x − x̄)², and each of these a
    /// ratio of sums over rows; so are its residuals.
    fn slope(&self, heights: &[f64], sums: &[Vec<[f64; 2]>], velocities: &[f64]) -> Option<SteadyEstimate> {
        let line = self.line(heights, velocities)?;
        let central: Vec<usize> =
            (0..self.slices).filter(|k| self.is_central(heights[*k]) && velocities[*k].is_finite()).collect();
        let middle = central.iter().map(|k| heights[*k]).sum::<f64>() / central.len() as f64;
        let squares: f64 = central.iter().map(|k| (heights[*k] - middle) * (heights[*k] - middle)).sum();
        let mut residuals = vec![0.0; sums[0].len()];
        for &slice in &central {
            let factor = (heights[slice] - middle) / squares * self.height / self.shear.speed;
            let mean = sums[slice].iter().map(|sum| sum[1]).sum::<f64>() / residuals.len() as f64;
            for (residual, [momentum, grains]) in residuals.iter_mut().zip(&sums[slice]) {
                *residual += factor * (momentum - velocities[slice] * grains) / mean;
            }
        }
        Some(SteadyEstimate::of_residuals(line.slope, &residuals, line.slope.abs().max(1.0)))
    }
}

impl<V: Vector> Measure<V> for VelocityProfile<V> {
    fn name(&self) -> &'static str {
        "velocity-profile"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn effort(&self) -> Effort {
        Effort::Table
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let Shear { axis, direction, .. } = self.shear;
        let mut row = slices::velocity_sums(snapshot.gas, axis, |v| v.dot(direction));
        row.extend(slices::counts(snapshot.gas, axis).into_iter().map(f64::from));
        self.samples.push(snapshot.gas.time(), &row);
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let rows = self.samples.since(from);
        let heights = slices::centres(snapshot.gas, self.shear.axis);
        let sums: Vec<Vec<[f64; 2]>> = (0..self.slices).map(|slice| self.sums_of(&rows, slice)).collect();
        let means: Vec<Option<SteadyEstimate>> =
            sums.iter().map(|sums| SteadyEstimate::ratio(sums)).collect();
        let velocities: Vec<f64> =
            means.iter().map(|mean| mean.map_or(f64::NAN, |mean| mean.value)).collect();
        let errors = means.iter().map(|mean| mean.and_then(|mean| mean.standard_error).unwrap_or(f64::NAN));
        let slope = self.slope(&heights, &sums, &velocities);
        let line = self.line(&heights, &velocities);
        // A profile that does not vary is no straight line that is met well.
        let share = line.map(|line| line.r_squared).filter(|share| share.is_finite());
        let r_squared = share.map(|value| Estimate { value, standard_error: None });
        let profile = Profile {
            name: "velocity-profile".to_owned(),
            time: snapshot.gas.time(),
            columns: columns(),
            values: vec![heights.clone(), velocities.clone(), errors.collect()],
        };
        let figures =
            vec![figure("velocity_profile_slope", slope), figure("velocity_profile_r_squared", r_squared)];
        (vec![profile], figures)
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

fn columns() -> Vec<Column> {
    vec![column("height", LENGTH), column("velocity", VELOCITY), column("standard_error", VELOCITY)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::observe::testing::{Bed, State, assert_resumes, figure_of, rough, setting_of, show};
    use glam::{DVec2, DVec3};

    fn sheared() -> Bed<DVec2> {
        let mut bed = setting_of(DVec2::splat(40.0), [20, 20, 1]);
        bed.walls(1, rough(DVec2::new(-0.5, 0.0)), rough(DVec2::new(0.5, 0.0)));
        bed
    }

    /// One grain in the middle of every cell, moving as `velocity` of its height says.
    fn flowing(bed: &Bed<DVec2>, time: f64, velocity: impl Fn(f64) -> f64) -> State<DVec2> {
        let cells = (0..400).map(|k| DVec2::new(f64::from(k % 20), f64::from(k / 20)) * 2.0 + DVec2::ONE);
        let positions: Vec<DVec2> = cells.collect();
        let velocities = positions.iter().map(|p| DVec2::new(velocity(p.y), 0.3)).collect();
        (bed.gas(time, positions, velocities), Totals::default())
    }

    #[test]
    fn a_linear_field_has_slope_one() {
        let bed = sheared();
        // Only what is before `from`, and the outer tenths, leave the line.
        let states: Vec<_> = (0..30)
            .map(|k| {
                let slipping = move |y: f64| if (4.0..36.0).contains(&y) { y / 40.0 - 0.5 } else { 7.0 };
                flowing(&bed, f64::from(k), move |y| if k < 10 { 3.0 } else { slipping(y) })
            })
            .collect();
        let mut measure = VelocityProfile::new(&bed.setting).unwrap();
        let (slope, error) = figure_of(&mut measure, &states, 10.0, "velocity_profile_slope");
        assert!((slope.unwrap() - 1.0).abs() < 1e-14, "{slope:?}");
        assert!(error.unwrap() < 1e-14);
        let (r_squared, _) = figure_of(&mut measure, &states, 10.0, "velocity_profile_r_squared");
        assert!((r_squared.unwrap() - 1.0).abs() < 1e-14);
        let (gas, totals) = &states[29];
        let (profiles, _) = measure.conclusion(&Snapshot::new(gas, totals), 10.0);
        assert_eq!(profiles[0].values[0][..2], [1.0, 3.0]);
        assert!((profiles[0].values[1][10] - (21.0 / 40.0 - 0.5)).abs() < 1e-15);
    }

    #[test]
    fn the_error_of_the_slope_is_that_of_the_slopes_of_single_looks() {
        let bed = sheared();
        let slope = |k: u32| 0.9 + 0.2 * f64::from(u8::from(k % 4 == 1 || k % 4 == 2));
        // No correlation from one to the next: s = 0.1 over √10.
        let states: Vec<_> =
            (0..10).map(|k| flowing(&bed, f64::from(k), move |y| slope(k) * (y / 40.0))).collect();
        let mut measure = VelocityProfile::new(&bed.setting).unwrap();
        let (mean, error) = figure_of(&mut measure, &states, 0.0, "velocity_profile_slope");
        let weighted = (0..10).map(slope).sum::<f64>() - 0.5 * (slope(0) + slope(9));
        assert!((mean.unwrap() - weighted / 9.0).abs() < 1e-13, "{mean:?}");
        assert!((error.unwrap() / (0.1 / 10.0_f64.sqrt()) - 1.0).abs() < 0.15, "{error:?}");
    }

    #[test]
    fn it_follows_the_walls_in_three_dimensions() {
        let mut bed = setting_of(DVec3::splat(20.0), [10; 3]);
        assert!(VelocityProfile::new(&bed.setting).is_none());
        bed.walls(2, rough(DVec3::ZERO), rough(DVec3::new(0.0, -3.0, 0.0)));
        let positions: Vec<DVec3> = (0..10).map(|k| DVec3::splat(f64::from(2 * k + 1))).collect();
        let velocities = positions.iter().map(|p| DVec3::new(9.0, -3.0 * p.z / 20.0, 9.0)).collect();
        let state = (bed.gas(1.0, positions, velocities), Totals::default());
        let mut measure = VelocityProfile::new(&bed.setting).unwrap();
        show(&mut measure, &state);
        let (slope, error) = figure_of(&mut measure, &[state], 0.0, "velocity_profile_slope");
        assert!((slope.unwrap() - 1.0).abs() < 1e-14);
        assert_eq!(error, None);
    }

    #[test]
    fn it_resumes() {
        let bed = sheared();
        let make = || Box::new(VelocityProfile::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 300));
    }
}
