//! Sweeps as scripts meet them: what is refused, what is kept, what stands in the tables.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod place;
mod signal;

use std::collections::BTreeMap;
use std::fs;
use std::process::Output;
use std::time::{Duration, Instant, SystemTime};

use place::Place;
use serde_json::{Map, Value};
use signal::send;

/// A gas that is done in no time.
const GAS: &str = "title = \"Gas <of tests>\"
dimension = 2
seed = 3
[engine]
kind = \"hsmc\"
cell_size = 3.0
[domain]
size = [24.0, 24.0]
[boundary]
x = \"periodic\"
y.lower = { wall = \"rough\", velocity = [-0.5, 0.0] }
y.upper = { wall = \"rough\", velocity = [0.5, 0.0] }
[particles]
count = 60
restitution = 0.9
[initial]
velocities = { maxwell = 1.0 }
[run]
steps = 40
[record]
frames = 2
";

const RESTITUTIONS: &str = "particles.restitution=[0.9, 0.8, 0.7]";

impl Place {
    /// A place with the scenario `gas.toml`.
    fn with_gas() -> Self {
        let place = Place::new();
        fs::write(place.path("gas.toml"), GAS).unwrap();
        place
    }

    fn sweep(&self, more: &[&str]) -> Output {
        self.grainflow(&[&["sweep", "gas.toml", "--threads", "2"], more].concat())
    }

    /// Asserts that a sweep ends with `code`; returns what was printed.
    fn ends(&self, more: &[&str], code: i32) -> (String, String) {
        let output = self.sweep(more);
        let (text, error) = (place::text(&output), place::error(&output));
        assert_eq!(place::code(&output), code, "{more:?}: {text}{error}");
        (text, error)
    }

    /// Asserts that a sweep is refused as wrong input and writes nothing; returns what was said.
    fn refused(&self, more: &[&str]) -> String {
        let (text, error) = self.ends(more, 2);
        assert_eq!(text, "");
        assert!(!self.path("out").exists(), "{more:?}");
        error
    }

    /// The rows of a table by their columns.
    fn rows(&self, folder: &str) -> Vec<BTreeMap<String, String>> {
        let text = fs::read_to_string(self.path(folder).join("sweep.csv")).unwrap();
        let mut lines = text.lines().map(cells);
        let head = lines.next().unwrap();
        lines
            .map(|line| {
                assert_eq!(line.len(), head.len(), "{line:?}");
                head.iter().cloned().zip(line).collect()
            })
            .collect()
    }

    fn column(&self, folder: &str, name: &str) -> Vec<String> {
        self.rows(folder).iter().map(|row| row[name].clone()).collect()
    }

    fn json(&self, file: &str) -> Map<String, Value> {
        serde_json::from_str(&fs::read_to_string(self.path(file)).unwrap()).unwrap()
    }

    fn modified(&self, file: &str) -> SystemTime {
        fs::metadata(self.path(file)).unwrap().modified().unwrap()
    }
}

/// The cells of a line of comma-separated values.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().unwrap().push(c),
        }
    }
    cells
}

#[test]
fn a_grid_has_a_row_for_every_run() {
    let place = Place::with_gas();
    let more = ["--vary", RESTITUTIONS, "--vary", "particles.count=[60, 80]", "--engines", "hsmc,dsmc"];
    let (text, _) = place.ends(&[&more[..], &["--replicas", "2", "--figure", "temperature"]].concat(), 0);
    let rows = place.rows("out/gas-sweep");
    assert_eq!(rows.len(), 3 * 2 * 2 * 2);
    let row = &rows[5];
    let expected = [
        ("case", "restitution=0.9_count=80_hsmc_replica-2"),
        ("particles.restitution", "0.9"),
        ("particles.count", "80"),
        ("engine", "hsmc"),
        ("replica", "2"),
        ("status", "done"),
        ("error", ""),
        ("particles_initial", "80"),
        ("end_reason", "steps"),
    ];
    for (column, value) in expected {
        assert_eq!(row[column], value, "{column}");
    }
    // Every key of a summary stands in the table, with the figures of its run.
    let summary = place.json(&format!("out/gas-sweep/{}/summary.json", row["case"]));
    for (key, value) in &summary {
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        assert_eq!(row[key], if value.is_null() { String::new() } else { text }, "{key}");
    }
    let seeds: std::collections::BTreeSet<String> =
        rows.iter().map(|row| format!("{} {}", row["replica"], row["seed"])).collect();
    assert_eq!(seeds.len(), 2, "one seed for each replica: {seeds:?}");
    means_are_those_of_replicas(&place.json("out/gas-sweep/sweep.json"), &rows);
    assert!(text.contains("gas: 24 runs, 24 done") && text.contains("out/gas-sweep/sweep.html"), "{text}");
}

