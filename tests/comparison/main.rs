//! Comparisons of made-up logs, in which it is known what differs.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod chance;
mod steadiness;

use grainflow::comparison::model::{Basis, Compared, Comparison, Difference, Verdict};
use grainflow::comparison::{Entry, Head, Replica, assemble};
use grainflow::comparison::{csv, json};
use grainflow::observe::measure::{Column, Dimension, Profile};
use grainflow::random::{Phase, Stream, Streams};
use grainflow::record::contents::RunLog;

fn column(name: &str, [mass, length, time]: [i8; 3]) -> Column {
    Column { name: name.to_owned(), unit: Dimension { mass, length, time } }
}

/// A log with the temperature, collisions and a stress at each time.
fn log(times: &[f64], row: impl FnMut(f64) -> [f64; 3]) -> RunLog {
    let columns = vec![
        column("time", [0, 0, 1]),
        column("temperature", [1, 2, -2]),
        column("collisions_per_particle", [0, 0, 0]),
        column("stress", [1, 0, -2]),
    ];
    let mut row = row;
    let series = times.iter().map(|time| {
        let [temperature, collisions, stress] = row(*time);
        vec![*time, temperature, collisions, stress]
    });
    RunLog { columns, series: series.collect(), ..RunLog::default() }
}

fn entry(label: &str, logs: Vec<RunLog>) -> Entry {
    let runs = logs.into_iter().zip(1..).map(|(log, number)| Replica {
        number,
        folder: format!("{label}-{number}"),
        log,
        summary: None,
    });
    Entry { label: label.to_owned(), engine: label.to_owned(), runs: runs.collect(), ..Entry::default() }
}

fn random(seed: u64) -> Stream {
    Streams::new(seed).at(0, Phase::Collisions).stream(0)
}

fn even(count: u32) -> Vec<f64> {
    (0..count).map(f64::from).collect()
}

/// Series `name` over `abscissa`, of the second contestant against the first.
fn found<'a>(comparison: &'a Comparison, name: &str, abscissa: &str) -> (&'a Compared, &'a Difference) {
    let is_it = |one: &&Compared| one.name == name && one.abscissa.name == abscissa;
    let compared = comparison.series.iter().find(is_it).unwrap();
    (compared, compared.differences[1].as_ref().unwrap())
}

/// Two engines, each `replicas` times, whose stresses are noise about 50; that of the second is `shift` higher from
/// time 10 on.
fn noisy(seed: u64, replicas: usize, shift: f64) -> Comparison {
    let mut random = random(seed);
    let mut logs = |shift: f64| -> Vec<RunLog> {
        let mut one =
            || log(&even(80), |t| [1.0, t, 50.0 + random.gaussian() + if t >= 10.0 { shift } else { 0.0 }]);
        (0..replicas).map(|_| one()).collect()
    };
    let entries = vec![entry("event-driven", logs(0.0)), entry("hsmc", logs(shift))];
    assemble(Head::default(), entries)
}

#[test]
fn a_shift_is_found_with_its_size_and_the_place_where_curves_part() {
    // Four replicas: error √(2/4) = 0.71, known from neighbours too, with some thirty degrees of freedom; the shift is 11
    // errors. With the three degrees of freedom of each place alone the limit would be 25.
    let comparison = noisy(7, 4, 8.0);
    let (compared, difference) = found(&comparison, "stress", "time");
    assert_eq!(difference.verdict, Verdict::Differs);
    assert_eq!(difference.parts_at, Some(10.0));
    assert!(!difference.is_relative);
    let share: f64 = (10..80).map(|k| (difference.values[k] - 8.0) / 70.0).sum();
    assert!(share.abs() < 4.0 * f64::sqrt(2.0 / 4.0 / 70.0), "{share}");
    assert!(difference.most.unwrap().standard_errors > difference.threshold);
    assert!((4.0..6.0).contains(&difference.threshold), "{}", difference.threshold);
    assert_eq!(difference.basis, Basis::Neighbours);
    assert!(
        difference.errors.iter().all(|error| (error / 0.71 - 1.0).abs() < 0.5),
        "{:?}",
        difference.errors
    );
    assert!(difference.sentence.contains("above event-driven"), "{}", difference.sentence);
    assert_eq!(compared.places.len(), 80);
}

