//! A machine that fails the program: full disks, limits, folders that vanish, signals, nobody who listens.

use std::fs;
use std::io::Write as _;

use grainflow::record::reader::{last_state, read_log};
use grainflow::record::recover::recover;

use crate::place::{Place, Said};
use crate::signal::send;

/// A run that writes some hundred kilobytes.
const RUN: &str =
    "run cooling --out run --set particles.count=500 --set run.collisions_per_particle=20 --quiet";

/// The log of `run` can be read up to where it ends, and its last state is one that runs.
fn assert_readable(place: &Place) {
    let path = place.path("run/log.mcap");
    let log = read_log(&path).unwrap();
    assert!(log.cut_off.is_some() && !log.series.is_empty());
    // Time and energies; what is counted between recordings is unknown at the first.
    assert!(log.series.iter().flat_map(|row| &row[..3]).all(|value| value.is_finite()));
    let recovery = recover(&path, &place.path("clean.mcap")).unwrap();
    assert!(recovery.is_some_and(|found| found.messages > 0));
    let clean = read_log(&place.path("clean.mcap")).unwrap();
    assert_eq!((clean.series.len(), clean.cut_off), (log.series.len(), None));
    assert_eq!(clean.state_hashes, log.state_hashes);
}

#[test]
fn a_file_that_may_not_grow_ends_the_run_with_a_log_that_reads() {
    let place = Place::new();
    // In blocks of 512 bytes; without the trap the system ends the program by a signal.
    let said = place.shell(&format!("ulimit -f 80; trap '' XFSZ; exec \"$G\" {RUN}"));
    said.failed(1, &["cannot write to the log run/log.mcap", "File too large", "stands in the file"]);
    assert_readable(&place);
    assert!(!place.path("run/summary.json").exists());
}

/// Does `words` beside a disk that is mounted for them alone. `None` where this machine does not let a user mount one, as in many
/// containers: the test that asks for it is then skipped, which is written to the terminal, and is a failure where `CI` is set.
fn on_a_disk(place: &Place, options: &str, words: &str) -> Option<Said> {
    fs::create_dir(place.path("disk")).unwrap();
    let mount = format!("mount -t tmpfs -o {options} tmpfs disk");
    let may = place.shell(&format!("unshare -rm sh -c '{mount}'"));
    if may.code == Some(0) {
        return Some(place.shell(&format!("unshare -rm sh -c '{mount} && {words}'")));
    }
    let reason = format!("skipped, as no disk can be mounted here: {}", may.error.trim());
    assert!(std::env::var_os("CI").is_none(), "{reason}");
    let test = std::thread::current().name().unwrap_or_default().to_owned();
    // Past the harness, which shows what is printed by tests that fail alone.
    std::io::stderr().write_all(format!("{test}: {reason}\n").as_bytes()).unwrap();
    None
}

#[test]
fn a_full_disk_ends_the_run_with_a_log_that_reads() {
    let place = Place::new();
    // The disk is gone with the shell: what is on it is copied away.
    let words =
        format!("cd disk && {{ \"$G\" {}; code=$?; cp -r run ..; exit $code; }}", RUN.replace("--quiet", ""));
    let Some(said) = on_a_disk(&place, "size=48k", &words) else { return };
    said.failed(1, &["cannot write to the log run/log.mcap", "No space left on device"]);
    assert!(said.error.contains("warning: the log takes about"), "{said:?}");
    assert_readable(&place);
}

#[test]
fn a_folder_that_may_only_be_read_is_told() {
    let place = Place::new();
    let words = format!("\"$G\" {}", RUN.replace("--out run", "--out disk/run"));
    let Some(said) = on_a_disk(&place, "ro", &words) else { return };
    said.failed(1, &["cannot use disk/run as a run folder", "Read-only file system"]);
}

#[test]
fn a_run_that_is_killed_leaves_a_log_that_reads() {
    let place = Place::new();
    let mut child = place.begun();
    send("-KILL", &child);
    assert_eq!(child.wait().unwrap().code(), None);
    assert_readable(&place);
}

