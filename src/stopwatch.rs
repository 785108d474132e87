//! The wall clock: the only file that looks at it.

use std::time::{Duration, Instant};

use crate::engine::Laps;

/// Measures how long each verb of the algorithm takes.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    started: Instant,
    lap_started: Instant,
    verb: Option<&'static str>,
    laps: Vec<(&'static str, f64)>,
}

impl Default for Stopwatch {
    fn default() -> Self {
        let now = Instant::now();
        Stopwatch { started: now, lap_started: now, verb: None, laps: Vec::new() }
    }
}

impl Laps for Stopwatch {
    fn start(&mut self, verb: &'static str) {
        self.stop();
        self.verb = Some(verb);
    }
}

impl Stopwatch {
    /// Ends the lap that is running; time goes to nobody until the next one starts.
    pub fn stop(&mut self) {
        let now = Instant::now();
        if let Some(verb) = self.verb.take() {
            let seconds = (now - self.lap_started).as_secs_f64();
            match self.laps.iter_mut().find(|(name, _)| *name == verb) {
                Some((_, total)) => *total += seconds,
                None => self.laps.push((verb, seconds)),
            }
        }
        self.lap_started = now;
    }

    /// Seconds since the stopwatch was made.
    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Sleeps until this many seconds have gone by since the stopwatch was made; not at all where they have.
    pub fn sleep_until(&self, seconds: f64) {
        let rest = seconds - self.seconds();
        if rest > 0.0 {
            std::thread::sleep(Duration::try_from_secs_f64(rest).unwrap_or(Duration::MAX));
        }
    }

    /// Seconds of each verb, in the order of their first laps.
    pub fn laps(&self) -> &[(&'static str, f64)] {
        &self.laps
    }
}