/// Means and errors of the first point: x̄ and |x₁ − x₂|/2.
fn means_are_those_of_replicas(json: &Map<String, Value>, rows: &[BTreeMap<String, String>]) {
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 12);
    let [first, second] = [0, 1].map(|k: usize| rows[k]["temperature"].parse::<f64>().unwrap());
    let temperature = &points[0]["figures"]["temperature"];
    assert!((temperature["mean"].as_f64().unwrap() - 0.5 * (first + second)).abs() < 1e-12);
    let error = temperature["standard_error"].as_f64().unwrap();
    assert!(error > 0.0 && (error - 0.5 * (first - second).abs()).abs() < 1e-12);
    assert_eq!(points[0]["settings"]["particles.restitution"], 0.9);
}

#[test]
fn mistakes_are_told_before_anything_is_written() {
    let place = Place::with_gas();
    let said = place.refused(&["--vary", "particles.count=[1,2] + particles.restitution=[0.5]"]);
    assert!(said.contains("--vary #1") && said.contains("`particles.count` has 2 values"), "{said}");
    let said = place.refused(&["--vary", RESTITUTIONS, "--vary", "particles.restituton=[1]"]);
    assert!(said.contains("--vary #2 'particles.restituton=1'") && said.contains("did you mean"), "{said}");
    let said = place.refused(&["--vary", "particles.restitution=[0.9, 1.5]", "--set", "seed=4"]);
    assert!(said.contains("--vary #1 'particles.restitution=1.5': particles.restitution: "), "{said}");
    let said = place.refused(&["--vary", RESTITUTIONS, "--figure", "wall_shear_stres"]);
    assert!(said.contains("did you mean `wall_shear_stress`?"), "{said}");
    let said = place.refused(&["--vary", RESTITUTIONS, "--figure", "stress"]);
    assert!(said.contains("did you mean `wall_shear_stress`"), "{said}");
    let said = place.refused(&["--vary", "particles.restitution=[0.9,", "0.7]"]);
    assert!(said.contains("quote it: 'particles.restitution=[0.9, 0.7]'"), "{said}");
    let said = place.refused(&["--vary", RESTITUTIONS, "--seed", "-1"]);
    assert!(said.contains("give a whole number from 0 to 9223372036854775807"), "{said}");
    let said = place.refused(&["--vary", RESTITUTIONS, "--engines", "hsmc,dsmcc"]);
    assert!(said.contains("--engines 'dsmcc'"), "{said}");
    assert!(place.refused(&["--vary", RESTITUTIONS, "--set", "run.steps=-1"]).contains("--set #1"));
    assert!(place.refused(&[]).contains("nothing varies"));
    assert!(place.refused(&["--vary", RESTITUTIONS, "--jobs", "0"]).contains("--jobs"));
}

