//! A case that never ends says which it is, and ends the program.

use std::sync::{Mutex, Once, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// The longest that a case may take before nobody waits any more [s].
const LONGEST: u64 = 120;

/// What is being done, by whom, and since when.
static NOW: Mutex<Vec<(ThreadId, Instant, String)>> = Mutex::new(Vec::new());
static BEGUN: Once = Once::new();

/// Does `work`, of which `what` is the name for the case that it has no end.
pub(crate) fn over<T>(what: String, work: impl FnOnce() -> T) -> T {
    BEGUN.call_once(|| drop(thread::spawn(look)));
    let me = thread::current().id();
    with(|now| now.push((me, Instant::now(), what)));
    let result = work();
    with(|now| now.retain(|(who, ..)| *who != me));
    result
}

#[expect(clippy::print_stderr, reason = "the program ends before anybody else could tell")]
fn look() {
    loop {
        thread::sleep(Duration::from_secs(1));
        let late = |now: &mut Vec<(ThreadId, Instant, String)>| {
            now.iter().find(|(_, since, _)| since.elapsed().as_secs() > LONGEST).map(|late| late.2.clone())
        };
        if let Some(what) = with(late) {
            eprintln!("no end after {LONGEST} s: {what}");
            std::process::exit(1);
        }
    }
}

fn with<T>(change: impl FnOnce(&mut Vec<(ThreadId, Instant, String)>) -> T) -> T {
    change(&mut NOW.lock().unwrap_or_else(PoisonError::into_inner))
}
