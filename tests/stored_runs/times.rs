//! Recordings and states come at their times, as many as are asked for, and each is shown at its own.

use glam::{DVec2, DVec3};
use grainflow::record::index::LogIndex;
use grainflow::record::reader::{read_log, read_states};

use super::{Place, code, error};

/// The times of all recordings [time].
fn times(place: &Place, run: &str) -> Vec<f64> {
    read_log(&place.path(run).join("log.mcap")).unwrap().series.iter().map(|row| row[0]).collect()
}

/// The times of all frames, as a viewer has them before it reads any [time].
fn viewed(place: &Place, run: &str) -> Vec<f64> {
    let index = LogIndex::open(&place.path(run).join("log.mcap")).unwrap();
    (0..index.frames()).map(|number| index.frame_time(number).unwrap()).collect()
}

#[test]
fn a_run_of_a_nanosecond_has_a_tick_for_each_recording_and_a_station_for_each_frame() {
    let place = Place::with_scenario("stored_runs/scenarios/argon.toml", &[]);
    let (times, viewed) = (times(&place, "run"), viewed(&place, "run"));
    assert_eq!((times.len(), viewed.len()), (21, 21));
    let pauses: Vec<f64> = viewed.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(pauses.iter().all(|pause| (4e-11..7e-11).contains(pause)), "{pauses:?}");
    for (time, viewed) in times.iter().zip(viewed) {
        assert!((time - viewed).abs() < 1e-3 * pauses[0], "{viewed:e} for {time:e}");
    }
}

#[test]
fn frames_of_a_run_beyond_the_range_of_ticks_are_shown_at_their_own_times() {
    let place = Place::with_scenario("stored_runs/scenarios/long-cooling.toml", &[]);
    let (times, viewed) = (times(&place, "run"), viewed(&place, "run"));
    assert_eq!(times.len(), 21);
    assert!(times[20] > 1e12, "{times:?}");
    for (time, viewed) in times.iter().zip(&viewed) {
        assert!((time - viewed).abs() <= 1e-3 * time, "{viewed:e} for {time:e}");
    }
    assert!(viewed.windows(2).all(|pair| pair[0] < pair[1]), "{viewed:?}");
}

#[test]
fn a_run_of_three_intervals_has_four_recordings_and_four_states() {
    let place = Place::with_scenario("stored_runs/scenarios/every.toml", &[]);
    assert_eq!(times(&place, "run"), [0.0, 0.3, 0.6, 0.9]);
    let states = read_states::<DVec2>(&place.path("run/log.mcap")).unwrap();
    assert_eq!(states.iter().map(|state| state.time).collect::<Vec<_>>(), [0.0, 0.3, 0.6, 0.9]);
    let last = read_log(&place.path("run/log.mcap")).unwrap().series.pop().unwrap();
    assert!(last.iter().all(|value| value.is_finite()));
    for kind in [&[][..], &["--states"]] {
        let out = format!("part{}.csv", kind.concat());
        let part = ["export", "run", "--format", "csv", "--from", "0.3", "--to", "0.3", "--out", &out];
        place.obeyed(&[&part, kind].concat());
        assert_eq!(place.read(&out).lines().count(), 1 + 200, "{kind:?}");
    }
    let verified = place.obeyed(&["replay", "run", "--verify"]);
    assert!(verified.contains("4 hashes, 4 states") && verified.contains("identical"), "{verified}");
    // Going on from any state gives the same bytes; going on to a later end keeps the rhythm.
    place.obeyed(&["run", "--resume", "run", "--out", "again", "--quiet"]);
    let bytes = |run: &str| std::fs::read(place.path(run).join("log.mcap")).unwrap();
    assert!(bytes("run") == bytes("again"), "the end comes again");
    place.obeyed(&["run", "--resume", "run", "--set", "run.time=1.5", "--out", "longer", "--quiet"]);
    assert_eq!(times(&place, "longer"), [0.0, 0.3, 0.6, 0.9, 1.2, 1.5]);
    assert_eq!(read_states::<DVec2>(&place.path("longer/log.mcap")).unwrap().len(), 6);
    assert!(place.obeyed(&["replay", "longer", "--verify"]).contains("identical"));
}

#[test]
fn a_recording_comes_with_the_step_that_ends_at_its_time_but_for_rounding() {
    // Five steps of 0.09 add up to one step of double precision less than 0.45, and four times as many to less than 4 · 0.45.
    let (head, _) = include_str!("scenarios/every.toml").split_once("[run]").unwrap();
    for (spacing, first) in [("every = 0.45\nstate_every = 0.45\n", 0.0), ("frames = 10\nstates = 9\n", 0.45)]
    {
        let place = Place::new();
        std::fs::write(place.path("a.toml"), format!("{head}[run]\ntime = 4.5\n[record]\n{spacing}"))
            .unwrap();
        let steps = ["--set", "engine.time_step={ fixed = 0.09 }"];
        let run = ["run", "a.toml", "--engine", "cba", "--out", "run", "--quiet"];
        place.obeyed(&[&run[..], &steps].concat());
        let found = times(&place, "run");
        assert_eq!(found.len(), 11, "{found:?}");
        for (k, time) in found.iter().enumerate() {
            assert!((time - 0.45 * k as f64).abs() < 1e-12, "{found:?}");
        }
        let states = read_states::<DVec2>(&place.path("run/log.mcap")).unwrap();
        for (k, state) in states.iter().enumerate() {
            assert!((state.time - first - 0.45 * k as f64).abs() < 1e-12, "state {k} at {}", state.time);
        }
        assert!(place.obeyed(&["replay", "run", "--verify"]).contains("identical"));
    }
}

#[test]
fn a_log_with_other_shares_of_its_species_is_refused_as_one_with_another_count_is() {
    let place = Place::with_scenario("stored_runs/scenarios/shares.toml", &[]);
    let text = include_str!("scenarios/shares.toml")
        .replace("share = 0.9", "share = 0.5")
        .replace("share = 0.1", "share = 0.5")
        .replace("velocities = { maxwell = 1.0 }", "positions = { log = \"run\" }");
    std::fs::write(place.path("b.toml"), &text).unwrap();
    for arguments in [&["check", "b.toml"][..], &["run", "b.toml", "--out", "b", "--quiet"]] {
        let said = place.refused(arguments);
        assert!(said.contains("holds 90 + 10 grains") && said.contains("says 50 + 50"), "{said}");
        assert!(said.contains("share = 90, 10"), "{said}");
    }
    // What it says helps.
    std::fs::write(
        place.path("c.toml"),
        text.replacen("share = 0.5", "share = 90", 1).replacen("share = 0.5", "share = 10", 1),
    )
    .unwrap();
    let output = place.grainflow(&["run", "c.toml", "--out", "c", "--quiet"]);
    assert_eq!(code(&output), 0, "{}", error(&output));
    assert!(read_states::<DVec3>(&place.path("c/log.mcap")).is_err(), "they are disks");
}