#[test]
fn a_small_shift_of_the_whole_curve_is_found_with_few_replicas() {
    // Four replicas: at each of 400 places the error is √(2/4) = 0.71 and the limit some 5.4 of them; the mean of 400 has
    // the error 0.035, and the limit for that, three degrees of freedom and the probability 0.0009, is 14. The shift
    // is 28 of its errors, and 1.4 of those of a place.
    const SHIFT: f64 = 1.0;
    let mut random = random(11);
    let mut logs = |shift: f64| -> Vec<RunLog> {
        (0..4).map(|_| log(&even(400), |t| [1.0, t, 5.0 + shift + random.gaussian()])).collect()
    };
    let comparison =
        assemble(Head::default(), vec![entry("event-driven", logs(0.0)), entry("hsmc", logs(SHIFT))]);
    let difference = found(&comparison, "stress", "time").1;
    assert_eq!(difference.verdict, Verdict::Differs, "{}", difference.sentence);
    // The mean alone finds it.
    assert!(difference.most.unwrap().standard_errors < difference.threshold, "{}", difference.sentence);
    assert_eq!(difference.parts_at, None, "{}", difference.sentence);
    let overall = difference.overall.unwrap();
    assert!(
        overall.standard_errors > overall.threshold && (overall.value - SHIFT).abs() < 4.0 * overall.error
    );
    assert!(difference.sentence.contains("in the mean of the whole curve"), "{}", difference.sentence);
    let read: serde_json::Value = serde_json::from_str(&json::text(&comparison)).unwrap();
    let series = read["series"].as_array().unwrap().iter().find(|series| series["name"] == "stress").unwrap();
    assert_eq!(series["differences"][1]["overall"]["standard_errors"], overall.standard_errors);
    assert!(csv::text(&comparison).contains("\nseries as a whole,stress,,,hsmc,,,"));
}

#[test]
fn long_series_are_thinned_with_their_ends() {
    let logs = || vec![log(&even(1001), |t| [1.0, t, 1.0]), log(&even(1001), |t| [1.0, t, 1.0])];
    let comparison = assemble(Head::default(), vec![entry("event-driven", logs()), entry("hsmc", logs())]);
    let places = &found(&comparison, "stress", "time").0.places;
    assert_eq!((places.len(), places[0], places[199]), (200, 0.0, 1000.0));
}

#[test]
fn exponentials_taken_at_other_times_are_equal() {
    let cooling = |t: f64| [(-0.3 * t).exp(), 2.0 * t, 0.0];
    let shifted: Vec<f64> = (0..21).map(|k| 0.97 * f64::from(k)).collect();
    let two = |times: &[f64]| vec![log(times, cooling), log(times, cooling)];
    let entries = vec![entry("event-driven", two(&even(20))), entry("hsmc", two(&shifted))];
    let comparison = assemble(Head::default(), entries);
    for abscissa in ["time", "collisions_per_particle"] {
        let (_, difference) = found(&comparison, "temperature", abscissa);
        assert_eq!(difference.verdict, Verdict::Agrees, "{}", difference.sentence);
        assert!(difference.is_relative);
        assert!(difference.values.iter().all(|value| value.is_nan() || value.abs() < 1e-12));
    }
}

#[test]
fn pairs_of_replicas_take_their_common_scatter_away() {
    // Initial states differ by a factor of up to 1.8, both engines alike; the second is 3 % colder.
    let logs = |factor: f64| -> Vec<RunLog> {
        let mut noise = random(5);
        let mut tiny = random(if factor < 1.0 { 6 } else { 8 });
        (0..6)
            .map(|_| {
                let state = (0.2 * noise.gaussian()).exp();
                log(&even(10), |t| {
                    let wobble = (1e-3 * tiny.gaussian()).exp();
                    [factor * state * wobble * (-0.2 * t).exp(), t, 0.0]
                })
            })
            .collect()
    };
    let comparison =
        assemble(Head::default(), vec![entry("event-driven", logs(1.0)), entry("hsmc", logs(0.97))]);
    let (compared, difference) = found(&comparison, "temperature", "time");
    assert_eq!(difference.verdict, Verdict::Differs, "{}", difference.sentence);
    // Error of a mean of six: 0.001 √2/√6 = 0.00058.
    assert!(difference.values.iter().all(|value| (value + 0.03).abs() < 0.003));
    assert!(difference.errors.iter().all(|error| *error < 0.0015));
    assert!(compared.curves[1].as_ref().unwrap().errors[0] > 0.02, "the curves themselves scatter");
    assert!(difference.sentence.contains("cools faster than event-driven"), "{}", difference.sentence);
}

