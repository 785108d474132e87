//! Writes a log while a run goes on, so that an interrupted run loses little.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, WriteOptions};
use prost::Message;

use super::background::{Background, Encoded, FileWriter};
use super::contents::{EarlierPart, Frame, Walls};
use super::error::LogError;
use super::frame::point_cloud;
use super::grids;
use super::saved;
use super::schema::descriptor::descriptor_set;
use super::schema::measures::{self, MeasuresMessage};
use super::schema::units::unit_text;
use super::schema::{self, Described, foxglove, grainflow, topic};
use super::state::SavedState;
use super::time_scale::tick;
use super::walls::scene;
use crate::observe::field::{Field, Quantity};
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
    /// Fields that will be recorded, and the dimension of their space.
    pub fields: (Vec<Quantity>, usize),
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
    /// Grains in the gas.
    pub grains: u64,
    /// Profiles of this moment.
    pub profiles: &'a [Profile],
    /// The picture of this moment, if there is one.
    pub frame: Option<&'a Frame>,
    /// Fields of this moment, of those that the header names.
    pub fields: &'a [Field],
}

/// A log that is being written, by a thread of its own. Without [`LogWriter::finish`] it has no end.
///
/// What is given is encoded at once, and compressed and written while the run goes on. Where something cannot be
/// written, this or the next call says so, whichever it is.
#[derive(Debug)]
pub struct LogWriter {
    file: Background,
    time_scale: u64,
    columns: usize,
    measures: Channel,
    particles: Channel,
    profiles: Channel,
    states: Channel,
    /// By the name of the field.
    fields: Vec<(&'static str, Channel)>,
}

/// A channel and where it stands.
#[derive(Debug)]
struct Channel {
    id: u16,
    sequence: u32,
    last_tick: u64,
}

impl LogWriter {
    /// Begins the log at `path`, in place of what may stand there.
    pub fn create(path: &Path, header: &LogHeader) -> Result<Self, LogError> {
        if let Some(fault) = measures::fault_of(&header.columns) {
            return Err(LogError::Columns { path: path.to_owned(), fault });
        }
        let file = File::create(path).map_err(|source| LogError::Create { path: path.to_owned(), source })?;
        let failed = |source| LogError::write(path, source);
        let mut writer = options().create(BufWriter::new(file)).map_err(failed)?;
        let ([measures, particles, profiles, states], fields) = begin(&mut writer, header).map_err(failed)?;
        Ok(LogWriter {
            file: Background::start(path, writer)?,
            time_scale: header.time_scale,
            columns: header.columns.len(),
            measures,
            particles,
            profiles,
            states,
            fields,
        })
    }

    /// Where the log is written.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Gives one recording to be written and flushed.
    pub fn recording(&mut self, recording: &Recording<'_>) -> Result<(), LogError> {
        assert_eq!(recording.values.len(), self.columns, "a value for every column");
        let message = MeasuresMessage {
            values: recording.values.to_vec(),
            state_hash: recording.state_hash.to_owned(),
            grains: recording.grains,
        };
        let tick = tick(recording.values[0], self.time_scale);
        let sequence = self.measures.sequence;
        let mut messages = vec![self.measures.message(tick, message.encode())];
        messages.extend(recording.profiles.iter().map(|profile| self.profile_message(profile)));
        // After the measures: a frame that is there has its time there, too.
        let cloud = recording.frame.map(|frame| point_cloud(frame, tick).encode_to_vec());
        messages.extend(cloud.map(|cloud| self.particles.message_of(sequence, tick, cloud)));
        for field in recording.fields {
            let known = self.fields.iter_mut().find(|(name, _)| *name == field.name);
            let (_, channel) = known.expect("the header names every field that is recorded");
            messages.push(channel.message_of(sequence, tick, grids::encode(field, tick)));
        }
        self.file.write(messages, true)
    }

    /// Gives a profile of the whole run to be written.
    pub fn profile(&mut self, profile: &Profile) -> Result<(), LogError> {
        let message = self.profile_message(profile);
        self.file.write(vec![message], false)
    }

    /// Gives a saved state to be written and flushed.
    pub fn state<V: Vector>(&mut self, state: &SavedState<'_, V>) -> Result<(), LogError> {
        let tick = tick(state.time, self.time_scale);
        // Part by part: only a few of a large state wait in memory.
        let mut parts = saved::parts(state).peekable();
        while let Some(rows) = parts.next() {
            let part = self.states.message(tick, saved::part(state, rows).encode_to_vec());
            self.file.write(vec![part], parts.peek().is_none())?;
        }
        Ok(())
    }

