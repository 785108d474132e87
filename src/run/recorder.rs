//! Records a run: measures, frames and states at their times, into the log.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use super::NUMERICS;
use crate::engine::Horizon;
use crate::matter::state_hash::state_hash;
use crate::observe::field::{Field, field};
use crate::observe::measure::{Column, Dimension, Figure, Measure, Place, Profile, Snapshot};
use crate::record::contents::Walls;
use crate::record::error::LogError;
use crate::record::frame::frame;
use crate::record::time_scale::time_scale;
use crate::record::writer::{LogHeader, LogWriter, Recording};
use crate::scenario::model::{RecordPlan, Scenario, Spacing};
use crate::simulation::Simulation;
use crate::simulation::schedule::Spread;
use crate::space::Vector;

/// Writes the log and keeps the series for the tables.
pub(super) struct Recorder {
    writer: LogWriter,
    frames: Spread,
    states: Spread,
    recordings: u64,
    states_saved: u64,
    /// Which state was recorded last.
    last_recorded: Option<Place>,
    recorded: Recorded,
    /// `[measure]`: whether its series and profiles are stored.
    stored: Vec<bool>,
}

/// What was recorded, for the tables.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    /// Columns of the series; the first is the time.
    pub(super) columns: Vec<Column>,
    /// `[recording][column]`.
    pub(super) series: Vec<Vec<f64>>,
    /// Profiles taken at recordings, then those of the whole run.
    pub(super) profiles: Vec<Profile>,
    /// Figures of the whole run.
    pub(super) figures: Vec<Figure>,
}

