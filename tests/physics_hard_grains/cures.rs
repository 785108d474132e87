//! Cures of inelastic collapse (Simić 2017, figures 7.3 and 7.4), and collapse without one.

use std::process::{Command, Output};

use glam::DVec2;
use grainflow::engine::EngineError;
use grainflow::record::reader::read_log;

use crate::trial::Trial;

/// The four cures, with the thermal speed 1 and diameter 2 at the start.
const CURES: [&str; 4] = [
    "{ elastic_below = 1e-3 }",
    "{ contact_time = 1e-3 }",
    "{ rotation = 5.0 }",
    "{ elastic_below = 1e-3, rotation = 5.0 }",
];

/// 2600 disks between smooth elastic walls.
fn text(restitution: f64, cure: &str) -> String {
    format!(
        "dimension = 2\n[engine]\nkind = \"event-driven\"\n[engine.event_driven]\ncollapse = {cure}\n\
         [domain]\nsize = [240.0, 240.0]\n\
         [boundary]\nx.lower = {{ wall = \"smooth\", restitution = 1.0 }}\nx.upper = {{ wall = \"smooth\", restitution = 1.0 }}\n\
         y.lower = {{ wall = \"smooth\", restitution = 1.0 }}\ny.upper = {{ wall = \"smooth\", restitution = 1.0 }}\n\
         [particles]\ncount = 2600\ndiameter = 2.0\nrestitution = {restitution}\n\
         [initial]\nvelocities = {{ maxwell = 1.0 }}\nequilibrate = 10\n[run]\ncollisions_per_particle = 800\n"
    )
}

/// T/T₀ at each of `taus` collisions per particle.
fn temperatures(restitution: f64, cure: &str, taus: &[f64]) -> Vec<f64> {
    let mut trial = Trial::<DVec2>::equilibrated(&text(restitution, cure), 1, 10.0);
    let start = std::time::Instant::now();
    let mut at = |&tau: &f64| {
        trial.advance_to(tau);
        trial.temperature()
    };
    let found: Vec<f64> = taus.iter().map(&mut at).collect();
    let shown: Vec<String> = found.iter().map(|found| format!("{found:.2e}")).collect();
    let events = trial.totals.events;
    println!(
        "r = {restitution} {cure}: T at {taus:?} {}, t = {:.1}, {} events, cured {:.2e} of collisions, {:.1} s",
        shown.join(" "),
        trial.gas.time(),
        events.all,
        events.cured as f64 / trial.totals.counts.collisions as f64,
        start.elapsed().as_secs_f64(),
    );
    assert_eq!(trial.invalid_states(), 0);
    found
}

/// Largest ratio of temperatures of two cures, at each of `taus`.
fn spread(restitution: f64, taus: &[f64]) -> Vec<f64> {
    let runs = CURES.map(|cure| temperatures(restitution, cure, taus));
    let at = |k: usize| {
        let all = runs.each_ref().map(|run| run[k]);
        all.iter().copied().fold(0.0, f64::max) / all.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let spread: Vec<f64> = (0..taus.len()).map(at).collect();
    println!("r = {restitution}: largest over smallest T at {taus:?} {spread:.3?}");
    spread
}

#[test]
fn cures_agree_for_a_while() {
    for restitution in [0.95, 0.70] {
        spread(restitution, &[10.0, 100.0]);
    }
}

#[test]
#[ignore = "full statement: cargo test --release --test physics_hard_grains -- --ignored"]
fn cures_agree_to_800_collisions_per_particle() {
    for restitution in [0.95, 0.70] {
        spread(restitution, &[10.0, 50.0, 100.0, 200.0, 400.0, 800.0]);
    }
}

#[test]
fn without_a_cure_a_dissipative_gas_collapses() {
    let mut trial = Trial::<DVec2>::equilibrated(&text(0.7, "\"none\""), 1, 10.0);
    let outcome = trial.try_to_advance_to(800.0);
    println!("r = 0.7 without a cure: τ = {}, {outcome:?}", trial.totals.collisions_per_particle);
    assert!(matches!(outcome, Err(EngineError::Collapse { .. })));
}

fn grainflow(folder: &std::path::Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

#[test]
fn a_collapse_ends_the_program_with_a_word_and_a_readable_log() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("simic.toml"), text(0.7, "\"none\"")).unwrap();
    let output = grainflow(folder.path(), &["run", "simic.toml", "--out", "run", "--quiet"]);
    let said = String::from_utf8(output.stderr).unwrap();
    println!("{said}");
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("inelastic collapse at t = ") && said.contains("collapse = { contact_time = "), "{said}");
    let mut logs = Vec::new();
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path().join("log.mcap");
        if path.exists() {
            logs.push(path);
        }
    }
    assert_eq!(logs.len(), 1, "one run folder");
    let log = read_log(&logs[0]).unwrap();
    assert!(!log.state_hashes.is_empty());
}
