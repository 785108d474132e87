//! What no step may break, on random small scenarios: the number of grains, their identities, the
//! order of cells, the capacity, the box, momentum, energy, and the way into a log and back.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::matter::gas::Gas;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::observe::moments;
use grainflow::record::reader::last_state;
use grainflow::record::writer::{LogHeader, LogWriter};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::{Simulation, SimulationError};
use grainflow::space::Vector;
use proptest::prelude::*;

/// Steps of each case.
const STEPS: u64 = 25;

/// What a scenario is drawn from.
#[derive(Clone, Debug)]
struct Draw {
    dimension: usize,
    engine: &'static str,
    cell_size: f64,
    /// Along x, then along the last axis.
    boundary: [usize; 2],
    fraction: f64,
    restitution: f64,
    gravity: f64,
    source: bool,
    time_step: &'static str,
    transfer: &'static str,
    lattice: bool,
    seed: u64,
    threads: usize,
}

const TIME_STEPS: [&str; 4] = [
    "{ collisions_per_particle = 0.1 }",
    "{ collisions_per_particle = 1.0 }",
    "{ crossing = 0.5 }",
    "{ fixed = 0.02 }",
];

/// Lower and upper face; nothing for a periodic axis.
const BOUNDARIES: [Option<[&str; 2]>; 6] = [
    None,
    Some(["{ wall = \"smooth\" }", "{ wall = \"rough\" }"]),
    Some([
        "{ wall = \"statistical\", reversal_probability = 0.5 }",
        "{ wall = \"smooth\", restitution = 1.0 }",
    ]),
    Some(["{ wall = \"rough\", restitution = 0.3 }", "\"open\""]),
    Some(["\"open\"", "\"open\""]),
    Some(["{ wall = \"vibrating\", amplitude = 0.3, frequency = 0.7 }", "{ wall = \"smooth\" }"]),
];
const VIBRATING: usize = 5;

fn draws() -> impl Strategy<Value = Draw> {
    let place = (2_usize..4, 0..BOUNDARIES.len(), 0..BOUNDARIES.len(), 2.0..4.0_f64);
    let matter = (0.02..0.55_f64, prop_oneof![Just(1.0), Just(0.0), 0.3..1.0_f64], any::<bool>());
    let drive = (prop_oneof![Just(0.0), 0.1..1.0_f64], any::<bool>());
    let engine = (
        prop::sample::select(vec!["dsmc", "cba", "hsmc", "hsmc"]),
        prop::sample::select(TIME_STEPS.to_vec()),
        prop::sample::select(vec!["momentum-change", "corrected"]),
    );
    (place, matter, drive, engine, 0_u64..1 << 40, 1_usize..4).prop_map(
        |(place, matter, drive, engine, seed, threads)| Draw {
            dimension: place.0,
            engine: engine.0,
            cell_size: place.3,
            boundary: [place.1, place.2],
            fraction: matter.0 * if drive.1 { 0.2 } else { 1.0 } * if place.0 == 2 { 1.0 } else { 0.7 },
            restitution: matter.1,
            gravity: drive.0,
            // A source needs gravity, and a floor or a hole below it.
            source: drive.1 && drive.0 > 0.0 && place.2 > 0,
            time_step: engine.1,
            transfer: engine.2,
            lattice: matter.2,
            seed,
            threads,
        },
    )
}

