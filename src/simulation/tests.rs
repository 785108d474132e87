use super::*;
use crate::engine::cell_counts::CellCount;
use crate::engine::report::{Counts, StepReport};
use crate::engine::{EngineMisfit, EngineState, NoLaps};
use crate::scenario::initial;
use crate::scenario::model::AnyScenario;
use glam::DVec2;

/// Time between two collisions of the whole gas.
const BEAT: f64 = 0.013;
/// Collisions after which it stops on its own.
const PATIENCE: u64 = 50;

/// Counts collisions at equal distances and moves nothing.
struct Beats {
    collided: u64,
    calls: u64,
}

impl Engine<DVec2> for Beats {
    fn step(
        &mut self,
        gas: &mut Gas<DVec2>,
        horizon: Horizon,
        _laps: &mut dyn Laps,
    ) -> Result<StepReport<DVec2>, EngineError> {
        let now = gas.time();
        assert!(horizon.time > now && horizon.collisions > 0);
        self.calls += 1;
        let next = |collided: u64| (collided + 1) as f64 * BEAT;
        let mut collisions = 0;
        let mut time = now;
        while collisions < horizon.collisions.min(PATIENCE) && next(self.collided) <= horizon.time {
            if gas.is_empty() {
                self.collided = (horizon.time / BEAT) as u64;
                break;
            }
            time = next(self.collided);
            self.collided += 1;
            collisions += 1;
        }
        if collisions < horizon.collisions.min(PATIENCE) {
            time = horizon.time;
        }
        gas.clock = crate::matter::clock::Clock::restored(time, 0.0);
        let mut report = StepReport { duration: time - now, ..StepReport::default() };
        report.counts = Counts { collisions, ..Counts::default() };
        report.events.all = collisions;
        Ok(report)
    }

    fn state(&self) -> EngineState {
        EngineState { words: vec![self.collided as u32], ..EngineState::default() }
    }

    fn restore(&mut self, state: &EngineState, _gas: &Gas<DVec2>) -> Result<(), EngineMisfit> {
        self.collided = u64::from(state.words[0]);
        Ok(())
    }

    fn forget_pace(&mut self) {}

    fn count_in_cells(&mut self, _counts: Vec<CellCount>) {}

    fn cell_counts(&self) -> &[CellCount] {
        &[]
    }

    fn capacity(&self, _gas: &Gas<DVec2>) -> Option<u32> {
        None
    }

    fn excludes_overlap(&self) -> bool {
        true
    }
}

fn scenario(text: &str) -> Scenario<DVec2> {
    match crate::scenario::parse("test", text, &Default::default()).unwrap() {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => panic!("the scenario is flat"),
    }
}

fn gas_of(run: &str) -> Scenario<DVec2> {
    scenario(&format!(
        r#"
dimension = 2
[engine]
kind = "dsmc"
cell_size = 2.0
time_step = {{ fixed = 0.1 }}
[domain]
size = [20.0, 20.0]
[particles]
count = 9
diameter = 1.0
mass = 1.0
restitution = 0.9
[initial]
velocities = {{ maxwell = 1.0 }}
[run]
{run}
"#
    ))
}

fn poured(run: &str) -> Scenario<DVec2> {
    scenario(&format!(
        r#"
dimension = 2
gravity = [0.0, -1.0]
[engine]
kind = "dsmc"
cell_size = 2.0
time_step = {{ fixed = 0.1 }}
[domain]
size = [20.0, 40.0]
[boundary]
y.lower = {{ wall = "smooth" }}
y.upper = "open"
[particles]
count = 0
diameter = 1.0
mass = 1.0
restitution = 0.9
[source]
count = 3
rate = 0.3
width = 0.0
[run]
{run}
"#
    ))
}

/// A simulation of `scenario` by beats.
fn beating(scenario: &Scenario<DVec2>) -> Simulation<'_, DVec2> {
    let gas = initial::build(scenario, None).unwrap();
    let mut simulation = Simulation::start(scenario, gas, &mut NoLaps).unwrap();
    simulation.engine = Box::new(Beats { collided: 0, calls: 0 });
    simulation
}

