//! Engines against the yardstick, in turn in one run: medians and ratios that hold on a noisy machine.
//!
//! `cargo bench --bench ratios` for a million grains on one thread and on all of them;
//! `cargo bench --bench ratios -- 10000` for another number of grains.

#![expect(clippy::print_stdout, reason = "a table is what this program is for")]

#[expect(dead_code, reason = "other states and going back are for the bench `steps`")]
mod support;

use std::time::Instant;

use glam::{DVec2, DVec3};
use grainflow::engine::NoLaps;
use grainflow::space::Vector;
use support::cases::{Case, build};
use support::yardstick::yardstick;

/// Rounds; each round times every contestant once.
const ROUNDS: usize = 7;
/// Grain-steps that one timing covers.
const GRAIN_STEPS: usize = 8_000_000;

fn main() {
    let grains = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(1_000_000);
    println!(
        "{grains} grains, elastic, volume fraction 0.25, 10 per cell; million particle-steps per second"
    );
    println!(
        "medians of {ROUNDS} rounds; the ratio is to the yardstick kernel (one thread) in the same round\n"
    );
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for threads in if cores > 1 { vec![1, cores] } else { vec![1] } {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
        for collisions in [0.5, 0.14] {
            pool.install(|| compare::<DVec2, 2>(threads, grains, collisions));
            pool.install(|| compare::<DVec3, 3>(threads, grains, collisions));
        }
    }
}

/// A name and what makes one step.
type Contestant = (&'static str, Box<dyn FnMut()>);

/// Times yardstick and engines in turn and prints a line for each.
fn compare<V: Vector, const D: usize>(threads: usize, grains: usize, collisions: f64) {
    let mut contestants: Vec<Contestant> =
        vec![("yardstick", Box::new(yardstick::<V, D>(grains, collisions)))];
    for engine in ["dsmc", "cba", "hsmc"] {
        let mut running = build(Case { engine, dimension: D, state: "gas", grains, collisions });
        contestants.push((engine, Box::new(move || _ = running.step(&mut NoLaps))));
    }
    for (_, step) in &mut contestants {
        (0..3).for_each(|_| step());
    }
    let mut rates = vec![Vec::new(); contestants.len()];
    for _ in 0..ROUNDS {
        for ((_, step), rates) in contestants.iter_mut().zip(&mut rates) {
            rates.push(rate(grains, step));
        }
    }
    for (k, (name, _)) in contestants.iter().enumerate() {
        let ratios = rates[k].iter().zip(&rates[0]).map(|(mine, kernel)| mine / kernel).collect();
        println!(
            "{D}D  {collisions:4} collisions per particle and step  {threads} threads  {name:<10} {:6.1}  ratio {:.2}",
            median(rates[k].clone()),
            median(ratios),
        );
    }
}

/// Million particle-steps per second.
fn rate(grains: usize, step: &mut dyn FnMut()) -> f64 {
    let steps = GRAIN_STEPS.div_ceil(grains);
    let start = Instant::now();
    (0..steps).for_each(|_| step());
    (grains * steps) as f64 / start.elapsed().as_secs_f64() * 1e-6
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
