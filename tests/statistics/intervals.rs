//! The true mean lies inside the intervals of Student's t as often as these say: over replicas of small gases, with the mean of
//! all replicas for the truth.

use crate::trial::{chance, figure, figures};

/// Elastic gas of a hundred disks: what is steady is in equilibrium.
const ELASTIC: &str = r#"
dimension = 2
[engine]
kind = "dsmc"
[domain]
size = [40.0, 40.0]
[particles]
count = 100
restitution = 1.0
[initial]
velocities = { maxwell = 1.0 }
[run]
collisions_per_particle = 60.0
"#;

/// Gas between rough walls that move past each other.
const SHEARED: &str = r#"
dimension = 2
[engine]
kind = "dsmc"
[domain]
size = [20.0, 20.0]
[boundary]
y.lower = { wall = "rough", velocity = [-1.0, 0.0], restitution = 1.0 }
y.upper = { wall = "rough", velocity = [1.0, 0.0], restitution = 1.0 }
[particles]
count = 80
restitution = 0.8
[initial]
velocities = { maxwell = 1.0 }
[run]
collisions_per_particle = 300.0
"#;

/// Grains thrown up by a floor that vibrates.
const SHAKEN: &str = r#"
dimension = 2
gravity = [0.0, -1.0]
[engine]
kind = "event-driven"
[engine.event_driven]
collapse = { elastic_below = 0.001 }
[domain]
size = [10.0, 100.0]
[boundary]
x = "periodic"
y.lower = { wall = "vibrating", amplitude = 0.2, frequency = 1.0 }
y.upper = { wall = "smooth" }
[particles]
count = 20
restitution = 0.9
[run]
time = 900.0
[record]
from = 100.0
"#;

/// Scenarios with the figures that are looked at.
const CASES: [(&str, &str, &[&str]); 3] = [
    ("elastic", ELASTIC, &["collision_frequency", "mean_free_time", "mean_free_path"]),
    ("sheared", SHEARED, &["collision_frequency", "wall_shear_stress", "wall_normal_stress"]),
    ("shaken", SHAKEN, &["centre_of_mass_mean_height", "collision_frequency", "wall_normal_stress"]),
];

/// Shares of `replicas` that have the truth inside their intervals of 68.27 and 95.45 %, for each figure of each case.
fn shares(replicas: u64) -> Vec<(String, [f64; 2])> {
    let mut shares = Vec::new();
    for (name, text, names) in CASES {
        let all: Vec<_> = (1..=replicas).map(|seed| figures(text, &[&format!("seed={seed}")])).collect();
        for figure_name in names {
            let mut of: Vec<_> = all.iter().map(|figures| figure(figures, figure_name)).collect();
            let truth = of.iter().map(|figure| figure.value.unwrap()).sum::<f64>() / replicas as f64;
            // A run that forgets too slowly states no error, and so no interval.
            of.retain(|figure| figure.standard_error.is_some());
            assert!(of.len() as f64 >= 0.98 * replicas as f64 - 1.0, "{name} {figure_name}: {}", of.len());
            let inside = |probability: f64| {
                let count = of.iter().filter(|figure| chance(figure, truth) > probability).count();
                count as f64 / of.len() as f64
            };
            let steady =
                of.iter().filter(|figure| figure.trend == Some(grainflow::statistics::Trend::Steady));
            let share = [inside(0.3173), inside(0.0455)];
            println!("{name} {figure_name}: {truth:.5}, {share:.3?} inside, {} steady", steady.count());
            shares.push((format!("{name} {figure_name}"), share));
        }
    }
    shares
}

/// Asserts that shares, pooled over all figures, are within `tolerance` of what they should be.
fn assert_pooled(shares: &[(String, [f64; 2])], tolerance: [f64; 2]) {
    for (k, expected) in [0.68, 0.95].into_iter().enumerate() {
        let pooled = shares.iter().map(|(_, share)| share[k]).sum::<f64>() / shares.len() as f64;
        println!("pooled: {pooled}");
        assert!((pooled - expected).abs() < tolerance[k], "{pooled} beside {expected}: {shares:?}");
    }
}

#[test]
fn intervals_of_a_few_replicas_hold() {
    // Shares of 16 replicas of each of three cases scatter by 6.7 and 3.1 %; beside the 5 and 2.5 % that are allowed.
    assert_pooled(&shares(16), [0.05 + 3.0 * 0.067, 0.025 + 3.0 * 0.031]);
}

#[test]
#[ignore = "minutes: cargo test --release --test statistics -- --ignored --nocapture four_hundred_replicas"]
fn intervals_of_four_hundred_replicas_hold() {
    assert_pooled(&shares(400), [0.05, 0.025]);
}
