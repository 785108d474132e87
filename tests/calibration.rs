//! `calibrate`: what it measures in exact dynamics, and the tables that it leaves.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::Command;
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
fn spheres_are_calibrated_like_disks() {
    let place = tempfile::tempdir().unwrap();
    let side = (400.0 * std::f64::consts::FRAC_PI_6 / 0.3_f64).cbrt();
    let text = format!(
        "dimension = 3\n[engine]\nkind = \"hsmc\"\ncell_size = 2.0\n[domain]\nsize = [{side}, {side}, {side}]\n\
         [particles]\ncount = 400\nrestitution = 1.0\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n\
         [run]\ncollisions_per_particle = 150\n"
    );
    let found = calibrated(&text, place.path(), 4, &Overrides::default()).unwrap();
    let (c, error) = mean_c(&found);
    assert!(c.abs() < 3.0 * error && error < 0.02, "{c} ± {error}");
    assert_eq!((found.dimension, found.cell.len()), (3, 3));
    // Cells of five grains on the average: few numbers of grains have attempts enough, and each lets most of them in.
    assert!(found.entries.len() > 1);
    assert!(found.entries.iter().all(|entry| (0.5..1.0).contains(&entry.probability.value)));
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

#[test]
fn options_name_tables_from_where_the_program_runs() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("gas.toml");
    fs::write(&path, gas(100, 0.1, 0.9, 5.0)).unwrap();
    fs::write(place.path().join("own.csv"), "c,collisions_per_particle\n0.2,0\n").unwrap();
    let with = |text: &str, set: &str| {
        fs::write(&path, text).unwrap();
        load(path.to_str().unwrap(), &Overrides { sets: vec![set.to_owned()], ..Overrides::default() })
    };
    let plain = gas(100, 0.1, 0.9, 5.0);
    // Tests run in the folder of the project.
    let error = with(&plain, "engine.impact_parameter.table=tests/tables/impact-too-large.csv").unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("--set #1 ") && message.contains("impact-too-large.csv:4: column `c`"),
        "{message}"
    );
    // An option takes the place of a table that the scenario names.
    let named = plain.replace("cell_size = 3.0", "impact_parameter = { table = \"own.csv\" }");
    let c_of = |scenario: AnyScenario| match scenario {
        AnyScenario::Two(scenario) => scenario.engine.impact_law.at(1.0).c(),
        AnyScenario::Three(_) => panic!("the gas is flat"),
    };
    assert_eq!(c_of(with(&named, "seed=4").unwrap()), 0.2);
    assert_eq!(c_of(with(&named, "engine.impact_parameter.c=-0.5").unwrap()), -0.5);
    assert_eq!(c_of(with(&named, "engine.impact_parameter=uniform").unwrap()), 0.0);
}

#[test]
fn the_command_writes_four_files_and_refuses_what_is_wrong() {
    let place = tempfile::tempdir().unwrap();
    let grainflow = |more: &[&str]| {
        let quick = ["calibrate", "cooling", "--set", "particles.count=400", "--set", "domain.size=[35, 35]"];
        let brief = ["--set", "run.collisions_per_particle=20", "--replicas=2"];
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("grainflow"));
        command.current_dir(place.path()).args(quick).args(brief).args(more).output().unwrap()
    };
    let output = grainflow(&["--threads=2"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("wrote out/cooling-calibrate/calibration.html"));
    let folder = place.path().join("out/cooling-calibrate");
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let found: serde_json::Value = serde_json::from_str(&read("calibration.json")).unwrap();
    assert_eq!(found["replicas"], 2);
    let counted = |key: &str| found[key].as_array().unwrap().len();
    // A comment and the names stand above the points.
    assert_eq!(read("impact.csv").lines().count(), 2 + counted("impact_parameter"));
    assert_eq!(read("entry.csv").lines().count(), 2 + counted("entry_probability"));
    assert!(read("calibration.html").matches("<svg").count() == 3);

    // The same again, on one thread, in silence: the same tables.
    let before = [read("impact.csv"), read("entry.csv"), read("calibration.json")];
    assert_eq!(grainflow(&[]).status.code(), Some(2), "an old calibration is not replaced unasked");
    let output = grainflow(&["--force", "--quiet", "--threads=1"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
    assert_eq!(before, [read("impact.csv"), read("entry.csv"), read("calibration.json")]);

    for (wrong, words) in [
        (["--set", "particles.restitution=2"], "--set #4 'particles.restitution=2'"),
        (["--threads", "0"], "--threads"),
    ] {
        let output = grainflow(&wrong);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(words), "{output:?}");
    }
}
