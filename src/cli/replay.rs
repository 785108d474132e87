//! `grainflow replay`.

use std::path::PathBuf;

use clap::Args;

use super::progress::Progress;
use super::run::{STOP, prepare};
use super::{Exit, complain};
use crate::run::verify::{Extent, Verdict, VerifyError, verify};

const VERIFYING: &str =
    "A log that holds gives exit code 0. Where something differs, the first time, grain and field that do
are told, and the exit code is 3. A log that cannot be verified (damaged, made by a version with
other numerics, with a hole) gives 2.

  grainflow replay out/cooling-hsmc --verify";

/// Run the scenario of a log again and compare bit for bit
#[derive(Args, Debug)]
#[command(after_help = VERIFYING)]
pub(super) struct ReplayArguments {
    /// A log, or a run folder
    #[arg(value_name = "LOG")]
    log: PathBuf,

    /// Run the scenario again and compare every recording and state bit for bit
    #[arg(long, required = true)]
    verify: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

pub(super) fn replay(arguments: &ReplayArguments) -> Exit {
    if let Err(error) = prepare(arguments.threads) {
        complain(&error);
        return Exit::RunFailed;
    }
    let mut progress = Progress::new(arguments.quiet);
    let verdict = verify(&arguments.log, &STOP, &mut |status| progress.tell(status));
    progress.finish();
    judge(verdict, arguments.quiet)
}

fn judge(verdict: Result<Verdict, VerifyError>, quiet: bool) -> Exit {
    match verdict {
        Ok(Verdict::Identical(extent, cut_off)) => {
            if !quiet {
                let up_to =
                    cut_off.as_ref().map(|_| format!(" up to t = {:?}", extent.time)).unwrap_or_default();
                println!("verified{up_to}: {}, identical", words(&extent));
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
