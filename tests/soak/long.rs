//! Long runs of few grains: what a million steps, or a hundred million events, do to momentum, energy, order,
//! memory and speed.

use std::time::Instant;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::machine::peak_memory_bytes;
use grainflow::observe::moments;
use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;

use super::laws::Laws;

/// Parts of a run, each of which is looked at and timed.
const PARTS: u64 = 20;
/// Momentum that rounding may bring in, as a share of Σ m|v| [1].
const DRIFT: f64 = 1e-9;
/// Memory that may come in the course of a run [bytes].
const GROWTH: u64 = 4_000_000;
/// How much slower the best part of the second half may be than that of the first: other programs run, too.
const SLOWER: f64 = 1.5;

/// A run and how long it is.
pub(crate) struct Long {
    pub(crate) name: &'static str,
    text: String,
    /// Steps, or events.
    length: u64,
}

/// Elastic gases, which keep energy and momentum, and a bed on a floor that shakes, which keeps only its grains;
/// `share` of their full lengths.
pub(crate) fn all(share: f64) -> Vec<Long> {
    let gas = |engine: &str, more: &str| {
        format!(
            "dimension = 2\nseed = 11\n[engine]\nkind = \"{engine}\"\n{more}[domain]\nsize = [16.0, 16.0]\n[particles]\n\
             volume_fraction = 0.3\nrestitution = 1.0\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\n\
             collisions_per_particle = 1e12\n"
        )
    };
    let bed = "dimension = 2\nseed = 11\ngravity = [0.0, -1.0]\n[engine]\nkind = \"hsmc\"\n[domain]\nsize = [12.0, 40.0]\n\
               [boundary]\ny.lower = { wall = \"vibrating\", amplitude = 0.3, frequency = 0.5 }\n\
               y.upper = { wall = \"smooth\" }\n[particles]\ncount = 90\nrestitution = 0.8\n[run]\ntime = 1e12\n";
    let of = |name, text, length: f64| Long { name, text, length: (share * length).ceil() as u64 };
    vec![
        of("dsmc", gas("dsmc", ""), 1e6),
        of("cba", gas("cba", ""), 1e6),
        of("hsmc", gas("hsmc", "cell_size = 2.0\n"), 1e6),
        of("hsmc-bed", bed.to_owned(), 1e6),
        of("event-driven", gas("event-driven", ""), 1e8),
    ]
}

/// What a long run came to.
#[derive(Debug)]
pub(crate) struct Report {
    pub(crate) done: u64,
    pub(crate) seconds: f64,
    /// What came to momentum, as a share of Σ m|v|, and to energy; nothing where neither is kept.
    pub(crate) drift: Option<(f64, f64)>,
    pub(crate) growth: u64,
    pub(crate) slower: f64,
}

impl Long {
    /// Runs it, and says what does not hold.
    pub(crate) fn run(&self) -> Result<Report, String> {
        match parse(self.name, &self.text, &Overrides::default()).map_err(|error| error.to_string())? {
            AnyScenario::Two(scenario) => {
                let gas = initial::build(&scenario, None).map_err(|error| error.to_string())?;
                let simulation = Simulation::start(&scenario, gas, &mut NoLaps);
                self.watch(simulation.map_err(|error| error.to_string())?)
            }
            AnyScenario::Three(_) => Err("is flat".to_owned()),
        }
    }

    fn watch(&self, mut simulation: Simulation<'_, glam::DVec2>) -> Result<Report, String> {
        let mut laws = Laws::of(simulation.scenario(), simulation.gas()).for_long();
        let start = moments::kinetic_energy(simulation.gas());
        let since = Instant::now();
        let (mut speeds, mut memory) = (Vec::new(), 0);
        for part in 1..=PARTS {
            let began = (since.elapsed().as_secs_f64(), done(&simulation));
            while done(&simulation) < part * self.length / PARTS {
                // As far as the engine goes by itself, or a thousand collisions.
                let horizon = Horizon { collisions: 1000, ..Horizon::NONE };
                simulation.advance(&mut NoLaps, horizon).map_err(|error| error.to_string())?;
            }
            laws.check(&simulation).map_err(|problem| format!("after part {part} of {PARTS}: {problem}"))?;
            speeds.push((done(&simulation) - began.1) as f64 / (since.elapsed().as_secs_f64() - began.0));
            if part == PARTS / 4 {
                memory = peak_memory_bytes().unwrap_or(0);
            }
        }
        let beginning = simulation.beginning();
        let momentum = (moments::momentum(simulation.gas()) - beginning.momentum).length();
        let energy = moments::kinetic_energy(simulation.gas()) / start - 1.0;
        let is_closed = simulation.scenario().boundary.is_fully_periodic();
        let best = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
        let (first, second) = speeds.split_at(speeds.len() / 2);
        let report = Report {
            done: done(&simulation),
            seconds: since.elapsed().as_secs_f64(),
            drift: is_closed.then(|| (momentum / beginning.momentum_scale, energy)),
            growth: peak_memory_bytes().unwrap_or(0).saturating_sub(memory),
            slower: best(first) / best(second),
        };
        report.judged()
    }
}

fn done(simulation: &Simulation<'_, glam::DVec2>) -> u64 {
    let totals = simulation.totals();
    if simulation.is_event_driven() { totals.events.all } else { totals.steps }
}

impl Report {
    fn judged(self) -> Result<Self, String> {
        let conserved =
            self.drift.is_none_or(|(momentum, energy)| momentum <= DRIFT && energy.abs() <= DRIFT);
        if conserved && self.growth <= GROWTH && self.slower <= SLOWER {
            Ok(self)
        } else {
            Err(format!("{self:?}"))
        }
    }
}
