//! Many cases in a row; one that fails is told with the text that shows it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::case::{Verdict, check};
use super::draw::{Units, scenario_text};
use super::watch;

/// What many cases came to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) held: u64,
    pub(crate) refused: u64,
    pub(crate) collisions: u64,
}

/// Case number `seed`; the message of one that fails holds its scenario.
pub(crate) fn trial(seed: u64, tally: &mut Tally) -> Result<(), String> {
    let verdict = watch::over(format!("seed {seed}"), || caught(|| check(seed)));
    let problem = match verdict {
        Ok(Verdict::Held(collisions)) => {
            tally.held += 1;
            tally.collisions += collisions;
            return Ok(());
        }
        Ok(Verdict::Refused) => {
            tally.refused += 1;
            return Ok(());
        }
        Err(problem) => problem,
    };
    let text = scenario_text(seed, Units::ONE);
    Err(format!("seed {seed}: {problem}\n\nshown by the scenario\n{text}"))
}

/// `work`, with a panic as an error like others.
pub(crate) fn caught<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|cause| {
        let text = cause.downcast_ref::<String>().map(String::as_str);
        Err(format!("panic: {}", text.or(cause.downcast_ref::<&str>().copied()).unwrap_or("without words")))
    })
}
