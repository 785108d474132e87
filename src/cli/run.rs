//! `grainflow run`.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use clap::Args;
use serde_json::{Map, Value};

use super::input::ScenarioInput;
use super::progress::Progress;
use super::{Exit, complain};
use crate::comparison::unit_of;
use crate::machine::Machine;
use crate::number::{figure_with_unit, plain};
use crate::observe::measure::Figure;
use crate::run::folder::REPORT;
use crate::run::resume::{ResumeError, Resumption};
use crate::run::series::unit_name;
use crate::run::{Outcome, RunError};
use crate::scenario::check::check_on;
use crate::scenario::model::{AnyScenario, Units};
use crate::simulation::figures::{figure_of, figures_of};
use crate::stopwatch::Stopwatch;

const RESUMING: &str =
    "With --resume the new folder holds the whole run, to the same bits as without interruption;
what was resumed stays as it is. --out is by default the folder of the log with -resumed behind.
--set may give a later end (run.*), other records (record.*) or another cure of inelastic collapse
(engine.event_driven.collapse); the rest of the scenario stays.

  grainflow run --resume out/heap-hsmc
  grainflow run --resume out/shear-hsmc --set run.collisions_per_particle=800";

/// Run a scenario and write a run folder: log, tables, summary, report
#[derive(Args, Debug)]
#[command(after_help = RESUMING)]
pub(super) struct RunArguments {
    #[command(flatten)]
    input: ScenarioInput,

    /// SCENARIO is a log or a run folder: go on from its last complete state
    #[arg(long)]
    resume: bool,