#[test]
fn a_second_call_makes_only_what_is_missing() {
    let place = Place::with_gas();
    place.ends(&["--vary", RESTITUTIONS, "--quiet"], 0);
    let before = place.rows("out/gas-sweep");
    let log = |value: &str| format!("out/gas-sweep/restitution={value}/log.mcap");
    let times = ["0.9", "0.8", "0.7"].map(|value| place.modified(&log(value)));
    fs::remove_dir_all(place.path("out/gas-sweep/restitution=0.8")).unwrap();
    // One whose log is there and whose summary is not was not finished.
    fs::remove_file(place.path("out/gas-sweep/restitution=0.7/summary.json")).unwrap();
    let (text, _) = place.ends(&["--vary", RESTITUTIONS], 0);
    assert!(text.contains("3 runs, 2 done, 1 kept"), "{text}");
    assert_eq!(place.modified(&log("0.9")), times[0]);
    assert!(place.modified(&log("0.8")) > times[1] && place.modified(&log("0.7")) > times[2]);
    assert_eq!(place.column("out/gas-sweep", "status"), ["kept", "done", "done"]);
    let hashes: Vec<&String> = before.iter().map(|row| &row["state_hash"]).collect();
    assert_eq!(place.column("out/gas-sweep", "state_hash").iter().collect::<Vec<_>>(), hashes);
}

#[test]
fn a_finished_case_whose_log_was_cut_is_run_again_and_one_with_a_foreign_summary_is_refused() {
    let place = Place::with_gas();
    place.ends(&["--vary", RESTITUTIONS, "--quiet"], 0);
    let log = |value: &str| place.path(&format!("out/gas-sweep/restitution={value}/log.mcap"));
    let whole = fs::read(log("0.8")).unwrap();
    // Half, and inside the index.
    for length in [whole.len() / 2, whole.len() - 40, whole.len() - 1] {
        fs::write(log("0.8"), &whole[..length]).unwrap();
        let (text, said) = place.ends(&["--vary", RESTITUTIONS], 0);
        assert!(text.contains("3 runs, 1 done, 2 kept"), "{length}: {text}");
        assert!(said.contains("restitution=0.8: was finished and is run again"), "{length}: {said}");
        assert!(said.contains(&format!("cut off after {length} bytes")), "{length}: {said}");
        assert_eq!(fs::read(log("0.8")).unwrap(), whole, "{length}");
    }
    // Before its scenario is complete nothing tells whose log it is.
    let scenario = whole.windows(13).position(|name| name == b"scenario.toml").unwrap();
    fs::write(log("0.8"), &whole[..scenario + 30]).unwrap();
    let (_, said) = place.ends(&["--vary", RESTITUTIONS], 2);
    assert!(said.contains("does not say which run it is of") && said.contains("--force"), "{said}");
    fs::write(log("0.8"), &whole).unwrap();
    // A summary of another run beside the log of this one.
    let summaries =
        ["0.9", "0.8"].map(|value| place.path(&format!("out/gas-sweep/restitution={value}/summary.json")));
    fs::copy(&summaries[0], &summaries[1]).unwrap();
    let (_, said) = place.ends(&["--vary", RESTITUTIONS], 2);
    assert!(said.contains("restitution=0.8 has a summary and a log that end in different states"), "{said}");
}

#[test]
fn another_run_in_the_place_of_a_case_is_refused() {
    let place = Place::with_gas();
    place.ends(&["--vary", RESTITUTIONS, "--quiet"], 0);
    let table = fs::read_to_string(place.path("out/gas-sweep/sweep.csv")).unwrap();
    let other = ["--vary", RESTITUTIONS, "--set", "run.steps=41"];
    let (_, said) = place.ends(&other, 2);
    assert!(said.contains("`steps = 40` where `steps = 41` is wanted"), "{said}");
    assert!(said.contains("--force") && said.contains("--out"), "{said}");
    assert_eq!(fs::read_to_string(place.path("out/gas-sweep/sweep.csv")).unwrap(), table);
    // A run of other numerics is another run.
    let summary = place.path("out/gas-sweep/restitution=0.8/summary.json");
    let text = fs::read_to_string(&summary).unwrap();
    let numerics = format!("\"numerics\": {}", grainflow::run::NUMERICS);
    assert!(text.contains(&numerics));
    fs::write(&summary, text.replace(&numerics, "\"numerics\": 0")).unwrap();
    let (_, said) = place.ends(&["--vary", RESTITUTIONS], 2);
    assert!(said.contains("restitution=0.8 was written by version") && said.contains("numerics 0"), "{said}");
    place.ends(&["--vary", RESTITUTIONS, "--force", "--quiet"], 0);
    assert_eq!(place.column("out/gas-sweep", "status"), ["kept", "done", "kept"]);
    place.ends(&[&other[..], &["--force", "--quiet"]].concat(), 0);
    assert_eq!(place.column("out/gas-sweep", "steps"), ["41", "41", "41"]);
}

