//! The impulses of all walls and of gravity add up to the change of momentum: P(t) − P(0) = M g t − Σ J, J what each wall
//! was given; and a wall is given the weight of what rests on it.

use super::*;
use crate::engine::NoLaps;
use crate::observe::moments::momentum;
use crate::scenario::initial;
use crate::scenario::model::{AnyScenario, EngineKind};

/// What may be missing, as a share of M g t: the rounding of as many summands as there are hits.
const ROUNDING: f64 = 1e-10;

/// The mass and the momentum of all grains, and the walls' impulses `[axis][side]`, over a run.
struct Balance<V> {
    change: V,
    walls: [[V; 2]; 3],
    /// M g t.
    weight: V,
    hits: u64,
}

fn run_to_end<V: Vector>(scenario: &Scenario<V>) -> Balance<V> {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    let before = simulation.beginning().momentum;
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, crate::engine::Horizon::NONE).unwrap();
    }
    let (gas, totals) = (simulation.gas(), simulation.totals());
    assert_eq!(totals.counts.removed + totals.poured, 0);
    let mass: f64 = (0..gas.len()).map(|row| gas.grain_at(row).mass).sum();
    Balance {
        change: momentum(gas) - before,
        walls: totals.counts.wall_momentum,
        weight: scenario.gravity * (mass * gas.time()),
        hits: totals.counts.collisions + totals.events.wall_hits,
    }
}

impl<V: Vector> Balance<V> {
    /// The part of the momentum that nothing accounts for, as a share of M g t.
    fn missing(&self) -> f64 {
        let walls = self.walls.iter().flatten().fold(V::ZERO, |sum, &wall| sum + wall);
        (self.change - self.weight + walls).length() / self.weight.length()
    }
}

/// A box with these walls in so many dimensions, under gravity that points at no wall squarely.
fn text(engine: EngineKind, dimension: usize, walls: &str, restitution: f64) -> String {
    let side = if dimension == 2 {
        ""
    } else {
        "z.lower = { wall = \"rough\" }\nz.upper = { wall = \"smooth\", restitution = 0.5 }\n"
    };
    let (size, gravity) = if dimension == 2 {
        ("[12.0, 16.0]", "[0.2, -1.0]")
    } else {
        ("[8.0, 12.0, 8.0]", "[0.2, -1.0, 0.1]")
    };
    // Grains at rest make events without end: those of exact dynamics lose energy to the walls alone.
    let (cure, restitution, time) = match engine {
        EngineKind::EventDriven => ("event_driven.collapse = { elastic_below = 0.5 }\n", 1.0, 8.0),
        _ => ("", restitution, 40.0),
    };
    let cells = if engine == EngineKind::EventDriven { "" } else { "cell_size = 2.0\n" };
    format!(
        "dimension = {dimension}\nseed = 5\ngravity = {gravity}\n[engine]\nkind = \"{}\"\n{cells}{cure}\
         [domain]\nsize = {size}\n[boundary]\n{walls}{side}\
         [particles]\ncount = 24\nrestitution = {restitution}\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n\
         [run]\ntime = {time}\n",
        engine.name()
    )
}

fn balance(text: &str) -> (f64, u64) {
    match crate::scenario::parse("balance", text, &Default::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
    {
        AnyScenario::Two(scenario) => {
            let balance = run_to_end(&scenario);
            (balance.missing(), balance.hits)
        }
        AnyScenario::Three(scenario) => {
            let balance = run_to_end(&scenario);
            (balance.missing(), balance.hits)
        }
    }
}

/// Walls of every kind, of x and y.
const WALLS: [&str; 4] = [
    "x.lower = { wall = \"smooth\" }\nx.upper = { wall = \"smooth\", restitution = 0.6 }\n\
     y.lower = { wall = \"smooth\", restitution = 0.7 }\ny.upper = { wall = \"smooth\" }\n",
    "x = \"periodic\"\ny.lower = { wall = \"rough\", velocity = [-0.5, 0.0] }\ny.upper = { wall = \"rough\", velocity = [0.5, 0.0], restitution = 0.8 }\n",
    "x.lower = { wall = \"statistical\", reversal_probability = 0.3 }\nx.upper = { wall = \"rough\" }\n\
     y.lower = { wall = \"statistical\", reversal_probability = 0.5, restitution = 0.9 }\ny.upper = { wall = \"smooth\" }\n",
    "x.lower = { wall = \"smooth\" }\nx.upper = { wall = \"rough\" }\n\
     y.lower = { wall = \"vibrating\", amplitude = 0.5, frequency = 0.4 }\ny.upper = { wall = \"smooth\" }\n",
];

#[test]
fn walls_and_gravity_account_for_all_momentum() {
    for engine in [EngineKind::Dsmc, EngineKind::Cba, EngineKind::EventDriven] {
        for dimension in [2, 3] {
            for (walls, restitution) in WALLS.into_iter().zip([0.8, 0.9, 1.0, 0.9]) {
                let walls =
                    if dimension == 2 { walls.to_owned() } else { walls.replace(", 0.0]", ", 0.0, 0.0]") };
                let text = text(engine, dimension, &walls, restitution);
                let (missing, hits) = balance(&text);
                assert!(missing <= ROUNDING && hits > 50, "{missing} after {hits} hits of\n{text}");
            }
        }
    }
}

/// What the floor was given over m g t, of one grain that falls on it and comes to rest.
fn carried(engine: EngineKind) -> f64 {
    let text = format!(
        "dimension = 2\ngravity = [0.0, -1.0]\n[engine]\nkind = \"{}\"\ncell_size = 2.0\n[domain]\nsize = [20.0, 20.0]\n\
         [boundary]\ny = {{ lower = {{ wall = \"smooth\", restitution = 0.5 }}, upper = \"open\" }}\n\
         [particles]\ncount = 1\nrestitution = 0.5\n[run]\ntime = 200.0\n",
        engine.name()
    );
    let AnyScenario::Two(scenario) = crate::scenario::parse("rest", &text, &Default::default()).unwrap()
    else {
        panic!("the scenario is flat")
    };
    let balance = run_to_end(&scenario);
    assert!(balance.missing() <= ROUNDING, "{}", balance.missing());
    balance.walls[1][0].y / balance.weight.y
}

#[test]
fn a_floor_carries_the_grain_that_rests_on_it() {
    for engine in [EngineKind::Dsmc, EngineKind::Cba] {
        // What is missing is the momentum that the grain began with or has yet to give up.
        assert!((carried(engine) - 1.0).abs() < 0.05, "{engine:?}: {}", carried(engine));
    }
}
