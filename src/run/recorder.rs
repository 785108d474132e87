//! Records a run: measures, frames and states at their times, into the log.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::last_good::last_good;
use super::looks::Looks;
use super::shown::Shown;
use super::timetable::Timetable;
use super::{NUMERICS, OBSERVATION, OBSERVATION_KEY};
use crate::engine::Horizon;
use crate::matter::state_hash::state_hash;
use crate::observe::field::{Field, field};
use crate::observe::measure::{Column, Figure, Place, Profile};
use crate::record::RECOVERED_KEY;
use crate::record::contents::EarlierPart;
use crate::record::continuation::copy_before;
use crate::record::error::LogError;
use crate::record::frame::frame;
use crate::record::history::History;
use crate::record::time_scale::time_scale;
use crate::record::writer::{LogHeader, LogWriter, Recording};
use crate::scenario::model::{InitialPositions, Scenario};
use crate::simulation::Simulation;
use crate::space::Vector;

/// Writes the log and keeps the series for the tables.
pub(super) struct Recorder {
    writer: LogWriter,
    timetable: Timetable,
    looks: Looks,
    /// Which state was recorded last.
    last_recorded: Option<Place>,
    recorded: Recorded,
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
    /// Begins the log of a run that is about to start. Where grains come from another log, they are saved first: the
    /// log can do without the other.
    pub(super) fn create<V: Vector>(
        path: &Path,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<Self, LogError> {
        let scenario = simulation.scenario();
        let looks = Looks::of(simulation);
        let writer = LogWriter::create(path, &header(scenario, &looks))?;
        let mut recorder = Recorder {
            writer,
            timetable: Timetable::new(&scenario.record),
            recorded: Recorded { columns: looks.columns.clone(), ..Recorded::default() },
            looks,
            last_recorded: None,
        };
        if matches!(scenario.initial.positions, InitialPositions::Log(_)) {
            recorder.save(simulation)?;
        }
        Ok(recorder)
    }

    /// Begins the log of a run that goes on, as [`Origin`] says, with everything that was recorded before.
    pub(super) fn resume<V: Vector>(
        path: &Path,
        simulation: &mut Simulation<'_, V>,
        timetable: Timetable,
        origin: &Origin<'_>,
    ) -> Result<Self, LogError> {
        let looks = Looks::of(simulation);
        let mut header = header(simulation.scenario(), &looks);
        header.earlier.clone_from(&origin.earlier);
        header.time_scale = origin.history.time_scale().unwrap_or(header.time_scale);
        if origin.history.has_holes {
            let lost = origin.history.value(RECOVERED_KEY).to_owned();
            header.metadata.insert(RECOVERED_KEY.to_owned(), lost);
        }
        // The sums of a run go on as they began.
        match origin.history.value(OBSERVATION_KEY) {
            "" => header.metadata.remove(OBSERVATION_KEY),
            number => header.metadata.insert(OBSERVATION_KEY.to_owned(), number.to_owned()),
        };
        let mut writer = LogWriter::create(path, &header)?;
        let copied = copy_before(origin.log, origin.state, &mut writer, &looks.columns)?;
        let is_here = copied.series.last().is_some_and(|row| row[0] == simulation.gas().time())
            && (copied.last_hash.is_empty() || copied.last_hash == state_hash(simulation.gas()));
        let recorded = Recorded {
            columns: looks.columns.clone(),
            series: copied.series,
            profiles: copied.profiles,
            figures: Vec::new(),
        };
        let last_recorded = is_here.then(|| simulation.observation().1.place());
        let mut recorder = Recorder { writer, timetable, looks, last_recorded, recorded };
        if origin.keeps_state {
            recorder.save(simulation)?;
        }
        Ok(recorder)
    }

    /// Where the next recording or saved state is due, for an engine that can stop there.
    pub(super) fn horizon<V: Vector>(&self, simulation: &Simulation<'_, V>) -> Horizon {
        self.timetable.horizon(simulation)
    }

    /// Makes the recording and saves the state that are due, if any. Also tells of what could not be written since the
    /// last step.
    pub(super) fn record_if_due<V: Vector>(
        &mut self,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<(), LogError> {
        self.writer.check()?;
        if self.timetable.wants_recording(simulation) {
            let shown = Shown::at(self.timetable.due(simulation), &simulation.scenario().record);
            // The last recording shows everything. Where the timetable does not want that, it comes after the last
            // state: a run that goes on from there makes the one that is due.
            if shown == Shown::ALL || simulation.end_reason().is_none() {
                self.record(simulation, shown)?;
                self.timetable.recorded(simulation);
            }
        }
        if self.timetable.wants_state(simulation) {
            self.save(simulation)?;
            self.timetable.state_saved(simulation);
        }
        Ok(())
    }

    /// Saves the last state, records the end and the profiles of the whole run, and ends the log. What stands before that
    /// state is what stands there in the log of a run that goes on.
    pub(super) fn finish<V: Vector>(
        mut self,
        simulation: &mut Simulation<'_, V>,
    ) -> Result<Recorded, LogError> {
        self.save(simulation)?;
        if self.last_recorded != Some(simulation.observation().1.place()) {
            self.record(simulation, Shown::ALL)?;
        }
        let from = simulation.steady_from();
        let (measures, snapshot) = simulation.observation();
        for (measure, &stored) in measures.iter().zip(&self.looks.stored) {
            let (profiles, figures) = measure.conclusion(&snapshot, from);
            self.recorded.figures.extend(figures);
            for profile in profiles.into_iter().filter(|_| stored) {
                self.writer.profile(&profile)?;
                self.recorded.profiles.push(profile);
            }
        }
        self.writer.finish()?;
        Ok(self.recorded)
    }

    /// Ends the log of a run that could not go on from `place` as that of a run that ends there, unless `stop` turns true
    /// before the run has come there once more. Returns what was recorded, and the run at that place.
    pub(super) fn finish_after_failure<'s, V: Vector>(
        mut self,
        scenario: &'s Scenario<V>,
        place: Place,
        stop: &AtomicBool,
    ) -> Result<Option<(Recorded, Simulation<'s, V>)>, LogError> {
        self.writer.flush()?;
        let Some(mut simulation) = last_good(scenario, self.writer.path(), place, stop) else {
            self.writer.finish()?;
            return Ok(None);
        };
        let recorded = self.finish(&mut simulation)?;
        Ok(Some((recorded, simulation)))
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
        let looks = &self.looks;
        let picture = || frame(snapshot.gas.time(), snapshot.gas.columns(), most_points);
        let ((hash, frame), (values, profiles)) = rayon::join(
            || {
                let hash = if shown.full { state_hash(snapshot.gas) } else { String::new() };
                (hash, shown.frame.then(picture))
            },
            || looks.take(measures, &snapshot, shown),
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

    fn save<V: Vector>(&mut self, simulation: &Simulation<'_, V>) -> Result<(), LogError> {
        let Timetable { recordings, saved, .. } = self.timetable;
        self.writer.state(&simulation.saved_state(recordings, saved))
    }
}

/// Where a run that goes on comes from.
pub(super) struct Origin<'a> {
    /// The log.
    pub(super) log: &'a Path,
    /// What it says of its run.
    pub(super) history: &'a History,
    /// The number of its state in the sequence of the states.
    pub(super) state: u32,
    /// Whether the new log begins with that state; else it stands there only where it is due.
    pub(super) keeps_state: bool,
    /// What ran by other scenarios before.
    pub(super) earlier: Vec<EarlierPart>,
}

fn header<V: Vector>(scenario: &Scenario<V>, looks: &Looks) -> LogHeader {
    LogHeader {
        metadata: metadata(scenario),
        scenario: scenario.source_text.clone(),
        earlier: Vec::new(),
        columns: looks.columns.clone(),
        walls: Some(scenario.walls()),
        fields: (scenario.fields().collect(), V::DIMENSION),
        start: 0.0,
        time_scale: expected_time_scale(scenario),
    }
}

/// Ticks per time from what can be told before the run of its length and of the pauses between recordings.
fn expected_time_scale<V: Vector>(scenario: &Scenario<V>) -> u64 {
    let duration = scenario.expected_duration().unwrap_or(f64::INFINITY);
    time_scale(duration, scenario.expected_pause().unwrap_or(0.0))
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
        (OBSERVATION_KEY, OBSERVATION.to_string()),
        ("unit_length", scenario.units.length.clone()),
        ("unit_mass", scenario.units.mass.clone()),
        ("unit_time", scenario.units.time.clone()),
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}