impl Draw {
    fn text(&self) -> String {
        let up = self.dimension - 1;
        let side = if self.dimension == 2 { 24.0 } else { 10.0 };
        let vector = |component: &dyn Fn(usize) -> f64| {
            let all: Vec<String> = (0..self.dimension).map(|axis| format!("{:?}", component(axis))).collect();
            format!("[{}]", all.join(", "))
        };
        let mut boundary = String::new();
        for (axis, kind) in [(0, self.boundary[0]), (up, self.boundary[1])] {
            if let Some([lower, upper]) = BOUNDARIES[kind] {
                let name = ["x", "y", "z"][axis];
                boundary += &format!("{name}.lower = {lower}\n{name}.upper = {upper}\n");
            }
        }
        let source = format!(
            "[source]\ncount = 12\nrate = 5.0\nheight = 1.0\nwidth = 4.0\nvelocity = {}\n",
            vector(&|axis| if axis == up { -2.0 } else { 0.0 })
        );
        format!(
            "dimension = {}
seed = {}
gravity = {}
[engine]
kind = \"{}\"
cell_size = {}
time_step = {}
transfer = \"{}\"
[engine.hsmc]
sweeps = 2
[domain]
size = {}
[boundary]
{boundary}[particles]
volume_fraction = {}
restitution = {}
[initial]
positions = \"{}\"
velocities = {{ maxwell = 1.0 }}
{}[run]
steps = {STEPS}
",
            self.dimension,
            self.seed,
            vector(&|axis| if axis == up { -self.gravity } else { 0.0 }),
            self.engine,
            self.cell_size,
            self.time_step,
            self.transfer,
            vector(&|axis| if axis == up { 2.0 * side } else { side }),
            self.fraction,
            self.restitution,
            if self.lattice { "lattice" } else { "random" },
            if self.source { &source } else { "" },
        )
    }

    fn is_periodic(&self) -> bool {
        self.boundary == [0, 0]
    }

    /// Whether nothing can give energy to the grains.
    fn is_undriven(&self) -> bool {
        self.gravity == 0.0 && !self.boundary.contains(&VIBRATING)
    }
}

/// Every grain stands in the rows of the cell of its position, every identity once.
fn assert_ordered<V: Vector>(gas: &Gas<V>) {
    let offsets = gas.offsets();
    assert_eq!(offsets.len(), gas.grid().number_of_cells() + 1);
    assert_eq!((offsets[0], offsets[offsets.len() - 1] as usize), (0, gas.len()));
    assert!(offsets.is_sorted());
    for cell in 0..gas.grid().number_of_cells() as u32 {
        for row in gas.rows(cell) {
            assert_eq!(gas.grid().cell_of(gas.positions()[row]), cell, "row {row}");
        }
    }
    let ids: BTreeSet<u32> = gas.ids().iter().copied().collect();
    assert_eq!(ids.len(), gas.len(), "every identity once");
    assert!(ids.last().is_none_or(|&id| id < gas.next_id()));
}

/// Every grain is where it may be: inside the box, below its end where that is periodic or open.
fn assert_inside<V: Vector>(scenario: &Scenario<V>, gas: &Gas<V>) {
    let (origin, end) = (gas.grid().origin(), gas.grid().end());
    for (&position, &velocity) in gas.positions().iter().zip(gas.velocities()) {
        assert!(position.is_finite() && velocity.is_finite());
        for axis in 0..V::DIMENSION {
            let x = position[axis];
            assert!(x >= origin[axis] && x <= end[axis], "{position:?} is outside along axis {axis}");
            assert!(!scenario.boundary.is_periodic(axis) || x < end[axis], "{position:?} is not wrapped");
        }
    }
}

