//! `grainflow compare`.

use std::path::PathBuf;
use std::sync::Mutex;

use clap::Args;

use super::progress::Progress;
use super::run::{STOP, prepare};
use super::{Exit, complain};
use crate::campaign::compare::{
    CompareError, Listener, Options, Outcome, Plan, Wish, compare as compare_engines, compare_logs,
};
use crate::comparison::model::Comparison;
use crate::report::{Judgement, judgements};
use crate::scenario::Overrides;

/// Sentences of differences that are printed for an engine; the page has all.
const SENTENCES: usize = 4;

/// Compare engines from the same grains, or stored runs, and say where they agree
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct CompareArguments {
    /// A scenario file, or the name of a built-in one; or two or more logs or run folders
    #[arg(value_name = "SCENARIO | LOG LOG", required = true)]
    inputs: Vec<String>,

    /// Engines, two or more [default: the scenario's own and event-driven]
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    engines: Option<Vec<String>>,

    /// Initial states, each through every engine [default: 4; 1 if it starts from a log]
    ///
    /// Standard errors come from their scatter; of one alone, from blocks in time.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    replicas: Option<u32>,

    /// Measures to record and compare, in place of the scenario's record.measures
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    measures: Option<Vec<String>>,

    /// Replicas side by side, each on its share of the threads; costs are then left out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    jobs: Option<u16>,

    /// Seed from which every replica draws its own, from 0 to 2^63 - 1
    #[arg(long, value_name = "N", value_parser = super::input::seed, allow_negative_numbers = true)]
    seed: Option<u64>,

    /// Change one key for all engines, as in particles.count=500; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,

    /// Folder to write to [default: out/<scenario>-compare; out/compare for logs]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace the comparison that the folder holds once the new one is complete
    #[arg(long)]
    force: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

const EXAMPLES: &str = "Examples:
  grainflow compare cooling                      hsmc and event-driven, into out/cooling-compare
  grainflow compare clustering --engines hsmc,cba,dsmc,event-driven --replicas 2
      --set engine.event_driven.collapse.contact_time=1e-4
  grainflow compare out/heap-hsmc out/heap-event-driven --out heaps";

pub(super) fn compare(arguments: &CompareArguments) -> Exit {
    let result = match &arguments.inputs[..] {
        [scenario] if !is_log(scenario) => of_scenario(arguments, scenario),
        logs => of_logs(arguments, logs),
    };
    match result {
        Ok(outcome) => {
            if !arguments.quiet {
                print!("{}", closing_words(&outcome));
            }
            let failures = outcome.comparison.contestants.iter().flat_map(|one| &one.failures);
            if outcome.interrupted {
                return Exit::Interrupted;
            }
            if failures.count() > 0 { Exit::RunFailed } else { Exit::Done }
        }
        Err(exit) => exit,
    }
}

/// Whether `path` is there and can only be a stored run.
fn is_log(path: &str) -> bool {
    let path = std::path::Path::new(path);
    path.is_dir() || (path.is_file() && path.extension().is_some_and(|ending| ending == "mcap"))
}

fn of_scenario(arguments: &CompareArguments, scenario: &str) -> Result<Outcome, Exit> {
    let wish = Wish {
        source: scenario.to_owned(),
        overrides: Overrides { sets: arguments.sets.clone(), engine: None, seed: arguments.seed },
        engines: arguments.engines.clone(),
        measures: arguments.measures.clone(),
        replicas: arguments.replicas,
    };
    let plan = Plan::new(&wish).map_err(|error| {
        complain(&error);
        Exit::BadInput
    })?;
    prepare(arguments.threads).map_err(|error| {
        complain(&error);
        Exit::RunFailed
    })?;
    let usual = || PathBuf::from("out").join(format!("{}-compare", plan.name()));
    let out = arguments.out.clone().unwrap_or_else(usual);
    let jobs = arguments.jobs.map_or(1, usize::from);
    let progress = Mutex::new(Progress::new(arguments.quiet));
    let tell: Listener<'_> = &|moment| {
        // Whoever cannot show how it goes runs on.
        if let Ok(mut progress) = progress.lock() {
            let name = format!("{} {}/{}: ", moment.engine, moment.replica, moment.replicas);
            progress.tell_part(&name, moment.progress, &moment.status);
        }
    };
    let result = compare_engines(&plan, Options { out: &out, force: arguments.force, jobs }, &STOP, tell);
    if let Ok(progress) = progress.lock() {
        progress.finish();
    }
    result.map_err(|error| told(&error))
}

