//! `wall-stress`: the momentum that the gas gives to its walls (Müller 2001, section 3.3).

use super::layout;
use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_rate};
use super::setting::Setting;
use super::units::{column, stress};
use crate::space::Vector;

/// Shear and normal stress on the walls of one axis.
///
/// The axis is that of shear; else, in a pipe, the first with walls beside it; else that of gravity if it
/// has walls; else the first with walls. The shear stress is taken along the way the walls move or, in a pipe,
/// along gravity; each wall's share is counted positive in the sense that the mean has, so that in
/// a steady state it is the mean of the magnitudes without the bias that magnitudes of noise have.
#[derive(Clone, Debug)]
pub struct WallStress<V> {
    axis: usize,
    /// For the lower and upper wall, the direction along which its tangential momentum counts.
    along: Option<[V; 2]>,
    /// Momentum to stress·time: one over area and number of walls [1/length^(D−1)].
    weight: f64,
    /// Time, shear and normal stress·time at the previous recording.
    previous: [f64; 3],
    samples: Samples,
}

impl<V: Vector> WallStress<V> {
    /// The measure for `setting`, if it has walls.
    pub fn new(setting: &Setting<V>) -> Option<Self> {
        let shear = layout::shear(setting);
        let pipe = layout::pipe_axis(setting);
        let walls_on = |axis: usize| setting.boundary.walls().filter(|wall| wall.0 == axis).count();
        let axis = match (shear, layout::gravity_axis(setting)) {
            (Some(shear), _) => shear.axis,
            (None, Some(axis)) if pipe.is_none() && walls_on(axis) > 0 => axis,
            _ => setting.boundary.walls().next()?.0,
        };
        // The lower wall is dragged with the gas, that is along the upper wall, and the other way round.
        let along = shear.map(|shear| [shear.direction, -shear.direction]).or_else(|| {
            let falling = pipe.map(|pipe| V::along(pipe, setting.gravity[pipe].signum()))?;
            Some([falling, falling])
        });
        let area = setting.size.product() / setting.size[axis];
        let weight = 1.0 / (area * walls_on(axis) as f64);
        // Every total is zero at time 0, whether or not anyone looks then.
        let samples = Samples::new(2).with(0.0, &[0.0; 2]);
        Some(WallStress { axis, along, weight, previous: [0.0; 3], samples })
    }

    /// Time, and the stresses summed over time since the start.
    fn accumulated(&self, snapshot: &Snapshot<'_, V>) -> [f64; 3] {
        let [lower, upper] = snapshot.totals.counts.wall_momentum[self.axis];
        let shear = self.along.map_or(0.0, |[below, above]| lower.dot(below) + upper.dot(above));
        let normal = upper[self.axis] - lower[self.axis];
        [snapshot.gas.time(), shear * self.weight, normal * self.weight]
    }
}

