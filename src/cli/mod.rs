//! The command line: one file a verb. Only here anything is printed.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "the command line is what prints")]

mod calibrate;
mod check;
mod compare;
mod input;
mod progress;
mod recover;
mod replay;
mod run;
mod scenarios;
mod sweep;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Exit codes that scripts rely on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Exit {
    /// Done.
    Done = 0,
    /// The run failed.
    RunFailed = 1,
    /// The input is wrong.
    BadInput = 2,
    /// What was to be verified does not hold.
    NotVerified = 3,
    /// Interrupted.
    Interrupted = 130,
}

/// Granular matter, simulated fast and honestly.
///
/// Runs scenarios of grains (shear, pipe flow, heaps, cooling, clustering, settling) with stochastic
/// engines on all cores, and writes a log, tables, a summary and a report.
#[derive(Debug, Parser)]
#[command(name = "grainflow", version, verbatim_doc_comment, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "Examples:
  grainflow run heap                             pour a heap, into out/heap-hsmc
  grainflow run shear --set particles.restitution=0.8 --seed 3
  grainflow sweep heap --vary particles.restitution=[0.9,0.7,0.5]
  grainflow compare cooling --engines hsmc,event-driven    the same grains through both
  grainflow run --resume out/heap-hsmc           go on where an interrupted run has stopped
  grainflow replay out/heap-hsmc --verify        run it again, and compare bit for bit
  grainflow scenarios show pipe > mine.toml      a file to start from
  grainflow check mine.toml                      what it means, or all that is wrong with it

Exit codes: 0 done; 1 the run failed; 2 the input is wrong; 3 not verified;
130 interrupted.";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::RunArguments),
    Calibrate(calibrate::CalibrateArguments),
    Sweep(sweep::SweepArguments),
    Compare(compare::CompareArguments),
    Replay(replay::ReplayArguments),
    Recover(recover::RecoverArguments),
    Check(check::CheckArguments),
    Scenarios(scenarios::ScenariosArguments),
}

/// Reads the command line and does what it says.
pub fn main() -> ExitCode {
    let exit = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Replay(arguments) => replay::replay(&arguments),
        Command::Recover(arguments) => recover::recover(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Scenarios(arguments) => scenarios::scenarios(&arguments),
    };
    ExitCode::from(exit as u8)
}

/// Says what went wrong.
fn complain(error: &dyn std::fmt::Display) {
    eprintln!("error: {error}");
}
