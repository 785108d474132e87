//! Reads a log: its contents for reports and comparisons, its saved states for resuming.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use prost::Message;

use super::contents::RunLog;
use super::error::LogError;
use super::frame::frame_of;
use super::grids;
use super::saved::Assembly;
use super::scan::{Event, Fault, scan};
use super::schema::foxglove::{PointCloud, SceneUpdate};
use super::schema::grainflow::{Profile as ProfileMessage, State};
use super::schema::measures::{MeasuresMessage, columns_of};
use super::schema::topic;
use super::schema::units::dimension_of;
use super::state::SavedState;
use super::walk::each_state;
use super::walls::walls_of;
use crate::observe::measure::{Column, Profile};
use crate::space::Vector;

/// Reads everything in the log at `path` but its saved states. A log that was cut off gives what is
/// complete and says so in [`RunLog::cut_off`]; one with wrong bytes is refused.
pub fn read_log(path: &Path) -> Result<RunLog, LogError> {
    let mut contents = Contents::default();
    let cut_off = scan(path, &mut |event| contents.add(event))?;
    Ok(RunLog { cut_off, ..contents.log })
}

/// The same without the pictures of the grains, which are nearly all of a large log.
pub fn read_tables(path: &Path) -> Result<RunLog, LogError> {
    let mut contents = Contents { without_frames: true, ..Contents::default() };
    let cut_off = scan(path, &mut |event| contents.add(event))?;
    Ok(RunLog { cut_off, ..contents.log })
}

/// What tells which run a log is of, and whether all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Version, numerics, seed, engine, units and the like, as `key = value`.
    pub metadata: BTreeMap<String, String>,
    /// The scenario as TOML text.
    pub scenario: String,
    /// The state hash of the last recording, in hexadecimal digits; empty where there is none.
    pub last_hash: String,
    /// What is missing, as a sentence, where the file was cut off.
    pub cut_off: Option<String>,
}

