//! Under fire, in the length of a test: random small scenarios, exact scaling, hostile bytes. The program
//! `examples/soak.rs` does the same at any length.

mod case;
mod draw;
mod gravity;
mod gravity_text;
mod hostile;
mod laws;
mod logs;
mod long;
mod mutation;
mod readers;
mod requests;
mod scaling;
mod states;
mod trial;
mod watch;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::Simulation;
use laws::Laws;
use trial::{Tally, trial};

/// Cases of every test run: scenarios, and shots at each reader.
const CASES: u64 = 40;
const SHOTS: u64 = 1500;
/// Runs under gravity, each gone on with from all of its states.
const GRAVITY_RUNS: u64 = 60;

#[test]
fn small_scenarios_keep_what_they_must() {
    let mut tally = Tally::default();
    let failures: Vec<String> = (1..=CASES).filter_map(|seed| trial(seed, &mut tally).err()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
    // Refused cases and cases without collisions test nothing.
    assert!(tally.held >= CASES * 3 / 4 && tally.collisions > 100 * CASES, "{tally:?}");
}

/// Moves that are rejected give grains back speeds of before their flights: such states must be there to be tried.
#[test]
fn runs_under_gravity_go_on_from_every_state_and_are_verified() {
    let mut tally = gravity::Tally::default();
    let failures: Vec<String> =
        (1..=GRAVITY_RUNS).filter_map(|seed| gravity::trial(seed, &mut tally).err()).collect();
    assert!(failures.is_empty(), "{} of {GRAVITY_RUNS}:\n{}", failures.len(), failures.join("\n\n"));
    let tried = tally.runs >= GRAVITY_RUNS * 9 / 10 && tally.states > 6 * GRAVITY_RUNS && tally.outrun > 0;
    assert!(tried && tally.failed > 2 && tally.stopped > 2, "{tally:?}");
}

#[test]
fn readers_bear_what_is_nearly_right() {
    let place = tempfile::tempdir().unwrap();
    let range = hostile::Range::new(place.path()).unwrap();
    for target in hostile::TARGETS {
        let mut fired = hostile::Fired::default();
        // Whole runs take longer than a look.
        let shots = if matches!(target, "resume" | "verify") { SHOTS / 5 } else { SHOTS };
        let failures: Vec<String> =
            (1..=shots).filter_map(|seed| range.fire(target, seed, &mut fired).err()).collect();
        assert!(failures.is_empty(), "{} of {target}: {}", failures.len(), failures[0]);
        // Wounds that kill everything at the door would reach nothing behind it.
        assert!((shots / 100..shots).contains(&fired.accepted), "{target}: {fired:?}");
    }
}

/// A failure is told by its number: the same number has to be the same case.
#[test]
fn the_same_number_is_the_same_shot() {
    let place = tempfile::tempdir().unwrap();
    let range = hostile::Range::new(place.path()).unwrap();
    for target in hostile::TARGETS {
        let shown: Vec<String> = (1..20).map(|seed| range.show(target, seed)).collect();
        assert_eq!(shown, (1..20).map(|seed| range.show(target, seed)).collect::<Vec<_>>(), "{target}");
        assert!(shown.windows(2).any(|pair| pair[0] != pair[1]), "{target}");
    }
}

#[test]
fn long_runs_lose_nothing() {
    for long in long::all(5e-3) {
        let report = long.run().unwrap_or_else(|problem| panic!("{}: {problem}", long.name));
        assert!(report.done >= 5000 && report.seconds > 0.0, "{}: {report:?}", long.name);
    }
}

fn gas(engine: &str) -> Scenario<glam::DVec2> {
    let text = format!(
        "dimension = 2\n[engine]\nkind = \"{engine}\"\ncell_size = 2.5\n[domain]\nsize = [20.0, 20.0]\n[particles]\n\
         volume_fraction = 0.4\nrestitution = 1.0\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\nsteps = 10\n"
    );
    match parse("gas", &text, &Overrides::default()) {
        Ok(AnyScenario::Two(scenario)) => scenario,
        other => panic!("{other:?}"),
    }
}

/// A billion units of time after the start a step is what it was, and the clock loses nothing of it.
#[test]
fn a_late_start_changes_no_step() {
    for engine in ["dsmc", "cba", "hsmc"] {
        let scenario = gas(engine);
        let after_a_start_at = |start: f64| {
            let gas = initial::build(&scenario, None).unwrap();
            let begun = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
            let mut saved = begun.saved_state(0, 0);
            saved.time = start;
            let mut simulation = Simulation::resume(&scenario, saved).unwrap();
            for _ in 0..300 {
                simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
            }
            let end = simulation.saved_state(0, 0);
            let bits = |vector: &glam::DVec2| (vector.x.to_bits(), vector.y.to_bits());
            let places: Vec<_> = end.columns.positions.iter().map(bits).collect();
            (places, (end.time - start) - end.compensation)
        };
        let (early, late) = (after_a_start_at(0.0), after_a_start_at(1e9));
        assert_eq!(early.0, late.0, "{engine}");
        assert!((early.1 - late.1).abs() < 1e-12 * early.1, "{engine}: {} and {}", early.1, late.1);
    }
}

/// The laws are worth what they find: one grain that is a little faster is enough.
#[test]
fn a_step_that_breaks_a_law_is_found() {
    let scenario = gas("hsmc");
    let gas = initial::build(&scenario, None).unwrap();
    let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
    let mut laws = Laws::of(&scenario, simulation.gas());
    simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    assert_eq!(laws.check(&simulation), Ok(()));
    let spoilt = |spoil: &dyn Fn(&mut Vec<glam::DVec2>, &mut Vec<u32>)| {
        let mut saved = simulation.saved_state(0, 0);
        // What such a state says of its fastest grain would give it away.
        saved.largest_speed = None;
        let columns = saved.columns.to_mut();
        spoil(&mut columns.velocities, &mut columns.ids);
        let spoilt = Simulation::resume(&scenario, saved).map_err(|misfit| misfit.to_string())?;
        Laws::of(&scenario, simulation.gas()).check(&spoilt)
    };
    assert_eq!(spoilt(&|_, _| {}), Ok(()));
    let heated = spoilt(&|velocities, _| {
        velocities[0] *= 1.0 + 1e-8;
        velocities[1] *= 1.0 + 1e-8;
    });
    assert!(heated.is_err_and(|problem| problem.contains("momentum") || problem.contains("energy")));
    let pushed = spoilt(&|velocities, _| {
        for velocity in velocities {
            velocity.x = 0.5 * velocity.x + 1e-8;
        }
    });
    assert!(pushed.is_err_and(|problem| problem.contains("momentum along axis 0")));
    let doubled = spoilt(&|_, ids| ids[0] = ids[1]);
    assert!(doubled.is_err_and(|problem| problem.contains("identity")));
}

/// A displacement may carry a grain out through an open side; when its move is then rejected for lack
/// of room, it must not keep a place outside the box.
#[test]
fn no_grain_stays_beyond_an_open_side() {
    for seed in 0..40 {
        let text = format!(
            "dimension = 2\nseed = {seed}\n[engine]\nkind = \"hsmc\"\ncell_size = 3.0\ntime_step = {{ crossing = 0.5 }}\n\
             transfer = \"corrected\"\n[engine.hsmc]\nsweeps = 2\n[domain]\nsize = [24.0, 48.0]\n[boundary]\n\
             y.lower = {{ wall = \"rough\", restitution = 0.3 }}\ny.upper = \"open\"\n[particles]\nvolume_fraction = 0.51\n\
             restitution = 1.0\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\nsteps = 25\n"
        );
        let Ok(AnyScenario::Two(scenario)) = parse("beyond", &text, &Overrides::default()) else {
            panic!("{text}")
        };
        let gas = initial::build(&scenario, None).unwrap();
        let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
        let mut laws = Laws::of(&scenario, simulation.gas());
        while simulation.end_reason().is_none() {
            simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
            assert_eq!(laws.check(&simulation), Ok(()), "seed {seed}");
        }
    }
}
