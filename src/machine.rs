//! The machine: memory, disk, the process. The only file that asks for them.

use std::path::Path;

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
