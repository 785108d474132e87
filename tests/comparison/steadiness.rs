//! Figures that are not steady, degrees of freedom that runs state, and runs that are the same bits.

use super::{entry, even, log};
use grainflow::comparison::model::{ComparedFigure, Comparison, Verdict};
use grainflow::comparison::{Head, assemble, csv, json};
use grainflow::report::{judgements, render_comparison};
use grainflow::statistics::Trend;
use serde_json::{Value, json};

/// Event-driven and HSMC, one run for each of the summaries given.
fn with_summaries(runs: [&[Value]; 2]) -> Comparison {
    let of = |label: &str, summaries: &[Value]| {
        let logs = summaries.iter().map(|_| log(&even(3), |t| [1.0, t, 0.0])).collect();
        let mut entry = entry(label, logs);
        for (run, summary) in entry.runs.iter_mut().zip(summaries) {
            run.summary = summary.as_object().cloned();
        }
        entry
    };
    assemble(Head::default(), vec![of("event-driven", runs[0]), of("hsmc", runs[1])])
}

/// A stress with an error of 1 %, its degrees of freedom and what its series does.
fn stress(value: f64, freedom: f64, trend: Option<Trend>) -> Value {
    json!({
        "stress": value,
        "stress_standard_error": 0.01 * value,
        "stress_degrees_of_freedom": freedom,
        "stress_steady": trend.map(|trend| trend == Trend::Steady),
        "stress_trend": trend.filter(|trend| *trend != Trend::Steady).map(Trend::name),
    })
}

fn figure(comparison: &Comparison) -> &ComparedFigure {
    comparison.figures.iter().find(|figure| figure.name == "stress").unwrap()
}

#[test]
fn a_figure_that_is_not_steady_gets_no_verdict_on_either_side() {
    let [steady, rising] = [Some(Trend::Steady), Some(Trend::Rising)];
    for (trends, whose) in [([steady, rising], "hsmc"), ([rising, steady], "event-driven")] {
        // 30 % apart: with steady figures they differ.
        let runs = [stress(1.0, 40.0, trends[0]), stress(1.3, 40.0, trends[1])];
        let comparison = with_summaries([&runs[..1], &runs[1..]]);
        let difference = figure(&comparison).differences[1].as_ref().unwrap();
        assert_eq!(difference.verdict, Verdict::NotSteady);
        let said = format!("hsmc: stress of {whose} is not steady (rising, mean ");
        assert!(difference.sentence.starts_with(&said), "{}", difference.sentence);
        let judgement = &judgements(&comparison)[0];
        assert_eq!(judgement.not_steady, std::slice::from_ref(&difference.sentence));
        assert!(judgement.differing.is_empty());
        let page = render_comparison(&comparison);
        assert!(page.contains("not steady (rising, mean 1"), "{whose}");
        let read: Value = serde_json::from_str(&json::text(&comparison)).unwrap();
        let of = if whose == "hsmc" { 1 } else { 0 };
        assert_eq!(read["figures"][0]["values"][of]["trend"], "rising");
        assert_eq!(read["figures"][0]["differences"][1]["verdict"], "not steady");
        let table = csv::text(&comparison);
        let row = table.lines().find(|line| line.starts_with(&format!("figure,stress,,,{whose},"))).unwrap();
        assert!(row.ends_with(",false"), "{row}");
    }
    let runs = [stress(1.0, 40.0, steady), stress(1.3, 40.0, steady)];
    let comparison = with_summaries([&runs[..1], &runs[1..]]);
    assert_eq!(figure(&comparison).differences[1].as_ref().unwrap().verdict, Verdict::Differs);
}

#[test]
fn the_degrees_of_freedom_of_single_runs_set_how_far_apart_they_may_be() {
    let of = |freedom: [f64; 2]| {
        let runs = [stress(1.0, freedom[0], None), stress(1.0726, freedom[1], None)];
        let comparison = with_summaries([&runs[..1], &runs[1..]]);
        figure(&comparison).differences[1].clone().unwrap()
    };
    // 0.0726 of √(0.01² + 0.010726²) is 4.95 errors; beyond 3σ of chance: t(4) = 6.6, t(80) = 3.1.
    let [few, many] = [of([2.0, 2.0]), of([40.0, 40.0])];
    assert_eq!((few.verdict, many.verdict), (Verdict::Agrees, Verdict::Differs));
    // Welch: (1 + 1.0726²)²/(1/2 + 1.0726⁴/2) for two degrees of freedom each.
    let expected = (1.0 + 1.0726_f64.powi(2)).powi(2) / (0.5 + 0.5 * 1.0726_f64.powi(4));
    assert!((few.freedom - expected).abs() < 1e-9, "{} {expected}", few.freedom);
}

#[test]
fn replicas_are_not_steady_together_where_one_is_not() {
    let [steady, falling] = [Some(Trend::Steady), Some(Trend::Falling)];
    let exact = [1.0, 1.1, 0.9].map(|value| stress(value, 40.0, steady));
    let own = [(1.0, steady), (1.1, falling), (0.9, steady)].map(|(value, trend)| stress(value, 40.0, trend));
    let comparison = with_summaries([&exact, &own]);
    assert_eq!(figure(&comparison).trends, [Some(Trend::Steady), Some(Trend::Falling)]);
    assert_eq!(figure(&comparison).differences[1].as_ref().unwrap().verdict, Verdict::NotSteady);
}

#[test]
fn engines_that_made_the_same_runs_are_named_once() {
    let of = |label: &str, temperature: f64, hashes: [&str; 2]| {
        let mut run = log(&even(2), |t| [temperature, t, f64::NAN]);
        run.state_hashes = hashes.map(str::to_owned).to_vec();
        entry(label, vec![run])
    };
    let remarks = |entries| assemble(Head::default(), entries).remarks.join("\n");
    let [hsmc, cba] = ["hsmc", "cba"].map(|engine| of(engine, 1.0, ["a", "b"]));
    let dsmc = of("dsmc", 1.0 + 1e-9, ["a", "c"]);
    let said = remarks(vec![hsmc.clone(), cba, dsmc.clone()]);
    assert_eq!(said.matches("made the same runs").count(), 1, "{said}");
    assert!(said.contains("hsmc and cba made the same runs, bit for bit"), "{said}");
    let rounded = remarks(vec![hsmc.clone(), of("cba", 1.0_f64.next_up(), ["a", "d"])]);
    assert!(rounded.contains("hsmc and cba made the same runs, but for rounding"), "{rounded}");
    assert!(!remarks(vec![hsmc, dsmc]).contains("made the same runs"));
}