#[test]
fn one_replica_has_errors_from_blocks_where_it_can() {
    let of = |seed: u64, shift: f64| {
        let mut random = random(seed);
        entry(
            if shift == 0.0 { "event-driven" } else { "hsmc" },
            vec![log(&even(400), |t| {
                [(-0.01 * t).exp() * (1.0 + shift * t * t / 1e5), t, 5.0 + shift + random.gaussian()]
            })],
        )
    };
    let comparison = assemble(Head::default(), vec![of(1, 0.0), of(2, 2.0)]);
    // Blocks of 40: error √(2/40) = 0.22, so the shift is 9 of them.
    let (_, stress) = found(&comparison, "stress", "time");
    assert_eq!(stress.verdict, Verdict::Differs, "{}", stress.sentence);
    assert!(stress.errors.iter().all(|error| (error / 0.22 - 1.0).abs() < 0.35), "{:?}", stress.errors[0]);
    assert_eq!(stress.basis, Basis::Blocks);
    assert!((stress.correlation.as_ref().unwrap().time - 0.5).abs() < 0.2, "{:?}", stress.correlation);
    let whole = stress.overall.unwrap();
    assert!(
        (whole.error / f64::sqrt(2.0 / 400.0) - 1.0).abs() < 0.35
            && (whole.value - 2.0).abs() < 4.0 * whole.error
    );
    assert!(comparison.remarks[0].contains("blocks"));
    let told = comparison
        .remarks
        .iter()
        .find(|remark| remark.starts_with("Correlation times of hsmc minus event-driven"));
    assert!(told.unwrap().contains("stress 0."), "{told:?}");
    // A bend without any chance in it has no error.
    let (_, temperature) = found(&comparison, "temperature", "time");
    assert_eq!((temperature.verdict, temperature.basis), (Verdict::Unknown, Basis::Nothing));
    assert!(temperature.sentence.contains("fewer than 20 independent stretches"), "{}", temperature.sentence);
}

#[test]
fn gaps_short_logs_and_failures_are_lived_with() {
    let mut gappy = log(&even(6), |t| [f64::NAN, t, if t == 3.0 { f64::NAN } else { 1.0 }]);
    gappy.columns.push(column("alone", [0, 0, 0]));
    gappy.series.iter_mut().for_each(|row| row.push(1.0));
    let whole = || log(&even(10), |t| [1.0, t, 1.0]);
    let mut failed = entry("cba", Vec::new());
    failed.failures.push("cba-1: a grain is lost".to_owned());
    let entries = vec![
        entry("event-driven", vec![whole(), whole()]),
        entry("hsmc", vec![gappy.clone(), gappy]),
        failed,
        entry("dsmc", vec![RunLog::default(), RunLog::default()]),
    ];
    let comparison = assemble(Head::default(), entries);
    assert_eq!(comparison.contestants[2].failures, ["cba-1: a grain is lost"]);
    let (compared, stress) = found(&comparison, "stress", "time");
    assert_eq!(stress.verdict, Verdict::Agrees);
    let known: Vec<bool> = stress.values.iter().map(|value| value.is_finite()).collect();
    assert_eq!(known, [true, true, true, false, true, true], "no farther than two of them go");
    let told = "Along time, curves are compared from 0 to 5, what at least two engines have of 0 to 9.";
    assert!(comparison.remarks.iter().any(|remark| remark == told), "{:?}", comparison.remarks);
    assert!(compared.curves[2].is_none() && compared.differences[3].is_none());
    assert!(!comparison.series.iter().any(|one| ["alone", "temperature"].contains(&one.name.as_str())));
    assert_eq!(assemble(Head::default(), Vec::new()).contestants.len(), 0);
}

