//! Runs that go on from a log, logs that are verified, logs that are recovered.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "what was tried is worth knowing")]

mod brief;
mod changes;
mod commands;
mod crashes;
mod damage;
mod failures;
mod foreign;
mod logs;
mod refusals;
#[path = "../small_scenarios/mod.rs"]
#[expect(dead_code, reason = "its gases are for other tests")]
mod small_scenarios;

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use grainflow::run::resume::Resumption;
use grainflow::run::verify::Verdict;
use grainflow::run::{Outcome, run};
use grainflow::scenario::model::{AnyScenario, EngineKind};
use grainflow::scenario::{Overrides, builtin, load};
use logs::{Place, figures, log_bytes, resume, run_into, verified};
use small_scenarios::{Small, driven};

/// What makes a built-in scenario small.
fn smaller(name: &str) -> &'static [&'static str] {
    const HEAP: &[&str] = &[
        "domain.size=[60.0, 60.0]",
        "source.position=[30.0]",
        "source.count=40",
        "source.rate=4.0",
        "run.rest=4.0",
        // Without a cure exact dynamics collapses: that has a test of its own.
        "engine.event_driven.collapse={ elastic_below = 0.05 }",
    ];
    match name {
        "clustering" => &["particles.count=400", "domain.size=[35.4, 35.4]", "run.collisions_per_particle=4"],
        "cooling" => &[
            "particles.count=400",
            "domain.size=[35.4, 35.4]",
            "run.collisions_per_particle=4",
            "record.measures=[\"energy\", \"collisions\", \"pair-correlation\", \"structure-factor\", \"clusters\"]",
        ],
        "correlations" => {
            &["particles.count=300", "domain.size=[70.0, 70.0]", "run.collisions_per_particle=4"]
        }
        "hard-spheres" => &["domain.size=[7.0, 7.0, 7.0]", "run.collisions_per_particle=4"],
        "heap" | "heap-full" => HEAP,
        "pipe" => &["domain.size=[20.0, 32.0]", "run.time=6"],
        "sedimentation" => &["run.time=0.05"],
        "shear" => &["domain.size=[60.0, 20.0]", "run.collisions_per_particle=4"],
        "simic-cooling" => {
            &["particles.count=200", "domain.size=[70.0, 70.0]", "run.collisions_per_particle=4"]
        }
        _ => panic!("{name} is not made small yet: say how"),
    }
}

/// Every built-in scenario with every engine that takes it.
fn built_in() -> Vec<(String, AnyScenario)> {
    let mut scenarios = Vec::new();
    for (name, _) in builtin::list() {
        for kind in EngineKind::ALL {
            let mut sets = smaller(name).to_vec();
            sets.extend(["record.frames=12", "record.states=3"]);
            let overrides = Overrides {
                sets: sets.iter().map(ToString::to_string).collect(),
                engine: Some(kind.name().to_owned()),
                seed: None,
            };
            match load(name, &overrides) {
                Ok(scenario) => scenarios.push((format!("{name} with {}", kind.name()), scenario)),
                Err(error) => println!("{name} refuses {}: {error}", kind.name()),
            }
        }
    }
    scenarios
}

/// Runs `scenario`, verifies its log, cuts it off at some tenths of its length, and resumes what is left.
fn assert_goes_on(label: &str, scenario: &AnyScenario, tenths: &[usize]) {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), scenario);
    let (extent, cut_off) = verified(&whole.folder);
    assert!(extent.hashes >= 2 && extent.states >= 4 && cut_off.is_none(), "{label}: {extent:?}");
    let bytes = log_bytes(&whole);
    for tenth in tenths {
        let killed = place.path(&format!("killed-{tenth}.mcap"));
        fs::write(&killed, &bytes[..bytes.len() * tenth / 10]).unwrap();
        let (killed_extent, cut_off) = verified(&killed);
        assert!(killed_extent.hashes <= extent.hashes && cut_off.is_some(), "{label}: {killed_extent:?}");
        let resumed = resume(&killed, &[], &place.path(&format!("resumed-{tenth}")));
        assert_same(&format!("{label}, {tenth} tenths"), &whole, &resumed);
    }
}

/// Asserts that the second run is the first: its figures, its tables, and every byte of its log.
fn assert_same(label: &str, whole: &Outcome, resumed: &Outcome) {
    assert_eq!(figures(whole), figures(resumed), "{label}");
    let text = |outcome: &Outcome, file: &str| fs::read_to_string(outcome.folder.join(file)).unwrap();
    assert_eq!(text(whole, "series.csv"), text(resumed, "series.csv"), "{label}");
    for profile in fs::read_dir(whole.folder.join("profiles")).into_iter().flatten() {
        let name = format!("profiles/{}", profile.unwrap().file_name().to_string_lossy());
        assert_eq!(text(whole, &name), text(resumed, &name), "{label}: {name}");
    }
    assert!(log_bytes(whole) == log_bytes(resumed), "{label}: the logs differ");
}

