//! How often equal engines are said to differ, and how far their errors are right: from both sides, on made-up curves.

use grainflow::comparison::model::{Basis, Comparison, Difference, Verdict};
use grainflow::comparison::{Head, assemble};
use grainflow::random::Stream;
use grainflow::record::contents::RunLog;

use super::{entry, even, found, log, random};

/// How the logarithm of the temperature, and the stress, wander about what is expected of them.
#[derive(Clone, Copy, Debug)]
enum Chance {
    /// Anew at each place, but for the share that is kept of the one before.
    Noise(f64),
    /// Adding up from the start, where all are alike, with the share that is kept from place to place.
    Walk(f64),
}

const NOISE: Chance = Chance::Noise(0.0);
const MEMORY: Chance = Chance::Noise(0.5);
const WALK: Chance = Chance::Walk(1.0);
/// Drawn back with a tenth of the curve as memory, as an energy over time.
const RETURNING: Chance = Chance::Walk(0.9);

impl Chance {
    /// What `places` values are made of.
    fn curve(self, places: usize, random: &mut Stream) -> Vec<f64> {
        let mut value = if let Chance::Noise(_) = self { random.gaussian() } else { 0.0 };
        let step = |value: f64, kick: f64| match self {
            Chance::Noise(kept) => kept * value + (1.0 - kept * kept).sqrt() * kick,
            Chance::Walk(kept) => kept * value + kick,
        };
        (0..places)
            .map(|_| {
                let here = value;
                value = step(value, random.gaussian());
                here
            })
            .collect()
    }
}

/// Two engines that are the same, but that the second falls faster by `faster` per place.
fn trial(chance: Chance, replicas: usize, places: u32, faster: f64, seed: u64) -> Comparison {
    let mut random = random(seed);
    let mut logs = |faster: f64| -> Vec<RunLog> {
        let mut one = || {
            let mut wander = chance.curve(places as usize, &mut random).into_iter();
            log(&even(places), |t| {
                let w = wander.next().unwrap();
                [(-0.05 * t - faster * t + 0.003 * w).exp(), 0.4 * t, 5.0 + w]
            })
        };
        (0..replicas).map(|_| one()).collect()
    };
    let entries = vec![entry("event-driven", logs(0.0)), entry("hsmc", logs(faster))];
    assemble(Head::default(), entries)
}

/// Of `trials` equal pairs: the share that is said to differ, and the mean square of the difference at the last place in
/// standard errors, beside what Student's t has.
fn of_equal_pairs(chance: Chance, name: &str, replicas: usize, places: u32, trials: u32) -> [f64; 2] {
    let (mut alarms, mut squares, mut expected, mut judged) = (0.0, 0.0, 0.0, 0.0);
    for seed in 0..trials {
        let comparison = trial(chance, replicas, places, 0.0, u64::from(seed));
        let difference = found(&comparison, name, "time").1;
        if difference.verdict == Verdict::Unknown || difference.freedom < 8.0 {
            continue;
        }
        judged += 1.0;
        alarms += f64::from(u8::from(difference.verdict == Verdict::Differs));
        let last = difference.values.len() - 1;
        squares += (difference.values[last] / difference.errors[last]).powi(2);
        expected += difference.freedom / (difference.freedom - 2.0);
    }
    assert!(judged > 0.9 * f64::from(trials), "{chance:?}: {judged} of {trials} judged");
    [alarms / judged, squares / expected]
}

/// 4 standard deviations of the number of alarms among equal pairs, about what is promised, and never none.
fn assert_as_promised(alarms: f64, trials: u32) {
    let (found, expected) = (alarms * f64::from(trials), 0.0027 * f64::from(trials));
    assert!(
        found >= 1.0 && found < expected + 4.0 * expected.sqrt(),
        "{found} of {trials} beside {expected}"
    );
}

#[test]
fn few_replicas_of_noise_differ_as_seldom_as_promised_and_no_more_seldom() {
    // Three tests share 0.0027: the last place is one of those among which the largest is sought, so a little less.
    let [alarms, square] = of_equal_pairs(NOISE, "stress", 4, 60, 2500);
    assert_as_promised(alarms, 2500);
    // The mean of 2500 squares of which each scatters by √2, a little more for Student's t.
    assert!((square - 1.0).abs() < 0.1, "{square}");
    let [alarms, square] = of_equal_pairs(MEMORY, "stress", 4, 100, 1000);
    assert!(alarms < 0.009 && (square - 1.0).abs() < 0.18, "{alarms} {square}");
}

#[test]
fn few_replicas_of_walks_have_the_errors_of_walks() {
    let [alarms, square] = of_equal_pairs(WALK, "temperature", 4, 100, 1000);
    assert!(alarms < 0.009, "{alarms}");
    // Variances are doubled on purpose, and a few per cent wide: memory that is not there is found more often than missed.
    assert!((square - 0.45).abs() < 0.1, "{square}");
    // What is drawn back is farther from a walk: errors too wide, never too narrow.
    let [alarms, square] = of_equal_pairs(RETURNING, "temperature", 4, 100, 500);
    assert!(alarms < 0.01 && square < 0.3, "{alarms} {square}");
}

#[test]
fn single_runs_have_the_errors_of_replicas() {
    let [alarms, square] = of_equal_pairs(NOISE, "stress", 1, 200, 1000);
    assert!(alarms < 0.009 && (square - 0.95).abs() < 0.18, "{alarms} {square}");
    let [alarms, square] = of_equal_pairs(WALK, "temperature", 1, 100, 2500);
    // Variances are doubled on purpose: one half, from both sides. A walk must not pass for noise: its errors would be
    // far too small, and every such curve an alarm.
    assert!(alarms < 0.003 && (square - 0.49).abs() < 0.07, "{alarms} {square}");
    let [alarms, square] = of_equal_pairs(RETURNING, "temperature", 1, 100, 500);
    assert!(alarms < 0.01 && square < 0.3, "{alarms} {square}");
}

#[test]
fn a_lasting_difference_of_the_rate_is_found_from_single_runs_and_from_few_replicas() {
    // ln T of each run walks by 0.003 per place: after 100 places by 0.03 √2, over four replicas by half of that, and
    // errors are √2 wider. The second falls faster by 0.45 and 0.225: 7.5 standard errors.
    for (replicas, faster) in [(1, 0.0045), (4, 0.00225)] {
        let mut parted = 0.0;
        for seed in 0..50 {
            let comparison = trial(WALK, replicas, 101, faster, seed);
            let difference: &Difference = found(&comparison, "temperature", "time").1;
            assert_eq!(
                (difference.verdict, difference.basis),
                (Verdict::Differs, Basis::Growth),
                "{replicas}: {seed}"
            );
            parted += difference.parts_at.unwrap_or(100.0) / 50.0;
            let truth = (-faster * 100.0).exp_m1();
            assert!((difference.values[100] - truth).abs() < 5.0 * difference.errors[100]);
        }
        // From 3.4 standard errors on, that is after a fifth of the curve, or somewhat later by chance.
        assert!((10.0..45.0).contains(&parted), "{replicas}: {parted}");
    }
}