impl Recorder {
    /// Begins the log of a run that is about to start.
    pub(super) fn create<V: Vector>(
        path: &Path,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<Self, LogError> {
        let scenario = simulation.scenario();
        let plan = &scenario.record;
        let (measures, _) = simulation.observation();
        let is_stored =
            |name: &str| plan.measures.as_ref().is_none_or(|names| names.iter().any(|n| n == name));
        let stored: Vec<bool> = measures.iter().map(|measure| is_stored(measure.name())).collect();
        let mut columns =
            vec![Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } }];
        for (measure, _) in measures.iter().zip(&stored).filter(|(_, stored)| **stored) {
            columns.extend(measure.columns());
        }
        let header = LogHeader {
            metadata: metadata(scenario),
            scenario: scenario.source_text.clone(),
            columns: columns.clone(),
            walls: Some(Walls::new(&scenario.boundary, V::ZERO, scenario.size)),
            fields: (scenario.fields().collect(), V::DIMENSION),
            start: 0.0,
            time_scale: expected_time_scale(scenario),
        };
        Ok(Recorder {
            writer: LogWriter::create(path, &header)?,
            frames: spread(plan),
            states: Spread::Inside(plan.states),
            recordings: 0,
            states_saved: 0,
            last_recorded: None,
            recorded: Recorded { columns, ..Recorded::default() },
            stored,
        })
    }

    /// Where the next recording or saved state is due, for an engine that can stop there.
    pub(super) fn horizon<V: Vector>(&self, simulation: &Simulation<'_, V>) -> Horizon {
        let recording = simulation.horizon_of(self.frames, self.recordings);
        recording.min(simulation.horizon_of(self.states, self.states_saved))
    }

    /// Makes the recording and saves the state that are due, if any. Also tells of what could not be written since the
    /// last step.
    pub(super) fn record_if_due<V: Vector>(
        &mut self,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<(), LogError> {
        self.writer.check()?;
        let (time, progress) = (simulation.gas().time(), simulation.progress());
        if self.frames.is_due(self.recordings, time, progress) {
            let next = self.frames.next(time, progress).max(self.recordings + 1);
            let shown = match simulation.end_reason() {
                Some(_) => Shown::ALL,
                None => Shown::at(self.recordings..next, &simulation.scenario().record),
            };
            self.record(simulation, shown)?;
            self.recordings = next;
        }
        if self.states.is_due(self.states_saved, time, progress) {
            self.writer.state(&simulation.saved_state(self.recordings, self.states_saved))?;
            self.states_saved = self.states.next(time, progress);
        }
        Ok(())
    }

    /// Records the end, the profiles of the whole run and the last state, and ends the log.
    pub(super) fn finish<V: Vector>(
        mut self,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<Recorded, LogError> {
        if self.last_recorded != Some(simulation.observation().1.place()) {
            self.record(simulation, Shown::ALL)?;
        }
        let from = simulation.scenario().record.from.unwrap_or(0.5 * simulation.gas().time());
        let (measures, snapshot) = simulation.observation();
        for (measure, &stored) in measures.iter().zip(&self.stored) {
            let (profiles, figures) = measure.conclusion(&snapshot, from);
            self.recorded.figures.extend(figures);
            for profile in profiles.into_iter().filter(|_| stored) {
                self.writer.profile(&profile)?;
                self.recorded.profiles.push(profile);
            }
        }
        self.writer.state(&simulation.saved_state(self.recordings, self.states_saved))?;
        self.writer.finish()?;
        Ok(self.recorded)
    }

    /// Ends the log of a run that cannot go on; what was recorded stays readable.
    pub(super) fn finish_after_failure(self) -> Result<(), LogError> {
        self.writer.finish()
    }

    fn record<V: Vector>(
        &mut self,
        simulation: &mut Simulation<'_, V>,
        shown: Shown,
    ) -> Result<(), LogError> {
        let scenario = simulation.scenario();
        let most_points = scenario.record.points.map(|points| points as usize);
        let quantities = scenario.fields().filter(|_| shown.fields);
        let fields: Vec<Field> =
            quantities.map(|one| field(one, simulation.gas(), simulation.cell_counts())).collect();
        let (measures, snapshot) = simulation.observation();
        let stored = &self.stored;
        let (hash, ((values, profiles), frame)) = rayon::join(
            || state_hash(snapshot.gas),
            || {
                let picture = || frame(snapshot.gas.time(), snapshot.gas.columns(), most_points);
                (look(measures, stored, &snapshot, shown.profiles), shown.frame.then(picture))
            },
        );
        self.writer.recording(&Recording {
            values: &values,
            state_hash: &hash,
            grains: snapshot.gas.len() as u64,
            profiles: &profiles,
            frame: frame.as_ref(),
            fields: &fields,
        })?;
        self.recorded.series.push(values);
        self.recorded.profiles.extend(profiles);
        self.last_recorded = Some(snapshot.place());
        if shown.fields {
            simulation.restart_cell_counts();
        }
        Ok(())
    }
}

/// What a recording shows beside the series.
#[derive(Clone, Copy, Debug)]
struct Shown {
    frame: bool,
    profiles: bool,
    fields: bool,
}

impl Shown {
    /// Everything.
    const ALL: Shown = Shown { frame: true, profiles: true, fields: true };

    /// What `plan` asks for at the recording that has these `numbers`: several where a step was longer than the pause.
    fn at(numbers: Range<u64>, plan: &RecordPlan) -> Self {
        let is_due = |every: u32| numbers.start.next_multiple_of(u64::from(every)) < numbers.end;
        Shown {
            frame: is_due(plan.frames_every),
            profiles: is_due(plan.profiles_every),
            fields: is_due(plan.fields_every),
        }
    }
}

/// Values of the series of all measures that are stored, and their profiles where those are wanted.
fn look<V: Vector>(
    measures: &mut [Box<dyn Measure<V>>],
    stored: &[bool],
    snapshot: &Snapshot<'_, V>,
    with_profiles: bool,
) -> (Vec<f64>, Vec<Profile>) {
    let (mut values, mut profiles) = (vec![snapshot.gas.time()], Vec::new());
    for (measure, _) in measures.iter_mut().zip(stored).filter(|(_, stored)| **stored) {
        values.extend(measure.values(snapshot));
        if with_profiles {
            profiles.extend(measure.profiles(snapshot));
        }
    }
    (values, profiles)
}

fn spread(plan: &RecordPlan) -> Spread {
    match plan.spacing {
        Spacing::Frames(number) => Spread::Even(number),
        Spacing::LogFrames(number) => Spread::Logarithmic(number),
        Spacing::Every(interval) => Spread::Every(interval),
        Spacing::Ends => Spread::Start,
    }
}

/// Ticks per time from what the scenario says of its length and of the pauses between recordings.
fn expected_time_scale<V: Vector>(scenario: &Scenario<V>) -> u64 {
    let poured = scenario.source.as_ref().map_or(0.0, |source| f64::from(source.count) / source.rate);
    let duration = scenario.run.time.or(scenario.run.rest.map(|rest| rest + poured));
    let interval = match scenario.record.spacing {
        Spacing::Every(interval) => Some(interval),
        Spacing::Frames(number) => duration.map(|duration| duration / f64::from(number.max(1))),
        Spacing::LogFrames(_) => duration.map(|duration| duration * 1e-3),
        Spacing::Ends => duration,
    };
    time_scale(duration.unwrap_or(f64::INFINITY), interval.unwrap_or(0.0))
}

fn metadata<V: Vector>(scenario: &Scenario<V>) -> BTreeMap<String, String> {
    let entries = [
        ("scenario", scenario.name.clone()),
        ("title", scenario.title.clone()),
        ("engine", scenario.engine.kind.name().to_owned()),
        ("dimension", V::DIMENSION.to_string()),
        ("seed", scenario.seed.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("numerics", NUMERICS.to_string()),
        ("unit_length", scenario.units.length.clone()),
        ("unit_mass", scenario.units.mass.clone()),
        ("unit_time", scenario.units.time.clone()),
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}
