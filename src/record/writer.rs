//! Writes a log while a run goes on, so that an interrupted run loses little.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, WriteOptions};
use prost::Message;

use super::contents::{EarlierPart, Frame, Walls};
use super::error::LogError;
use super::frame::point_cloud;
use super::saved;
use super::schema::descriptor::descriptor_set;
use super::schema::measures::{self, MeasuresMessage};
use super::schema::units::unit_text;
use super::schema::{self, Described, foxglove, grainflow, topic};
use super::state::SavedState;
use super::time_scale::tick;
use super::walls::scene;
use crate::observe::measure::{Column, Profile};
use crate::space::Vector;

/// Everything that is known before the first step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogHeader {
    /// Version, numerics, seed, engine, units and the like.
    pub metadata: BTreeMap<String, String>,
    /// The scenario as TOML text.
    pub scenario: String,
    /// What ran by other scenarios before, in the order of time.
    pub earlier: Vec<EarlierPart>,
    /// Columns of the series; the first is `time`.
    pub columns: Vec<Column>,
    /// The box and its walls.
    pub walls: Option<Walls>,
    /// When the log begins [time].
    pub start: f64,
    /// Ticks per unit of time, from [`super::time_scale::time_scale`].
    pub time_scale: u64,
}

/// What is recorded at one time.
#[derive(Clone, Copy, Debug)]
pub struct Recording<'a> {
    /// `[column]`; the first is the time [time].
    pub values: &'a [f64],
    /// The state hash in hexadecimal digits.
    pub state_hash: &'a str,
    /// Profiles of this moment.
    pub profiles: &'a [Profile],
    /// The picture of this moment.
    pub frame: &'a Frame,
}

/// A log that is being written. Without [`LogWriter::finish`] it has no end.
pub struct LogWriter {
    path: PathBuf,
    writer: mcap::Writer<BufWriter<File>>,
    time_scale: u64,
    columns: usize,
    measures: Channel,
    particles: Channel,
    profiles: Channel,
    states: Channel,
}

/// A channel and where it stands.
#[derive(Debug)]
struct Channel {
    id: u16,
    sequence: u32,
    last_tick: u64,
}

impl std::fmt::Debug for LogWriter {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("LogWriter").field("path", &self.path).finish_non_exhaustive()
    }
}

impl LogWriter {
    /// Begins the log at `path`, in place of what may stand there.
    pub fn create(path: &Path, header: &LogHeader) -> Result<Self, LogError> {
        if let Some(fault) = measures::fault_of(&header.columns) {
            return Err(LogError::Columns { path: path.to_owned(), fault });
        }
        let file = File::create(path).map_err(|source| LogError::Create { path: path.to_owned(), source })?;
        Self::begin(path, BufWriter::new(file), header).map_err(|source| LogError::write(path, source))
    }

    fn begin(path: &Path, file: BufWriter<File>, header: &LogHeader) -> mcap::McapResult<Self> {
        let mut writer = options().create(file)?;
        writer.write_metadata(&Metadata { name: schema::METADATA.to_owned(), metadata: metadata(header) })?;
        for part in &header.earlier {
            writer.write_metadata(&resumption(part))?;
        }
        let start = tick(header.start, header.time_scale);
        writer.attach(&scenario(start, schema::SCENARIO.to_owned(), &header.scenario))?;
        for (k, part) in header.earlier.iter().enumerate() {
            let name = format!("{}{}.toml", schema::EARLIER_SCENARIO, k + 1);
            writer.attach(&scenario(start, name, &part.scenario))?;
        }
        let mut log = LogWriter {
            path: path.to_owned(),
            time_scale: header.time_scale,
            columns: header.columns.len(),
            measures: measures_channel(&mut writer, &header.columns)?,
            particles: channel::<foxglove::PointCloud>(&mut writer, topic::PARTICLES)?,
            profiles: channel::<grainflow::Profile>(&mut writer, topic::PROFILES)?,
            states: channel::<grainflow::State>(&mut writer, topic::STATE)?,
            writer,
        };
        if let Some(walls) = &header.walls {
            let mut channel = channel::<foxglove::SceneUpdate>(&mut log.writer, topic::WALLS)?;
            channel.write(&mut log.writer, start, &scene(walls, start).encode_to_vec())?;
        }
        log.writer.flush()?;
        Ok(log)
    }

    /// Where the log is written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes one recording and flushes it.
    pub fn recording(&mut self, recording: &Recording<'_>) -> Result<(), LogError> {
        assert_eq!(recording.values.len(), self.columns, "a value for every column");
        self.checked(|log| {
            let message = MeasuresMessage {
                values: recording.values.to_vec(),
                state_hash: recording.state_hash.to_owned(),
                grains: recording.frame.grains,
            };
            let tick = tick(recording.values[0], log.time_scale);
            log.measures.write(&mut log.writer, tick, &message.encode())?;
            for profile in recording.profiles {
                log.write_profile(profile)?;
            }
            // After the measures: a frame that is there has its time there, too.
            let cloud = point_cloud(recording.frame, tick);
            log.particles.write(&mut log.writer, tick, &cloud.encode_to_vec())?;
            log.writer.flush()
        })
    }

    /// Writes a profile of the whole run.
    pub fn profile(&mut self, profile: &Profile) -> Result<(), LogError> {
        self.checked(|log| log.write_profile(profile))
    }

