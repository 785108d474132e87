//! Exports: the grains of a log in the formats that other programs open.
//!
//! Moments go one by one from the log into the file, so that a log of any size needs the memory of one of them.

mod csv;
mod error;
pub mod fields;
mod lammps;
pub mod moment;
mod series;
mod sink;
pub mod target;
pub(crate) mod volume;
mod vti;
mod vtk;
mod vtp;
mod xyz;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

pub use error::ExportError;
use fields::{FieldGrid, fields_of};
use moment::Moment;
use series::SeriesSink;
use sink::{Sink, TextSink};
use target::Target;
pub use volume::Volume;

use crate::record::error::LogError;
use crate::record::overview::{Overview, overview};
use crate::record::walk::{each_frame, each_state};
use crate::replay::scenario_of;
use crate::replay::selection::{Picker, Selection};
use crate::scenario::kinds::Kinds;
use crate::scenario::model::{AnyScenario, Scenario};
use crate::space::Vector;

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text dump of LAMMPS.
    Lammps,
    /// Points of VTK, a folder with a collection.
    Vtp,
    /// Fields on a grid as images of VTK, a folder with a collection.
    Vti,
    /// Extended XYZ.
    Xyz,
    /// One long table.
    Csv,
}

impl Format {
    /// What the usual place of an export ends in; of a folder, what its files end in.
    pub fn ending(self) -> &'static str {
        match self {
            Format::Lammps => "lammpstrj",
            Format::Vtp => "vtp",
            Format::Vti => "vti",
            Format::Xyz => "xyz",
            Format::Csv => "csv",
        }
    }

    /// Whether it is a folder with a file for every moment.
    pub fn is_folder(self) -> bool {
        matches!(self, Format::Vtp | Format::Vti)
    }

    /// Where an export of `log` goes if nobody says: beside it.
    pub fn usual_place(self, log: &Path) -> PathBuf {
        let stem = log.file_stem().map_or_else(|| "log".into(), |stem| stem.to_string_lossy().into_owned());
        let dot = if self.is_folder() { '-' } else { '.' };
        log.with_file_name(format!("{stem}{dot}{}", self.ending()))
    }
}

/// What is to be exported.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The log.
    pub log: &'a Path,
    /// The format.
    pub format: Format,
    /// Where it shall stand.
    pub out: &'a Path,
    /// Which part of the log.
    pub selection: Selection,
    /// The saved states at full precision, in place of the frames.
    pub states: bool,
    /// Wished side of a cell of fields [length]; `None` for the cells of the scenario.
    pub cell_size: Option<f64>,
    /// Whether an older export may be replaced.
    pub force: bool,
}

/// What an export has written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Where it stands.
    pub place: PathBuf,
    /// Moments in it.
    pub moments: u64,
    /// Those that are not all of the gas.
    pub thinned: u64,
    /// Points of the largest moment.
    pub most_points: u64,
    /// Grains of the largest gas.
    pub most_grains: u64,
    /// What is missing in the log, as a sentence.
    pub cut_off: Option<String>,
}

/// Exports a log, until the end or until `stop` turns true. Nothing stands in the place before all of it does.
pub fn export(request: &Request<'_>, stop: &AtomicBool) -> Result<Outcome, ExportError> {
    let found = overview(request.log)?;
    match scenario_of(request.log, &found.metadata, &found.scenario)? {
        AnyScenario::Two(scenario) => export_in(request, &found, &scenario, stop),
        AnyScenario::Three(scenario) => export_in(request, &found, &scenario, stop),
    }
}

fn export_in<V: Vector>(
    request: &Request<'_>,
    found: &Overview,
    scenario: &Scenario<V>,
    stop: &AtomicBool,
) -> Result<Outcome, ExportError> {
    check_contents(request, found, scenario)?;
    let volume = Volume::of(scenario);
    let grid = field_grid(request, scenario, &volume)?;
    let target = match request.format.is_folder() {
        true => Target::folder(request.out, request.force, &[request.format.ending(), "pvd"], "--out")?,
        false => Target::file(request.out, request.force, "--out")?,
    };
    let mut work = Work {
        picker: request.selection.picker(),
        sink: sink(request.format, &target, volume, grid)?,
        kinds: Kinds::new(scenario, found.species.clone()),
        outcome: Outcome { cut_off: found.cut_off.clone(), ..Outcome::default() },
        stop,
        failure: None,
    };
    if request.states {
        work.states::<V>(request.log)?;
    } else {
        work.frames(request.log)?;
    }
    if stop.load(Relaxed) {
        return Err(ExportError::Interrupted);
    }
    let Work { sink, mut outcome, failure, .. } = work;
    let written = failure.map_or_else(|| sink.finish(), Err);
    written.map_err(|source| target.failed(source))?;
    outcome.place = target.settle()?;
    Ok(outcome)
}

