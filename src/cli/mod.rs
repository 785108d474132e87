//! The command line: one file a verb. Only here anything is printed.

/// As in the standard library, but without a panic where nobody can be told: see [`output`].
macro_rules! print {
    ($($text:tt)*) => { $crate::cli::output::put(format_args!($($text)*)) };
}
/// The same with an end of line.
macro_rules! println {
    ($($text:tt)*) => { $crate::cli::output::put(format_args!("{}\n", format_args!($($text)*))) };
}
/// The same to the standard error.
macro_rules! eprintln {
    ($($text:tt)*) => { $crate::cli::output::put_aside(format_args!("{}\n", format_args!($($text)*))) };
}

mod calibrate;
mod check;
mod compare;
mod export;
mod hint;
mod input;
mod output;
mod progress;
mod recover;
mod replay;
mod run;
mod scenarios;
mod span;
mod sweep;
mod view;

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
  grainflow view out/heap-hsmc                   what happened, in the browser
  grainflow replay out/heap-hsmc --speed 20      watch it in the terminal
  grainflow export out/heap-hsmc --format vtp    for ParaView
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
    Export(export::ExportArguments),
    Recover(recover::RecoverArguments),
    Check(check::CheckArguments),
    Scenarios(scenarios::ScenariosArguments),
    View(view::ViewArguments),
}

/// Reads the command line and does what it says.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return refuse(&error),
    };
    let exit = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Replay(arguments) => replay::replay(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Recover(arguments) => recover::recover(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Scenarios(arguments) => scenarios::scenarios(&arguments),
        Command::View(arguments) => view::view(&arguments),
    };
    ExitCode::from(output::ended(exit) as u8)
}

/// Prints what clap says, with a hint where the shell is the cause: a mistake, the help or the version.
fn refuse(error: &clap::Error) -> ExitCode {
    if error.use_stderr()
        && let Some(hint) = hint::unquoted_list(std::env::args().skip(1))
    {
        eprintln!("error: {hint}");
    }
    // As clap itself has it: a closed pipe ends the output.
    let _ = error.print();
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(Exit::BadInput as u8))
}

/// Prints `text`, or as much of it as somebody reads: one who closes the pipe has seen enough.
fn print_text(text: &str) -> Exit {
    use std::io::{ErrorKind, Write, stdout};
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Exit::Done,
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Exit::Done,
        Err(error) => {
            complain(&format!("cannot write to standard output: {error}"));
            Exit::RunFailed
        }
    }
}

/// Says what went wrong.
fn complain(error: &dyn std::fmt::Display) {
    eprintln!("error: {error}");
}