impl<V: Vector> Measure<V> for WallStress<V> {
    fn name(&self) -> &'static str {
        "wall-stress"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        let [time, shear, normal] = self.accumulated(snapshot);
        self.samples.push(time, &[shear, normal]);
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("wall_shear_stress", stress::<V>()), column("wall_normal_stress", stress::<V>())]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let now = self.accumulated(snapshot);
        let before = std::mem::replace(&mut self.previous, now);
        // Zero over zero, NaN, for a recording at the time of the previous one.
        let rate = |k: usize| (now[k] - before[k]) / (now[0] - before[0]);
        vec![if self.along.is_some() { rate(1) } else { f64::NAN }, rate(2)]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let [time, shear, normal] = self.accumulated(snapshot);
        let samples = self.samples.with(time, &[shear, normal]);
        let rows = samples.since(from);
        let shear = self.along.and_then(|_| steady_rate(&rows, |row| row[1]));
        let normal = steady_rate(&rows, |row| row[2]);
        (Vec::new(), vec![figure("wall_shear_stress", shear), figure("wall_normal_stress", normal)])
    }

    fn memory(&self) -> Vec<f64> {
        [&self.previous, self.samples.memory()].concat()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        let Some((previous, samples)) = memory.split_first_chunk() else { return false };
        let is_one = self.samples.recall(samples);
        if is_one {
            self.previous = *previous;
        }
        is_one
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::law::boundary::Face;
    use crate::observe::testing::{Bed, State, assert_resumes, figure_of, rough, setting_of, show, smooth};
    use glam::{DVec2, DVec3};

    /// Walls get `lower` and `upper` per time unit, and once twice as much.
    fn pushed<V: Vector>(bed: &Bed<V>, axis: usize, lower: V, upper: V) -> Vec<State<V>> {
        (0..=20)
            .map(|k| {
                let mut totals = Totals::default();
                let time = f64::from(k + i32::from(k > 10));
                totals.counts.wall_momentum[axis] = [lower * time, upper * time];
                (bed.gas(f64::from(k), vec![], vec![]), totals)
            })
            .collect()
    }

    #[test]
    fn stress_is_momentum_over_time_and_area() {
        let mut bed = setting_of(DVec3::new(2.0, 5.0, 8.0), [2, 2, 2]);
        bed.walls(2, rough(DVec3::new(0.0, -1.0, 0.0)), rough(DVec3::new(0.0, 1.0, 0.0)));
        // Area 10; shear (30 + 50)/2, normal (20 + 40)/2.
        let states = pushed(&bed, 2, DVec3::new(7.0, 30.0, -20.0), DVec3::new(0.0, -50.0, 40.0));
        let mut measure = WallStress::new(&bed.setting).unwrap();
        for (k, state) in states.iter().enumerate() {
            let values = show(&mut measure, state);
            let factor = if k == 11 { 2.0 } else { 1.0 };
            if k == 0 {
                assert!(values[0].is_nan());
            } else {
                assert!((values[0] - 4.0 * factor).abs() < 1e-12 && (values[1] - 3.0 * factor).abs() < 1e-12);
            }
        }
        let (shear, error) = figure_of(&mut measure, &states, 10.0, "wall_shear_stress");
        // Ten blocks of one interval, one of them at 8: mean 4.4, s = 4/√10, error 0.4.
        assert!((shear.unwrap() - 4.4).abs() < 1e-12, "{shear:?}");
        assert!((error.unwrap() - 0.4).abs() < 1e-12);
        let (later, _) = figure_of(&mut measure, &states, 11.0, "wall_shear_stress");
        assert!((later.unwrap() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_pipe_is_dragged_along_gravity_on_both_sides() {
        let mut bed = setting_of(DVec2::new(6.0, 10.0), [3, 5, 1]);
        bed.walls(0, smooth(), smooth());
        bed.setting.gravity = DVec2::new(0.0, -2.0);
        let states = pushed(&bed, 0, DVec2::new(-10.0, -20.0), DVec2::new(10.0, -40.0));
        let mut measure = WallStress::new(&bed.setting).unwrap();
        let (shear, _) = figure_of(&mut measure, &states, 11.0, "wall_shear_stress");
        let (normal, _) = figure_of(&mut measure, &states, 11.0, "wall_normal_stress");
        assert!((shear.unwrap() - 3.0).abs() < 1e-12);
        assert!((normal.unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_single_floor_bears_all() {
        let mut bed = setting_of(DVec2::new(6.0, 10.0), [3, 5, 1]);
        bed.walls(0, smooth(), smooth());
        bed.walls(1, smooth(), Face::Open);
        bed.setting.gravity = DVec2::new(0.0, -1.0);
        let states = pushed(&bed, 1, DVec2::new(0.0, -12.0), DVec2::ZERO);
        let mut measure = WallStress::new(&bed.setting).unwrap();
        let (normal, _) = figure_of(&mut measure, &states, 11.0, "wall_normal_stress");
        assert!((normal.unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(figure_of(&mut measure, &states, 11.0, "wall_shear_stress"), (None, None));
    }

    #[test]
    fn it_resumes() {
        let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
        bed.walls(1, rough(-DVec2::X), rough(DVec2::X));
        let make = || Box::new(WallStress::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 10));
    }
}
