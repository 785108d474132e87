//! `collisions`: how often grains collide, and how far they get in between.

use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::samples::{Samples, figure, steady_rate, steady_ratio};
use super::units::{RATE, column};
use crate::space::Vector;

/// Collisions per particle and time 2ΔC/(N Δt), the mean free time N Δt/(2ΔC), and the mean free path: the mean
/// speed |v − u| about the local flow u (`local_flow`), summed over time, per collision of a grain.
///
/// Between two looks at the gas the mean speed is taken as the mean of both.
#[derive(Clone, Debug)]
pub struct Collisions {
    /// Time and collisions per particle at the previous recording.
    previous: Option<[f64; 2]>,
    /// `[sample][collisions per particle, mean speed]`.
    samples: Samples,
}

impl Default for Collisions {
    fn default() -> Self {
        Self::new()
    }
}

impl Collisions {
    /// The measure; every setting has it.
    pub fn new() -> Self {
        Collisions { previous: None, samples: Samples::new(2) }
    }
}

/// First in a memory whose speeds are about the local flow: older ones begin with 0 or 1.
const ABOUT_LOCAL_FLOW: f64 = -2.0;

/// Collisions per particle, mean speed [length/time].
fn row<V: Vector>(snapshot: &Snapshot<'_, V>) -> [f64; 2] {
    [snapshot.totals.collisions_per_particle, snapshot.local_flow().mean_speed(snapshot.gas)]
}

/// Time, collisions per particle, and the path that a grain has gone since the first row, `[row]`.
fn paths(rows: &[&[f64]]) -> Vec<[f64; 3]> {
    let mut path = 0.0;
    let mut walked = Vec::with_capacity(rows.len());
    for (k, row) in rows.iter().enumerate() {
        let before = rows[k.saturating_sub(1)];
        path += 0.5 * (before[2] + row[2]) * (row[0] - before[0]);
        walked.push([row[0], row[1], path]);
    }
    walked
}

impl<V: Vector> Measure<V> for Collisions {
    fn name(&self) -> &'static str {
        "collisions"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.samples.push(snapshot.gas.time(), &row(snapshot));
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("collision_frequency", RATE)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let now = [snapshot.gas.time(), snapshot.totals.collisions_per_particle];
        let frequency = match self.previous.replace(now) {
            Some(before) if before[0] < now[0] => (now[1] - before[1]) / (now[0] - before[0]),
            _ => f64::NAN,
        };
        vec![frequency]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let samples = self.samples.with(snapshot.gas.time(), &row(snapshot));
        let rows = paths(&samples.since(from));
        let rows: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
        let figures = vec![
            figure("collision_frequency", steady_rate(&rows, |row| row[1])),
            figure("mean_free_time", steady_ratio(&rows, |row| row[0], |row| row[1])),
            figure("mean_free_path", steady_ratio(&rows, |row| row[2], |row| row[1])),
        ];
        (Vec::new(), figures)
    }

    fn memory(&self) -> Vec<f64> {
        let mut memory = vec![ABOUT_LOCAL_FLOW];
        memory.extend(self.samples.memory_behind(self.previous));
        memory
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        let [ABOUT_LOCAL_FLOW, memory @ ..] = memory else { return false };
        self.samples.recall_behind(&mut self.previous, memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::observe::testing::{State, assert_resumes, figure_of, setting_of, show};
    use glam::{DVec2, DVec3};

    /// Two grains at speed 2 beside their mean, which collide `rate` times per time each. As two of many, whose mean they would
    /// not move, they have √2 times that speed.
    fn colliding(rate: f64) -> Vec<State<DVec2>> {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let flow = DVec2::new(9.0, 9.0);
        let velocities = vec![flow + DVec2::X * 2.0, flow - DVec2::X * 2.0];
        let state = |k: u32| {
            let time = f64::from(k);
            let totals = Totals { collisions_per_particle: rate * time, ..Totals::default() };
            (bed.gas(time, vec![DVec2::ONE; 2], velocities.clone()), totals)
        };
        (0..40).map(state).collect()
    }

    #[test]
    fn a_steady_gas_by_hand() {
        let states = colliding(4.0);
        let figure = |name| figure_of(&mut Collisions::new(), &states, 20.0, name);
        assert_eq!(figure("collision_frequency"), (Some(4.0), Some(0.0)));
        assert_eq!(figure("mean_free_time"), (Some(0.25), Some(0.0)));
        let (path, error) = figure("mean_free_path");
        assert!((path.unwrap() - 0.5_f64.sqrt()).abs() < 1e-12 && error.unwrap() < 1e-12);
        let mut measure = Collisions::new();
        assert!(show(&mut measure, &states[0])[0].is_nan());
        assert_eq!(show(&mut measure, &states[1]), [4.0]);
    }

    #[test]
    fn without_collisions_nothing_is_free() {
        let states = colliding(0.0);
        let figure = |name| figure_of(&mut Collisions::new(), &states, 20.0, name);
        assert_eq!(figure("collision_frequency"), (Some(0.0), Some(0.0)));
        assert_eq!(figure("mean_free_time"), (None, None));
        assert_eq!(figure("mean_free_path"), (None, None));
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert_resumes(|| Box::new(Collisions::new()), &bed.random_states(30, 20));
    }
}