    /// Gives a message of an older log to be written as it stands there, at its `tick`. A field that this log does not have
    /// is left out.
    pub(crate) fn copy(
        &mut self,
        topic: &str,
        sequence: u32,
        tick: u64,
        data: Vec<u8>,
    ) -> Result<(), LogError> {
        let channel = match topic {
            topic::MEASURES => &mut self.measures,
            topic::PARTICLES => &mut self.particles,
            topic::PROFILES => &mut self.profiles,
            topic::STATE => &mut self.states,
            _ => match topic.strip_prefix(topic::FIELDS) {
                Some(field) => match self.fields.iter_mut().find(|(name, _)| *name == field) {
                    Some((_, channel)) => channel,
                    None => return Ok(()),
                },
                None => {
                    let path = self.path().to_owned();
                    return Err(LogError::UnknownTopic { path, topic: topic.to_owned() });
                }
            },
        };
        let message = channel.message_of(sequence, tick, data);
        self.file.write(vec![message], false)
    }

    /// Waits until everything given so far is handed to the system.
    pub fn flush(&mut self) -> Result<(), LogError> {
        self.file.flush()
    }

    /// Whether everything that was tried so far could be written; waits for nothing.
    pub fn check(&mut self) -> Result<(), LogError> {
        self.file.check()
    }

    /// Ends the log: statistics and index, and everything on the disk.
    pub fn finish(self) -> Result<(), LogError> {
        self.file.finish()
    }

    fn profile_message(&mut self, profile: &Profile) -> Encoded {
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
        self.profiles.message(tick(profile.time, self.time_scale), message.encode_to_vec())
    }
}

impl Channel {
    /// The next message; its tick is never before that of an earlier one.
    fn message(&mut self, tick: u64, data: Vec<u8>) -> Encoded {
        self.last_tick = tick.max(self.last_tick);
        let header = MessageHeader {
            channel_id: self.id,
            sequence: self.sequence,
            log_time: self.last_tick,
            publish_time: self.last_tick,
        };
        self.sequence += 1;
        Encoded { header, data }
    }

    /// A message that belongs to the recording `sequence`, where that was not the last one's.
    fn message_of(&mut self, sequence: u32, tick: u64, data: Vec<u8>) -> Encoded {
        self.sequence = sequence;
        self.message(tick, data)
    }
}

/// The channels of measures, particles, profiles and states, and those of fields by name.
type Channels = ([Channel; 4], Vec<(&'static str, Channel)>);

/// Writes everything that is known before the first step, and flushes it.
fn begin(writer: &mut FileWriter, header: &LogHeader) -> mcap::McapResult<Channels> {
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
    let channels = [
        measures_channel(writer, &header.columns)?,
        channel::<foxglove::PointCloud>(writer, topic::PARTICLES)?,
        channel::<grainflow::Profile>(writer, topic::PROFILES)?,
        channel::<grainflow::State>(writer, topic::STATE)?,
    ];
    if let Some(walls) = &header.walls {
        let mut channel = channel::<foxglove::SceneUpdate>(writer, topic::WALLS)?;
        let Encoded { header, data } = channel.message(start, scene(walls, start).encode_to_vec());
        writer.write_to_known_channel(&header, &data)?;
    }
    let (quantities, dimension) = &header.fields;
    let mut fields = Vec::new();
    for &quantity in quantities {
        fields.push((quantity.name(), field_channel(writer, quantity, *dimension)?));
    }
    writer.flush()?;
    Ok((channels, fields))
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

fn channel<M: Described>(writer: &mut FileWriter, topic: &str) -> mcap::McapResult<Channel> {
    channel_with::<M>(writer, topic, &BTreeMap::new())
}

fn channel_with<M: Described>(
    writer: &mut FileWriter,
    topic: &str,
    metadata: &BTreeMap<String, String>,
) -> mcap::McapResult<Channel> {
    let schema = writer.add_schema(&M::TABLE.full_name(), "protobuf", &descriptor_set(&M::TABLE))?;
    let id = writer.add_channel(schema, topic, "protobuf", metadata)?;
    Ok(Channel { id, sequence: 0, last_tick: 0 })
}

fn field_channel(writer: &mut FileWriter, quantity: Quantity, dimension: usize) -> mcap::McapResult<Channel> {
    let topic = format!("{}{}", topic::FIELDS, quantity.name());
    let units = grids::units(&quantity.components(dimension));
    match dimension {
        3 => channel_with::<foxglove::VoxelGrid>(writer, &topic, &units),
        _ => channel_with::<foxglove::Grid>(writer, &topic, &units),
    }
}

fn measures_channel(writer: &mut FileWriter, columns: &[Column]) -> mcap::McapResult<Channel> {
    let schema = writer.add_schema(measures::NAME, "protobuf", &measures::descriptor_set(columns))?;
    let id = writer.add_channel(schema, topic::MEASURES, "protobuf", &measures::units(columns))?;
    Ok(Channel { id, sequence: 0, last_tick: 0 })
}
