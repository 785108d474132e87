//! `grainflow export`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::run::{STOP, prepare};
use super::span::Span;
use super::{Exit, complain, print_text};
use crate::export::{ExportError, Format, Outcome, Request};
use crate::record::log_at;

/// Write the grains of a log in a format that OVITO, ParaView or pandas opens
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct ExportArguments {
    /// A log, or a run folder
    #[arg(value_name = "LOG")]
    log: PathBuf,

    /// Format to write
    #[arg(long, value_name = "FORMAT")]
    format: FormatName,

    /// File to write, or folder for vtp and vti [default: beside the log, named after it]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,

    #[command(flatten)]
    span: Span,

    /// Export the saved states at full precision, all grains, in place of the frames
    #[arg(long)]
    states: bool,

    /// vti: side of the cells that fields are taken in [default: the scenario's cells]
    #[arg(long, value_name = "L", allow_negative_numbers = true)]
    cell_size: Option<f64>,

    /// Replace an older export
    #[arg(long)]
    force: bool,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// The formats by the names that users give them.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    /// LAMMPS text dump, one file: OVITO, VMD
    Lammps,
    /// Points of VTK, a file for each frame and a .pvd with the times: ParaView, OVITO
    Vtp,
    /// Fields on a grid, a file for each frame and a .pvd with the times: ParaView
    Vti,
    /// Extended XYZ, one file: OVITO, ASE
    Xyz,
    /// One long table: pandas, spreadsheets
    Csv,
}

impl FormatName {
    fn format(self) -> Format {
        match self {
            FormatName::Lammps => Format::Lammps,
            FormatName::Vtp => Format::Vtp,
            FormatName::Vti => Format::Vti,
            FormatName::Xyz => Format::Xyz,
            FormatName::Csv => Format::Csv,
        }
    }
}

const EXAMPLES: &str = "Examples:
  grainflow export out/heap-hsmc --format lammps             out/heap-hsmc/log.lammpstrj, for OVITO
  grainflow export out/heap-hsmc --format vtp --out heap     heap/particles.pvd, for ParaView
  grainflow export out/heap-hsmc --format vti --states --cell-size 4
  grainflow export out/heap-hsmc --format csv --from 1000 --every 10";

pub(super) fn export(arguments: &ExportArguments) -> Exit {
    let log = log_at(&arguments.log);
    let format = arguments.format.format();
    let out = arguments.out.clone().unwrap_or_else(|| format.usual_place(&log));
    let selection = match arguments.span.selection().and_then(|selection| {
        check_cell_size(arguments.cell_size, format)?;
        Ok(selection)
    }) {
        Ok(selection) => selection,
        Err(mistake) => {
            complain(&mistake);
            return Exit::BadInput;
        }
    };
    if let Err(error) = prepare(None) {
        complain(&error);
        return Exit::RunFailed;
    }
    let request = Request {
        log: &log,
        format,
        out: &out,
        selection,
        states: arguments.states,
        cell_size: arguments.cell_size,
        force: arguments.force,
    };
    match crate::export::export(&request, &STOP) {
        Ok(outcome) => {
            notes(&outcome, format).iter().for_each(|note| eprintln!("note: {note}"));
            if arguments.quiet { Exit::Done } else { print_text(&closing_words(&outcome, arguments.states)) }
        }
        Err(error) => {
            complain(&error);
            match error {
                ExportError::Interrupted => Exit::Interrupted,
                _ if error.is_bad_input() => Exit::BadInput,
                _ => Exit::RunFailed,
            }
        }
    }
}

fn check_cell_size(side: Option<f64>, format: Format) -> Result<(), String> {
    match side {
        Some(_) if format != Format::Vti => {
            Err("--cell-size: belongs to --format vti, whose fields have cells; leave it out".to_owned())
        }
        Some(side) if !(side.is_finite() && side > 0.0) => {
            Err(format!("--cell-size {side}: has to be a length above 0"))
        }
        _ => Ok(()),
    }
}

/// What should be known of what was written.
fn notes(outcome: &Outcome, format: Format) -> Vec<String> {
    let mut notes: Vec<String> = outcome.cut_off.iter().cloned().collect();
    if outcome.thinned > 0 {
        let effect = match format {
            Format::Vti => "fields count each for as many as it stands for",
            _ => "record.points = \"all\" keeps all in the frames of a new run",
        };
        notes.push(format!(
            "{} of {} frames are thinned, to {} of up to {} grains; {effect}, --states has all",
            outcome.thinned, outcome.moments, outcome.most_points, outcome.most_grains
        ));
    }
    notes
}

fn closing_words(outcome: &Outcome, states: bool) -> String {
    let what = match (states, outcome.moments) {
        (true, 1) => "state",
        (true, _) => "states",
        (false, 1) => "frame",
        (false, _) => "frames",
    };
    let precision = if states { "full" } else { "single" };
    format!(
        "{} {what} of up to {} grains, {precision} precision\nwrote {}\n",
        outcome.moments,
        outcome.most_points,
        outcome.place.display()
    )
}
