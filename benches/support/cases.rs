//! The gases that benches time, each with the engine that advances it.
//!
//! | state | ν | what it is |
//! |---|---|---|
//! | `dilute` | 0.02 | homogeneous, elastic |
//! | `gas` | 0.25 | homogeneous, elastic |
//! | `dense` | 0.5 (3D: 0.4) | homogeneous, elastic |
//! | `clustered` | 0.25 | r = 0.8, as the built-in scenario `clustering`, once there are clusters |
//! | `heap` | | the box, the walls and the rules of `heap-full`, scaled to the number of grains, and a heap at rest |
//!
//! The first four are periodic, with ten grains per cell.

use glam::{DVec2, DVec3};
use grainflow::engine::{Engine, EngineState, Horizon, Laps, NoLaps};
use grainflow::matter::gas::Gas;
use grainflow::scenario::model::{AnyScenario, EngineKind, Scenario, TimeStep};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::assembly;
use grainflow::space::Vector;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Volume fraction of the state `gas`, and of the yardstick.
pub(crate) const VOLUME_FRACTION: f64 = 0.25;
/// Grains per cell where the box is periodic.
const PER_CELL: f64 = 10.0;
/// Restitution of the scenario `clustering`.
const CLUSTERING_RESTITUTION: f64 = 0.8;
/// Collisions per particle until there are clusters, in two dimensions and in three.
const CLUSTERING_COLLISIONS: [f64; 2] = [100.0, 300.0];
/// Collisions per particle and step on the way there.
const CLUSTERING_STEP: f64 = 0.5;
/// Grains, width and height of the box of `heap-full`, and the height of its heap over half its base.
const HEAP: (f64, f64, f64, f64) = (30_500.0, 800.0, 320.0, 0.6);
/// Width of such a box for spheres: the heap takes the same share of it.
const HEAP_WIDTH_3D: f64 = 83.0;
/// A heap built of full cells comes to rest: it is stopped so often, then goes on for so many steps.
const STOPS: usize = 40;
const STEPS_BETWEEN_STOPS: usize = 10;
const SETTLING: usize = 200;

/// What is timed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    /// `dsmc`, `cba`, `hsmc` or, for the state `gas`, `event-driven`.
    pub(crate) engine: &'static str,
    /// Two or three.
    pub(crate) dimension: usize,
    /// One of those above.
    pub(crate) state: &'static str,
    /// Number of grains.
    pub(crate) grains: usize,
    /// Collisions per particle and step; in a heap steps are as long as its scenario says.
    pub(crate) collisions: f64,
}

/// A gas and its engine.
pub(crate) trait Running: Send {
    /// Makes a step (event-driven: as many collisions) and returns the number of collisions of pairs.
    fn step(&mut self, laps: &mut dyn Laps) -> u64;
    /// Number of grains.
    fn grains(&self) -> usize;
    /// Remembers this state.
    fn mark(&mut self);
    /// Goes back to the state that was marked: the next steps are the same again.
    fn rewind(&mut self);
    /// Share of cells without grains, and variance over mean of the number in a cell (independent grains: 1).
    fn unevenness(&self) -> (f64, f64);
}

struct Run<V: Vector> {
    gas: Gas<V>,
    engine: Box<dyn Engine<V>>,
    horizon: Horizon,
    marked: Option<(Gas<V>, EngineState)>,
}

impl<V: Vector> Running for Run<V> {
    fn step(&mut self, laps: &mut dyn Laps) -> u64 {
        let mut collisions = 0;
        loop {
            let left = Horizon { collisions: self.horizon.collisions - collisions, ..self.horizon };
            let report =
                self.engine.step(&mut self.gas, left, laps).expect("the bench's gas goes on for ever");
            collisions += report.counts.collisions;
            if report.steps > 0 || collisions >= self.horizon.collisions {
                return collisions;
            }
        }
    }

    fn grains(&self) -> usize {
        self.gas.len()
    }

    fn mark(&mut self) {
        self.marked = Some((self.gas.clone(), self.engine.state()));
    }

