//! `calibrate`: what it measures in exact dynamics, and the tables that it leaves.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use grainflow::campaign::calibrate::{CalibrationError, Request, calibrate};
use grainflow::record::reader::read_log;
use grainflow::report::calibration::Calibration;
use grainflow::run::run;
use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, load, parse};

/// A free gas of disks, as text.
fn gas(count: u32, volume_fraction: f64, restitution: f64, limit: f64) -> String {
    let side = (f64::from(count) * std::f64::consts::FRAC_PI_4 / volume_fraction).sqrt();
    format!(
        "dimension = 2
seed = 3
[engine]
kind = \"hsmc\"
cell_size = 3.0
[domain]
size = [{side}, {side}]
[particles]
count = {count}
restitution = {restitution}
[initial]
velocities = {{ maxwell = 1.0 }}
[run]
collisions_per_particle = {limit}
"
    )
}

fn calibrated(
    text: &str,
    folder: &Path,
    replicas: u32,
    overrides: &Overrides,
) -> Result<Calibration, CalibrationError> {
    let scenario = folder.join("gas.toml");
    fs::write(&scenario, text).unwrap();
    let request = Request {
        source: scenario.to_str().unwrap(),
        overrides,
        replicas,
        folder: Some(&folder.join("tables")),
        force: true,
    };
    calibrate(&request, &AtomicBool::new(false), &mut |_| {}).map(|(_, calibration)| calibration)
}

/// Mean of c over all stages, weighted by their errors, and its error.
fn mean_c(calibration: &Calibration) -> (f64, f64) {
    let weighted = |value: fn(f64) -> f64| -> f64 {
        calibration.stages.iter().map(|s| value(s.c.value) / s.c.standard_error.unwrap().powi(2)).sum()
    };
    let weight = weighted(|_| 1.0);
    (weighted(|c| c) / weight, weight.sqrt().recip())
}

#[test]
fn a_dense_elastic_gas_keeps_to_molecular_chaos() {
    let place = tempfile::tempdir().unwrap();
    let text = gas(400, 0.5, 1.0, 150.0);
    let found = calibrated(&text, place.path(), 4, &Overrides::default()).unwrap();
    let (c, error) = mean_c(&found);
    assert!(c.abs() < 3.0 * error && error < 0.02, "{c} ± {error}");
    // Every collision of every run is in a stage.
    let collisions: u64 = found.stages.iter().flat_map(|stage| stage.impacts).sum();
    assert!((4 * 400 * 150 / 2..4 * 400 * 151 / 2).contains(&collisions));
    // The flux into cells is that of free flights where cells are as full as they are on the average.
    let attempts =
        |of: fn(&grainflow::report::calibration::Entry) -> u64| -> u64 { found.entries.iter().map(of).sum() };
    let ratio = attempts(|entry| entry.arrivals) as f64 / attempts(|entry| entry.attempts) as f64;
    assert!(ratio > 0.5 && ratio <= 1.0, "{ratio}");
    for pair in found.entries.windows(2) {
        let errors =
            pair[0].probability.standard_error.unwrap().hypot(pair[1].probability.standard_error.unwrap());
        assert!(pair[1].probability.value < pair[0].probability.value + 4.0 * errors, "p(ν) does not rise");
    }
}

#[test]
fn a_dilute_gas_lets_grains_in() {
    let place = tempfile::tempdir().unwrap();
    let text = gas(2000, 0.01, 1.0, 10.0);
    // Steps so short that two grains in a thousand collide in one.
    let overrides = Overrides {
        sets: vec!["engine.time_step={collisions_per_particle=0.002}".to_owned()],
        ..Overrides::default()
    };
    let found = calibrated(&text, place.path(), 2, &overrides).unwrap();
    let sum = |of: fn(&grainflow::report::calibration::Entry) -> u64| -> f64 {
        found.entries.iter().map(of).sum::<u64>() as f64
    };
    let (attempts, entered) = (sum(|entry| entry.attempts), sum(|entry| entry.entered));
    // Those who want to enter are faster than the average and collide more often, at most three times.
    let (refused, most) = (1.0 - entered / attempts, 3.0 * 0.002);
    assert!(attempts > 2000.0 && refused <= most + 4.0 * (most / attempts).sqrt(), "{refused} of {attempts}");
}

#[test]
fn tables_of_a_clustering_gas_go_round() {
    let place = tempfile::tempdir().unwrap();
    let text = gas(4000, 0.25, 0.8, 100.0);
    let found = calibrated(&text, place.path(), 3, &Overrides::default()).unwrap();
    let last = found.stages.last().unwrap();
    // Glancing collisions prevail after 100 collisions per particle at r = 0.8 (Müller 2001, figure 3.7).
    assert!(last.c.value > 3.0 * last.c.standard_error.unwrap(), "{:?}", last.c);
    assert!(last.cooling_factor < 1.0);

    let named = text
        .replace("cell_size = 3.0", "cell_size = 3.0\nimpact_parameter = { table = \"tables/impact.csv\" }")
        + "[engine.hsmc]\nentry_probability = { table = \"tables/entry.csv\" }\n";
    let path = place.path().join("corrected.toml");
    fs::write(&path, &named).unwrap();
    let overrides = Overrides { sets: vec!["run={steps=30}".to_owned()], ..Overrides::default() };
    let scenario = load(path.to_str().unwrap(), &overrides).unwrap();
    let AnyScenario::Two(corrected) = &scenario else { panic!("the gas is flat") };
    let points: Vec<[f64; 2]> = corrected.engine.impact_law.table().unwrap().points().collect();
    assert_eq!(points.len(), found.stages.len());
    assert_eq!(*points.last().unwrap(), [last.place(), last.c.value]);
    assert_eq!(corrected.engine.entry_probability.as_ref().unwrap().points().count(), found.entries.len());

    let outcome =
        run(&scenario, &place.path().join("out"), false, &AtomicBool::new(false), &mut |_| {}).unwrap();
    // The log alone is enough: without the tables its scenario is the same.
    fs::remove_dir_all(place.path().join("tables")).unwrap();
    let log = read_log(&outcome.folder.join("log.mcap")).unwrap();
    let again = parse("corrected", &log.scenario, &Overrides::default()).unwrap();
    assert_eq!(again, scenario);
    // A calibration of the corrected scenario does not need the tables that it is to write.
    let brief =
        Overrides { sets: vec!["run={collisions_per_particle=3}".to_owned()], ..Overrides::default() };
    let found = calibrated(&named, place.path(), 1, &brief).unwrap();
    assert!(place.path().join("tables/impact.csv").exists() && found.replicas == 1);
}

#[test]
fn what_cannot_be_calibrated_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let rough = gas(100, 0.1, 0.9, 5.0)
        .replace("count = 100", "count = 100\ntangential_restitution = 0.5\nmoment_of_inertia = 0.5");
    let error = calibrated(&rough, place.path(), 1, &Overrides::default()).unwrap_err();
    assert!(
        error.is_bad_input() && error.to_string().contains("particles.tangential_restitution"),
        "{error}"
    );
    let lonely = gas(100, 0.001, 0.9, 5.0).replace("collisions_per_particle = 5", "time = 1e-9");
    let error = calibrated(&lonely, place.path(), 1, &Overrides::default()).unwrap_err();
    assert!(matches!(error, CalibrationError::Nothing) && !place.path().join("tables").exists(), "{error}");
}
