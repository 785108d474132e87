//! Small fixed cases on one thread, for `benches/instructions.sh`, which counts their instructions.
//!
//! `instructions CASE STEPS` builds a case, makes five steps and STEPS more, and prints its number of grains;
//! `instructions --list` prints the names of the cases. The difference of two runs is what the steps cost.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "what this program is for")]

#[expect(dead_code, reason = "going back is for the bench `steps`")]
#[path = "support/cases.rs"]
mod cases;

use std::process::ExitCode;

use cases::{Case, build};
use grainflow::engine::NoLaps;

const WARM_UP: usize = 5;

fn main() -> ExitCode {
    // `cargo bench` says `--bench` to every bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let cases = cases();
    if words.is_empty() {
        println!("benches/instructions.sh counts the instructions of these cases");
        return ExitCode::SUCCESS;
    }
    if words == ["--list"] {
        cases.iter().for_each(|(name, _)| println!("{name}"));
        return ExitCode::SUCCESS;
    }
    let case = words.first().and_then(|wanted| cases.iter().find(|(name, _)| name == wanted));
    let steps = words.get(1).and_then(|word| word.parse::<usize>().ok());
    let (Some((_, case)), Some(steps)) = (case, steps) else {
        eprintln!("usage: instructions --list | CASE STEPS; benches/instructions.sh is what to run");
        return ExitCode::from(2);
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be had");
    println!("{}", pool.install(|| go(*case, steps)));
    ExitCode::SUCCESS
}

fn go(case: Case, steps: usize) -> usize {
    let mut running = build(case);
    (0..WARM_UP + steps).for_each(|_| _ = running.step(&mut NoLaps));
    running.grains()
}

fn cases() -> Vec<(String, Case)> {
    let mut cases = Vec::new();
    let mut add = |name: &str, case: Case| cases.push((format!("{name}-{}d", case.dimension), case));
    for dimension in [2, 3] {
        for engine in ["dsmc", "cba", "hsmc"] {
            add(engine, Case { engine, dimension, state: "gas", grains: 20_000, collisions: 0.5 });
        }
        add("heap", Case { engine: "hsmc", dimension, state: "heap", grains: 1000, collisions: 0.5 });
        // A step is a tenth of a collision per particle.
        let events = Case { engine: "event-driven", dimension, state: "gas", grains: 5000, collisions: 0.1 };
        add("event-driven", events);
    }
    cases
}
