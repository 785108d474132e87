//! `grainflow sweep`.

use std::io::{IsTerminal, stderr};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::run::{STOP, prepare, threads_taken};
use super::{Exit, complain};
use crate::campaign::sweep::{Ended, Moment, Options, Outcome, Plan, SweepError, Wish, sweep as make};
use crate::number::with_error;
use crate::report::{FigureCurve, SweepFigure, SweepReport};

/// Figures that the last words show; the page has all.
const SHOWN_FIGURES: usize = 4;
/// Rows that the last words show of each.
const SHOWN_ROWS: usize = 24;
/// A smaller share of a run is not worth a look at the bar.
const LEAST_PROGRESS: f64 = 2e-3;
/// Steps of the bar for each run.
const BAR_LENGTH: f64 = 1000.0;

/// Run a scenario once for every value of what varies: one table, one page of plots
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct SweepArguments {
    /// A scenario file, or the name of a built-in scenario (see `grainflow scenarios`)
    #[arg(value_name = "SCENARIO")]
    scenario: String,

    /// A key and its values: key=[a, b, c], key=linear(from, to, count), key=log(…)
    ///
    /// 'a=[…] + b=[…]' moves keys together; several --vary make a grid.
    #[arg(long = "vary", value_name = "KEY=[A,B,C]")]
    varies: Vec<String>,

    /// Engines to sweep over
    #[arg(long, visible_alias = "engine", value_name = "A,B", value_delimiter = ',')]
    engines: Vec<String>,

    /// Runs of every case, the first with the seed, the others with seeds drawn from it
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000), allow_negative_numbers = true)]
    replicas: u32,

    /// Runs side by side, each on its share of the threads
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    jobs: u16,

    /// A number of the summaries to plot; may be repeated [default: the scenario's own figures]
    #[arg(long = "figure", value_name = "NAME")]
    figures: Vec<String>,

    /// Folder to write to [default: out/<scenario>-sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace other runs in the folders of cases; finished runs of the same cases stay
    #[arg(long)]
    force: bool,

    /// Seed of all random numbers, from 0 to 2^63 - 1
    #[arg(long, value_name = "N", value_parser = super::input::seed, allow_negative_numbers = true)]
    seed: Option<u64>,

    /// Change one key in every case, as in particles.count=500; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

const EXAMPLES: &str = "Examples:
  grainflow sweep heap --vary particles.restitution=[0.9,0.7,0.5] --replicas 3 --figure heap_slope
  grainflow sweep shear --figure wall_shear_stress --vary \\
      'boundary.y.lower.velocity[0]=[-0.05,-0.5,-5] + boundary.y.upper.velocity[0]=[0.05,0.5,5]'

The same command again keeps the runs that are finished and makes those that are missing.";

pub(super) fn sweep(arguments: &SweepArguments) -> Exit {
    match try_sweep(arguments) {
        Ok(outcome) => {
            let count = |test: fn(&Ended) -> bool| outcome.rows.iter().filter(|row| test(&row.ended)).count();
            if count(|ended| matches!(ended, Ended::Interrupted | Ended::NotRun)) > 0 {
                return Exit::Interrupted;
            }
            if count(|ended| matches!(ended, Ended::Failed(_))) > 0 { Exit::RunFailed } else { Exit::Done }
        }
        Err(exit) => exit,
    }
}

fn try_sweep(arguments: &SweepArguments) -> Result<Outcome, Exit> {
    let wish = Wish {
        source: arguments.scenario.clone(),
        sets: arguments.sets.clone(),
        seed: arguments.seed,
        varies: arguments.varies.clone(),
        engines: arguments.engines.clone(),
        replicas: arguments.replicas,
        figures: arguments.figures.clone(),
    };
    // Before the plan: its measures may ask for threads.
    prepare(arguments.threads).map_err(|error| {
        complain(&error);
        Exit::RunFailed
    })?;
    let plan = Plan::new(&wish).map_err(|error| told(&error))?;
    let usual = || PathBuf::from("out").join(format!("{}-sweep", plan.name()));
    let out = arguments.out.clone().unwrap_or_else(usual);
    let options = Options {
        out: &out,
        force: arguments.force,
        jobs: usize::from(arguments.jobs),
        threads: threads_taken(arguments.threads),
    };
    let progress = Mutex::new(Progress::new(&plan, arguments.quiet));
    let tell =
        |moment: &Moment<'_>| progress.lock().unwrap_or_else(PoisonError::into_inner).tell(&plan, moment);
    let outcome = make(&plan, &options, &STOP, &tell);
    progress.lock().unwrap_or_else(PoisonError::into_inner).finish();
    let outcome = outcome.map_err(|error| told(&error))?;
    if !arguments.quiet {
        print!("{}", closing_words(&outcome.report));
        println!("wrote {}", out.join("sweep.html").display());
    }
    Ok(outcome)
}