#[test]
fn runs_side_by_side_are_those_of_plain_runs() {
    let place = Place::with_gas();
    let walls = "boundary.y.lower.velocity[0]=[-0.2,-0.4] + boundary.y.upper.velocity[0]=[0.2,0.4]";
    for jobs in ["1", "2"] {
        let more = ["--vary", walls, "--replicas", "2", "--jobs", jobs, "--out", jobs, "--quiet"];
        place.ends(&more, 0);
    }
    let rows = place.rows("1");
    assert_eq!(place.column("1", "state_hash"), place.column("2", "state_hash"));
    assert_eq!(place.column("2", "threads"), ["1"; 4]);
    for (k, row) in rows.iter().enumerate() {
        let sets = ["lower", "upper"].map(|side| {
            let key = format!("boundary.y.{side}.velocity[0]");
            format!("{key}={}", row[&key])
        });
        let out = format!("plain-{k}");
        let run = ["run", "gas.toml", "--quiet", "--out", &out, "--seed", &row["seed"]];
        let plain = [&run[..], &["--set", &sets[0], "--set", &sets[1]]].concat();
        assert!(place.command(&plain).status().unwrap().success());
        assert_eq!(place.json(&format!("{out}/summary.json"))["state_hash"], row["state_hash"].as_str());
    }
    let hashes: std::collections::BTreeSet<&String> = rows.iter().map(|row| &row["state_hash"]).collect();
    assert_eq!(hashes.len(), 4);
}

#[test]
fn a_failing_case_does_not_stop_the_others() {
    let place = Place::with_gas();
    // A step so long that a grain would jump over a cell stops the run that has it.
    let more = ["--vary", "engine.time_step=[{ fixed = 0.01 }, { fixed = 1.0 }, { crossing = 0.2 }]"];
    let (text, said) = place.ends(&[&more[..], &["--quiet"]].concat(), 1);
    assert_eq!(text, "");
    assert!(said.contains("error: time-step=fixed-1.0: failed: "), "{said}");
    assert_eq!(place.column("out/gas-sweep", "status"), ["done", "failed", "done"]);
    let row = &place.rows("out/gas-sweep")[1];
    assert!(row["error"].contains("step") && row["temperature"].is_empty(), "{row:?}");
    assert!(place.json("out/gas-sweep/sweep.json")["runs"][1]["error"].as_str().unwrap().contains("step"));
    // It is tried again, alone.
    place.ends(&more, 1);
    assert_eq!(place.column("out/gas-sweep", "status"), ["kept", "failed", "kept"]);
}

#[test]
fn an_interrupt_leaves_a_table_and_the_next_call_goes_on() {
    let place = Place::with_gas();
    let slow = ["sweep", "gas.toml", "--vary", RESTITUTIONS, "--set", "run.steps=100000000", "--quiet"];
    let mut child = place.command(&slow).spawn().unwrap();
    let begun = Instant::now();
    while !place.path("out/gas-sweep/restitution=0.9/log.mcap").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the first run does not begin");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(200));
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(place.column("out/gas-sweep", "status"), ["interrupted", "not run", "not run"]);
    assert!(
        !place.rows("out/gas-sweep")[0].contains_key("temperature"),
        "nothing of a part of a run is told"
    );
    // The unfinished run of the same case is no obstacle.
    let mut again = place.command(&slow).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(400));
    assert!(again.try_wait().unwrap().is_none(), "it is refused");
    again.kill().unwrap();
    again.wait().unwrap();
}