#[test]
fn profiles_are_compared_between_recordings_and_written() {
    let with = |shift: f64, late: f64| {
        let profile = |time: f64| Profile {
            name: "density-profile".to_owned(),
            time,
            columns: vec![column("height", [0, 1, 0]), column("density", [0, 0, 0])],
            values: vec![vec![0.5, 1.5, 2.5], [1.0, 2.0, 3.0].map(|y| y + time * shift).to_vec()],
        };
        RunLog { profiles: vec![profile(0.0), profile(1.0 + late)], ..log(&even(3), |t| [1.0, t, 0.0]) }
    };
    let entries = vec![
        entry("event-driven", vec![with(0.0, 0.0), with(0.0, 0.0)]),
        entry("hsmc, thesis", vec![with(0.1, 0.1), with(0.1, 0.1)]),
    ];
    let comparison = assemble(Head::default(), entries);
    let verdicts: Vec<(Option<f64>, Verdict)> = comparison
        .profiles
        .iter()
        .map(|one| (one.time, one.differences[1].as_ref().unwrap().verdict))
        .collect();
    assert_eq!(verdicts, [(Some(0.0), Verdict::Agrees), (Some(1.0), Verdict::Differs)]);
    let table = csv::text(&comparison);
    assert!(table.starts_with(csv::HEADER));
    // Recorded at 1.1, where it is 3.11; straight from 3 at time 0 it is 3.1 at time 1.
    let line = "profile,density-profile: density,1.0,2.5,\"hsmc, thesis\",3.1,0.0,";
    assert!(table.contains(line), "{table}");
    let read: serde_json::Value = serde_json::from_str(&json::text(&comparison)).unwrap();
    assert_eq!(read["profiles"][1]["differences"][1]["verdict"], "differs");
    assert_eq!(read["contestants"][1]["label"], "hsmc, thesis");
}

#[test]
fn a_replica_that_ends_early_is_left_out_and_told() {
    let whole = || log(&even(10), |t| [1.0, t, 1.0]);
    let short = || log(&even(4), |t| [1.0, t, 1.0]);
    let entries = vec![
        entry("event-driven", vec![whole(), whole(), whole()]),
        entry("hsmc", vec![whole(), short(), whole()]),
    ];
    let comparison = assemble(Head::default(), entries);
    let (compared, stress) = found(&comparison, "stress", "time");
    assert_eq!(compared.places, even(10));
    assert!(stress.values.iter().all(|value| *value == 0.0), "no place is blank: {stress:?}");
    let told =
        "hsmc-2 ends at time 3, long before the others of hsmc, and is left out of what runs along time.";
    assert_eq!(
        comparison.remarks.iter().filter(|remark| *remark == told).count(),
        1,
        "{:?}",
        comparison.remarks
    );
}

/// A run with one profile at each of `times`: a line that rises with time, with or without errors of its own.
fn with_profiles(times: &[f64], shift: f64, error: Option<f64>) -> RunLog {
    let profile = |time: &f64| {
        let mut columns = vec![column("height", [0, 1, 0]), column("density", [0, 0, 0])];
        let mut values = vec![vec![0.5, 1.5, 2.5], [1.0, 2.0, 3.0].map(|y| y + time + shift).to_vec()];
        if let Some(error) = error {
            columns.push(column("standard_error", [0, 0, 0]));
            values.push(vec![error; 3]);
        }
        Profile { name: "density-profile".to_owned(), time: *time, columns, values }
    };
    RunLog { profiles: times.iter().map(profile).collect(), ..log(&even(3), |t| [1.0, t, 0.0]) }
}

#[test]
fn replicas_that_record_at_other_times_are_all_kept() {
    let runs = |times: [&[f64]; 3], shift: f64| times.map(|times| with_profiles(times, shift, None)).to_vec();
    let exact = runs([&[0.0, 1.0, 2.0], &[0.0, 0.6, 1.9], &[0.0, 1.4, 2.0]], 0.0);
    let other = runs([&[0.0, 0.5, 1.5, 2.1], &[0.0, 2.0], &[0.0, 0.3, 0.7, 1.95]], 0.25);
    let comparison = assemble(Head::default(), vec![entry("event-driven", exact), entry("hsmc", other)]);
    let times: Vec<Option<f64>> = comparison.profiles.iter().map(|one| one.time).collect();
    assert_eq!(times, [Some(0.0), Some(1.0), Some(1.9)], "up to the end of the shortest");
    for compared in &comparison.profiles {
        let difference = compared.differences[1].as_ref().unwrap();
        assert!(difference.values.iter().all(|value| (value - 0.25).abs() < 1e-12), "{difference:?}");
        // All three are in the mean.
        assert_eq!(difference.freedom, 2.0);
    }
}