    /// Writes a saved state and flushes it.
    pub fn state<V: Vector>(&mut self, state: &SavedState<'_, V>) -> Result<(), LogError> {
        self.checked(|log| {
            let tick = tick(state.time, log.time_scale);
            for rows in saved::parts(state) {
                log.states.write(&mut log.writer, tick, &saved::part(state, rows).encode_to_vec())?;
            }
            log.writer.flush()
        })
    }

    /// Writes a message of an older log as it stands there, at its `tick`.
    pub(crate) fn copy(
        &mut self,
        topic: &str,
        sequence: u32,
        tick: u64,
        data: &[u8],
    ) -> Result<(), LogError> {
        let channel = match topic {
            topic::MEASURES => &mut self.measures,
            topic::PARTICLES => &mut self.particles,
            topic::PROFILES => &mut self.profiles,
            topic::STATE => &mut self.states,
            _ => return Err(LogError::UnknownTopic { path: self.path.clone(), topic: topic.to_owned() }),
        };
        channel.sequence = sequence;
        channel.write(&mut self.writer, tick, data).map_err(|source| LogError::write(&self.path, source))
    }

    /// Hands everything written so far to the system.
    pub fn flush(&mut self) -> Result<(), LogError> {
        self.checked(|log| log.writer.flush())
    }

    /// Ends the log: statistics and index, and everything on the disk.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.checked(|log| log.writer.finish().map(drop))?;
        let LogWriter { path, writer, .. } = self;
        let mut file = writer.into_inner();
        file.flush().and_then(|()| file.get_ref().sync_all()).map_err(|source| LogError::write(&path, source))
    }

    fn checked(&mut self, write: impl FnOnce(&mut Self) -> mcap::McapResult<()>) -> Result<(), LogError> {
        write(self).map_err(|source| LogError::write(&self.path, source))
    }

    fn write_profile(&mut self, profile: &Profile) -> mcap::McapResult<()> {
        let column = |(column, values): (&Column, &Vec<f64>)| grainflow::ProfileColumn {
            name: column.name.clone(),
            unit: unit_text(column.unit),
            values: values.clone(),
        };
        let message = grainflow::Profile {
            time: profile.time,
            name: profile.name.clone(),
            columns: profile.columns.iter().zip(&profile.values).map(column).collect(),
        };
        let tick = tick(profile.time, self.time_scale);
        self.profiles.write(&mut self.writer, tick, &message.encode_to_vec())
    }
}

impl Channel {
    /// Writes a message; its tick is never before that of an earlier one.
    fn write(
        &mut self,
        writer: &mut mcap::Writer<BufWriter<File>>,
        tick: u64,
        data: &[u8],
    ) -> mcap::McapResult<()> {
        let tick = tick.max(self.last_tick);
        let header = MessageHeader {
            channel_id: self.id,
            sequence: self.sequence,
            log_time: tick,
            publish_time: tick,
        };
        writer.write_to_known_channel(&header, data)?;
        self.sequence += 1;
        self.last_tick = tick;
        Ok(())
    }
}

/// The same bytes on every machine: one compression thread, no seeking back; a chunk that is not
/// complete never reaches the file.
pub(crate) fn options() -> WriteOptions {
    WriteOptions::new()
        .compression(Some(Compression::Zstd))
        .compression_level(1)
        .compression_threads(1)
        .library(concat!("grainflow ", env!("CARGO_PKG_VERSION")))
        .disable_seeking(true)
}

fn metadata(header: &LogHeader) -> BTreeMap<String, String> {
    let mut metadata = header.metadata.clone();
    metadata.insert(schema::FORMAT_KEY.to_owned(), schema::FORMAT.to_string());
    metadata.insert(schema::TIME_SCALE_KEY.to_owned(), header.time_scale.to_string());
    metadata.insert(schema::DIGEST_KEY.to_owned(), schema::digest(&header.scenario));
    metadata
}

/// What says where an earlier part ended, and what was changed then.
fn resumption(part: &EarlierPart) -> Metadata {
    let entries = [
        ("time", format!("{:?}", part.time)),
        ("steps", part.steps.to_string()),
        ("events", part.events.to_string()),
        ("changes", part.changes.clone()),
    ];
    let metadata = entries.map(|(key, value)| (key.to_owned(), value)).into();
    Metadata { name: schema::RESUMPTION.to_owned(), metadata }
}

fn scenario(time: u64, name: String, text: &str) -> mcap::Attachment<'_> {
    let media_type = "application/toml".to_owned();
    mcap::Attachment { log_time: time, create_time: time, name, media_type, data: text.as_bytes().into() }
}

fn channel<M: Described>(
    writer: &mut mcap::Writer<BufWriter<File>>,
    topic: &str,
) -> mcap::McapResult<Channel> {
    let schema = writer.add_schema(&M::TABLE.full_name(), "protobuf", &descriptor_set(&M::TABLE))?;
    let id = writer.add_channel(schema, topic, "protobuf", &BTreeMap::new())?;
    Ok(Channel { id, sequence: 0, last_tick: 0 })
}

fn measures_channel(
    writer: &mut mcap::Writer<BufWriter<File>>,
    columns: &[Column],
) -> mcap::McapResult<Channel> {
    let schema = writer.add_schema(measures::NAME, "protobuf", &measures::descriptor_set(columns))?;
    let id = writer.add_channel(schema, topic::MEASURES, "protobuf", &measures::units(columns))?;
    Ok(Channel { id, sequence: 0, last_tick: 0 })
}
