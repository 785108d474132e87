//! A bed on a vibrating floor: its height swings by its own half in every period.

use crate::trial::{chance, figure, figures};

/// Mean heights of 4000 and more time units are 3.990: at samples of one phase they are between 2.1 and 5.2.
const BED: &str = r#"
dimension = 3
gravity = [0.0, 0.0, -30.0]
[engine]
kind = "event-driven"
[engine.event_driven]
collapse = { elastic_below = 0.01 }
[domain]
size = [15.0, 15.0, 40.0]
[boundary]
x = { lower = { wall = "smooth" }, upper = { wall = "smooth" } }
y = { lower = { wall = "smooth" }, upper = { wall = "smooth" } }
z.lower = { wall = "vibrating", amplitude = 2.0, frequency = 1.0 }
z.upper = { wall = "smooth" }
[particles]
count = 1000
restitution = 0.6
[run]
time = 400.0
[record]
from = 100.0
"#;

/// Mean height of the bed, sampled three hundred times a period.
const HEIGHT: f64 = 3.990;

/// A smaller bed of the same kind, for many runs.
fn small(period: f64, time: f64) -> Vec<String> {
    vec![
        "particles.count=50".to_owned(),
        "domain.size=[4.0, 4.0, 40.0]".to_owned(),
        format!("boundary.z.lower.frequency={}", 1.0 / period),
        // The floor always throws with 2.6 times gravity.
        format!("boundary.z.lower.amplitude={}", 2.0 * period * period),
        "engine.event_driven.collapse.elastic_below=0.1".to_owned(),
        format!("run.time={time}"),
        format!("record.from={}", 0.25 * time),
    ]
}

fn small_figures(period: f64, time: f64, more: &[&str]) -> Vec<grainflow::observe::measure::Figure> {
    let sets = small(period, time);
    let sets: Vec<&str> = sets.iter().map(String::as_str).chain(more.iter().copied()).collect();
    figures(BED, &sets)
}

#[test]
fn a_mean_does_not_depend_on_where_in_a_period_the_window_begins() {
    let heights = [20.0, 20.0 + 1.0 / 3.0, 20.0 + 2.0 / 3.0].map(|from| {
        let set = format!("record.from={from}");
        figure(&small_figures(1.0, 60.0, &[&set]), "centre_of_mass_mean_height")
    });
    // The three windows have 39 of 40 periods in common: means differ by the scatter of one period alone.
    let value = |k: usize| heights[k].value.unwrap();
    let error = heights[0].standard_error.unwrap();
    assert_eq!(value(1), value(2), "both begin at t = 21");
    assert!((value(0) - value(1)).abs() < error, "{heights:?}");
}

/// Asserts that the means of runs whose samples once came in step with the floor agree with one that could not.
fn no_outliers(periods: &[f64], times: &[f64]) {
    for &period in periods {
        let mean_of = |time: &f64| figure(&small_figures(period, *time, &[]), "centre_of_mass_mean_height");
        let all = times.iter().map(|time| (*time, mean_of(time)));
        // A run that forgets too slowly states no error.
        let (times, means): (Vec<f64>, Vec<_>) =
            all.filter(|(_, mean)| mean.standard_error.is_some()).unzip();
        assert!(means.len() >= 3, "period {period}: {} of the runs have an error", means.len());
        let weight = |k: usize| means[k].standard_error.unwrap().powi(-2);
        let all: f64 = (0..means.len()).map(weight).sum();
        for (k, mean) in means.iter().enumerate() {
            // The others are the truth as well as they know it.
            let rest = all - weight(k);
            let others = (0..means.len()).filter(|other| *other != k);
            let truth = others.map(|other| weight(other) * means[other].value.unwrap()).sum::<f64>() / rest;
            let widened = grainflow::observe::measure::Figure {
                standard_error: Some(mean.standard_error.unwrap().hypot(rest.powf(-0.5))),
                ..mean.clone()
            };
            let chance = chance(&widened, truth);
            println!("period {period}, time {}: {:?} beside {truth}, chance {chance}", times[k], mean.value);
            assert!(chance > 1e-3, "{period} {}: {mean:?} beside {truth}", times[k]);
        }
    }
}

#[test]
fn run_times_in_step_with_the_floor_do_no_harm() {
    no_outliers(&[1.0], &[40.0, 40.79, 80.0]);
}

#[test]
#[ignore = "minutes: cargo test --release --test statistics -- --ignored --nocapture thirty_periods"]
fn thirty_periods_and_run_times_have_no_outlier() {
    no_outliers(&[0.5, 0.75, 0.9, 1.0, 1.25, 1.5], &[100.0, 101.7, 150.0, 200.0, 400.0]);
}

#[test]
#[ignore = "minutes: cargo test --release --test statistics -- --ignored --nocapture four_hundred_periods"]
fn the_bed_of_four_hundred_periods_has_its_height() {
    let mean = figure(&figures(BED, &[]), "centre_of_mass_mean_height");
    let chance = chance(&mean, HEIGHT);
    println!("{mean:?}: chance {chance}");
    assert!(chance > 2.7e-3 && mean.standard_error.unwrap() < 0.1, "{mean:?}");
}