    /// Folder to write to [default: out/<scenario>-<engine>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace the run that the folder holds once the new one is complete
    #[arg(long)]
    force: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// Set by the first interrupt: the run ends at its next step.
pub(super) static STOP: AtomicBool = AtomicBool::new(false);
/// Since when the user has asked to stop.
static FIRST_INTERRUPT: OnceLock<Stopwatch> = OnceLock::new();
/// Two interrupts that are not farther apart are one [s].
const SAME_INTERRUPT: f64 = 0.5;

pub(super) fn run(arguments: &RunArguments) -> Exit {
    if arguments.resume {
        return resume(arguments);
    }
    let scenario = match arguments.input.load() {
        Ok(scenario) => scenario,
        Err(error) => {
            complain(&error);
            return Exit::BadInput;
        }
    };
    if let Err(error) = prepare(arguments.threads) {
        complain(&error);
        return Exit::RunFailed;
    }
    let folder = arguments.out.clone().unwrap_or_else(|| usual_folder(&scenario));
    if !arguments.quiet {
        warn(&scenario, &folder);
    }
    let mut progress = Progress::new(arguments.quiet);
    let result =
        crate::run::run(&scenario, &folder, arguments.force, &STOP, &mut |status| progress.tell(status));
    progress.finish();
    conclude(result, arguments.quiet)
}

/// `run --resume`.
fn resume(arguments: &RunArguments) -> Exit {
    let input = &arguments.input;
    let options = [("--engine", input.engine.is_some()), ("--seed", input.seed.is_some())];
    if let Some((option, _)) = options.into_iter().find(|(_, given)| *given) {
        complain(&ResumeError::Change(option.to_owned()));
        return Exit::BadInput;
    }
    if let Err(error) = prepare(arguments.threads) {
        complain(&error);
        return Exit::RunFailed;
    }
    let resumption = match Resumption::open(Path::new(&input.scenario), &input.sets) {
        Ok(resumption) => resumption,
        Err(error) => {
            complain(&error);
            return Exit::BadInput;
        }
    };
    let mut progress = Progress::new(arguments.quiet);
    if !arguments.quiet {
        print!("{}", opening_words(&resumption));
    }
    let folder = arguments.out.clone().unwrap_or_else(|| resumption.usual_folder());
    let result = resumption.run(&folder, arguments.force, &STOP, &mut |status| progress.tell(status));
    progress.finish();
    conclude(result, arguments.quiet)
}

/// Where a run goes on.
fn opening_words(resumption: &Resumption) -> String {
    let log = resumption.log().display();
    let cut_off = resumption.cut_off().map(|sentence| format!("{sentence}\n")).unwrap_or_default();
    let anew = match resumption.begun_anew() {
        [] => String::new(),
        names => format!(
            "the log is of an earlier version, in which these measures remember other things: {}; they begin anew here, and \
             their figures are those of what follows\n",
            names.join(", ")
        ),
    };
    cut_off
        + &anew
        + &match resumption.time() {
            Some(time) => format!("goes on from the state at t = {} in {log}\n", plain(time, 6)),
            None => format!("{log} holds no complete state: the run begins again from its scenario\n"),
        }
}

/// Says how a run has ended.
fn conclude(result: Result<Outcome, RunError>, quiet: bool) -> Exit {
    match result {
        Ok(outcome) => {
            if !quiet {
                print!("{}", closing_words(&outcome));
            }
            if outcome.interrupted { Exit::Interrupted } else { Exit::Done }
        }
        Err(error) => {
            complain(&error);
            if error.is_bad_input() { Exit::BadInput } else { Exit::RunFailed }
        }
    }
}

/// Says what may spoil the run, before it hurts.
fn warn(scenario: &AnyScenario, folder: &Path) {
    for warning in check_on(scenario, Machine::holding(folder)).warnings {
        eprintln!("warning: {warning}");
    }
}

/// Starts the threads and listens for Ctrl-C and SIGTERM: the first ends the run cleanly, a
/// second ends the program at once. `timeout` and some shells send one signal twice in a row: that counts once.
pub(super) fn prepare(threads: Option<u16>) -> Result<(), Box<dyn std::error::Error>> {
    let taken = threads_taken(threads).unwrap_or(0);
    if let Some(wanted) = threads.filter(|&wanted| usize::from(wanted) > taken) {
        eprintln!(
            "note: --threads {wanted} is more than this machine can use; {taken} are taken, with the same result"
        );
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(taken)
        .build_global()
        .map_err(|error| format!("cannot start the threads: {error}; ask for fewer with --threads"))?;
    ctrlc::set_handler(|| {
        STOP.store(true, SeqCst);
        if FIRST_INTERRUPT.get_or_init(Stopwatch::default).seconds() > SAME_INTERRUPT {
            std::process::exit(Exit::Interrupted as i32);
        }
    })?;
    Ok(())
}

/// As many threads as were asked for, but no more than what only makes them hinder each other: results are the same bits for
/// any number of them.
pub(super) fn threads_taken(wanted: Option<u16>) -> Option<usize> {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    wanted.map(|wanted| usize::from(wanted).min((4 * cores).max(64)))
}

fn usual_folder(scenario: &AnyScenario) -> PathBuf {
    let (name, engine) = match scenario {
        AnyScenario::Two(scenario) => (&scenario.name, scenario.engine.kind),
        AnyScenario::Three(scenario) => (&scenario.name, scenario.engine.kind),
    };
    PathBuf::from("out").join(format!("{name}-{}", engine.name()))
}

/// The figures of a summary, a line each: value, error and unit, or that it is not steady.
fn figure_lines(summary: &Map<String, Value>, units: &Units) -> String {
    let dimension = summary.get("dimension").and_then(Value::as_u64).unwrap_or(2) as usize;
    let figures: Vec<Figure> = figures_of(summary).filter_map(|name| figure_of(summary, name)).collect();
    let width = figures.iter().map(|figure| figure.name.len()).max().unwrap_or(0);
    let line = |figure: &Figure| {
        let unit = unit_name(unit_of(&figure.name, dimension), units);
        let unit = if unit == "1" { "" } else { &unit };
        let value = figure_with_unit(figure.value?, figure.standard_error, figure.trend, unit);
        Some(format!("  {:<width$}  {value}\n", figure.name))
    };
    figures.iter().filter_map(line).collect()
}

/// What a user wants to know when a run has ended.
fn closing_words(outcome: &Outcome) -> String {
    let mut text = String::new();
    let summary = &outcome.summary;
    let number = |key: &str| summary.get(key).and_then(Value::as_f64);
    let ended = match outcome.interrupted {
        true => "interrupted".to_owned(),
        false => format!("ended by its limit on {}", summary["end_reason"].as_str().unwrap_or("?")),
    };
    text += &format!(
        "{} with {}: {ended} at t = {}, {} collisions per particle, {}, {:.1} s{}\n",
        summary["scenario"].as_str().unwrap_or("?"),
        summary["engine"].as_str().unwrap_or("?"),
        plain(number("simulated_time").unwrap_or(0.0), 6),
        plain(number("collisions_per_particle").unwrap_or(0.0), 4),
        match summary["events"].as_u64() {
            Some(events) => format!("{events} events"),
            None => format!("{} steps", summary["steps"]),
        },
        number("wall_seconds").unwrap_or(0.0),
        number("resumed_at").map(|time| format!(" since t = {}", plain(time, 6))).unwrap_or_default(),
    );
    text += &figure_lines(summary, &outcome.units);
    let total: f64 = outcome.laps.iter().map(|(_, seconds)| seconds).sum();
    let laps: Vec<String> = outcome
        .laps
        .iter()
        .filter(|(_, seconds)| *seconds >= 0.01 * total)
        .map(|(verb, seconds)| format!("{verb} {:.0} %", 100.0 * seconds / total))
        .collect();
    text += &format!("  time went to: {}\n", laps.join(", "));
    if let Some(speed) = number("particle_steps_per_second") {
        text += &format!("  {:.1} million particle-steps per second\n", speed * 1e-6);
    }
    if let Some(speed) = number("events_per_second") {
        text += &format!("  {:.2} million events per second\n", speed * 1e-6);
    }
    text += &format!("wrote {}\n", outcome.folder.join(REPORT).display());
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_rounded_to_their_errors_and_have_units() {
        let summary = serde_json::json!({
            "dimension": 3,
            "wall_shear_stress": 0.00130992, "wall_shear_stress_standard_error": 3.04e-5,
            "wall_shear_stress_steady": true, "wall_shear_stress_trend": null,
            "pressure": 264_960.0, "pressure_standard_error": 5.38e-11,
            "mean_free_time": 5.561e-11, "mean_free_time_standard_error": 3.58e-13,
            "heap_slope": 0.7546123, "heap_slope_standard_error": 0.003,
            "heap_slope_steady": false, "heap_slope_trend": "rising",
            "flow_velocity": 12.8, "flow_velocity_standard_error": 0.2,
            "flow_velocity_steady": false, "flow_velocity_trend": "wandering",
            "temperature": 3.0, "spectrum_slope": null, "spectrum_slope_standard_error": null,
        });
        let units = Units { length: "m".to_owned(), mass: "kg".to_owned(), time: "s".to_owned() };
        let lines = figure_lines(summary.as_object().unwrap(), &units);
        let expected = "  wall_shear_stress  0.001310 ± 0.000030 kg/(m·s^2)
  pressure           264\u{202f}960 kg/(m·s^2)
  mean_free_time     (5.561 ± 0.036) × 10⁻¹¹ s
  heap_slope         not steady (rising, mean 0.755)
  flow_velocity      not steady (wandering, mean 12.8 m/s)
";
        assert_eq!(lines, expected);
    }
}