/// Runs to the end; when each of `frames` recordings was due, and the calls that it took.
fn recorded(simulation: &mut Simulation<'_, DVec2>, frames: Spread) -> (Vec<(f64, f64)>, u32) {
    let (mut times, mut calls) = (Vec::new(), 0);
    let mut done = 0;
    loop {
        let (time, progress) = (simulation.gas().time(), simulation.progress());
        if frames.is_due(done, time, progress) {
            times.push((time, simulation.totals().collisions_per_particle));
            done = frames.next(time, progress).max(done + 1);
        }
        if simulation.end_reason().is_some() {
            return (times, calls);
        }
        let horizon = simulation.horizon_of(frames, done);
        simulation.advance(&mut NoLaps, horizon).unwrap();
        calls += 1;
        assert!(calls < 5000, "at t = {time}");
    }
}

#[test]
fn recordings_come_exactly_at_their_times() {
    let scenario = gas_of("time = 7.0");
    let mut simulation = beating(&scenario);
    let (times, _) = recorded(&mut simulation, Spread::Even(7));
    for (k, (time, _)) in times.iter().enumerate() {
        assert_eq!(*time, k as f64);
    }
    assert_eq!((times.len(), simulation.end_reason()), (8, Some(EndReason::Time)));
    let (times, _) = recorded(&mut beating(&scenario), Spread::Every(0.7));
    assert!(times.iter().enumerate().all(|(k, (time, _))| *time == k as f64 * 0.7) && times.len() > 9);
}

#[test]
fn collisions_end_a_run_at_the_collision_that_is_enough() {
    let scenario = gas_of("collisions_per_particle = 20.1");
    let mut simulation = beating(&scenario);
    let (times, _) = recorded(&mut simulation, Spread::Even(4));
    assert_eq!(simulation.end_reason(), Some(EndReason::CollisionsPerParticle));
    // 20.1 · 9/2 = 90.45.
    assert_eq!(simulation.totals().counts.collisions, 91);
    let collisions: Vec<f64> = times.iter().map(|(_, done)| (done * 4.5).round()).collect();
    assert_eq!(collisions, [0.0, 23.0, 46.0, 68.0, 91.0]);
}

#[test]
fn the_limit_that_comes_first_decides() {
    // 9 grains collide 1/(4.5 · 0.013) = 17.1 times per time.
    let scenario = gas_of("time = 3.0\ncollisions_per_particle = 100.0");
    let mut simulation = beating(&scenario);
    let (times, _) = recorded(&mut simulation, Spread::Even(10));
    assert_eq!((times.len(), simulation.gas().time()), (11, 3.0));
}

#[test]
fn who_looks_changes_nothing() {
    let scenario = gas_of("time = 3.0");
    let (mut often, mut rarely) = (beating(&scenario), beating(&scenario));
    recorded(&mut often, Spread::Even(997));
    recorded(&mut rarely, Spread::Start);
    assert_eq!(often.totals(), rarely.totals());
    assert_eq!(often.engine.state(), rarely.engine.state());
    assert_eq!(often.samples, rarely.samples);
}

#[test]
fn grains_are_poured_at_their_times_and_wait_for_room() {
    // The grains do not move: the second one waits for ever, and so does the end.
    let scenario = poured("time = 20.0\nrest = 5.0");
    let mut simulation = beating(&scenario);
    let frames = Spread::Even(10);
    let (times, calls) = recorded(&mut simulation, frames);
    assert_eq!((simulation.totals().poured, simulation.end_reason()), (1, Some(EndReason::Time)));
    assert_eq!(simulation.gas().time(), 20.0);
    // At most 2048 samples, and the trials and recordings.
    assert!(times.len() >= 10 && calls < 2500, "{} {calls}", times.len());
    let pouring = simulation.pouring.as_ref().unwrap();
    assert_eq!(pouring.last_poured(), 0.0);
    let (held, nominal) = (pouring.held_until(), 1.0 / 0.3);
    assert!((20.0..20.0 + 0.05 / 0.3).contains(&held));
    // Every trial was a whole number of pauses after the nominal time.
    let pauses = (held - nominal) / (0.05 / 0.3);
    assert!((pauses - pauses.round()).abs() < 1e-9, "{pauses}");
}

#[test]
fn a_rest_ends_after_the_last_grain() {
    let scenario = poured("rest = 5.0");
    let mut simulation = beating(&scenario);
    let mut calls = 0;
    while simulation.end_reason().is_none() {
        // What is poured falls out of the way at once.
        for position in simulation.gas.parts_mut().2.positions.iter_mut().filter(|p| p.y > 1.0) {
            position.x = 0.5;
        }
        let horizon = simulation.horizon_of(Spread::Even(4), calls);
        simulation.advance(&mut NoLaps, horizon).unwrap();
        calls += 1;
        assert!(calls < 3000);
    }
    assert_eq!(simulation.totals().poured, 3);
    assert_eq!(simulation.pouring.as_ref().unwrap().last_poured(), 2.0 / 0.3);
    assert_eq!(simulation.gas().time(), 2.0 / 0.3 + 5.0);
    assert_eq!(simulation.progress(), 1.0);
}

