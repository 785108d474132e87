//! Laws that calibrations measure, in the engines that use them: impact parameters and the probability of entering
//! a cell.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "a test tells its figures")]

use std::borrow::Cow;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::law::impact::Impacts;
use grainflow::matter::state_hash::state_hash;
use grainflow::observe::moments::temperature;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;
use grainflow::statistics::average;

const ENGINES: [&str; 3] = ["dsmc", "cba", "hsmc"];

/// A periodic gas of some thousand grains; a dense one fills its cells, a dilute one has a fiftieth of its volume full.
#[derive(Clone, Copy)]
struct Free {
    dimension: usize,
    engine: &'static str,
    is_dense: bool,
}

fn gas(dimension: usize, engine: &'static str, is_dense: bool) -> Free {
    Free { dimension, engine, is_dense }
}

impl Free {
    /// The checked scenario, after some `--set`.
    fn with(self, sets: &[&str]) -> AnyScenario {
        let (side, cell, fraction) = match (self.dimension, self.is_dense) {
            (2, true) => (72.0, 2.5, 0.62),
            (2, false) => (400.0, 16.0, 0.02),
            (_, true) => (16.0, 2.0, 0.48),
            (_, false) => (48.0, 6.0, 0.02),
        };
        let Free { dimension, engine, .. } = self;
        let size = vec![side; dimension];
        let text = format!(
            "dimension = {dimension}\nseed = 5\n[engine]\nkind = \"{engine}\"\ncell_size = {cell}\n\
             [domain]\nsize = {size:?}\n[particles]\nvolume_fraction = {fraction}\nrestitution = 0.9\n\
             [initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\nsteps = 40\n"
        );
        let sets = sets.iter().map(ToString::to_string).collect();
        parse("gas", &text, &Overrides { sets, ..Overrides::default() })
            .unwrap_or_else(|error| panic!("{error}\n{text}"))
    }
}

macro_rules! in_its_space {
    ($any:expr, $scenario:ident => $body:expr) => {
        match $any {
            AnyScenario::Two($scenario) => $body,
            AnyScenario::Three($scenario) => $body,
        }
    };
}

fn start<V: Vector>(scenario: &Scenario<V>) -> Simulation<'_, V> {
    let gas = initial::build(scenario, None).unwrap();
    Simulation::start(scenario, gas, &mut NoLaps).unwrap()
}

fn finish<V: Vector>(simulation: &mut Simulation<'_, V>) {
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
}

/// The state at the end, and how many moves were rejected on the way.
fn outcome(scenario: &AnyScenario) -> (String, u64) {
    in_its_space!(scenario, scenario => {
        let mut simulation = start(scenario);
        finish(&mut simulation);
        (state_hash(simulation.gas()), simulation.totals().counts.rejected_moves)
    })
}

/// −ln T(τ)/T(0) per collision per particle of a dilute gas, with the error from runs of their own.
fn cooling(dimension: usize, engine: &'static str, impacts: &str) -> (f64, f64) {
    let rate = |seed: u32| {
        let seed = format!("seed={seed}");
        let sets = [&seed, impacts, "run={collisions_per_particle=4}", "initial.equilibrate=4"];
        in_its_space!(gas(dimension, engine, false).with(&sets), scenario => {
            let mut simulation = start(&scenario);
            let before = temperature(simulation.gas());
            finish(&mut simulation);
            (before / temperature(simulation.gas())).ln() / simulation.totals().collisions_per_particle
        })
    };
    let rates: Vec<f64> = (1..=6).map(rate).collect();
    let estimate = average(&rates).unwrap();
    (estimate.value, estimate.standard_error.unwrap())
}

/// A collision takes (1 − r²) m g² (1 − b²)/4, so c changes the cooling per collision by ⟨1 − b²⟩. The distribution of
/// velocities changes too, in a₂ of order 0.01 at r = 0.9, and with it the rate by less than 0.005 of itself.
fn cools_as_the_law_says<V: Vector>(engine: &'static str) {
    const BIAS: f64 = 0.005;
    let dimension = V::DIMENSION;
    let (chaos, chaos_error) = cooling(dimension, engine, "engine.impact_parameter=uniform");
    for c in [-2.0, 0.8] {
        let (rate, error) = cooling(dimension, engine, &format!("engine.impact_parameter={{c={c:?}}}"));
        let (ratio, expected) = (rate / chaos, Impacts::new(c).cooling_factor::<V>());
        let error = ratio * (error / rate).hypot(chaos_error / chaos);
        println!("{dimension}D {engine} c = {c}: {ratio:.4} ± {error:.4}, law {expected:.4}");
        assert!((ratio - expected).abs() < 4.0 * error + BIAS * expected);
        // Chaos itself would be found out.
        assert!((ratio - 1.0).abs() > 4.0 * error + BIAS);
    }
}

#[test]
fn a_gas_cools_by_the_energy_that_the_law_leaves_to_collisions() {
    for engine in ENGINES {
        cools_as_the_law_says::<glam::DVec2>(engine);
    }
    cools_as_the_law_says::<glam::DVec3>("cba");
}

