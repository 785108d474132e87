//! A step of every engine: by dimension, state, number of grains and threads, with the time of each of its verbs.
//!
//! `cargo bench --bench steps` for the usual rows; words choose others, in any order:
//!
//! ```text
//! cargo bench --bench steps -- cba 2d gas 1000000 1
//! cargo bench --bench steps -- hsmc clustered heap 10000 100000 1 2 --rounds=9
//! cargo bench --bench steps -- gas 1000000 --collisions=0.14 --csv
//! ```
//!
//! * engines: `dsmc`, `cba`, `hsmc`; dimensions: `2d`, `3d`;
//! * states: `dilute`, `gas`, `dense`, `clustered`, `heap` (`support/cases.rs` says what they are; a heap has `hsmc` alone);
//! * numbers: grains from 1000 on, threads below;
//! * `--rounds=N`: rounds of which medians are given (5); `--collisions=X`: collisions per particle and step (0.5), which
//!   the longest step that an engine takes may cut short; `--csv`: a line for each row, with a head.
//!
//! Where there is no word of a kind: all engines, both dimensions, `gas`, `clustered` and `heap`, 100 000 grains, one thread
//! and two. Clusters of a million grains take half a minute to make.
//!
//! Each round times, in turn, the yardstick kernel (one thread; as many grains, and as many collisions per particle and
//! step, in the homogeneous gas of ν = 0.25), the state on every number of threads, and for `clustered` and `heap` also
//! `gas`. In a heap next to nothing collides: its yardstick is that of the gas. Every round begins at the same state, so
//! that it times the same steps. Ratios are those of one round.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a table is what this program is for")]

#[path = "support/choice.rs"]
mod choice;
mod support;
#[path = "support/timing.rs"]
mod timing;

use std::process::ExitCode;

use choice::Choice;
use glam::{DVec2, DVec3};
use rayon::{ThreadPool, ThreadPoolBuilder};
use support::cases::{Case, Running, build};
use support::yardstick::yardstick;
use timing::{Timing, median, time, time_plain};

/// Grain-steps that one timing covers, and the fewest steps.
const GRAIN_STEPS: (usize, usize) = (4_000_000, 2);
const HEAD: &str =
    "dimension,state,engine,grains,threads,collisions,rate,nanoseconds,ratio,of_gas,speed_up,verbs";

