//! Structure of hard disks in equilibrium, made by the event-driven engine, against their equation of state.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "all of this is test code; figures are printed for those who run with --nocapture"
)]

#[path = "physics_gas/claim.rs"]
mod claim;
#[path = "physics_hard_grains/trial.rs"]
mod trial;

use claim::{Claim, replicas};
use glam::DVec2;
use grainflow::observe::measure::{Measure, Snapshot};
use grainflow::observe::pair_correlation::PairCorrelation;
use grainflow::observe::structure_factor::StructureFactor;
use grainflow::space::Vector;
use trial::{Trial, periodic};

/// Few, since a long wave forgets in a time that grows as its length squared.
const GRAINS: u32 = 256;
/// ν.
const FRACTION: f64 = 0.3;
/// Looks at each replica, and the time between them in √(m d²/T), some seven collisions per particle.
const LOOKS: usize = 500;
const BETWEEN: f64 = 3.0;
/// Shells of the longest waves that are averaged: kd = 0.29 and 0.52.
const SHELLS: usize = 2;

/// S of the longest waves, and g at contact, of one gas.
fn structure(seed: u64) -> [f64; 2] {
    let mut trial = Trial::<DVec2>::equilibrated(&periodic::<DVec2>(GRAINS, FRACTION, 1.0), seed, 40.0);
    let setting = trial.scenario.setting();
    let mut waves = StructureFactor::new(&setting).unwrap();
    let mut pairs = PairCorrelation::new(&setting).unwrap();
    for look in 0..LOOKS {
        // Times, not numbers of collisions: at a collision there is always a pair in contact.
        trial.advance_to_either(BETWEEN * (look + 1) as f64, f64::INFINITY).unwrap();
        let snapshot = Snapshot::new(&trial.gas, &trial.totals);
        waves.profiles(&snapshot);
        pairs.profiles(&snapshot);
    }
    assert_eq!(trial.invalid_states(), 0);
    assert!((trial.temperature() - 1.0).abs() < 1e-9);
    let snapshot = Snapshot::new(&trial.gas, &trial.totals);
    let mean_of = |measure: &dyn Measure<DVec2>| measure.conclusion(&snapshot, 0.0).0.remove(0).values;
    [long_waves(&mean_of(&waves)), contact(&mean_of(&pairs))]
}

/// Mean S of the first shells.
fn long_waves(columns: &[Vec<f64>]) -> f64 {
    assert!(columns[0][SHELLS - 1] < 0.53, "{:?}", columns[0]);
    columns[1][..SHELLS].iter().sum::<f64>() / SHELLS as f64
}

/// g at contact: the parabola that has the means of the first three bins, at its left end.
fn contact(columns: &[Vec<f64>]) -> f64 {
    let first = columns[0].iter().position(|&r| r > 1.0).unwrap();
    assert!(columns[1][..first].iter().all(|&g| g == 0.0), "pairs nearer than contact");
    let g = &columns[1][first..];
    (11.0 * g[0] - 7.0 * g[1] + 2.0 * g[2]) / 6.0
}

/// T (∂ρ/∂p)_T of Henderson's disks: 1/(d(νZ)/dν) with Z = (1 + ν²/8)/(1 − ν)².
fn compressibility(fraction: f64) -> f64 {
    let free = 1.0 - fraction;
    let z = (1.0 + fraction * fraction / 8.0) / (free * free);
    let slope = 0.25 * fraction / (free * free) + 2.0 * z / free;
    1.0 / (z + fraction * slope)
}

/// Biases: 1/S(k) − 1 falls as 1 − ⟨r²⟩k²/4 with ⟨r²⟩ ≈ d²/2 over the overlap that the direct correlation resembles:
/// S is 0.8 % and 2.5 % above S(0) in the two shells. What a parabola leaves of g, the equation of state, and that
/// the number of grains is fixed make less than 1 % each.
#[test]
fn disks_are_as_compressible_and_touch_as_often_as_their_pressure_says() {
    let touches = std::sync::Mutex::new(Vec::new());
    let strengths = replicas(8, |seed| {
        let [waves, touch] = structure(seed);
        touches.lock().unwrap().push(touch);
        waves
    });
    Claim { theory: compressibility(FRACTION), tolerance: 0.05 }.check("S(k → 0), disks", &strengths);
    let theory = DVec2::contact_correlation(FRACTION);
    Claim { theory, tolerance: 0.02 }.check("g at contact, disks", &touches.into_inner().unwrap());
}