#[test]
fn a_source_that_waits_resumes_to_the_same_bits() {
    let scenario = poured("time = 9.0");
    let mut whole = beating(&scenario);
    while whole.gas().time() < 4.0 {
        whole.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let mut saved = whole.saved_state(0, 0);
    saved.columns = Cow::Owned(saved.columns.into_owned());
    let begun = SavedState { engine: EngineState::default(), ..saved.clone() };
    let mut resumed = Simulation::resume(&scenario, begun).unwrap();
    resumed.engine = Box::new(Beats { collided: 0, calls: 0 });
    resumed.engine.restore(&saved.engine, &resumed.gas).unwrap();
    for simulation in [&mut whole, &mut resumed] {
        recorded(simulation, Spread::Start);
    }
    // The shortest decimal that reads back the same: equal text is equal bits, also where there is no number.
    let text = |simulation: &Simulation<'_, DVec2>| format!("{:?}", simulation.saved_state(0, 0));
    assert_eq!(text(&whole), text(&resumed));
}

/// Grains poured at `rate` by hsmc, to a rest of 20 time units after the last one: how many came, and how high the highest
/// ever was.
fn poured_at(rate: f64) -> (u64, f64) {
    let scenario = scenario(&format!(
        r#"
dimension = 2
gravity = [0.0, -1.0]
[engine]
kind = "hsmc"
cell_size = 2.0
time_step = {{ fixed = 0.1 }}
[engine.hsmc]
cell_restitution = {{ at_least = 0.9 }}
sweeps = 4
[domain]
size = [20.0, 100.0]
[boundary]
y.lower = {{ wall = "rough" }}
y.upper = "open"
[particles]
count = 0
restitution = 0.5
[source]
count = 100
rate = {rate:?}
[run]
rest = 20.0
"#
    ));
    let gas = initial::build(&scenario, None).unwrap();
    let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
    let mut highest = 0.0_f64;
    while simulation.end_reason().is_none() {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
        highest = simulation.gas().positions().iter().fold(highest, |h, p| h.max(p.y));
    }
    (simulation.totals().poured, highest)
}

#[test]
fn a_source_does_not_climb_on_its_own_stream() {
    // A hundred disks on a floor of 20 d lie about 6 d high at the end. A spout that took its stream for a heap left the box of
    // 100 d at t = 9.8.
    let (poured, highest) = poured_at(8.0);
    assert_eq!(poured, 100);
    assert!(highest > 9.9 && highest < 30.0, "{highest}");
}

#[test]
fn measures_that_remember_otherwise_begin_anew_and_the_others_go_on() {
    let scenario = scenario(
        "dimension = 2\n[engine]\nkind = \"cba\"\ncell_size = 2.0\n[domain]\nsize = [20.0, 20.0]\n[particles]\ncount = 90\n\
         restitution = 0.9\n[initial]\nvelocities = { maxwell = 1.0 }\n[run]\ntime = 9.0\n",
    );
    let gas = initial::build(&scenario, None).unwrap();
    let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
    for _ in 0..20 {
        simulation.advance(&mut NoLaps, Horizon::NONE).unwrap();
    }
    let mut state = simulation.saved_state(0, 0);
    assert!(Simulation::resume(&scenario, state.clone()).unwrap().begun_anew().is_empty());
    // As earlier versions remembered it: no previous row, then rows of time, temperature, Σ p·s and grains.
    let place = state.memories.iter().position(|(name, _)| name == "pressure").unwrap();
    state.memories[place].1 = vec![0.0, 0.0, 1.0, 0.0, 90.0];
    // Of this version it would be no memory of a run.
    assert!(Simulation::resume(&scenario, state.clone()).is_err());
    // Earlier versions counted the samples of every run from 1 on.
    state.samples.fill(3);
    let resumed = Simulation::resume(&scenario, state).unwrap();
    assert_eq!(resumed.gas().time(), simulation.gas().time());
    assert_eq!(resumed.begun_anew(), ["pressure"]);
}
