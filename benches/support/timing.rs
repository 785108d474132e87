//! Times of steps and of their verbs, and medians.

use std::time::Instant;

use grainflow::engine::{Laps, NoLaps};

use crate::support::cases::Running;

/// Nanoseconds of each verb, in the order of their first appearance.
#[derive(Default)]
pub(crate) struct Verbs {
    times: Vec<(&'static str, f64)>,
    running: Option<(usize, Instant)>,
}

impl Verbs {
    fn stop(&mut self, now: Instant) {
        if let Some((verb, since)) = self.running.take() {
            self.times[verb].1 += now.duration_since(since).as_secs_f64() * 1e9;
        }
    }
}

impl Laps for Verbs {
    fn start(&mut self, verb: &'static str) {
        let now = Instant::now();
        self.stop(now);
        let known = self.times.iter().position(|(name, _)| *name == verb);
        let place = known.unwrap_or_else(|| {
            self.times.push((verb, 0.0));
            self.times.len() - 1
        });
        self.running = Some((place, now));
    }
}

/// What a number of steps took, per grain and step.
pub(crate) struct Timing {
    /// [nanosecond]
    pub(crate) nanoseconds: f64,
    /// Of each verb [nanosecond].
    pub(crate) verbs: Vec<(&'static str, f64)>,
    /// Collisions per particle, 2C/N.
    pub(crate) collisions: f64,
}

/// Times `steps` steps from the marked state on, after one that is not timed.
pub(crate) fn time(running: &mut dyn Running, steps: usize) -> Timing {
    running.rewind();
    running.step(&mut NoLaps);
    let grain_steps = (running.grains() * steps) as f64;
    let mut verbs = Verbs::default();
    let start = Instant::now();
    let collisions: u64 = (0..steps).map(|_| running.step(&mut verbs)).sum();
    verbs.stop(Instant::now());
    Timing {
        nanoseconds: start.elapsed().as_secs_f64() * 1e9 / grain_steps,
        verbs: verbs.times.into_iter().map(|(verb, time)| (verb, time / grain_steps)).collect(),
        collisions: 2.0 * collisions as f64 / grain_steps,
    }
}

/// Nanoseconds per grain and step of a plain step.
pub(crate) fn time_plain(step: &mut dyn FnMut(), grains: usize, steps: usize) -> f64 {
    let start = Instant::now();
    (0..steps).for_each(|_| step());
    start.elapsed().as_secs_f64() * 1e9 / (grains * steps) as f64
}

/// The value in the middle.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