const RISING: &str = "engine.impact_parameter={collisions_per_particle=[1.5,1.6],c=[0.0,0.9]}";

#[test]
fn the_law_follows_collisions_per_particle() {
    for engine in ENGINES {
        let after = |impacts: &str, limit: &str| outcome(&gas(2, engine, true).with(&[impacts, limit])).0;
        let [early, late] = ["run={collisions_per_particle=1.4}", "run={collisions_per_particle=3}"];
        assert_eq!(after(RISING, early), after("engine.impact_parameter=uniform", early));
        assert_ne!(after(RISING, late), after("engine.impact_parameter=uniform", late));
        assert_ne!(after(RISING, late), after("engine.impact_parameter={c=0.9}", late));
    }
}

#[test]
fn a_resumed_run_knows_where_in_the_law_it_was() {
    for engine in ENGINES {
        for dimension in [2, 3] {
            in_its_space!(gas(dimension, engine, true).with(&[RISING]), scenario => {
                let mut whole = start(&scenario);
                for _ in 0..25 {
                    whole.advance(&mut NoLaps, Horizon::NONE).unwrap();
                }
                assert!(whole.totals().collisions_per_particle > 1.6);
                let mut saved = whole.saved_state(0, 0);
                saved.columns = Cow::Owned(saved.columns.into_owned());
                let mut resumed = Simulation::resume(&scenario, saved).unwrap();
                finish(&mut resumed);
                finish(&mut whole);
                assert_eq!(state_hash(whole.gas()), state_hash(resumed.gas()));
            });
        }
    }
}

#[test]
fn equilibration_keeps_to_molecular_chaos() {
    let after = |impacts: &str| {
        let sets = [impacts, "initial.equilibrate=2", "run={steps=1}"];
        in_its_space!(gas(2, "cba", false).with(&sets), scenario => state_hash(start(&scenario).gas()))
    };
    assert_eq!(after("engine.impact_parameter={c=0.9}"), after("engine.impact_parameter=uniform"));
}

/// Entry with probability 1 below a volume fraction and 0 from there on.
fn step_at(volume_fraction: f64) -> String {
    let (below, above) = (volume_fraction * (1.0 - 1e-9), volume_fraction);
    format!("engine.hsmc.entry_probability={{volume_fraction=[{below:?},{above:?}],probability=[1.0,0.0]}}")
}

#[test]
fn a_step_function_is_the_rule_of_the_thesis() {
    for dimension in [2, 3] {
        let small = gas(dimension, "hsmc", true);
        let full = in_its_space!(small.with(&[]), scenario => {
            let grid = scenario.grid();
            f64::from(scenario.capacity().unwrap()) * scenario.mean_volume() / grid.cell_volume()
        });
        let thesis = "engine.hsmc.admission=thesis";
        let (state, rejected) = outcome(&small.with(&[thesis]));
        assert!(rejected > 1000, "{rejected}");
        assert_eq!((state, rejected), outcome(&small.with(&[thesis, &step_at(full * (1.0 - 1e-9))])));
        // One grain less makes another gas.
        assert_ne!(rejected, outcome(&small.with(&[thesis, &step_at(0.8 * full)])).1);
    }
}

#[test]
fn open_cells_change_nothing() {
    for dimension in [2, 3] {
        let small = gas(dimension, "hsmc", true);
        let open = "engine.hsmc.entry_probability={volume_fraction=[0.0],probability=[1.0]}";
        assert_eq!(outcome(&small.with(&[])), outcome(&small.with(&[open])));
    }
}

#[test]
fn movers_get_in_with_the_stated_probability() {
    let movers = |probability: &str| {
        let entry =
            format!("engine.hsmc.entry_probability={{volume_fraction=[0.0],probability=[{probability}]}}");
        outcome(&gas(2, "hsmc", false).with(&[&entry, "run={steps=1}"])).1 as f64
    };
    // Of p = 0 nobody gets in: these are all who want to.
    let all = movers("0.0");
    assert!(all > 100.0, "{all}");
    for p in [0.3, 0.8] {
        let refused = movers(&format!("{p:?}"));
        let error = (all * p * (1.0 - p)).sqrt();
        assert!((refused - all * (1.0 - p)).abs() < 4.0 * error, "p = {p}: {refused} of {all}");
    }
}

#[test]
fn no_cell_exceeds_its_capacity_whoever_is_refused() {
    for dimension in [2, 3] {
        let entry = "engine.hsmc.entry_probability={volume_fraction=[0.1,0.8],probability=[1.0,0.1]}";
        in_its_space!(gas(dimension, "hsmc", true).with(&[entry]), scenario => {
            let mut simulation = start(&scenario);
            let capacity = simulation.capacity().unwrap();
            let grains = simulation.gas().len();
            while simulation.end_reason().is_none() {
                let before = simulation.gas().largest_occupancy();
                simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
                assert!(simulation.gas().largest_occupancy() <= capacity.max(before));
            }
            assert_eq!(simulation.gas().len(), grains);
        });
    }
}
