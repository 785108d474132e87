//! The commands as people and scripts meet them: exit codes, files, texts.

use std::fs;
use std::process::{Command, Output, Stdio};

use super::logs::{Place, chunks, rewritten, without_chunk};

const GAS: [&str; 9] = [
    "run",
    "cooling",
    "--set",
    "particles.count=300",
    "--set",
    "run.collisions_per_particle=3",
    "--out",
    "run",
    "--quiet",
];

/// Runs the program; its exit code, what it says, and what it complains of.
fn grainflow(place: &Place, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
    command.current_dir(place.path(".")).args(arguments).stdin(Stdio::null());
    let Output { status, stdout, stderr } = command.output().unwrap();
    (status.code().unwrap(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

fn with_a_run() -> (Place, Vec<u8>) {
    let place = Place::new();
    assert_eq!(grainflow(&place, &GAS).0, 0);
    let bytes = fs::read(place.path("run/log.mcap")).unwrap();
    (place, bytes)
}

#[test]
fn a_killed_run_is_resumed_and_verified() {
    let (place, bytes) = with_a_run();
    fs::create_dir(place.path("killed")).unwrap();
    fs::write(place.path("killed/log.mcap"), &bytes[..bytes.len() * 7 / 10]).unwrap();
    let (code, said, complaint) = grainflow(&place, &["replay", "killed", "--verify"]);
    assert_eq!((code, complaint.as_str()), (0, ""));
    assert!(said.starts_with("verified up to t = ") && said.contains("is cut off after"), "{said}");
    let (code, said, complaint) = grainflow(&place, &["run", "--resume", "killed"]);
    assert_eq!((code, complaint.as_str()), (0, ""));
    assert!(said.contains("goes on from the state at t = ") && said.contains(" s since t = "), "{said}");
    assert!(said.contains("wrote killed-resumed/report.html"), "{said}");
    assert!(fs::read(place.path("killed-resumed/log.mcap")).unwrap() == bytes);
    let (code, said, _) = grainflow(&place, &["replay", "killed-resumed/log.mcap", "--verify"]);
    assert_eq!(code, 0);
    assert!(said.starts_with("verified: ") && said.ends_with(" particle-steps, identical\n"), "{said}");
    // Again: the folder is there.
    let (code, _, complaint) = grainflow(&place, &["run", "--resume", "killed"]);
    assert!(code == 2 && complaint.contains("already holds something"), "{complaint}");
    assert_eq!(grainflow(&place, &["run", "--resume", "killed", "--force", "--quiet"]).0, 0);
    // A log can take the place of the one that it goes on from.
    assert_eq!(grainflow(&place, &["run", "killed", "--resume", "--out=killed", "--force", "--quiet"]).0, 0);
    assert!(fs::read(place.path("killed/log.mcap")).unwrap() == bytes);
}

#[test]
fn what_is_wrong_has_its_exit_code() {
    let (place, bytes) = with_a_run();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let (found, said, complaint) = grainflow(&place, arguments);
        assert!(found == code && complaint.contains(words), "{arguments:?}: {found}: {said}{complaint}");
    };
    let other = rewritten(&bytes, |_| {}, |text| text.replace("seed = 1", "seed = 2"));
    fs::write(place.path("other.mcap"), other).unwrap();
    refused(&["replay", "other.mcap", "--verify"], 3, "error: not verified: the log was made with seed 1");
    refused(&["run", "--resume", "other.mcap"], 2, "is not the one that the log was begun with");
    fs::write(place.path("chunk.mcap"), without_chunk(&bytes, 3)).unwrap();
    refused(&["replay", "chunk.mcap", "--verify"], 2, "is not whole");
    refused(&["replay", "none.mcap", "--verify"], 2, "cannot read the log none.mcap");
    refused(&["run", "--resume", "run", "--seed", "3"], 2, "--seed: a run that goes on keeps its scenario");
    refused(&["run", "--resume", "run", "--engine", "cba"], 2, "--engine: a run that goes on");
    refused(
        &["run", "--resume", "run", "--set", "gravity=[0,1]"],
        2,
        "only run.*, record.* and engine.event_driven.collapse may change",
    );
    assert!(!place.path("run-resumed").exists() && !place.path("out").exists());
}

#[test]
fn recover_says_what_it_found() {
    let (place, bytes) = with_a_run();
    let (code, said, _) = grainflow(&place, &["recover", "run"]);
    assert_eq!((code, said.as_str()), (0, "run/log.mcap is whole: nothing to recover, nothing written\n"));
    let mut damaged = bytes.clone();
    damaged[chunks(&bytes)[5].end - 30] ^= 1;
    fs::write(place.path("bad.mcap"), &damaged).unwrap();
    let (code, said, complaint) = grainflow(&place, &["recover", "bad.mcap"]);
    assert_eq!((code, complaint.as_str()), (0, ""));
    for words in ["1 part of the file is damaged", "lost: 1 message of /measures", "whole up to t = "] {
        assert!(said.contains(words), "{said}");
    }
    assert!(said.ends_with("wrote bad.recovered.mcap\n"), "{said}");
    assert!(fs::read(place.path("bad.mcap")).unwrap() == damaged);
    let (code, _, complaint) = grainflow(&place, &["recover", "bad.mcap"]);
    assert!(code == 2 && complaint.contains("exists already"), "{complaint}");
    let (code, _, complaint) = grainflow(&place, &["recover", "bad.mcap", "--out", "bad.mcap"]);
    assert!(code == 2 && complaint.contains("exists already"), "{complaint}");
    let (code, _, complaint) = grainflow(&place, &["replay", "bad.recovered.mcap", "--verify"]);
    assert!(code == 2 && complaint.contains("was recovered from a damaged one"), "{complaint}");
    assert_eq!(grainflow(&place, &["run", "--resume", "bad.recovered.mcap", "--out", "end", "--quiet"]).0, 0);
    fs::write(place.path("empty.mcap"), b"").unwrap();
    let (code, _, complaint) = grainflow(&place, &["recover", "empty.mcap"]);
    assert!(code == 2 && complaint.contains("is empty"), "{complaint}");
}