fn main() -> ExitCode {
    let choice = match Choice::of(std::env::args().skip(1)) {
        Ok(choice) => choice,
        Err(mistake) => {
            eprintln!("{mistake}");
            return ExitCode::from(2);
        }
    };
    let pools: Vec<ThreadPool> = (choice.threads.iter())
        .map(|&threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had"))
        .collect();
    if choice.csv {
        println!("{HEAD}");
    } else {
        println!("medians of {} rounds; ratio: to the yardstick kernel (one thread)", choice.rounds);
        println!(
            "of gas: rate per grain to that of the state `gas`; times of verbs in ns per grain and step\n"
        );
    }
    for &dimension in &choice.dimensions {
        for &state in &choice.states {
            for &grains in &choice.sizes {
                // A heap is the model of one engine; the others have nothing that keeps it up.
                let able = |engine: &&str| state != "heap" || *engine == "hsmc";
                for &engine in choice.engines.iter().filter(|engine| able(engine)) {
                    let case = Case { engine, dimension, state, grains, collisions: choice.collisions };
                    rows(case, &choice, &pools);
                }
            }
        }
    }
    ExitCode::SUCCESS
}

/// What one round says of one number of threads.
struct Round {
    timing: Timing,
    yardstick: f64,
    gas: Option<f64>,
    one_thread: Option<f64>,
}

/// Times a case on each number of threads and prints a row for each.
fn rows(case: Case, choice: &Choice, pools: &[ThreadPool]) {
    let widest =
        pools.iter().max_by_key(|pool| pool.current_num_threads()).expect("there is a number of threads");
    let mut state = widest.install(|| marked(case));
    if !choice.csv {
        let (empty, contrast) = state.unevenness();
        println!(
            "{}D {} {} {} grains; empty cells {:.0} %, variance over mean of counts {contrast:.2}",
            case.dimension,
            case.state,
            case.engine,
            state.grains(),
            100.0 * empty,
        );
    }
    let is_gas = !["clustered", "heap"].contains(&case.state);
    let mut gas = (!is_gas).then(|| widest.install(|| marked(Case { state: "gas", ..case })));
    let (grain_steps, fewest) = GRAIN_STEPS;
    let steps = (grain_steps / case.grains).max(fewest);
    // In a heap at rest nearly nothing collides, and a kernel in which nothing moves measures nothing.
    let collisions = match case.state {
        "heap" => choice.collisions,
        _ => widest.install(|| time(state.as_mut(), steps)).collisions,
    };
    let mut kernel: Box<dyn FnMut()> = match case.dimension {
        2 => Box::new(yardstick::<DVec2, 2>(case.grains, collisions)),
        _ => Box::new(yardstick::<DVec3, 3>(case.grains, collisions)),
    };
    (0..3).for_each(|_| kernel());
    let mut rounds: Vec<Vec<Round>> = pools.iter().map(|_| Vec::new()).collect();
    for _ in 0..choice.rounds {
        let yardstick = time_plain(&mut kernel, case.grains, steps);
        let mut one_thread = None;
        for (pool, rounds) in pools.iter().zip(&mut rounds) {
            let timing = pool.install(|| time(state.as_mut(), steps));
            let gas = gas.as_mut().map(|gas| pool.install(|| time(gas.as_mut(), steps)).nanoseconds);
            if pool.current_num_threads() == 1 {
                one_thread = Some(timing.nanoseconds);
            }
            rounds.push(Round { timing, yardstick, gas, one_thread });
        }
    }
    for (pool, rounds) in pools.iter().zip(&rounds) {
        row(case, pool.current_num_threads(), rounds, choice.csv);
    }
}

/// The case, some steps on its way, ready to go back there.
fn marked(case: Case) -> Box<dyn Running> {
    let mut running = build(case);
    (0..3).for_each(|_| _ = running.step(&mut grainflow::engine::NoLaps));
    running.mark();
    running
}

/// The median over rounds; nothing where a round has none.
fn over(rounds: &[Round], value: impl Fn(&Round) -> Option<f64>) -> Option<f64> {
    rounds.iter().map(value).collect::<Option<Vec<f64>>>().map(median)
}

fn row(case: Case, threads: usize, rounds: &[Round], csv: bool) {
    let Case { engine, dimension, state, grains, .. } = case;
    let collisions = rounds[0].timing.collisions;
    let nanoseconds = median(rounds.iter().map(|round| round.timing.nanoseconds));
    let rate = 1e3 / nanoseconds;
    let ratio = median(rounds.iter().map(|round| round.yardstick / round.timing.nanoseconds));
    let of_gas = over(rounds, |round| Some(round.gas? / round.timing.nanoseconds));
    let speed_up = over(rounds, |round| Some(round.one_thread? / round.timing.nanoseconds));
    let verbs = rounds[0].timing.verbs.iter().enumerate().map(|(k, (verb, _))| {
        let time = median(rounds.iter().map(|round| round.timing.verbs[k].1));
        (*verb, time)
    });
    if csv {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
        let verbs: Vec<String> = verbs.map(|(verb, time)| format!("{verb}={time:.3}")).collect();
        println!(
            "{dimension},{state},{engine},{grains},{threads},{collisions:.4},{rate:.4},{nanoseconds:.4},{ratio:.4},{},{},{}",
            number(of_gas),
            number(speed_up),
            verbs.join(";"),
        );
        return;
    }
    let part =
        |name: &str, value: Option<f64>| value.map_or(String::new(), |value| format!("  {name} {value:.2}"));
    println!(
        "  threads {threads}  collisions {collisions:.2}  {rate:6.2} M/s  {nanoseconds:6.1} ns  ratio {ratio:.2}{}{}",
        part("of gas", of_gas),
        part("speed-up", speed_up.filter(|_| threads > 1)),
    );
    let verbs: Vec<String> = verbs.map(|(verb, time)| format!("{verb} {time:.1}")).collect();
    println!("    {}", verbs.join(", "));
}
