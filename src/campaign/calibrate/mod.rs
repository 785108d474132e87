//! Measures laws of the stochastic engines in event-driven runs of a scenario: c of p(b) in the course of a run, and
//! p(ν) of entering a cell ("corrected" HSMC, Müller 2001, sections 2.3.2 and 3.6.1).

mod board;
mod entries;
mod files;
mod replica;
mod stages;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::engine::report::IMPACT_BINS;
use crate::report::calibration::Calibration;
use crate::run::folder::{FolderError, RunFolder};
use crate::run::{Listener, RunError};
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{AnyScenario, InitialPositions, InitialVelocities, Scenario};
use crate::scenario::{Overrides, load};
use crate::simulation::SimulationError;
use crate::space::Vector;
use board::Board;
use replica::{Replica, watch};

/// Collisions per particle of the equilibration of a free gas that asks for none.
const EQUILIBRATION: f64 = 10.0;
/// χ² of a p(b) that has the form of the law: bins without the norm and c.
const EXPECTED_CHI_SQUARED: f64 = (IMPACT_BINS - 2) as f64;
/// Seeds end below this.
const SEEDS: u64 = 1 << 63;

/// Why a calibration could not be made.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// The scenario is wrong, or not one for HSMC and for event-driven dynamics.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The folder, the initial state or a file.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A run cannot go on.
    #[error("an event-driven run cannot go on: {0}")]
    Simulation(#[from] SimulationError),
    /// Nothing was measured.
    #[error(
        "the runs hold no collision from which c could be told, and too few flights from cell to cell for p(ν); make \
         them longer or take more --replicas"
    )]
    Nothing,
    /// Somebody stopped it; nothing is kept.
    #[error("interrupted; a calibration keeps nothing of runs that are not complete")]
    Interrupted,
}

impl CalibrationError {
    /// Whether the input is at fault.
    pub fn is_bad_input(&self) -> bool {
        match self {
            CalibrationError::Scenario(_) => true,
            CalibrationError::Run(error) => error.is_bad_input(),
            _ => false,
        }
    }
}

impl From<FolderError> for CalibrationError {
    fn from(error: FolderError) -> Self {
        RunError::from(error).into()
    }
}

/// What to calibrate.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// A scenario file or a built-in one.
    pub source: &'a str,
    /// Changes to it; `engine` is not used.
    pub overrides: &'a Overrides,
    /// Event-driven runs, at least 1, with seeds that follow the scenario's.
    pub replicas: u32,
    /// Where to write; `None` for `out/<scenario>-calibrate`.
    pub folder: Option<&'a Path>,
    /// Whether to replace what stands there.
    pub force: bool,
}

/// Measures, and writes `impact.csv`, `entry.csv`, `calibration.json` and `calibration.html`. Returns the folder and
/// what was found. `tell` hears how the runs go on.
pub fn calibrate(
    request: &Request<'_>,
    stop: &AtomicBool,
    tell: Listener<'_>,
) -> Result<(PathBuf, Calibration), CalibrationError> {
    let (stochastic, exact) = scenarios(request)?;
    let name = match &stochastic {
        AnyScenario::Two(scenario) => &scenario.name,
        AnyScenario::Three(scenario) => &scenario.name,
    };
    let usual = PathBuf::from("out").join(format!("{name}-calibrate"));
    let folder = RunFolder::claim(request.folder.unwrap_or(&usual), request.force)?;
    let board = Board::new(exact.len(), tell);
    let found = match &stochastic {
        AnyScenario::Two(stochastic) => measure(stochastic, &exact, in_the_plane, stop, &board),
        AnyScenario::Three(stochastic) => measure(stochastic, &exact, in_space, stop, &board),
    };
    let calibration = match found {
        Ok(calibration) => calibration,
        Err(error) => {
            folder.abandon();
            return Err(error);
        }
    };
    files::write(folder.path(), &calibration)?;
    Ok((folder.settle()?, calibration))
}

fn in_the_plane(scenario: &AnyScenario) -> Option<&Scenario<glam::DVec2>> {
    if let AnyScenario::Two(scenario) = scenario { Some(scenario) } else { None }
}

fn in_space(scenario: &AnyScenario) -> Option<&Scenario<glam::DVec3>> {
    if let AnyScenario::Three(scenario) = scenario { Some(scenario) } else { None }
}

