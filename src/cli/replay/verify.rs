//! `grainflow replay --verify`.

use std::path::Path;

use clap::Args;

use crate::cli::progress::Progress;
use crate::cli::run::{STOP, prepare};
use crate::cli::{Exit, complain};
use crate::run::verify::{Extent, Verdict, VerifyError, verify};

/// The log beside its scenario that runs again.
#[derive(Args, Debug)]
#[command(next_help_heading = "Proof")]
pub(super) struct VerifyOptions {
    /// Run the scenario again and compare everything bit for bit; exit code 3 where it differs
    #[arg(long, conflicts_with_all = ["from", "to", "every", "measures", "source", "series", "profiles", "frames", "report", "speed", "force"])]
    pub(super) verify: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true, requires = "verify")]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long, requires = "verify")]
    quiet: bool,
}

/// Runs the scenario of `log` again and says whether it is the same.
pub(super) fn run_again(log: &Path, options: &VerifyOptions) -> Exit {
    if let Err(error) = prepare(options.threads) {
        complain(&error);
        return Exit::RunFailed;
    }
    let mut progress = Progress::new(options.quiet);
    let verdict = verify(log, &STOP, &mut |status| progress.tell(status));
    progress.finish();
    judge(verdict, options.quiet)
}

fn judge(verdict: Result<Verdict, VerifyError>, quiet: bool) -> Exit {
    match verdict {
        Ok(Verdict::Identical(extent, cut_off)) => {
            if !quiet {
                let up_to =
                    cut_off.as_ref().map(|_| format!(" up to t = {:?}", extent.time)).unwrap_or_default();
                println!("verified{up_to}: {}, identical{}", words(&extent), parts(&extent));
                cut_off.iter().for_each(|sentence| println!("{sentence}"));
            }
            Exit::Done
        }
        Ok(Verdict::Different(extent, difference)) => {
            complain(&format!("not verified: {difference}\nidentical before that: {}", words(&extent)));
            Exit::NotVerified
        }
        Ok(Verdict::Interrupted(extent)) => {
            complain(&format!("interrupted; identical up to t = {:?}: {}", extent.time, words(&extent)));
            Exit::Interrupted
        }
        Err(error) => {
            complain(&error);
            Exit::BadInput
        }
    }
}

/// That a run which went on with changes was made again as it was.
fn parts(extent: &Extent) -> String {
    match extent.parts {
        0 | 1 => String::new(),
        parts => format!(", in {parts} parts, each by the scenario that it ran by"),
    }
}

/// Such as `200 hashes, 4 states, 2 000 000 particle-steps`.
fn words(extent: &Extent) -> String {
    let count = |number: u64, thing: &str| {
        format!("{} {thing}{}", grouped(number), if number == 1 { "" } else { "s" })
    };
    let (hashes, states) = (extent.hashes, count(extent.states, "state"));
    let hashes = format!("{} hash{}", grouped(hashes), if hashes == 1 { "" } else { "es" });
    let work = match extent.events {
        0 => count(extent.particle_steps, "particle-step"),
        events => count(events, "event"),
    };
    format!("{hashes}, {states}, {work}")
}

/// The digits of `number` in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_groups_of_three() {
        assert_eq!([0, 999, 1000, 2_000_000].map(grouped), ["0", "999", "1 000", "2 000 000"]);
        let extent = Extent { hashes: 1, states: 4, particle_steps: 12_345, ..Extent::default() };
        assert_eq!(words(&extent), "1 hash, 4 states, 12 345 particle-steps");
    }
}
