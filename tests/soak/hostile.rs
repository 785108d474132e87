//! Readers under fire: scenario files, `--set`, tables of calibration, logs, requests to the viewer are given input that
//! is nearly right. They may refuse it; they may not panic, hang or ask for memory without bound.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use grainflow::engine::{Horizon, NoLaps};
use grainflow::machine::peak_memory_bytes;
use grainflow::scenario::check::check;
use grainflow::scenario::model::{AnyScenario, InitialPositions, Scenario};
use grainflow::scenario::{Overrides, builtin, initial, parse, parse_in};
use grainflow::simulation::Simulation;
use grainflow::space::Vector;
use grainflow::view::ViewedLog;

use super::draw::{Dice, Units, scenario_text};
use super::requests::Door;
use super::trial::caught;
use super::{logs, mutation, readers, requests, watch};

/// What is fired at.
pub(crate) const TARGETS: [&str; 11] =
    ["scenario", "set", "table", "log", "recover", "replay", "export", "view", "request", "resume", "verify"];
/// The longest that one case may take on a loaded machine [s].
const PATIENCE: f64 = 20.0;
/// The most memory that the whole program may come to hold [bytes].
const MEMORY: u64 = 2_000_000_000;

/// Everything that wounds are made in.
pub(crate) struct Range {
    scenarios: Vec<String>,
    sets: Vec<String>,
    tables: Vec<String>,
    logs: Vec<Vec<u8>>,
    requests: Vec<Vec<u8>>,
    door: Door,
    place: PathBuf,
}

/// What many cases came to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fired {
    pub(crate) cases: u64,
    /// Input that was taken in spite of its wounds.
    pub(crate) accepted: u64,
    /// The longest case [s].
    pub(crate) longest: f64,
}

impl Range {
    /// Reads what is kept in `tests/`, and works in `place`.
    pub(crate) fn new(place: &Path) -> Result<Self, String> {
        let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
        let mut scenarios: Vec<String> =
            builtin::list().iter().filter_map(|(name, _)| builtin::text(name)).map(str::to_owned).collect();
        scenarios.extend(texts(&tests.join("scenario_errors"))?);
        scenarios.extend((1..40).map(|seed| scenario_text(seed, Units::ONE)));
        let sets = texts(&tests.join("corpus/sets"))?.concat().lines().map(str::to_owned).collect();
        let mut tables = texts(&tests.join("corpus/tables"))?;
        tables.extend(texts(&tests.join("tables"))?);
        let mut files = logs::written(place)?;
        files.extend(contents(&tests.join("corpus/logs"))?);
        let door = Door::to(ViewedLog::open(&logs::first(place)).map_err(|error| error.to_string())?);
        let (requests, place) = (requests::known(), place.to_owned());
        Ok(Range { scenarios, sets, tables, logs: files, requests, door, place })
    }

    /// Case number `seed` against `target`; the message of one that is not borne says how to see it again.
    pub(crate) fn fire(&self, target: &str, seed: u64, fired: &mut Fired) -> Result<(), String> {
        let dice = &mut Dice::new(seed);
        let since = Instant::now();
        let mut shot = Shot::default();
        let result = caught(|| {
            shot = self.shot(target, dice);
            watch::over(format!("{target} #{seed}\n{}", shot.shown()), || self.land(target, &shot))
        });
        let seconds = since.elapsed().as_secs_f64();
        fired.cases += 1;
        fired.accepted += u64::from(result == Ok(true));
        fired.longest = fired.longest.max(seconds);
        let problem = match result {
            Err(problem) => problem,
            Ok(_) if seconds > PATIENCE => format!("took {seconds:.1} s"),
            Ok(_) if seed.is_multiple_of(256) && peak_memory_bytes().is_some_and(|peak| peak > MEMORY) => {
                "the program has come to hold more than 2 GB".to_owned()
            }
            Ok(_) => return Ok(()),
        };
        Err(format!("{target} #{seed}: {problem}\n{}", shot.shown()))
    }

    /// What is fired in case number `seed`.
    pub(crate) fn show(&self, target: &str, seed: u64) -> String {
        self.shot(target, &mut Dice::new(seed)).shown()
    }

    fn shot(&self, target: &str, dice: &mut Dice) -> Shot {
        let any = |dice: &mut Dice, texts: &[String]| texts[dice.below(texts.len())].clone();
        match target {
            "scenario" => {
                let text = any(dice, &self.scenarios);
                Shot::text(mutation::text(dice, &text, &self.scenarios))
            }
            "set" => {
                let set = any(dice, &self.sets);
                Shot {
                    scenario: dice.below(builtin::list().len()),
                    ..Shot::text(mutation::text(dice, &set, &self.sets))
                }
            }
            "table" => {
                let text = any(dice, &self.tables);
                Shot::text(mutation::text(dice, &text, &self.tables))
            }
            "request" => {
                let request = &self.requests[dice.below(self.requests.len())];
                let wounds = dice.below(4);
                let data = (0..wounds).fold(request.clone(), |data, _| mutation::bytes(dice, &data));
                Shot { data, ..Shot::default() }
            }
            _ => {
                let log = &self.logs[dice.below(self.logs.len())];
                let goes_on = matches!(target, "resume" | "verify");
                let wounded = if goes_on && dice.chance(0.8) {
                    logs::with_wounded_states(dice, log)
                } else if dice.chance(0.6) {
                    logs::rewritten(dice, log)
                } else {
                    None
                };
                let data = wounded.unwrap_or_else(|| mutation::bytes(dice, log));
                Shot { data, choice: dice.below(1000), ..Shot::default() }
            }
        }
    }

