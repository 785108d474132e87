//! `flow`: how many grains pass through a pipe, and how fast (Müller 2001, section 3.4.1).

use super::layout;
use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::moments;
use super::samples::{Samples, figure, steady_mean};
use super::setting::Setting;
use super::units::{RATE, VELOCITY, column};
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Grains per time through the cross-section of a pipe, averaged over its length: Σ v_g / L; and their
/// mean velocity. Both are positive along gravity.
#[derive(Clone, Debug)]
pub struct Flow {
    axis: usize,
    /// Sign of gravity along the axis.
    sense: f64,
    /// L [length].
    length: f64,
    samples: Samples,
}

impl Flow {
    /// The measure for `setting`, if grains fall for ever along a periodic axis.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let axis = layout::pipe_axis(setting)?;
        let sense = setting.gravity[axis].signum();
        Some(Flow { axis, sense, length: setting.size[axis], samples: Samples::new(2) })
    }

    /// Flow rate [1/time] and mean velocity [length/time]; the latter NaN without grains.
    fn flow<V: Vector>(&self, gas: &Gas<V>) -> [f64; 2] {
        let total = self.sense * moments::sum(gas.velocities(), |v| v[self.axis]);
        [total / self.length, total / gas.len() as f64]
    }
}

impl<V: Vector> Measure<V> for Flow {
    fn name(&self) -> &'static str {
        "flow"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.samples.push(snapshot.gas.time(), &self.flow(snapshot.gas));
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("flow_rate", RATE), column("flow_velocity", VELOCITY)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        self.flow(snapshot.gas).to_vec()
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &self.flow(snapshot.gas));
        let rows = samples.since(from);
        let figures = vec![
            figure("flow_rate", steady_mean(&rows, |row| row[1])),
            figure("flow_velocity", steady_mean(&rows, |row| row[2])),
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
    use crate::observe::testing::{assert_resumes, figure_of, setting_of};
    use glam::{DVec2, DVec3};

    #[test]
    fn a_steady_flow() {
        let mut bed = setting_of(DVec3::new(4.0, 4.0, 10.0), [2, 2, 5]);
        bed.setting.gravity = DVec3::new(0.0, 0.0, -1.0);
        // 20 grains at speeds 2 and 4 on a length of 10: 6 per time.
        let states: Vec<_> = (0..40)
            .map(|k| {
                let velocities = (0..20).map(|i| DVec3::new(5.0, 0.0, -f64::from(2 + i % 2 * 2))).collect();
                (bed.gas(f64::from(k), vec![DVec3::ONE; 20], velocities), Totals::default())
            })
            .collect();
        let mut measure = Flow::new(&bed.setting).unwrap();
        assert_eq!(figure_of(&mut measure, &states, 20.0, "flow_rate"), (Some(6.0), Some(0.0)));
        assert_eq!(figure_of(&mut measure, &states, 20.0, "flow_velocity"), (Some(3.0), Some(0.0)));
    }

    #[test]
    fn a_box_without_gravity_has_no_flow() {
        assert!(Flow::new(&setting_of(DVec2::splat(4.0), [2, 2, 1]).setting).is_none());
    }

    #[test]
    fn it_resumes() {
        let mut bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        bed.setting.gravity = DVec2::X;
        let make = || Box::new(Flow::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec2>>;
        assert_resumes(make, &bed.random_states(30, 20));
    }
}