/// The scenario as HSMC would run it, and for every replica as event-driven dynamics does.
fn scenarios(request: &Request<'_>) -> Result<(AnyScenario, Vec<AnyScenario>), ScenarioError> {
    let mut overrides = request.overrides.clone();
    // Tables that the scenario names may be those that this calibration is to write.
    overrides.sets.push("engine.impact_parameter=uniform".to_owned());
    overrides.sets.push("engine.hsmc.entry_probability=step".to_owned());
    overrides.sets.push("record.measures=[\"energy\"]".to_owned());
    overrides.engine = Some("hsmc".to_owned());
    let stochastic = load(request.source, &overrides)?;
    let (seed, starts_raw) = match &stochastic {
        AnyScenario::Two(scenario) => (scenario.seed, is_raw(scenario)),
        AnyScenario::Three(scenario) => (scenario.seed, is_raw(scenario)),
    };
    if starts_raw {
        overrides.sets.push(format!("initial.equilibrate={EQUILIBRATION:?}"));
    }
    overrides.engine = Some("event-driven".to_owned());
    let exact = |replica: u32| {
        let seed = Some((seed + u64::from(replica)) % SEEDS);
        load(request.source, &Overrides { seed, ..overrides.clone() })
    };
    Ok((stochastic, (0..request.replicas).map(exact).collect::<Result<_, _>>()?))
}

/// Whether a free gas would begin with places and velocities that no dynamics has made.
fn is_raw<V: Vector>(scenario: &Scenario<V>) -> bool {
    let is_driven = scenario.gravity != V::ZERO
        || scenario.source.is_some()
        || scenario.boundary.largest_wall_speed() > 0.0;
    let initial = &scenario.initial;
    let is_made = matches!(initial.positions, InitialPositions::Log(_))
        || initial.velocities == InitialVelocities::Rest
        || initial.equilibrate > 0.0;
    !is_driven && !is_made && scenario.count > 1
}

/// All runs, side by side on the threads there are, and what they show.
fn measure<V: Vector>(
    stochastic: &Scenario<V>,
    exact: &[AnyScenario],
    in_its_space: fn(&AnyScenario) -> Option<&Scenario<V>>,
    stop: &AtomicBool,
    board: &Board<'_>,
) -> Result<Calibration, CalibrationError> {
    let runs: Result<Vec<Replica>, CalibrationError> = exact
        .par_iter()
        .enumerate()
        .map(|(number, exact)| {
            let exact = in_its_space(exact).expect("the text is the same, and with it the dimension");
            watch(exact, stochastic, stop, &|status| board.tell(number, status))
        })
        .collect();
    let runs = runs?;
    let slices: Vec<_> = runs.iter().map(|run| run.slices.clone()).collect();
    let entries: Vec<_> = runs.iter().map(|run| run.entries.clone()).collect();
    let grid = stochastic.grid();
    let found = Calibration {
        title: stochastic.title.clone(),
        scenario: stochastic.name.clone(),
        dimension: V::DIMENSION,
        particles: stochastic.count,
        volume_fraction: stochastic.volume_fraction(),
        seed: stochastic.seed,
        replicas: exact.len() as u32,
        cell: grid.side().components(),
        capacity: stochastic.capacity().unwrap_or(0),
        stages: stages::stages::<V>(&slices),
        entries: entries::curve(&entries, stochastic.grain.volume::<V>() / grid.cell_volume()),
        remarks: Vec::new(),
    };
    if found.stages.is_empty() && found.entries.is_empty() {
        return Err(CalibrationError::Nothing);
    }
    Ok(Calibration { remarks: remarks(&found), ..found })
}

/// What a reader must know beside the numbers.
fn remarks(found: &Calibration) -> Vec<String> {
    let mut remarks = vec![
        "c is that of maximum likelihood over 40 bins; its error is that of independent collisions, or what the runs \
         scatter by where that is more."
            .to_owned(),
        "p(ν) belongs to these cells and this step, and counts every collision on the way, also those that the \
         stochastic engine makes by itself; arrivals over attempts show what is left when as many come in otherwise."
            .to_owned(),
    ];
    let limit = EXPECTED_CHI_SQUARED + 5.0 * (2.0 * EXPECTED_CHI_SQUARED).sqrt();
    if found.stages.iter().any(|stage| stage.chi_squared > limit) {
        remarks.push(format!(
            "In some stages χ² exceeds {limit:.0}: p(b) has another form there than one c can give it, and the law is its \
             best likeness."
        ));
    }
    if found.replicas < 4 {
        remarks.push("Fewer than four runs tell little of how runs scatter.".to_owned());
    }
    if found.stages.is_empty() {
        remarks.push("There were too few collisions for c: impact.csv is not written.".to_owned());
    }
    if found.entries.is_empty() {
        remarks.push(
            "There were too few flights from cell to cell for p(ν): entry.csv is not written.".to_owned(),
        );
    }
    remarks
}