    fn rewind(&mut self) {
        let (gas, state) = self.marked.as_ref().expect("a state was marked");
        self.gas = gas.clone();
        self.engine.restore(state, &self.gas).expect("the engine takes back its own state");
    }

    fn unevenness(&self) -> (f64, f64) {
        let cells = self.gas.grid().number_of_cells();
        let mean = self.gas.len() as f64 / cells as f64;
        let counts = || (0..cells as u32).map(|cell| f64::from(self.gas.occupancy(cell)));
        let variance = counts().map(|n| (n - mean).powi(2)).sum::<f64>() / cells as f64;
        (counts().filter(|&n| n == 0.0).count() as f64 / cells as f64, variance / mean)
    }
}

/// The gas of `case`, ready to be timed.
pub(crate) fn build(case: Case) -> Box<dyn Running> {
    match parsed(&text(case)) {
        AnyScenario::Two(scenario) => boxed(case, &scenario),
        AnyScenario::Three(scenario) => boxed(case, &scenario),
    }
}

fn boxed<V: Vector>(case: Case, scenario: &Scenario<V>) -> Box<dyn Running> {
    Box::new(match case.state {
        "clustered" => clustered(case, scenario),
        "heap" => heap(case, scenario),
        _ => run(case, scenario, initial::build(scenario, None).expect("such a gas can be built")),
    })
}