/// Says what went wrong.
fn told(error: &SweepError) -> Exit {
    complain(error);
    if error.is_bad_input() { Exit::BadInput } else { Exit::RunFailed }
}

/// How a sweep is going: a bar on a terminal, and a line for every run that ends.
struct Progress {
    bar: Option<ProgressBar>,
    quiet: bool,
    /// `[case]`, in [0, 1].
    shares: Vec<f64>,
    ended: usize,
}

impl Progress {
    fn new(plan: &Plan, quiet: bool) -> Self {
        let bar = (!quiet && stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new((plan.runs() as f64 * BAR_LENGTH) as u64);
            bar.set_style(
                ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {eta} left")
                    .expect("the template is part of the program"),
            );
            bar
        });
        Progress { bar, quiet, shares: vec![0.0; plan.runs()], ended: 0 }
    }

    fn tell(&mut self, plan: &Plan, moment: &Moment<'_>) {
        if let Some(why) = moment.remade.filter(|_| !self.quiet) {
            self.say(&format!("{}: was finished and is run again: {why}", plan.case(moment.case)));
        }
        // Steps may be many and short.
        if moment.ended.is_none() && moment.progress < self.shares[moment.case] + LEAST_PROGRESS {
            return;
        }
        self.shares[moment.case] = moment.progress;
        if let Some(bar) = &self.bar {
            bar.set_position((self.shares.iter().sum::<f64>() * BAR_LENGTH) as u64);
            bar.set_message(plan.case(moment.case).to_owned());
        }
        let Some(ended) = moment.ended else { return };
        self.ended += 1;
        let line = format!("{}: {}", plan.case(moment.case), ended.word());
        match ended {
            // A failure is said even to those who want to hear nothing else.
            Ended::Failed(error) => self.say(&format!("error: {line}: {error}")),
            _ if !self.quiet => self.say(&format!("{line}{}", seconds(moment))),
            _ => {}
        }
    }

    fn say(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| eprintln!("{line}")),
            None => eprintln!("{line}"),
        }
    }

    /// Leaves the line free.
    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn seconds(moment: &Moment<'_>) -> String {
    let seconds = moment.summary.and_then(|summary| summary.get("wall_seconds")?.as_f64());
    seconds.map_or_else(String::new, |seconds| format!(", {seconds:.1} s"))
}

/// What a user wants to know when a sweep has ended.
fn closing_words(report: &SweepReport) -> String {
    let count = |status: &str| report.cases.iter().filter(|case| case.status == status).count();
    let mut text = format!("{}: {} runs", report.scenario, report.cases.len());
    for status in ["done", "kept", "failed", "interrupted", "not run"] {
        if count(status) > 0 {
            text += &format!(", {} {status}", count(status));
        }
    }
    text += "\n";
    let with_points = |figure: &&SweepFigure| figure.curves.iter().any(|curve| !curve.points.is_empty());
    let figures: Vec<&SweepFigure> = report.figures.iter().filter(with_points).collect();
    for figure in figures.iter().take(SHOWN_FIGURES) {
        text += &format!("\n{}\n", figure.labelled(&figure.name));
        for curve in &figure.curves {
            text += &curve_words(report, curve);
        }
    }
    if figures.len() > SHOWN_FIGURES {
        text += &format!("\nand {} more figures on the page\n", figures.len() - SHOWN_FIGURES);
    }
    text + "\n"
}

/// The points of one curve, and its power law.
fn curve_words(report: &SweepReport, curve: &FigureCurve) -> String {
    let mut text = if curve.name.is_empty() { String::new() } else { format!("  {}\n", curve.name) };
    let abscissa = &report.abscissa;
    let value = |x: f64| {
        let place = abscissa.places.iter().position(|&place| place == x);
        place.map_or("?", |place| abscissa.values[place].as_str())
    };
    for point in curve.points.iter().take(SHOWN_ROWS) {
        text += &format!("  {} = {:<10} {}\n", abscissa.name, value(point.x), point.text());
    }
    if curve.points.len() > SHOWN_ROWS {
        text += &format!("  and {} more\n", curve.points.len() - SHOWN_ROWS);
    }
    if let Some(law) = curve.power_law {
        let exponent = with_error(law.exponent, Some(law.standard_error));
        text += &format!(
            "  power law: exponent {exponent}, all {}points within {:.1} %\n",
            if curve.not_steady() > 0 { "steady " } else { "" },
            100.0 * law.largest_deviation
        );
    }
    match curve.not_steady() {
        0 => {}
        1 => text += "  1 point is not steady: no fit takes it; a longer run may settle it\n",
        many => {
            text +=
                &format!("  {many} points are not steady: no fit takes them; longer runs may settle them\n")
        }
    }
    text
}