/// Runs all steps of the case and looks at everything after each.
fn check<V: Vector>(draw: &Draw, scenario: &Scenario<V>) {
    let gas = initial::build(scenario, None).unwrap();
    assert_ordered(&gas);
    let starts: Vec<u32> = gas.offsets().windows(2).map(|ends| ends[1] - ends[0]).collect();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    let mut energy = moments::kinetic_energy(simulation.gas());
    while simulation.end_reason().is_none() {
        match simulation.advance(&mut NoLaps, Horizon::NONE) {
            Ok(()) => {}
            // A source has grown its heap to the top of the box: an end like others.
            Err(SimulationError::Pouring(_)) => return,
            Err(error) => panic!("{error}"),
        }
        let (gas, totals) = (simulation.gas(), simulation.totals());
        assert_ordered(gas);
        assert_inside(scenario, gas);
        let expected = u64::from(scenario.count) + totals.poured - totals.counts.removed;
        assert_eq!(gas.len() as u64, expected, "initial + poured − removed");
        assert_eq!(u64::from(gas.next_id()), u64::from(scenario.count) + totals.poured);
        if let Some(capacity) = simulation.capacity() {
            for (cell, &start) in starts.iter().enumerate() {
                let occupancy = gas.occupancy(cell as u32);
                assert!(occupancy <= capacity.max(start), "{occupancy} grains in cell {cell} of {capacity}");
            }
        }
        if draw.is_undriven() {
            let now = moments::kinetic_energy(gas);
            assert!(now <= energy * (1.0 + 1e-13), "energy rose from {energy:?} to {now:?}");
            energy = now;
        }
        if draw.is_periodic() && draw.gravity == 0.0 {
            let beginning = simulation.beginning();
            let drift = (moments::momentum(gas) - beginning.momentum).length();
            assert!(drift <= 1e-12 * beginning.momentum_scale, "momentum drifted by {drift:e}");
        }
    }
    assert_comes_back_from_a_log(&simulation);
}

fn assert_comes_back_from_a_log<V: Vector>(simulation: &Simulation<'_, V>) {
    let file = tempfile::NamedTempFile::new().unwrap();
    let time = Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } };
    let header = LogHeader { columns: vec![time], time_scale: 1_000_000_000, ..LogHeader::default() };
    let mut log = LogWriter::create(file.path(), &header).unwrap();
    let saved = simulation.saved_state(7, 2);
    log.state(&saved).unwrap();
    log.finish().unwrap();
    let mut read = last_state::<V>(file.path()).unwrap().unwrap();
    // As text: a measure may remember what is not a number, and that equals nothing.
    assert_eq!(format!("{read:?}"), format!("{saved:?}"));
    let scenario = simulation.scenario();
    assert_eq!(&read.take_gas(scenario.grid(), scenario.grain), simulation.gas());
}

fn simulate(draw: &Draw, text: &str) {
    let scenario = match parse("random", text, &Overrides::default()) {
        Ok(scenario) => scenario,
        // What a scenario refuses is not for engines to bear; `most_draws_are_scenarios` counts these.
        Err(error) if is_expected(&error.to_string()) => return,
        Err(error) => panic!("{error}"),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(draw.threads).build().unwrap();
    pool.install(|| match &scenario {
        AnyScenario::Two(scenario) => check(draw, scenario),
        AnyScenario::Three(scenario) => check(draw, scenario),
    });
}

/// More grains than the cells of hsmc hold.
fn is_expected(error: &str) -> bool {
    error.contains("do not fit")
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_step_keeps_what_it_must(draw in draws()) {
        let text = draw.text();
        let outcome = std::panic::catch_unwind(|| simulate(&draw, &text));
        if let Err(cause) = outcome {
            let cause = cause
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| cause.downcast_ref::<&str>().copied())
                .unwrap_or("a panic");
            return Err(TestCaseError::fail(format!("{cause}\nwith {} threads:\n{text}", draw.threads)));
        }
    }
}

/// A displacement may carry a grain out through an open side; when its move is then rejected for lack
/// of room, it must not keep a place outside the box.
#[test]
fn no_grain_stays_beyond_an_open_side() {
    for seed in 0..40 {
        let draw = Draw {
            dimension: 2,
            engine: "hsmc",
            cell_size: 3.0,
            boundary: [0, 3],
            fraction: 0.51,
            restitution: 1.0,
            gravity: 0.0,
            source: false,
            time_step: TIME_STEPS[2],
            transfer: "corrected",
            lattice: false,
            seed,
            threads: 1,
        };
        simulate(&draw, &draw.text());
    }
}

/// Refused draws test nothing: they have to be few.
#[test]
fn most_draws_are_scenarios() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let refused = (0..200)
        .filter(|_| {
            let draw = draws().new_tree(&mut runner).unwrap().current();
            parse("random", &draw.text(), &Overrides::default()).is_err()
        })
        .count();
    assert!(refused < 40, "{refused} of 200");
}
