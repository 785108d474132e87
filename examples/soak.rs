//! Under fire: random small scenarios, each run in every way that has to agree; long runs; readers that are fed
//! what is nearly right. As many cases as time allows.
//!
//! ```sh
//! cargo run --release --example soak -- --cases 1000 --seed 1
//! cargo run --release --example soak -- --minutes 3
//! cargo run --release --example soak -- --gravity 400
//! cargo run --release --example soak -- --long
//! cargo run --release --example soak -- --fuzz log --cases 1000000
//! ```

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for people")]

#[path = "../tests/soak/case.rs"]
mod case;
#[path = "../tests/soak/draw.rs"]
mod draw;
#[path = "../tests/soak/gravity.rs"]
mod gravity;
#[path = "../tests/soak/gravity_text.rs"]
mod gravity_text;
#[path = "../tests/soak/hostile.rs"]
mod hostile;
#[path = "../tests/soak/laws.rs"]
mod laws;
#[path = "../tests/soak/logs.rs"]
mod logs;
#[path = "../tests/soak/long.rs"]
mod long;
#[path = "../tests/soak/mutation.rs"]
mod mutation;
#[path = "../tests/soak/readers.rs"]
mod readers;
#[path = "../tests/soak/requests.rs"]
mod requests;
#[path = "../tests/soak/scaling.rs"]
mod scaling;
#[path = "../tests/soak/states.rs"]
mod states;
#[path = "../tests/soak/trial.rs"]
mod trial;
#[path = "../tests/soak/watch.rs"]
mod watch;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use hostile::{Fired, Range, TARGETS};
use trial::{Tally, trial};

/// After so many failures there is nothing new to see.
const MOST_FAILURES: u64 = 20;

/// Random small scenarios under fire
#[derive(Debug, Parser)]
struct Arguments {
    /// Cases to try
    #[arg(long, value_name = "N", conflicts_with = "minutes")]
    cases: Option<u64>,

    /// Minutes to go on for [default: 1, if no number of cases is given]
    #[arg(long, value_name = "M")]
    minutes: Option<f64>,

    /// Number of the first case
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,

    /// Print the scenario of the first case, or what is fired first, and do nothing
    #[arg(long)]
    show: bool,

    /// So many runs under gravity, each gone on with from every state of its log, in place of small scenarios
    #[arg(long, value_name = "N", conflicts_with_all = ["cases", "minutes"])]
    gravity: Option<u64>,

    /// Runs of a million steps and of a hundred million events, in place of small scenarios
    #[arg(long)]
    long: bool,

    /// Share of these lengths
    #[arg(long, value_name = "X", default_value_t = 1.0, requires = "long")]
    share: f64,

    /// Fire at a reader in place of running scenarios, or at all of them
    #[arg(long, value_name = "READER", value_parser = TARGETS.iter().copied().chain(["all"]).collect::<Vec<_>>())]
    fuzz: Option<String>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.show && arguments.fuzz.is_none() {
        let gravity = arguments.gravity.map(|_| gravity_text::drawn(arguments.seed).text);
        print!("{}", gravity.unwrap_or_else(|| draw::scenario_text(arguments.seed, draw::Units::ONE)));
        return ExitCode::SUCCESS;
    }
    let failures = match (&arguments.fuzz, arguments.gravity, arguments.long) {
        (Some(target), ..) => fuzz(&arguments, target),
        (None, Some(runs), _) => under_gravity(arguments.seed, runs),
        (None, None, true) => long_runs(arguments.share),
        (None, None, false) => scenarios(&arguments),
    };
    if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Numbers of cases, until there have been enough of them or the time is over.
fn seeds(arguments: &Arguments, parts: f64) -> impl Iterator<Item = u64> + use<> {
    let since = Instant::now();
    let timed = 60.0 * arguments.minutes.unwrap_or(1.0) / parts;
    let seconds = if arguments.cases.is_some() { f64::INFINITY } else { timed };
    let end = arguments.cases.map_or(u64::MAX, |cases| arguments.seed.saturating_add(cases));
    (arguments.seed..end).take_while(move |_| since.elapsed().as_secs_f64() < seconds)
}

fn scenarios(arguments: &Arguments) -> u64 {
    let since = Instant::now();
    let (mut tally, mut failures) = (Tally::default(), 0);
    for seed in seeds(arguments, 1.0) {
        if let Err(problem) = trial(seed, &mut tally) {
            eprintln!("{problem}\n");
            failures += 1;
        }
        if failures == MOST_FAILURES {
            break;
        }
    }
    println!(
        "{} cases held, {} refused, {failures} failed; {} collisions; {:.0} s",
        tally.held,
        tally.refused,
        tally.collisions,
        since.elapsed().as_secs_f64()
    );
    failures
}

fn under_gravity(first: u64, runs: u64) -> u64 {
    let since = Instant::now();
    let (mut tally, mut failures) = (gravity::Tally::default(), 0);
    for seed in first..first.saturating_add(runs) {
        if let Err(problem) = gravity::trial(seed, &mut tally) {
            eprintln!("{problem}\n");
            failures += 1;
        }
        if failures == MOST_FAILURES {
            break;
        }
    }
    let gravity::Tally { runs, states, failed, stopped, outrun, refused } = tally;
    println!(
        "{runs} runs under gravity held, {refused} refused, {failures} failed; {states} states, {outrun} of them with a grain \
         faster than the speed that sets the step; {failed} runs ended by a failure, {stopped} were stopped; {:.0} s",
        since.elapsed().as_secs_f64()
    );
    failures
}

fn long_runs(share: f64) -> u64 {
    let mut failures = 0;
    for long in long::all(share) {
        match long.run() {
            Ok(report) => {
                let drift = report.drift.map(|(momentum, energy)| {
                    format!("momentum drift {momentum:.1e}, energy {energy:+.1e}, ")
                });
                println!(
                    "{:<13} {} in {:.0} s: {}memory +{} kB, best parts of the halves {:.2}",
                    long.name,
                    report.done,
                    report.seconds,
                    drift.unwrap_or_default(),
                    report.growth / 1024,
                    report.slower
                );
            }
            Err(problem) => {
                eprintln!("{}: {problem}", long.name);
                failures += 1;
            }
        }
    }
    failures
}

fn fuzz(arguments: &Arguments, target: &str) -> u64 {
    let place = tempfile::tempdir().expect("a temporary folder can be made");
    let range = Range::new(place.path()).unwrap_or_else(|error| panic!("{error}"));
    let targets: Vec<&str> = TARGETS.into_iter().filter(|one| target == "all" || *one == target).collect();
    if arguments.show {
        targets.iter().for_each(|target| println!("{}", range.show(target, arguments.seed)));
        return 0;
    }
    // A panic is told with its case, once.
    std::panic::set_hook(Box::new(|_| {}));
    let mut failures = 0;
    for target in &targets {
        let (since, mut fired, mut wrong) = (Instant::now(), Fired::default(), 0);
        for seed in seeds(arguments, targets.len() as f64) {
            if let Err(problem) = range.fire(target, seed, &mut fired) {
                eprintln!("{problem}\n");
                wrong += 1;
            }
            if wrong == MOST_FAILURES {
                break;
            }
        }
        println!(
            "{target}: {} cases, {} taken, {wrong} failed; longest {:.3} s; {:.0} s",
            fired.cases,
            fired.accepted,
            fired.longest,
            since.elapsed().as_secs_f64()
        );
        failures += wrong;
    }
    failures
}
