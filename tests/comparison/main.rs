//! Comparisons of made-up logs, in which it is known what differs.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod chance;

use grainflow::comparison::model::{Compared, Comparison, Difference, Verdict};
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

/// Two engines, each `replicas` times, whose stresses are noise about 5; that of the second is `shift` higher from
/// time 10 on.
fn noisy(seed: u64, replicas: usize, shift: f64) -> Comparison {
    let mut random = random(seed);
    let mut logs = |shift: f64| -> Vec<RunLog> {
        let mut one =
            || log(&even(20), |t| [1.0, t, 5.0 + random.gaussian() + if t >= 10.0 { shift } else { 0.0 }]);
        (0..replicas).map(|_| one()).collect()
    };
    let entries = vec![entry("event-driven", logs(0.0)), entry("hsmc", logs(shift))];
    assemble(Head::default(), entries)
}

#[test]
fn the_same_process_differs_as_seldom_as_promised() {
    let comparisons = 2000_u32;
    let alarms = (0..comparisons)
        .filter(|seed| {
            let comparison = noisy(u64::from(*seed), 4, 0.0);
            found(&comparison, "stress", "time").1.verdict == Verdict::Differs
        })
        .count() as f64;
    // p = 0.0027 for all 20 places together: 5.4 ± 2.3 of 2000; the places are independent, so none is missing either.
    let expected = 0.0027 * f64::from(comparisons);
    assert!((alarms - expected).abs() < 4.0 * expected.sqrt(), "{alarms}");
}

#[test]
fn a_shift_is_found_with_its_size_and_the_place_where_curves_part() {
    // Twelve replicas: error √(2/12) = 0.41, eleven degrees of freedom, threshold 6; the shift is 24 errors.
    let comparison = noisy(7, 12, 10.0);
    let (compared, difference) = found(&comparison, "stress", "time");
    assert_eq!(difference.verdict, Verdict::Differs);
    assert_eq!(difference.parts_at, Some(10.0));
    assert!(!difference.is_relative);
    let share: f64 = (10..20).map(|k| (difference.values[k] - 10.0) / 10.0).sum();
    assert!(share.abs() < 4.0 * f64::sqrt(2.0 / 12.0 / 10.0), "{share}");
    assert!(difference.most.unwrap().standard_errors > difference.threshold);
    assert!(difference.threshold > 4.0, "twenty places, eleven degrees of freedom");
    assert!(difference.sentence.contains("above event-driven"), "{}", difference.sentence);
    assert_eq!(compared.places.len(), 20);
}

#[test]
fn a_small_shift_of_the_whole_curve_is_found_with_few_replicas() {
    // Four replicas: at each of ten places the limit is 20 errors; the mean of ten has the error √(2/40) = 0.22, and
    // the limit for that, three degrees of freedom and the probability 0.00135, is 12. The shift is 27.
    let mut random = random(11);
    let mut logs = |shift: f64| -> Vec<RunLog> {
        (0..4).map(|_| log(&even(10), |t| [1.0, t, 5.0 + shift + random.gaussian()])).collect()
    };
    let comparison =
        assemble(Head::default(), vec![entry("event-driven", logs(0.0)), entry("hsmc", logs(6.0))]);
    let difference = found(&comparison, "stress", "time").1;
    assert_eq!(difference.verdict, Verdict::Differs, "{}", difference.sentence);
    assert!(difference.threshold > 20.0, "{}", difference.threshold);
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
    let (_, temperature) = found(&comparison, "temperature", "time");
    assert_eq!(temperature.verdict, Verdict::Unknown, "a bend has no error");
    assert!(comparison.remarks[0].contains("blocks"));
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
    assert_eq!(known, [true, true, true, false, true, true, false, false, false, false]);
    assert!(compared.curves[2].is_none() && compared.differences[3].is_none());
    assert!(!comparison.series.iter().any(|one| ["alone", "temperature"].contains(&one.name.as_str())));
    assert_eq!(assemble(Head::default(), Vec::new()).contestants.len(), 0);
}

#[test]
fn profiles_are_compared_at_the_nearest_times_and_written() {
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
    let line = "profile,density-profile: density,1.0,2.5,\"hsmc, thesis\",3.11,0.0,";
    assert!(table.contains(line), "{table}");
    let read: serde_json::Value = serde_json::from_str(&json::text(&comparison)).unwrap();
    assert_eq!(read["profiles"][1]["differences"][1]["verdict"], "differs");
    assert_eq!(read["contestants"][1]["label"], "hsmc, thesis");
}