#[test]
fn a_second_signal_ends_the_program_at_once() {
    let place = Place::new();
    // Nobody looks for signals while a million grains are compressed.
    let sets =
        ["domain.size=[1000.0, 1000.0]", "particles.volume_fraction=0.8", "initial.positions=compressed"];
    let sets = sets.map(|set| ["--set", set]).concat();
    let child = place.command(&[&["run", "cooling", "--out", "run"], &sets[..]].concat()).spawn().unwrap();
    for _ in 0..2 {
        std::thread::sleep(std::time::Duration::from_millis(800));
        send("-TERM", &child);
    }
    let said = Said::of(&child.wait_with_output().unwrap());
    assert_eq!(said.code, Some(130), "{said:?}");
    assert!(!place.path("run").exists());
}

#[test]
fn a_signal_that_comes_twice_in_a_row_counts_once() {
    let place = Place::new();
    let child = place.begun();
    send("-TERM", &child);
    send("-TERM", &child);
    let said = Said::of(&child.wait_with_output().unwrap());
    assert_eq!(said.code, Some(130), "{said:?}");
    assert!(place.path("run/summary.json").is_file() && place.path("run/report.html").is_file());
}

#[test]
fn a_folder_that_vanishes_is_told() {
    let place = Place::new();
    let child = place.begun();
    fs::remove_dir_all(place.path("run")).unwrap();
    send("-INT", &child);
    let said = Said::of(&child.wait_with_output().unwrap());
    said.failed(1, &["run/", "No such file or directory"]);
    assert!(!place.path("run").exists());
}

#[test]
fn no_more_file_handles_are_told() {
    let place = Place::new();
    assert_eq!(place.shell(&format!("exec \"$G\" {RUN}")).code, Some(0));
    let mut codes = Vec::new();
    for handles in [3, 4, 5, 6, 7, 8, 64] {
        // One log is read while another is written.
        let going_on = format!("run --resume run --out next-{handles} --quiet");
        let said = place.shell(&format!("ulimit -n {handles}; exec \"$G\" {going_on}"));
        if said.code != Some(0) {
            assert!(said.code.is_some_and(|code| [1, 2, 127].contains(&code)), "{handles}: {said:?}");
            assert!(said.error.contains("open files") || said.code == Some(127), "{handles}: {said:?}");
        }
        codes.push(said.code);
    }
    // The program itself lacks them: 127 is the system, which does not find its libraries.
    assert!(codes.iter().any(|code| matches!(code, Some(1 | 2))), "{codes:?}");
    assert_eq!(codes.last(), Some(&Some(0)));
}

#[test]
fn more_threads_than_cores_change_nothing() {
    let place = Place::new();
    let hash = |threads: &str, out: &str| {
        let run = RUN.replace("--out run", &format!("--out {out}"));
        assert_eq!(place.shell(&format!("\"$G\" {run} --threads {threads}")).code, Some(0));
        last_state::<glam::DVec2>(&place.path(out).join("log.mcap")).unwrap()
    };
    assert_eq!(hash("1", "one"), hash("64", "many"));
}

#[test]
fn nobody_has_to_listen() {
    let place = Place::new();
    // A reader that goes away, a terminal that is closed, outputs that are full.
    assert_eq!(place.shell("{ \"$G\" scenarios show heap-full; echo $? >&2; } | true").error, "0\n");
    assert_eq!(place.shell("exec \"$G\" check heap >&- 2>&-").code, Some(0));
    let told = "cannot write to the standard output: No space left on device";
    place.shell("exec \"$G\" scenarios > /dev/full").failed(1, &[told]);
    let loud = RUN.replace("--quiet", "");
    place.shell(&format!("exec \"$G\" {loud} > /dev/full")).failed(1, &[told]);
    assert!(place.path("run/report.html").exists(), "the run is complete all the same");
    assert_eq!(place.shell(&format!("exec \"$G\" {loud} --force 2> /dev/full")).code, Some(0));
    assert_eq!(place.shell("exec \"$G\" run nowhere 2> /dev/full").code, Some(2));
}

#[test]
fn a_log_is_a_file() {
    let place = Place::new();
    assert_eq!(place.shell(&format!("mkfifo pipe && mkdir empty && exec \"$G\" {RUN}")).code, Some(0));
    let from = |path: &str| format!("exec \"$G\" run cooling --set initial.positions.log={path} --out next");
    for path in ["pipe", "/dev/null"] {
        place.shell(&from(path)).failed(2, &["is not a file but a folder, a pipe or a device"]);
    }
    // A folder means the log in it.
    place.shell(&from("empty")).failed(2, &["cannot read the log empty/log.mcap", "No such file"]);
    assert!(!place.path("next").exists());
}