/// The origin of the log at `path`, once all its checksums are seen to hold.
pub fn read_origin(path: &Path) -> Result<Origin, LogError> {
    let mut origin = Origin::default();
    let cut_off = scan(path, &mut |event| {
        match event {
            Event::Metadata(found) => origin.metadata = found,
            Event::Scenario(found) => origin.scenario = found,
            Event::Message { topic: topic::MEASURES, data, .. } => {
                origin.last_hash = MeasuresMessage::decode(data, &[]).map_err(Fault::damage)?.state_hash;
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok(Origin { cut_off, ..origin })
}

/// All complete saved states of the log at `path`, in the order of their times.
pub fn read_states<V: Vector>(path: &Path) -> Result<Vec<SavedState<'static, V>>, LogError> {
    let mut states = Vec::new();
    each_state(path, &mut |state| {
        states.push(state);
        ControlFlow::Continue(())
    })?;
    Ok(states)
}

/// The last complete saved state of the log at `path`, from which its run can go on.
pub fn last_state<V: Vector>(path: &Path) -> Result<Option<SavedState<'static, V>>, LogError> {
    let mut last = None;
    each_state(path, &mut |state| {
        last = Some(state);
        ControlFlow::Continue(())
    })?;
    Ok(last)
}

/// The same, with the number of its first part in the sequence of the states.
pub(crate) fn last_state_and_place<V: Vector>(path: &Path) -> Result<Option<Placed<V>>, LogError> {
    let (mut last, mut first_part) = (None, 0);
    let mut assembly = Assembly::<V>::default();
    scan(path, &mut |event| {
        if let Event::Message { topic: topic::STATE, sequence, data, .. } = event {
            let part = State::decode(data).map_err(Fault::damage)?;
            if part.first_row == 0 {
                first_part = sequence;
            }
            if let Some(state) = assembly.add(&part).map_err(Fault::damage)? {
                last = Some((state, first_part));
            }
        }
        Ok(())
    })?;
    Ok(last)
}

/// Who is of which kind: the two fields of [`State`] that say it. Decoding passes over all others, which are nearly all of it.
#[derive(Clone, PartialEq, Message)]
struct Kinds {
    #[prost(bytes = "vec", tag = "8")]
    ids: Vec<u8>,
    #[prost(bytes = "vec", tag = "10")]
    species: Vec<u8>,
}

/// Puts the `kinds` of the grains `ids`, four bytes each, into `species` `[id]`.
pub(super) fn add_species(species: &mut Vec<u8>, ids: &[u8], kinds: &[u8]) {
    for (id, &kind) in ids.chunks_exact(4).zip(kinds) {
        let id = u32::from_le_bytes([id[0], id[1], id[2], id[3]]) as usize;
        if id >= species.len() {
            species.resize(id + 1, 0);
        }
        species[id] = kind;
    }
}

/// A state and the number of its first part in the sequence of the states.
pub(crate) type Placed<V> = (SavedState<'static, V>, u32);

/// The contents so far.
#[derive(Default)]
struct Contents {
    log: RunLog,
    /// Numbers of the fields of the columns.
    numbers: Vec<u32>,
    /// Topic of each channel of fields, whether it is of space, and its units.
    grids: Vec<(String, bool, BTreeMap<String, String>)>,
    /// Place in the sequence and grains in the gas of every recording.
    recordings: Vec<(u32, u64)>,
    /// Whether pictures are passed over.
    without_frames: bool,
}

impl Contents {
    fn add(&mut self, event: Event<'_>) -> Result<(), Fault> {
        match event {
            Event::Metadata(metadata) => self.log.metadata = metadata,
            Event::Scenario(scenario) => self.log.scenario = scenario,
            Event::Channel { topic: topic::MEASURES, description, metadata } => {
                let columns = columns_of(description, metadata)
                    .ok_or_else(|| Fault::damage("the columns of the series have no proper units"))?;
                (self.numbers, self.log.columns) = columns.into_iter().unzip();
            }
            Event::Channel { topic, description, metadata } if topic.starts_with(topic::FIELDS) => {
                self.grids.push((topic.to_owned(), grids::is_of_space(description), metadata.clone()));
            }
            Event::Message { topic, sequence, data, .. } => match topic {
                topic::MEASURES => self.measures(sequence, data)?,
                topic::PARTICLES if self.without_frames => {}
                topic::PARTICLES => self.frame(sequence, data)?,
                _ if topic.starts_with(topic::FIELDS) => self.field(topic, sequence, data)?,
                topic::PROFILES => self.log.profiles.push(profile(data)?),
                topic::STATE if !self.without_frames => self.species(data)?,
                topic::WALLS => {
                    self.log.walls = walls_of(&SceneUpdate::decode(data).map_err(Fault::damage)?);
                }
                _ => {}
            },
            _ => {}
        }
        Ok(())
    }

    fn measures(&mut self, sequence: u32, data: &[u8]) -> Result<(), Fault> {
        let message = MeasuresMessage::decode(data, &self.numbers).map_err(Fault::damage)?;
        self.log.series.push(message.values);
        self.log.state_hashes.push(message.state_hash);
        self.recordings.push((sequence, message.grains));
        Ok(())
    }

    /// A frame belongs to the recording of the same place in the sequence; one whose recording
    /// was lost to damage is passed over.
    fn frame(&mut self, sequence: u32, data: &[u8]) -> Result<(), Fault> {
        let Ok(recording) = self.recordings.binary_search_by_key(&sequence, |&(place, _)| place) else {
            return Ok(());
        };
        let cloud = PointCloud::decode(data).map_err(Fault::damage)?;
        let mut frame =
            frame_of(&cloud).ok_or_else(|| Fault::damage("a frame lacks a field or part of a point"))?;
        frame.time = self.log.series[recording][0];
        frame.grains = self.recordings[recording].1;
        self.log.frames.push(frame);
        Ok(())
    }

    /// Who is of which kind, as the states say it.
    fn species(&mut self, data: &[u8]) -> Result<(), Fault> {
        let part = Kinds::decode(data).map_err(Fault::damage)?;
        add_species(&mut self.log.species, &part.ids, &part.species);
        Ok(())
    }

    /// A field belongs to its recording as a frame does.
    fn field(&mut self, topic: &str, sequence: u32, data: &[u8]) -> Result<(), Fault> {
        let Ok(recording) = self.recordings.binary_search_by_key(&sequence, |&(place, _)| place) else {
            return Ok(());
        };
        let found = self.grids.iter().find(|(known, ..)| known == topic);
        let mut field = found
            .and_then(|(_, of_space, units)| grids::decode(data, *of_space, units))
            .ok_or_else(|| Fault::damage("a field lacks a unit or part of a cell"))?;
        field.name = topic[topic::FIELDS.len()..].to_owned();
        field.time = self.log.series[recording][0];
        self.log.fields.push(field);
        Ok(())
    }
}

pub(super) fn profile(data: &[u8]) -> Result<Profile, Fault> {
    let message = ProfileMessage::decode(data).map_err(Fault::damage)?;
    let mut profile =
        Profile { name: message.name, time: message.time, columns: Vec::new(), values: Vec::new() };
    for column in message.columns {
        let unit = dimension_of(&column.unit)
            .ok_or_else(|| Fault::Damage(format!("`{}` is no unit", column.unit)))?;
        profile.columns.push(Column { name: column.name, unit });
        profile.values.push(column.values);
    }
    Ok(profile)
}
