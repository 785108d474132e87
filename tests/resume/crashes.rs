//! The program killed at any moment: its log is readable, and the run goes on to the same end.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use grainflow::record::reader::read_log;
use serde_json::Value;

use super::logs::Place;

/// What is killed: a shear flow, a heap that is poured, and exact dynamics.
const RUNS: [(&str, &[&str]); 3] = [
    ("shear", &["--set", "domain.size=[100.0, 40.0]", "--set", "run.collisions_per_particle=40"]),
    (
        "heap",
        &[
            "--set=domain.size=[120.0, 80.0]",
            "--set=source.position=[60.0]",
            "--set=source.count=150",
            "--set=source.rate=2.0",
            "--set=run.rest=20",
        ],
    ),
    (
        "cooling",
        &[
            "--engine=event-driven",
            "--set=particles.count=1000",
            "--set=domain.size=[56.0, 56.0]",
            "--set=run.collisions_per_particle=30",
        ],
    ),
];

fn grainflow(place: &Place, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
    command.current_dir(place.path(".")).args(arguments).arg("--quiet");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::inherit());
    command
}

fn succeeds(place: &Place, arguments: &[&str]) {
    assert!(grainflow(place, arguments).status().unwrap().success(), "{arguments:?}");
}

/// Waits until the log at `path` has so many bytes, or the program is done.
fn wait_for(child: &mut Child, path: &Path, bytes: u64) {
    let since = Instant::now();
    while fs::metadata(path).map_or(0, |log| log.len()) < bytes && child.try_wait().unwrap().is_none() {
        assert!(since.elapsed() < Duration::from_secs(100), "{} does not grow", path.display());
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Kills each of the runs so many `times`, at moments spread over it; says how far the logs had come.
fn kill(times: [u32; 3]) {
    let (mut kills, mut unfinished, mut from_states) = (0, 0, 0);
    for ((name, sets), times) in RUNS.into_iter().zip(times) {
        let place = Place::new();
        let run = |out: &'static str| [&["run", name, "--out", out], sets].concat();
        succeeds(&place, &run("whole"));
        let whole = fs::read(place.path("whole/log.mcap")).unwrap();
        for k in 0..times {
            let mut child = grainflow(&place, &run("killed")).spawn().unwrap();
            let log = place.path("killed/log.mcap");
            // Multiples of irrational numbers fall everywhere: a length of the log, and a moment after that.
            let [length, pause] = [0.618_034, 0.414_214].map(|step| (f64::from(k + 1) * step) % 1.0);
            wait_for(&mut child, &log, (whole.len() as f64 * length).max(500.0) as u64);
            std::thread::sleep(Duration::from_millis(30).mul_f64(pause));
            child.kill().unwrap();
            child.wait().unwrap();
            let killed = read_log(&log).unwrap();
            kills += 1;
            unfinished += u32::from(killed.cut_off.is_some());
            succeeds(&place, &["run", "--resume", "killed", "--out", "resumed"]);
            assert_eq!(state_hash(&place.path("resumed")), state_hash(&place.path("whole")), "{name}, {k}");
            assert!(fs::read(place.path("resumed/log.mcap")).unwrap() == whole, "{name}, {k}: another log");
            from_states += u32::from(!summary(&place.path("resumed"))["resumed_at"].is_null());
            fs::remove_dir_all(place.path("killed")).unwrap();
            fs::remove_dir_all(place.path("resumed")).unwrap();
        }
    }
    println!(
        "{kills} kills: {kills} readable logs, {unfinished} of them without an end; {kills} resumed runs, {from_states} of \
         them from a state, all with the log of the run that nobody killed, byte for byte"
    );
    assert!(unfinished > 0, "every run had ended before it was killed");
}

fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

fn state_hash(folder: &Path) -> Value {
    summary(folder)["state_hash"].clone()
}

#[test]
fn a_killed_run_goes_on_to_the_same_end() {
    kill([2, 2, 2]);
}

#[test]
#[ignore = "a hundred runs, two minutes: cargo test --release --test resume -- --ignored"]
fn a_hundred_killed_runs_go_on_to_the_same_end() {
    kill([34, 33, 33]);
}
