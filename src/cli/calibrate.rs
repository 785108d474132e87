//! `grainflow calibrate`.

use std::path::PathBuf;

use clap::Args;

use super::progress::Progress;
use super::run::{STOP, prepare};
use super::{Exit, complain};
use crate::campaign::calibrate::{CalibrationError, Request};
use crate::number::with_error;
use crate::report::calibration::Calibration;
use crate::scenario::Overrides;
use crate::statistics::Estimate;

/// Measure p(b) and p(ν) in event-driven runs, as tables for the stochastic engines
#[derive(Args, Debug)]
pub(super) struct CalibrateArguments {
    /// A scenario file, or the name of a built-in scenario (see `grainflow scenarios`)
    #[arg(value_name = "SCENARIO")]
    scenario: String,

    /// Folder to write to [default: out/<scenario>-calibrate]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Event-driven runs, each from an initial state of its own
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    replicas: u32,

    /// Seed of the first run, from 0 to 2^63 - 1; others count on from it
    #[arg(long, value_name = "N", value_parser = super::input::seed, allow_negative_numbers = true)]
    seed: Option<u64>,

    /// Change one key, as in particles.count=500 or gravity[1]=-2; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,

    /// Replace the calibration that the folder holds once the new one is complete
    #[arg(long)]
    force: bool,

    /// Threads to use, one for each run [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

pub(super) fn calibrate(arguments: &CalibrateArguments) -> Exit {
    if let Err(error) = prepare(arguments.threads) {
        complain(&error);
        return Exit::RunFailed;
    }
    let overrides = Overrides { sets: arguments.sets.clone(), engine: None, seed: arguments.seed };
    let request = Request {
        source: &arguments.scenario,
        overrides: &overrides,
        replicas: arguments.replicas,
        folder: arguments.out.as_deref(),
        force: arguments.force,
    };
    let mut progress = Progress::new(arguments.quiet);
    let result = crate::campaign::calibrate::calibrate(&request, &STOP, &mut |status| progress.tell(status));
    progress.finish();
    match result {
        Ok((folder, calibration)) => {
            if !arguments.quiet {
                print!("{}", closing_words(&calibration));
                println!("wrote {}", folder.join("calibration.html").display());
            }
            Exit::Done
        }
        Err(error) => {
            complain(&error);
            match error {
                CalibrationError::Interrupted => Exit::Interrupted,
                _ if error.is_bad_input() => Exit::BadInput,
                _ => Exit::RunFailed,
            }
        }
    }
}

/// c and p at both ends of what was measured.
fn closing_words(calibration: &Calibration) -> String {
    let shown = |estimate: Estimate| with_error(estimate.value, estimate.standard_error);
    let mut text = format!("{}: {} event-driven runs\n", calibration.scenario, calibration.replicas);
    if let (Some(first), Some(last)) = (calibration.stages.first(), calibration.stages.last()) {
        for stage in [first, last] {
            let place = stage.place();
            text += &format!("  c = {} at {place:.1} collisions per particle\n", shown(stage.c));
        }
        text += "  to use it: [engine] impact_parameter = { table = \"impact.csv\" }\n";
    }
    if let (Some(first), Some(last)) = (calibration.entries.first(), calibration.entries.last()) {
        for entry in [first, last] {
            text += &format!("  p = {} at ν = {:.3}\n", shown(entry.probability), entry.volume_fraction);
        }
        text += "  to use it: [engine.hsmc] entry_probability = { table = \"entry.csv\" }\n";
    }
    text
}