    /// Whether the input was taken.
    fn land(&self, target: &str, shot: &Shot) -> Result<bool, String> {
        match target {
            "scenario" => Ok(take(parse("fire", &shot.words(), &Overrides::default()).ok())),
            "set" => {
                let (name, _) = builtin::list()[shot.scenario];
                let overrides = Overrides { sets: vec![shot.words()], ..Default::default() };
                Ok(take(parse(name, builtin::text(name).unwrap_or_default(), &overrides).ok()))
            }
            "table" => {
                fs::write(self.place.join("table.csv"), &shot.data).map_err(|error| error.to_string())?;
                let scenario = builtin::text("cooling").unwrap_or_default();
                let is_entry = shot.words().contains("volume_fraction");
                let key = if is_entry { "hsmc.entry_probability" } else { "impact_parameter" };
                let set = format!("engine.{key}={{ table = {:?} }}", self.place.join("table.csv"));
                let overrides = Overrides { sets: vec![set], ..Default::default() };
                Ok(take(parse_in(&self.place, "cooling", scenario, &overrides).ok()))
            }
            "request" => Ok(self.door.ask(&shot.data) == 200),
            _ => {
                let log = self.place.join("fire.mcap");
                fs::write(&log, &shot.data).map_err(|error| error.to_string())?;
                Ok(match target {
                    "recover" => readers::recovered(&log),
                    "replay" => readers::replayed(&log),
                    "export" => readers::exported(&log, shot.choice),
                    "view" => readers::viewed(&log),
                    "resume" => readers::resumed(&log, shot.choice),
                    "verify" => readers::verified(&log),
                    _ => readers::read(&log),
                })
            }
        }
    }
}

/// Looks at what a scenario means, too, and takes the first steps of a small one.
fn take(scenario: Option<AnyScenario>) -> bool {
    let Some(scenario) = scenario else { return false };
    let said = check(&scenario).to_string();
    assert!(!said.contains("NaN"), "check says NaN:\n{said}");
    // Who asks for more than a month is warned, and may wait.
    if said.contains("warning: the run takes about") {
        return true;
    }
    match &scenario {
        AnyScenario::Two(scenario) => begin(scenario),
        AnyScenario::Three(scenario) => begin(scenario),
    }
    true
}

/// A run may end with an error of its own, never with a panic.
fn begin<V: Vector>(scenario: &Scenario<V>) {
    if !is_small(scenario) {
        return;
    }
    let Ok(gas) = initial::build(scenario, None) else { return };
    let Ok(mut simulation) = Simulation::start(scenario, gas, &mut NoLaps) else { return };
    for _ in 0..4 {
        let horizon = Horizon { collisions: 200, ..Horizon::NONE };
        if simulation.end_reason().is_some() || simulation.advance(&mut NoLaps, horizon).is_err() {
            return;
        }
    }
}

/// Whether a run begins within a moment.
pub(crate) fn is_small<V: Vector>(scenario: &Scenario<V>) -> bool {
    let from_log = matches!(scenario.initial.positions, InitialPositions::Log(_));
    scenario.count <= 300
        && scenario.grid().number_of_cells() <= 20_000
        && scenario.initial.equilibrate <= 2.0
        && !from_log
}

/// What is fired.
#[derive(Default)]
struct Shot {
    data: Vec<u8>,
    /// Which built-in scenario a `--set` changes.
    scenario: usize,
    /// Which of several ways to read a log is taken.
    choice: usize,
}

impl Shot {
    fn text(text: String) -> Self {
        Shot { data: text.into_bytes(), ..Shot::default() }
    }

    fn words(&self) -> String {
        String::from_utf8_lossy(&self.data).into_owned()
    }

    fn shown(&self) -> String {
        let text: String = self.words().chars().take(6000).collect();
        if text.chars().filter(|c| c.is_control() && *c != '\n').count() * 20 > text.len() {
            return format!("{} bytes", self.data.len());
        }
        text
    }
}

/// All files of `folder`, in the order of their names.
fn contents(folder: &Path) -> Result<Vec<Vec<u8>>, String> {
    let told = |error: std::io::Error| format!("{}: {error}", folder.display());
    let entries = fs::read_dir(folder).map_err(told)?.collect::<Result<Vec<_>, _>>().map_err(told)?;
    let mut paths: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).map_err(told)).collect()
}

fn texts(folder: &Path) -> Result<Vec<String>, String> {
    Ok(contents(folder)?.iter().map(|bytes| String::from_utf8_lossy(bytes).into_owned()).collect())
}
