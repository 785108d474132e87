//! `grainflow replay`.

mod info;
mod page;
mod pictures;
mod play;
mod table;
mod verify;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::span::Span;
use super::{Exit, complain};
use crate::export::target::{Target, TargetError};
use crate::record::error::LogError;
use crate::record::log_at;
use crate::replay::compute::{Basis, ComputeError};
use crate::replay::selection::Selection;

/// Play a log back: its measures as CSV, pictures, a report, a film in the terminal
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct ReplayArguments {
    /// A log, or a run folder
    #[arg(value_name = "LOG")]
    log: PathBuf,

    #[command(flatten)]
    span: Span,

    #[command(flatten)]
    tables: TableOptions,

    #[command(flatten)]
    pictures: PictureOptions,

    #[command(flatten)]
    verification: verify::VerifyOptions,

    /// Tell what the log holds, and nothing else
    #[arg(long, conflicts_with_all = ["from", "to", "every", "measures", "source", "series", "profiles", "frames", "report", "speed", "verify"])]
    info: bool,

    /// Replace what stands where something is to be written
    #[arg(long)]
    force: bool,
}

/// Measures as tables of comma-separated values.
#[derive(Args, Debug)]
#[command(next_help_heading = "Tables (comma-separated values)")]
struct TableOptions {
    /// Only these measures; those that the run did not take are computed
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    measures: Option<Vec<String>>,

    /// What measures are computed from [default: states, or frames where there are none]
    #[arg(long, value_name = "SOURCE", requires = "measures")]
    source: Option<Source>,

    /// Write the series into this file instead of printing it
    #[arg(long, value_name = "FILE")]
    series: Option<PathBuf>,

    /// Write each kind of profile into a file of this folder
    #[arg(long, value_name = "DIR")]
    profiles: Option<PathBuf>,
}

/// Pictures and pages.
#[derive(Args, Debug)]
#[command(next_help_heading = "Pictures")]
struct PictureOptions {
    /// Write a picture (PNG) of every frame into this folder
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,

    /// Width of the pictures in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(16..=8000), requires = "frames")]
    width: u32,

    /// Write the report of the run, or of the part of it that is picked, into this file
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Play in the terminal, X units of simulated time in a second; Ctrl-C ends it
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with_all = ["measures", "source", "series", "profiles", "frames", "report"])]
    speed: Option<f64>,
}

/// What measures are computed from, by the names that users give.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Source {
    /// Saved states: full precision, all grains, few times
    States,
    /// Frames: single precision, many times
    Frames,
}

impl Source {
    fn basis(self) -> Basis {
        match self {
            Source::States => Basis::States,
            Source::Frames => Basis::Frames,
        }
    }
}

const EXAMPLES: &str = "Examples:
  grainflow replay out/heap-hsmc > series.csv                  the series of the run
  grainflow replay out/heap-hsmc --info                        what the log holds
  grainflow replay out/heap-hsmc --measures pair-correlation   a measure that the run did not take
  grainflow replay out/heap-hsmc --from 3000 --every 4 --frames pictures
  grainflow replay out/heap-hsmc --speed 200                   in the terminal
  grainflow replay out/heap-hsmc --verify                      run it again, compare bit for bit";

pub(super) fn replay(arguments: &ReplayArguments) -> Exit {
    if arguments.verification.verify {
        return verify::run_again(&arguments.log, &arguments.verification);
    }
    let log = log_at(&arguments.log);
    let selection = match arguments.span.selection() {
        Ok(selection) => selection,
        Err(mistake) => return bad_input(&mistake),
    };
    if arguments.info {
        return info::info(&log);
    }
    if let Some(speed) = arguments.pictures.speed {
        return play::play(&log, selection, speed);
    }
    let work = Work { log: &log, selection, is_part: arguments.span.is_given(), force: arguments.force };
    done(work.all(arguments))
}

/// What all modes but the terminal need.
#[derive(Clone, Copy, Debug)]
struct Work<'a> {
    log: &'a Path,
    selection: Selection,
    /// Whether less than everything was asked for.
    is_part: bool,
    force: bool,
}

impl Work<'_> {
    /// Everything that was asked for; the series on standard output where that is nothing else.
    fn all(&self, arguments: &ReplayArguments) -> Result<Exit, Failure> {
        let pictures = &arguments.pictures;
        let tables = &arguments.tables;
        if let Some(folder) = &pictures.frames {
            self.pictures(folder, pictures.width)?;
        }
        if let Some(file) = &pictures.report {
            self.page(file)?;
        }
        let others = pictures.frames.is_some() || pictures.report.is_some();
        if tables.series.is_some() || tables.profiles.is_some() || tables.measures.is_some() || !others {
            return self.tables(tables);
        }
        Ok(Exit::Done)
    }
}

/// Why nothing came of it.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Log(#[from] LogError),
    #[error(transparent)]
    Compute(#[from] ComputeError),
    #[error(transparent)]
    Target(#[from] TargetError),
    #[error("{0}")]
    Input(String),
    #[error("interrupted; the files that were not complete are taken away")]
    Interrupted,
}

fn done(result: Result<Exit, Failure>) -> Exit {
    match result {
        Ok(exit) => exit,
        Err(failure) => {
            complain(&failure);
            match failure {
                Failure::Interrupted => Exit::Interrupted,
                Failure::Target(error) if !error.is_bad_input() => Exit::RunFailed,
                _ => Exit::BadInput,
            }
        }
    }
}

fn bad_input(mistake: &str) -> Exit {
    complain(&mistake);
    Exit::BadInput
}

/// Writes `text` to `file`, whole or not at all.
fn write_file(file: &Path, text: &str, force: bool, option: &'static str) -> Result<(), TargetError> {
    use std::io::Write;
    let target = Target::file(file, force, option)?;
    let mut out = target.create()?;
    let written = out.write_all(text.as_bytes()).and_then(|()| out.sync_all());
    written.map_err(|source| target.failed(source))?;
    println!("wrote {}", target.settle()?.display());
    Ok(())
}
