//! What a log holds, counted: everything about it but its contents.

use std::collections::BTreeMap;
use std::path::Path;

use prost::Message;

use super::contents::Walls;
use super::error::LogError;
use super::reader::add_species;
use super::scan::{Event, Fault, scan};
use super::schema::foxglove::{PointCloud, SceneUpdate};
use super::schema::grainflow::{Profile, State};
use super::schema::measures::{MeasuresMessage, TIME, columns_of};
use super::schema::topic;
use super::walls::walls_of;
use crate::observe::measure::Column;

/// What a log holds. Making one reads the whole file and checks every checksum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overview {
    /// Length of the file [bytes].
    pub bytes: u64,
    /// Version, numerics, seed, engine, units and the like.
    pub metadata: BTreeMap<String, String>,
    /// The scenario as TOML text.
    pub scenario: String,
    /// Columns of the series.
    pub columns: Vec<Column>,
    /// The box and its walls.
    pub walls: Option<Walls>,
    /// Messages of every topic and their bytes before compression.
    pub channels: BTreeMap<String, Channel>,
    /// Times of the recordings [time].
    pub times: Vec<f64>,
    /// Frames.
    pub frames: u64,
    /// Frames that show fewer points than there are grains.
    pub thinned: u64,
    /// The most points of a frame.
    pub most_points: u64,
    /// The most grains of a recording.
    pub most_grains: u64,
    /// Profiles by name.
    pub profiles: BTreeMap<String, u64>,
    /// Time [time] and grains of every saved state.
    pub states: Vec<(f64, u64)>,
    /// The species of every grain `[id]` that a state holds, 0 where none does; empty where all grains are alike.
    pub species: Vec<u8>,
    /// Where the run was resumed with changes: time, steps, events and what was changed.
    pub resumptions: Vec<BTreeMap<String, String>>,
    /// Messages that a recovery could not save.
    pub lost: u64,
    /// What is missing, as a sentence, where the file was cut off.
    pub cut_off: Option<String>,
}

/// The messages of a topic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Channel {
    /// How many.
    pub messages: u64,
    /// Their length before compression [bytes].
    pub bytes: u64,
}

/// Goes through the log at `path` and counts what it holds.
pub fn overview(path: &Path) -> Result<Overview, LogError> {
    let mut found = Overview::default();
    let mut grains = 0;
    found.cut_off = scan(path, &mut |event| {
        match event {
            Event::Metadata(metadata) => found.metadata = metadata,
            Event::Scenario(scenario) => found.scenario = scenario,
            Event::Resumption(resumption) => found.resumptions.push(resumption),
            Event::Hole { missing, .. } => found.lost += u64::from(missing.end - missing.start),
            Event::EarlierScenario(_) => {}
            Event::Channel { topic, description, metadata } => {
                found.channels.entry(topic.to_owned()).or_default();
                if topic == topic::MEASURES {
                    let columns = columns_of(description, metadata)
                        .ok_or_else(|| Fault::damage("the columns of the series have no proper units"))?;
                    found.columns = columns.into_iter().map(|(_, column)| column).collect();
                }
            }
            Event::Message { topic, data, .. } => {
                let channel = found.channels.entry(topic.to_owned()).or_default();
                channel.messages += 1;
                channel.bytes += data.len() as u64;
                found.message(topic, data, &mut grains).map_err(Fault::damage)?;
            }
        }
        Ok(())
    })?;
    let unreadable = |source| LogError::Read { path: path.to_owned(), source };
    found.bytes = std::fs::metadata(path).map_err(unreadable)?.len();
    Ok(found)
}

impl Overview {
    /// Takes account of one message; `grains` are those of the last recording.
    fn message(&mut self, topic: &str, data: &[u8], grains: &mut u64) -> Result<(), prost::DecodeError> {
        match topic {
            topic::MEASURES => {
                let message = MeasuresMessage::decode(data, &[TIME])?;
                self.times.push(message.values[0]);
                *grains = message.grains;
                self.most_grains = self.most_grains.max(message.grains);
            }
            topic::PARTICLES => {
                let cloud = PointCloud::decode(data)?;
                let points = cloud.data.len() as u64 / u64::from(cloud.point_stride.max(1));
                self.frames += 1;
                self.thinned += u64::from(points < *grains);
                self.most_points = self.most_points.max(points);
            }
            topic::PROFILES => *self.profiles.entry(Profile::decode(data)?.name).or_default() += 1,
            topic::WALLS => self.walls = walls_of(&SceneUpdate::decode(data)?),
            topic::STATE => self.state(&State::decode(data)?),
            _ => {}
        }
        Ok(())
    }

    /// A state counts with its last part.
    fn state(&mut self, part: &State) {
        if part.first_row == 0 {
            self.states.push((part.time.unwrap_or(f64::NAN), part.grains));
        }
        if let Some(species) = &part.species {
            add_species(&mut self.species, &part.ids, species);
        }
    }
}
