//! The event-driven engine: collisions and events per second, bytes per grain, and how long this machine takes
//! for a load from a random place in memory, all in one run.
//!
//! `cargo bench --bench events` for ten thousand, a hundred thousand and a million grains; `cargo bench --bench
//! events -- 10000` for one number of them.

#![expect(clippy::print_stdout, reason = "a table is what this program is for")]

use std::process::Command;
use std::time::Instant;

use glam::{DVec2, DVec3};
use grainflow::engine::report::EventCounts;
use grainflow::engine::{Engine, Horizon, NoLaps};
use grainflow::machine::peak_memory_bytes;
use grainflow::matter::gas::Gas;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::assembly;
use grainflow::space::Vector;

/// Dimension and volume fraction of each case.
const CASES: [(usize, f64); 4] = [(3, 0.01), (3, 0.25), (3, 0.49), (2, 0.25)];
/// Collisions per particle before the clock starts: the lattice has melted, the order in memory has aged.
const WARM_UP: f64 = 10.0;
/// Parts that each case is timed in; the table gives their median.
const PARTS: usize = 5;
/// Collisions in a part, at least, and for each grain.
const COLLISIONS: (u64, f64) = (300_000, 0.5);
/// The word that makes this program time one case for its parent.
const ONE_CASE: &str = "one-case";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.first().is_some_and(|word| word == ONE_CASE) {
        return one_case(&words[1..]);
    }
    let wanted = words.iter().find_map(|word| word.parse().ok());
    let sizes = wanted.map_or(vec![10_000, 100_000, 1_000_000], |grains: u64| vec![grains]);
    println!("elastic grains, one thread; medians of {PARTS} parts");
    println!("a load from a random place in 256 MiB takes {:.0} ns here\n", load_latency());
    println!(
        "{:>3} {:>6} {:>9} {:>22} {:>12} {:>11}",
        "D", "nu", "grains", "1000 collisions per s", "1000 events", "bytes/grain"
    );
    for (dimension, volume_fraction) in CASES {
        for &grains in &sizes {
            let [collisions, events, bytes] = in_a_process(dimension, volume_fraction, grains);
            let [_, _, program] = in_a_process(dimension, volume_fraction, 1000);
            println!(
                "{dimension:>3} {volume_fraction:>6} {grains:>9} {:>22.0} {:>12.0} {:>11.0}",
                1e-3 * collisions,
                1e-3 * events,
                (bytes - program) / grains as f64,
            );
        }
    }
}

/// Collisions and events per second and peak memory of one case, timed in a process of its own.
fn in_a_process(dimension: usize, volume_fraction: f64, grains: u64) -> [f64; 3] {
    let program = std::env::current_exe().expect("a running program has a file");
    let words = [dimension.to_string(), volume_fraction.to_string(), grains.to_string()];
    let output = Command::new(program).arg(ONE_CASE).args(words).output().expect("it can be started again");
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    numbers
        .try_into()
        .unwrap_or_else(|_| panic!("a case has failed: {}", String::from_utf8_lossy(&output.stderr)))
}

fn one_case(words: &[String]) {
    let volume_fraction = words[1].parse().expect("the parent writes a number");
    let grains = words[2].parse().expect("the parent writes a number");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be had");
    let (collisions, events) = pool.install(|| match scenario(&words[0], volume_fraction, grains) {
        AnyScenario::Two(scenario) => time(&scenario),
        AnyScenario::Three(scenario) => time(&scenario),
    });
    println!("{collisions} {events} {}", peak_memory_bytes().unwrap_or(0));
}

fn scenario(dimension: &str, volume_fraction: f64, grains: u64) -> AnyScenario {
    let axes = if dimension == "2" { 2 } else { 3 };
    let sphere = if axes == 2 { DVec2::sphere_volume(1.0) } else { DVec3::sphere_volume(1.0) };
    let side = (grains as f64 * sphere / volume_fraction).powf(1.0 / f64::from(axes));
    let sizes = vec![format!("{side:?}"); axes as usize].join(", ");
    let text = format!(
        "dimension = {axes}\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = [{sizes}]\n\
         [particles]\ncount = {grains}\nrestitution = 1.0\n\
         [initial]\npositions = \"lattice\"\nvelocities = {{ maxwell = 1.0 }}\n[run]\ntime = 1\n",
    );
    parse("bench", &text, &Overrides::default()).expect("the bench's scenario is right")
}

/// Medians of collisions and events per second.
fn time<V: Vector>(scenario: &Scenario<V>) -> (f64, f64) {
    let mut gas = initial::build(scenario, None).expect("the lattice has room");
    let mut engine = assembly::engine(scenario, 1, &scenario.boundary, scenario.gravity, None);
    let grains = gas.len() as f64;
    go_on(engine.as_mut(), &mut gas, (0.5 * WARM_UP * grains) as u64);
    let (least, per_grain) = COLLISIONS;
    let collisions = least.max((per_grain * grains) as u64);
    let mut rates: Vec<(f64, f64)> = Vec::new();
    for _ in 0..PARTS {
        let start = Instant::now();
        let events = go_on(engine.as_mut(), &mut gas, collisions);
        let seconds = start.elapsed().as_secs_f64();
        rates.push((collisions as f64 / seconds, events.all as f64 / seconds));
    }
    rates.sort_by(|a, b| a.0.total_cmp(&b.0));
    rates[PARTS / 2]
}

fn go_on<V: Vector>(engine: &mut dyn Engine<V>, gas: &mut Gas<V>, collisions: u64) -> EventCounts {
    let (mut left, mut events) = (collisions, EventCounts::default());
    while left > 0 {
        let horizon = Horizon { time: f64::INFINITY, collisions: left };
        let report = engine.step(gas, horizon, &mut NoLaps).expect("an elastic gas goes on for ever");
        left -= report.counts.collisions;
        events.add(&report.events);
    }
    events
}

/// Mean time of a load whose address is the result of the last one [nanosecond].
fn load_latency() -> f64 {
    const PLACES: usize = 1 << 25;
    const LOADS: usize = 4_000_000;
    // One cycle through all places (Sattolo 1986), by a congruential generator.
    let mut next: Vec<u64> = (0..PLACES as u64).collect();
    let mut random = 1_u64;
    for k in (1..PLACES).rev() {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        next.swap(k, ((u128::from(random) * k as u128) >> 64) as usize);
    }
    let start = Instant::now();
    let mut place = 0;
    for _ in 0..LOADS {
        place = next[place as usize];
    }
    std::hint::black_box(place);
    start.elapsed().as_secs_f64() * 1e9 / LOADS as f64
}