#[test]
fn the_page_needs_nothing_else() {
    let place = Place::with_gas();
    let walls = "boundary.y.lower.velocity[0]=[-0.1,-1,-10] + boundary.y.upper.velocity[0]=log(0.1, 10, 3)";
    let (text, _) =
        place.ends(&["--vary", walls, "--figure", "wall_shear_stress", "--set", "run.steps=4000"], 0);
    assert!(text.contains("power law: exponent"), "{text}");
    let page = fs::read_to_string(place.path("out/gas-sweep/sweep.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("Gas &lt;of tests&gt;"));
    for outside in ["http:", "https:", "<script", "<link rel=\"stylesheet", "@import", "url(h", " src="] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("<svg") && page.contains("exponent") && !page.contains("NaN"));
    // Pages of runs are linked where they stand.
    assert!(page.contains("href=\"upper.velocity.0=0.1/report.html\""));
    assert!(place.path("out/gas-sweep/upper.velocity.0=0.1/report.html").exists());
    let json = place.json("out/gas-sweep/sweep.json");
    let law = &json["power_laws"][0];
    assert_eq!((law["figure"].as_str(), law["points"].as_u64()), (Some("wall_shear_stress"), Some(3)));
    let said = text.split("exponent ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let difference = said.parse::<f64>().unwrap() - law["exponent"].as_f64().unwrap();
    assert!(difference.abs() < 0.1 * law["exponent_standard_error"].as_f64().unwrap(), "{said}: {law}");
}

#[test]
fn what_is_not_steady_is_said_and_left_out_of_fits() {
    let place = Place::with_gas();
    let more = ["--vary", "particles.count=[20, 40, 100, 200]", "--figure", "wall_normal_stress"];
    place.ends(&more, 0);
    // Summaries made up: the stress is that of a count, but for one that still rises.
    for (count, stress) in [(20, 2.0), (40, 4.0), (100, 7.0), (200, 20.0)] {
        let file = format!("out/gas-sweep/count={count}/summary.json");
        let mut summary = place.json(&file);
        let mut set =
            |ending: &str, value: Value| summary.insert(format!("wall_normal_stress{ending}"), value);
        set("", stress.into());
        set("_standard_error", (0.01 * stress).into());
        set("_degrees_of_freedom", 17.0.into());
        set("_steady", (count != 100).into());
        set("_trend", if count == 100 { "rising".into() } else { Value::Null });
        fs::write(place.path(&file), Value::Object(summary).to_string()).unwrap();
    }
    let (text, _) = place.ends(&more, 0);
    assert!(text.contains("particles.count = 100        not steady (rising, mean 7)"), "{text}");
    assert!(text.contains("1 point is not steady: no fit takes it"), "{text}");
    assert_eq!(place.column("out/gas-sweep", "wall_normal_stress_steady"), ["true", "true", "false", "true"]);
    let json = place.json("out/gas-sweep/sweep.json");
    let law = &json["power_laws"][0];
    assert!((law["exponent"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{law}");
    assert_eq!((&law["points"], &law["points_left_out_as_not_steady"]), (&3.into(), &1.into()));
    let of = |point: usize| &json["points"][point]["figures"]["wall_normal_stress"];
    assert_eq!((&of(2)["steady"], &of(2)["trend"]), (&false.into(), &"rising".into()));
    assert_eq!((&of(0)["steady"], &of(0)["degrees_of_freedom"]), (&true.into(), &17.0.into()));
    let page = fs::read_to_string(place.path("out/gas-sweep/sweep.html")).unwrap();
    assert!(
        page.contains("fill:none;stroke:") && page.contains("The ring is a mean of runs that are not steady")
    );
    assert!(page.contains("<td class=\"number\">not steady (rising, mean 7)</td>"));
}