fn run<V: Vector>(case: Case, scenario: &Scenario<V>, gas: Gas<V>) -> Run<V> {
    let engine = assembly::engine(scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
    let mut horizon = Horizon::NONE;
    if engine.excludes_overlap() {
        horizon.collisions = (0.5 * case.collisions * gas.len() as f64) as u64;
    }
    Run { gas, engine, horizon, marked: None }
}

/// HSMC makes the clusters, whichever engine is timed on them.
fn clustered<V: Vector>(case: Case, scenario: &Scenario<V>) -> Run<V> {
    let mut maker = scenario.clone();
    maker.engine.kind = EngineKind::Hsmc;
    maker.engine.time_step = TimeStep::CollisionsPerParticle(CLUSTERING_STEP);
    let mut making = run(case, &maker, initial::build(&maker, None).expect("a random gas can be built"));
    let goal = CLUSTERING_COLLISIONS[V::DIMENSION - 2];
    let mut collisions = 0;
    while 2.0 * collisions as f64 <= goal * case.grains as f64 {
        collisions += making.step(&mut NoLaps);
    }
    let mut clustered = run(case, scenario, making.gas);
    clustered
        .engine
        .restore(&making.engine.state(), &clustered.gas)
        .expect("any engine begins with a state without grains");
    clustered
}

/// Full cells under a roof of the heap's slope; then it comes to rest.
fn heap<V: Vector>(case: Case, scenario: &Scenario<V>) -> Run<V> {
    let grid = scenario.grid();
    let mut run = run(case, scenario, Gas::empty(grid.clone(), scenario.grain));
    let capacity = run.engine.capacity(&run.gas).expect("a heap needs an engine with an excluded volume");
    let vertical = V::DIMENSION - 1;
    let corner = |cell: u32| {
        let at = grid.coordinates(cell);
        V::from_fn(|axis| grid.origin()[axis] + f64::from(at[axis]) * grid.side()[axis])
    };
    // How high above the middle of the box a roof over the cell begins.
    let roof = |cell: &u32| {
        let place = corner(*cell) + grid.side() * 0.5 - (grid.origin() + grid.size() * 0.5);
        let aside = (0..vertical).map(|axis| place[axis].powi(2)).sum::<f64>().sqrt();
        place[vertical] + HEAP.3 * aside
    };
    let mut cells: Vec<u32> = (0..grid.number_of_cells() as u32).collect();
    cells.sort_by(|a, b| roof(a).total_cmp(&roof(b)));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let positions = (0..case.grains)
        .map(|grain| corner(cells[grain / capacity as usize]) + V::from_fn(|a| uniform() * grid.side()[a]))
        .collect();
    run.gas = Gas::new(grid, scenario.grain, positions, vec![V::ZERO; case.grains]);
    for _ in 0..STOPS {
        (0..STEPS_BETWEEN_STOPS).for_each(|_| _ = run.step(&mut NoLaps));
        run.gas.velocities_mut().fill(V::ZERO);
        run.engine.forget_pace();
    }
    (0..SETTLING).for_each(|_| _ = run.step(&mut NoLaps));
    run
}

fn parsed(text: &str) -> AnyScenario {
    parse("bench", text, &Overrides::default()).unwrap_or_else(|mistakes| panic!("{mistakes}\n{text}"))
}

/// The scenario of `case`.
fn text(case: Case) -> String {
    let Case { engine, dimension, state, grains, collisions } = case;
    if state == "heap" {
        return heap_text(case);
    }
    let volume_fraction = match (state, dimension) {
        ("dilute", _) => 0.02,
        ("gas" | "clustered", _) => VOLUME_FRACTION,
        ("dense", 2) => 0.5,
        ("dense", _) => 0.4,
        _ => panic!("there is no state {state}"),
    };
    let (side, cells) = match dimension {
        2 => geometry::<DVec2>(grains, volume_fraction),
        _ => geometry::<DVec3>(grains, volume_fraction),
    };
    let restitution = if state == "clustered" { CLUSTERING_RESTITUTION } else { 1.0 };
    let positions = if engine == "event-driven" { "lattice" } else { "random" };
    format!(
        "dimension = {dimension}\n[engine]\nkind = \"{engine}\"\ncell_size = {:?}\n\
         time_step = {{ collisions_per_particle = {collisions} }}\n\
         [domain]\nsize = {:?}\n[particles]\ncount = {grains}\nrestitution = {restitution:?}\n\
         [initial]\npositions = \"{positions}\"\nvelocities = {{ maxwell = 1.0 }}\n[run]\ntime = 1\n",
        side / cells as f64,
        vec![side; dimension],
    )
}

/// `heap-full` without its source, in a box in which the heap takes the same share.
fn heap_text(case: Case) -> String {
    let Case { engine, dimension, grains, .. } = case;
    let (heap_full, width_2d, height, _) = HEAP;
    let width = if dimension == 2 { width_2d } else { HEAP_WIDTH_3D };
    let width = width * (grains as f64 / heap_full).powf(1.0 / dimension as f64);
    // Whole cells with a side of 2.
    let [width, height] = [width, width * height / width_2d].map(|length| 2.0 * (0.5 * length).ceil());
    let (mut gravity, mut size) = (vec![0.0; dimension], vec![width; dimension]);
    gravity[dimension - 1] = -1.0;
    size[dimension - 1] = height;
    let faces = ["x = \"open\"\n", "y = \"open\"\n"][..dimension - 1].concat();
    let vertical = ["x", "y", "z"][dimension - 1];
    format!(
        "dimension = {dimension}\ngravity = {gravity:?}\n\
         [engine]\nkind = \"{engine}\"\ncell_size = 2.0\ntime_step = {{ fixed = 0.1 }}\n\
         [engine.hsmc]\ncell_restitution = {{ at_least = 0.9 }}\nsweeps = 4\n\
         [domain]\nsize = {size:?}\n\
         [boundary]\n{faces}{vertical}.lower = {{ wall = \"rough\" }}\n{vertical}.upper = \"open\"\n\
         [particles]\ncount = {grains}\nrestitution = 0.9\n[run]\ntime = 1\n"
    )
}

/// Side of the box and cells along it, an even number, for `grains` in D dimensions.
pub(crate) fn geometry<V: Vector>(grains: usize, volume_fraction: f64) -> (f64, usize) {
    let root = 1.0 / V::DIMENSION as f64;
    let side = (grains as f64 * V::UNIT_SPHERE_VOLUME / volume_fraction).powf(root);
    let cells = (grains as f64 / PER_CELL).powf(root);
    (side, 2 * (0.5 * cells).round() as usize)
}
