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

#[test]
fn explore() {
    for (chance, name, replicas, places) in [
        (NOISE, "stress", 4, 60),
        (MEMORY, "stress", 4, 100),
        (WALK, "temperature", 4, 60),
        (WALK, "temperature", 4, 200),
        (RETURNING, "temperature", 4, 100),
        (NOISE, "stress", 1, 200),
        (MEMORY, "stress", 1, 200),
        (WALK, "temperature", 1, 100),
        (WALK, "temperature", 1, 200),
        (RETURNING, "temperature", 1, 100),
    ] {
        let [alarms, square] = of_equal_pairs(chance, name, replicas, places, 3000);
        println!("{chance:?} {name} {replicas} {places}: alarms {alarms:.5}, square {square:.3}");
    }
}