fn of_logs(arguments: &CompareArguments, logs: &[String]) -> Result<Outcome, Exit> {
    let of_scenarios = [
        ("--engines", arguments.engines.is_some()),
        ("--replicas", arguments.replicas.is_some()),
        ("--measures", arguments.measures.is_some()),
        ("--jobs", arguments.jobs.is_some()),
        ("--seed", arguments.seed.is_some()),
        ("--set", !arguments.sets.is_empty()),
    ];
    if let Some((option, _)) = of_scenarios.iter().find(|(_, given)| *given) {
        complain(&format!(
            "{option}: belongs to a scenario, and logs are compared as they are; leave it out"
        ));
        return Err(Exit::BadInput);
    }
    let logs: Vec<PathBuf> = logs.iter().map(PathBuf::from).collect();
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/compare"));
    compare_logs(&logs, &out, arguments.force).map_err(|error| told(&error))
}

/// Says what went wrong.
fn told(error: &CompareError) -> Exit {
    complain(error);
    match error {
        CompareError::Nothing { interrupted: true, .. } => Exit::Interrupted,
        error if error.is_bad_input() => Exit::BadInput,
        _ => Exit::RunFailed,
    }
}

/// What a user wants to know when a comparison has ended.
fn closing_words(outcome: &Outcome) -> String {
    let comparison = &outcome.comparison;
    let mut text = String::new();
    for judgement in judgements(comparison) {
        text += &verdicts(comparison, &judgement);
    }
    for contestant in &comparison.contestants {
        for failure in &contestant.failures {
            text += &format!("{}: {failure}\n", contestant.label);
        }
    }
    for remark in &comparison.remarks {
        text += &format!("note: {remark}\n");
    }
    text + &costs(comparison) + &format!("wrote {}\n", outcome.folder.join("comparison.html").display())
}

/// One engine beside the reference.
fn verdicts(comparison: &Comparison, judgement: &Judgement) -> String {
    let reference = &comparison.contestants[comparison.reference].label;
    if judgement.quantities() == 0 {
        return format!("{}: no quantity could be compared with {reference}\n", judgement.engine);
    }
    let mut text = format!(
        "{} agrees with {reference} in {} of {} quantities\n",
        judgement.engine,
        judgement.agreeing,
        judgement.quantities()
    );
    for sentence in judgement.differing.iter().take(SENTENCES) {
        text += &format!("  {sentence}\n");
    }
    let more = judgement.differing.len().saturating_sub(SENTENCES);
    if more > 0 {
        text += &format!("  and {more} more\n");
    }
    if judgement.unknown > 0 {
        text += &format!("  {} without errors to judge by\n", judgement.unknown);
    }
    for sentence in judgement.not_steady.iter().take(SENTENCES) {
        text += &format!("  {sentence}\n");
    }
    let more = judgement.not_steady.len().saturating_sub(SENTENCES);
    if more > 0 {
        text += &format!("  and {more} more that are not steady\n");
    }
    text
}

/// Seconds of each engine and how they stand to the reference.
fn costs(comparison: &Comparison) -> String {
    let exact = comparison.contestants[comparison.reference].cost;
    let mut text = String::new();
    for contestant in &comparison.contestants {
        let Some(cost) = contestant.cost else { continue };
        text += &format!(
            "{:<14} {:.3} s advancing, {:.3} s in all",
            contestant.label, cost.advancing_seconds, cost.wall_seconds
        );
        let ratio = exact.map(|exact| exact.advancing_seconds / cost.advancing_seconds);
        if let Some(ratio) = ratio.filter(|ratio| ratio.is_finite() && *ratio != 1.0) {
            text += &format!(", {ratio:.3} times as fast");
        }
        text.push('\n');
    }
    text
}