/// Whether there is anything to export, and enough known about it.
fn check_contents<V: Vector>(
    request: &Request<'_>,
    found: &Overview,
    scenario: &Scenario<V>,
) -> Result<(), ExportError> {
    let log = request.log.to_owned();
    let mut picker = request.selection.picker();
    let states = found.states.iter().map(|state| state.0);
    let times: Vec<f64> = if request.states { states.collect() } else { found.times.clone() };
    if !times.iter().any(|&time| picker.takes(time)) {
        let what = if request.states { "saved state" } else { "frame" };
        let span = match (times.first(), times.last()) {
            (Some(first), Some(last)) => format!("its {what}s go from t = {first} to {last}"),
            _ => format!("it holds no {what}"),
        };
        return Err(ExportError::Nothing { log, what, words: request.selection.words(), span });
    }
    let is_mixture = !scenario.species.is_empty();
    if is_mixture && found.species.is_empty() && !request.states {
        return Err(ExportError::UnknownSpecies { log });
    }
    Ok(())
}

fn field_grid<V: Vector>(
    request: &Request<'_>,
    scenario: &Scenario<V>,
    volume: &Volume,
) -> Result<FieldGrid, ExportError> {
    match request.cell_size {
        Some(side) => {
            FieldGrid::new(volume, side).ok_or(ExportError::TooManyCells { side, most: fields::MOST_CELLS })
        }
        None => Ok(FieldGrid::of_cells(volume, scenario.cells.map(|cells| cells as usize))),
    }
}

fn sink(
    format: Format,
    target: &Target,
    volume: Volume,
    grid: FieldGrid,
) -> Result<Box<dyn Sink>, ExportError> {
    let folder = target.working().to_owned();
    let mut is_first = true;
    let mut first = move || std::mem::replace(&mut is_first, false);
    Ok(match format {
        Format::Lammps => Box::new(TextSink::new(target.create()?, move |to, moment| {
            lammps::write(to, moment, &volume, first())
        })),
        Format::Xyz => {
            Box::new(TextSink::new(target.create()?, move |to, moment| xyz::write(to, moment, &volume)))
        }
        Format::Csv => {
            Box::new(TextSink::new(target.create()?, move |to, moment| csv::write(to, moment, first())))
        }
        Format::Vtp => Box::new(SeriesSink::new(folder, "particles", "vtp", vtp::write)),
        Format::Vti => Box::new(SeriesSink::new(folder, "fields", "vti", move |to, moment| {
            vti::write(to, &fields_of(moment, grid))
        })),
    })
}

/// An export while it goes on.
struct Work<'a> {
    picker: Picker,
    sink: Box<dyn Sink>,
    kinds: Kinds,
    outcome: Outcome,
    stop: &'a AtomicBool,
    failure: Option<std::io::Error>,
}

impl Work<'_> {
    fn frames(&mut self, log: &Path) -> Result<(), LogError> {
        each_frame(log, &mut |number, frame| {
            if !self.picker.takes(frame.time) {
                return ControlFlow::Continue(());
            }
            let moment = Moment::of_frame(number.into(), &frame, &self.kinds);
            self.add(&moment)
        })
    }

    fn states<V: Vector>(&mut self, log: &Path) -> Result<(), LogError> {
        let mut number = 0;
        each_state::<V>(log, &mut |state| {
            number += 1;
            if !self.picker.takes(state.time) {
                return ControlFlow::Continue(());
            }
            let moment = Moment::of_state(number - 1, &state, &self.kinds);
            self.add(&moment)
        })
    }

    fn add(&mut self, moment: &Moment) -> ControlFlow<()> {
        let outcome = &mut self.outcome;
        outcome.moments += 1;
        outcome.thinned += u64::from(moment.is_thinned());
        outcome.most_points = outcome.most_points.max(moment.len() as u64);
        outcome.most_grains = outcome.most_grains.max(moment.grains);
        match self.sink.add(moment) {
            Ok(()) if !self.stop.load(Relaxed) => ControlFlow::Continue(()),
            Ok(()) => ControlFlow::Break(()),
            Err(failure) => {
                self.failure = Some(failure);
                ControlFlow::Break(())
            }
        }
    }
}