#[test]
fn single_profiles_are_judged_by_the_errors_that_they_state() {
    let of = |shift: f64, error: Option<f64>| {
        let single = |shift: f64| vec![with_profiles(&[1.0], shift, error)];
        let entries = vec![entry("event-driven", single(0.0)), entry("hsmc", single(shift))];
        assemble(Head::default(), entries).profiles[0].differences[1].clone().unwrap()
    };
    // Three places, nine degrees of freedom: the limit is 5.
    let [near, far] = [of(0.3, Some(0.1)), of(1.0, Some(0.1))];
    assert_eq!((near.verdict, far.verdict), (Verdict::Agrees, Verdict::Differs), "{}", far.sentence);
    assert!((far.most.unwrap().standard_errors - 1.0 / 0.1 / f64::sqrt(2.0)).abs() < 1e-9);
    assert_eq!((near.basis, near.freedom), (Basis::Stated, 9.0));
    assert!((4.5..5.5).contains(&near.threshold), "{}", near.threshold);
    let silent = of(0.3, None);
    assert_eq!(silent.verdict, Verdict::Unknown);
    assert!(silent.sentence.contains("a single profile has no column of errors"), "{}", silent.sentence);
}

/// Engines whose summaries have a figure in each of these runs, with these errors.
fn with_figures(runs: [&[(f64, Option<f64>)]; 2]) -> Difference {
    let of = |label: &str, runs: &[(f64, Option<f64>)]| {
        let mut entry = entry(label, runs.iter().map(|_| log(&even(3), |t| [1.0, t, 0.0])).collect());
        for (run, (value, error)) in entry.runs.iter_mut().zip(runs) {
            let summary = serde_json::json!({ "stress": value, "stress_standard_error": error });
            run.summary = summary.as_object().cloned();
        }
        entry
    };
    let entries = vec![of("event-driven", runs[0]), of("hsmc", runs[1])];
    assemble(Head::default(), entries).figures[0].differences[1].clone().unwrap()
}

#[test]
fn figures_are_compared_as_shares_and_say_why_they_have_no_error() {
    let single = with_figures([&[(2.0, Some(0.03))], &[(2.2, Some(0.04))]]);
    assert!(single.is_relative && (single.values[0] - 0.1).abs() < 1e-12, "{single:?}");
    assert!((single.errors[0] - 0.025).abs() < 1e-12 && single.verdict == Verdict::Agrees);
    let far = with_figures([&[(2.0, Some(0.03))], &[(2.6, Some(0.04))]]);
    assert!(
        far.sentence.contains("stress is 30.0 ± 2.5 % above event-driven (12 standard errors"),
        "{}",
        far.sentence
    );
    let silent = with_figures([&[(2.0, None)], &[(2.2, Some(0.04))]]);
    assert_eq!(silent.verdict, Verdict::Unknown);
    assert!(silent.sentence.contains("(a single run states none)"), "{}", silent.sentence);
    // A figure that may be below zero stays in its unit.
    assert!(!with_figures([&[(2.0, Some(0.03))], &[(-0.1, Some(0.04))]]).is_relative);
    let replicas =
        with_figures([&[(1.0, None), (1.1, None), (0.9, None)], &[(2.0, None), (2.1, None), (1.91, None)]]);
    assert!(replicas.is_relative && replicas.verdict == Verdict::Differs, "{}", replicas.sentence);
    assert!((replicas.values[0] - 1.003_333).abs() < 1e-3 && replicas.basis == Basis::Replicas);
}

#[test]
fn a_figure_that_outlives_the_blocks_of_its_run_has_no_error() {
    // Stresses that wander slowly: the ten blocks of the second half are much shorter than their memory.
    let of = |label: &str, kept: f64, seed: u64, value: f64| {
        let (mut random, mut stress) = (random(seed), 0.0);
        let run = log(&even(400), |t| {
            stress = kept * stress + random.gaussian();
            [1.0, t, 5.0 + stress]
        });
        let mut entry = entry(label, vec![run]);
        let summary = serde_json::json!({ "stress": value, "stress_standard_error": 0.01 });
        entry.runs[0].summary = summary.as_object().cloned();
        entry
    };
    let verdict = |kept: f64| {
        let entries = vec![of("event-driven", kept, 1, 5.0), of("hsmc", kept, 2, 5.5)];
        assemble(Head::default(), entries).figures[0].differences[1].clone().unwrap()
    };
    assert_eq!(verdict(0.0).verdict, Verdict::Differs);
    let slow = verdict(0.98);
    assert_eq!(slow.verdict, Verdict::Unknown, "{}", slow.sentence);
    assert!(slow.sentence.contains("remembers longer than the blocks"), "{}", slow.sentence);
}
