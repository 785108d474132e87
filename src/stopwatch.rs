//! The wall clock and the machine: the only file that looks at either.

use std::path::Path;
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

/// The most memory this process has held so far, where the system tells [bytes].
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    kilobytes(&status, "VmHWM:")
}

/// Makes [`peak_memory_bytes`] count from now on, where the system lets it; returns whether it does.
pub fn forget_peak_memory() -> bool {
    // Linux: 5 sets the peak back to what is held now.
    std::fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// The number behind `key` in a table of the system, which counts in kilobytes [bytes].
fn kilobytes(table: &str, key: &str) -> Option<u64> {
    let line = table.lines().find_map(|line| line.strip_prefix(key))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}

/// What the machine has to give, where the system tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Machine {
    /// Memory that a new process can have [bytes].
    pub memory: Option<u64>,
    /// Room on the disk of a folder [bytes].
    pub disk: Option<u64>,
}

impl Machine {
    /// This machine, with the disk that holds `folder`, or will hold it.
    pub fn holding(folder: &Path) -> Self {
        // Where nothing but names are missing, the last folder that is there has the disk.
        let disk = folder.ancestors().find_map(|place| {
            let place = if place.as_os_str().is_empty() { Path::new(".") } else { place };
            fs4::available_space(place).ok()
        });
        Machine { memory: available_memory_bytes(), disk }
    }
}

/// Memory that a new process can have, where the system tells [bytes].
fn available_memory_bytes() -> Option<u64> {
    let facts = std::fs::read_to_string("/proc/meminfo").ok()?;
    kilobytes(&facts, "MemAvailable:")
}

/// A number that differs from process to process, for names of temporary files.
pub fn process_number() -> u32 {
    std::process::id()
}
