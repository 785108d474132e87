//! How a run is going: a bar on a terminal, a line now and then elsewhere.

use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressStyle};

use crate::number::plain;
use crate::run::Status;
use crate::stopwatch::Stopwatch;

/// Seconds between two refreshes of the bar.
const BAR_SECONDS: f64 = 0.1;
/// Seconds between two lines where there is no terminal.
const LINE_SECONDS: f64 = 10.0;
/// Steps of the bar.
const BAR_LENGTH: u64 = 1000;

/// Tells how a run is going.
pub(super) struct Progress {
    bar: Option<ProgressBar>,
    quiet: bool,
    watch: Stopwatch,
    last: f64,
    /// Particle-steps or events at the last time; nothing before the first.
    last_work: Option<u64>,
}

impl Progress {
    pub(super) fn new(quiet: bool) -> Self {
        let bar = (!quiet && stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new(BAR_LENGTH);
            bar.set_style(
                ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {eta} left")
                    .expect("the template is part of the program"),
            );
            bar
        });
        Progress { bar, quiet, watch: Stopwatch::default(), last: 0.0, last_work: None }
    }

    /// Shows `status`, if it is time to.
    pub(super) fn tell(&mut self, status: &Status) {
        self.tell_part("", status.progress, status);
    }

    /// Shows the `status` of the run that `name` begins to tell of, where `share` of everything is done.
    pub(super) fn tell_part(&mut self, name: &str, share: f64, status: &Status) {
        if self.quiet {
            return;
        }
        let (work, things) = match status.events {
            0 => (status.particle_steps, "particle-steps"),
            events => (events, "events"),
        };
        // A run that was resumed has not begun with nothing.
        let last_work = *self.last_work.get_or_insert(work);
        let now = self.watch.seconds();
        let pause = now - self.last;
        if pause < if self.bar.is_some() { BAR_SECONDS } else { LINE_SECONDS } {
            return;
        }
        let speed = work.saturating_sub(last_work) as f64 / pause;
        (self.last, self.last_work) = (now, Some(work));
        let line = format!(
            "{name}t = {}, {}, {} collisions per particle, {:.1} M {things}/s",
            plain(status.time, 6),
            if status.grains == 1 { "1 grain".to_owned() } else { format!("{} grains", status.grains) },
            plain(status.collisions_per_particle, 4),
            speed * 1e-6
        );
        match &self.bar {
            Some(bar) => {
                bar.set_position((share * BAR_LENGTH as f64) as u64);
                bar.set_message(line);
            }
            None => eprintln!("{:3.0} %  {line}", 100.0 * share),
        }
    }

    /// Leaves the line free.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