#[test]
fn every_built_in_scenario_is_verified_and_goes_on_with_every_engine() {
    let scenarios = built_in();
    assert!(scenarios.len() > 30, "{}", scenarios.len());
    for (label, scenario) in scenarios {
        assert_goes_on(&label, &scenario, &[4, 8]);
    }
}

#[test]
fn driven_matter_goes_on_in_two_and_three_dimensions() {
    for engine in ["dsmc", "hsmc"] {
        for small in [driven(2, engine), driven(3, engine)].concat() {
            let scenario = small.with(&["record.frames=6", "record.states=3", "run.steps=30"]);
            assert_goes_on(&small.name, &scenario, &[6]);
        }
    }
}

/// Runs until `steps` steps, or stops, are made; then somebody interrupts.
fn interrupted(scenario: &AnyScenario, folder: &std::path::Path, steps: u32) -> Outcome {
    let (stop, mut made) = (AtomicBool::new(false), 0);
    let outcome = run(scenario, folder, false, &stop, &mut |_| {
        made += 1;
        stop.store(made > steps, SeqCst);
    });
    let outcome = outcome.unwrap();
    assert!(outcome.interrupted);
    outcome
}

#[test]
fn an_interrupted_run_goes_on_as_if_nothing_had_happened() {
    for engine in ["cba", "event-driven"] {
        let small = gas(engine);
        let place = Place::new();
        let scenario = small.with(&[]);
        let whole = run_into(&place.path("whole"), &scenario);
        let once = interrupted(&scenario, &place.path("once"), 17);
        let (extent, cut_off) = verified(&once.folder);
        assert!(extent.time > 0.0 && cut_off.is_none(), "{extent:?}");
        // It goes on, is interrupted once more, and goes on.
        let stop = AtomicBool::new(false);
        let resumption = Resumption::open(&once.folder, &[]).unwrap();
        let mut made = 0;
        let twice = resumption.run(&place.path("twice"), false, &stop, &mut |_| {
            made += 1;
            stop.store(made > 19, SeqCst);
        });
        let twice = twice.unwrap();
        assert!(twice.interrupted && twice.summary["resumed_at"].is_f64());
        let (further, _) = verified(&twice.folder);
        assert!(further.time > extent.time);
        let end = resume(&twice.folder, &[], &place.path("end"));
        assert_same(engine, &whole, &end);
    }
}

/// Grains whose moves are rejected keep the speeds of before their flights, and so do the states that hold them.
#[test]
fn runs_under_gravity_are_verified_and_go_on() {
    let built_in = |name: &str, sets: &[&str]| {
        let sets = sets.iter().map(ToString::to_string).collect();
        load(name, &Overrides { sets, ..Default::default() }).unwrap()
    };
    let place = Place::new();
    let grains = run_into(&place.path("grains"), &built_in("sedimentation", &[]));
    let (extent, cut_off) = verified(&grains.folder);
    assert!(extent.states == 5 && cut_off.is_none(), "{extent:?}");
    assert_same("sedimentation", &grains, &resume(&grains.folder, &[], &place.path("again")));
    let heap = run_into(&place.path("heap"), &built_in("heap", &["source.count=800"]));
    assert_same("heap", &heap, &resume(&heap.folder, &[], &place.path("heap again")));
}

#[test]
fn a_run_that_has_ended_gives_its_end_again() {
    for (frames, engine) in
        [("record.frames=5", "hsmc"), ("record.frames=0", "dsmc"), ("record.every=0.7", "event-driven")]
    {
        let place = Place::new();
        let whole = run_into(&place.path("whole"), &gas(engine).with(&[frames]));
        let again = resume(&whole.folder, &[], &place.path("again"));
        assert_same(engine, &whole, &again);
        assert_eq!(again.summary["resumed_at"], again.summary["simulated_time"]);
    }
}

#[test]
fn states_every_so_much_time_leave_little_to_repeat() {
    let place = Place::new();
    let scenario = gas("event-driven").with(&["record.state_every=0.25", "run.time=2"]);
    let whole = run_into(&place.path("whole"), &scenario);
    let (extent, _) = verified(&whole.folder);
    // One at the start and one every quarter; the last of them is that of the end.
    assert_eq!(extent.states, 9);
}

/// A small gas.
fn gas(engine: &str) -> Small {
    Small {
        name: "gas".to_owned(),
        text: format!(
            "dimension = 2\nseed = 3\n[engine]\nkind = \"{engine}\"\n[domain]\nsize = [30.0, 30.0]\n[particles]\ncount = 250\n\
             restitution = 0.9\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\ncollisions_per_particle = 6.0\n\
             [record]\nframes = 20\n"
        ),
    }
}

#[test]
fn a_verdict_says_what_was_compared() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("hsmc").with(&[]));
    let verdict = logs::verify(&whole.folder).unwrap();
    let Verdict::Identical(extent, None) = verdict else { panic!("{verdict:?}") };
    assert_eq!((extent.hashes, extent.states), (21, 5));
    assert_eq!(Some(extent.particle_steps), whole.summary["steps"].as_u64().map(|steps| 250 * steps));
}
