//! Goes through the file of a log from start to end, checking every checksum on the way.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek};
use std::ops::Range;
use std::path::Path;

use mcap::records::{MessageHeader, Record};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};

use super::error::LogError;
use super::schema;

/// Bytes read at a time.
pub(crate) const BLOCK: usize = 1 << 18;
/// The compression of MCAP that is not read here.
pub(crate) const UNREAD_COMPRESSION: &str = "lz4";
/// The number that a channel without a schema gives for it.
pub(crate) const NO_SCHEMA: u16 = 0;
/// A record may always be this long; a longer one has to be plausible for the length of the file.
const USUAL_LIMIT: u64 = 1 << 28;

/// Something that stands in a log.
pub(crate) enum Event<'a> {
    /// What is known about the run.
    Metadata(BTreeMap<String, String>),
    /// The scenario as TOML text.
    Scenario(String),
    /// Where the run was resumed with changes.
    Resumption(BTreeMap<String, String>),
    /// The scenario up to there, as TOML text.
    EarlierScenario(String),
    /// A channel, its description and its own metadata.
    Channel { topic: &'a str, description: &'a [u8], metadata: &'a BTreeMap<String, String> },
    /// A message.
    Message { topic: &'a str, sequence: u32, log_time: u64, data: &'a [u8] },
    /// Messages of a recovered log that were lost, before the one that comes next.
    Hole { topic: &'a str, missing: Range<u32> },
}

/// Gives every event of the log at `path` to `visit`, which says what is wrong with it, if anything. A
/// sentence about what is missing, where the file was cut off.
pub(crate) fn scan(
    path: &Path,
    visit: &mut dyn FnMut(Event<'_>) -> Result<(), Fault>,
) -> Result<Option<String>, LogError> {
    let unreadable = |source| LogError::Read { path: path.to_owned(), source };
    let (mut file, length) = open(path)?;
    let mut reader = LinearReader::new_with_options(options(length));
    let mut state = Progress::default();
    let mut position = 0;
    while let Some(event) = reader.next_event() {
        let done = match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let block = reader.insert(wanted.clamp(1, BLOCK));
                let read = file.read(block).map_err(unreadable)?;
                reader.notify_read(read);
                position += read as u64;
                Ok(())
            }
            Ok(LinearReadEvent::Record { opcode, data }) => state.record(opcode, data, visit),
            Err(error) => Err(Fault::from(error)),
        };
        match done {
            Ok(()) => {}
            Err(Fault::End) => return state.verdict(path, length, false),
            Err(Fault::Enough) => return Ok(None),
            Err(fault) => return Err(fault.at(path, position)),
        }
    }
    state.verdict(path, length, true)
}

/// Why a scan stops.
#[derive(Debug)]
pub(crate) enum Fault {
    /// The file ends too early.
    End,
    /// Nothing: the visitor has seen what it wanted.
    Enough,
    /// There is no header.
    NoHeader,
    /// The format is newer: its number and the version that wrote it.
    Newer(String, String),
    /// States of another dimension: what they have, what was wanted.
    Dimension(u32, usize),
    /// Messages are missing: their topic and their places in the sequence.
    Missing(String, Range<u32>),
    /// Chunks have a compression that is not read here: its name.
    Compression(String),
    /// Another log cannot be written.
    Other(LogError),
    /// Anything else.
    Damage(String),
}

impl Fault {
    pub(crate) fn damage(reason: impl ToString) -> Self {
        Fault::Damage(reason.to_string())
    }

    pub(crate) fn at(self, path: &Path, position: u64) -> LogError {
        let path = path.to_owned();
        match self {
            Fault::End | Fault::Enough | Fault::NoHeader => LogError::NoHeader { path },
            Fault::Newer(found, writer) => LogError::Newer { path, found, writer },
            Fault::Dimension(found, wanted) => LogError::Dimension { path, found, wanted },
            Fault::Missing(topic, missing) => {
                LogError::Missing { path, topic, first: missing.start, last: missing.end - 1 }
            }
            Fault::Compression(compression) => LogError::Compression { path, compression },
            Fault::Other(error) => error,
            Fault::Damage(reason) => LogError::Damaged { path, position, reason },
        }
    }
}

impl From<McapError> for Fault {
    fn from(error: McapError) -> Self {
        match error {
            McapError::UnexpectedEof => Fault::End,
            // Any other name is a wrong byte in the one that was written.
            McapError::UnsupportedCompression(name) if name == UNREAD_COMPRESSION => Fault::Compression(name),
            other => Fault::damage(other),
        }
    }
}

/// The file of a log, at its start, and its length [bytes].
pub(crate) fn open(path: &Path) -> Result<(File, u64), LogError> {
    let unreadable = |source| LogError::Read { path: path.to_owned(), source };
    let facts = std::fs::metadata(path).map_err(unreadable)?;
    // To open a pipe would wait for somebody who writes to it.
    if !facts.is_file() {
        return Err(LogError::NotAFile { path: path.to_owned() });
    }
    if facts.len() == 0 {
        return Err(LogError::Empty { path: path.to_owned() });
    }
    let mut file = File::open(path).map_err(unreadable)?;
    let mut start = Vec::new();
    file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut start).map_err(unreadable)?;
    if start != MAGIC {
        return Err(LogError::NotMcap { path: path.to_owned() });
    }
    file.rewind().map_err(unreadable)?;
    Ok((file, facts.len()))
}

/// How long a record may be in a file of `file_length` bytes.
pub(crate) fn length_limit(file_length: u64) -> usize {
    usize::try_from(file_length.saturating_mul(8).max(USUAL_LIMIT)).unwrap_or(usize::MAX)
}

/// Every checksum is checked, and those of a chunk before anything in it is believed.
fn options(file_length: u64) -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(length_limit(file_length))
}

/// What has been seen so far.
#[derive(Default)]
struct Progress {
    /// Whether the header of a log was there.
    header: bool,
    /// Whether the recorded part ended as it should.
    data_ended: bool,
    /// Descriptions by number.
    schemas: BTreeMap<u16, Vec<u8>>,
    /// Topics by number of the channel.
    topics: BTreeMap<u16, String>,
    /// The place in the sequence that comes next, by number of the channel.
    places: BTreeMap<u16, u32>,
    /// Whether it is a recovered log, in which messages may be missing.
    recovered: bool,
}

impl Progress {
    fn record(
        &mut self,
        opcode: u8,
        data: &[u8],
        visit: &mut dyn FnMut(Event<'_>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        if opcode == mcap::records::op::ATTACHMENT && !holds_attachment(data) {
            return Err(Fault::damage("an attachment is too short"));
        }
        match mcap::parse_record(opcode, data).map_err(Fault::damage)? {
            Record::Metadata(record) if record.name == schema::METADATA => {
                check_format(&record.metadata)?;
                self.header = true;
                self.recovered = record.metadata.contains_key(schema::RECOVERED_KEY);
                visit(Event::Metadata(record.metadata))
            }
            Record::Metadata(record) if record.name == schema::RESUMPTION => {
                visit(Event::Resumption(record.metadata))
            }
            Record::Attachment { header, data, .. } if header.name == schema::SCENARIO => {
                visit(Event::Scenario(text_of(&data)?))
            }
            Record::Attachment { header, data, .. } if header.name.starts_with(schema::EARLIER_SCENARIO) => {
                visit(Event::EarlierScenario(text_of(&data)?))
            }
            Record::Schema { header, data } => {
                self.schemas.insert(header.id, data.into_owned());
                Ok(())
            }
            Record::Channel(channel) if !self.data_ended => {
                // A channel of another program may do without; nothing here reads it.
                let description = match channel.schema_id {
                    NO_SCHEMA => Some(&[][..]),
                    id => self.schemas.get(&id).map(Vec::as_slice),
                };
                let description = description.ok_or_else(|| Fault::damage("a channel lacks its schema"))?;
                let (topic, metadata) = (channel.topic.as_str(), &channel.metadata);
                visit(Event::Channel { topic, description, metadata })?;
                self.topics.insert(channel.id, channel.topic);
                Ok(())
            }
            Record::Message { header, data } => self.message(&header, &data, visit),
            Record::DataEnd(_) => {
                self.data_ended = true;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn message(
        &mut self,
        header: &MessageHeader,
        data: &[u8],
        visit: &mut dyn FnMut(Event<'_>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        if !self.header {
            return Err(Fault::NoHeader);
        }
        let topic = self.topics.get(&header.channel_id);
        let topic = topic.ok_or_else(|| Fault::damage("a message lacks its channel"))?;
        let next = self.places.entry(header.channel_id).or_insert(0);
        let is_counted = schema::topic::COUNTED.contains(&topic.as_str());
        if let Some(missing) = missing(topic, *next, header.sequence)?.filter(|_| is_counted) {
            if !self.recovered {
                return Err(Fault::Missing(topic.clone(), missing));
            }
            visit(Event::Hole { topic, missing })?;
        }
        *next = header.sequence.saturating_add(1);
        visit(Event::Message { topic, sequence: header.sequence, log_time: header.log_time, data })
    }

    /// What to say of a log of `length` bytes that was read up to its proper end, or not.
    fn verdict(&self, path: &Path, length: u64, ended: bool) -> Result<Option<String>, LogError> {
        if !self.header {
            return Err(Fault::NoHeader.at(path, length));
        }
        match (self.data_ended, ended) {
            (true, true) => Ok(None),
            (false, true) => Err(Fault::damage("its recorded part has no end").at(path, length)),
            (true, false) => Ok(Some(format!(
                "the log {} is cut off after {length} bytes, in its index; all that was recorded is there",
                path.display()
            ))),
            (false, false) => Ok(Some(format!(
                "the log {} is cut off after {length} bytes; what was complete before is there",
                path.display()
            ))),
        }
    }
}

/// The places between the one that comes `next` and the one that came, if there are any.
fn missing(topic: &str, next: u32, came: u32) -> Result<Option<Range<u32>>, Fault> {
    if came < next {
        return Err(Fault::Damage(format!("message {came} of {topic} comes again, or too late")));
    }
    Ok((came > next).then_some(next..came))
}

fn text_of(data: &[u8]) -> Result<String, Fault> {
    String::from_utf8(data.to_vec()).map_err(Fault::damage)
}

pub(crate) fn check_format(metadata: &BTreeMap<String, String>) -> Result<(), Fault> {
    let text = metadata.get(schema::FORMAT_KEY).ok_or_else(|| Fault::damage("it names no format"))?;
    match text.parse::<u32>() {
        Ok(format) if format <= schema::FORMAT => Ok(()),
        _ => {
            let writer = metadata.get("version").map_or("of unknown version", String::as_str);
            Err(Fault::Newer(text.clone(), writer.to_owned()))
        }
    }
}

/// Whether `body` is long enough for the attachment that it says it is: times, two strings, data
/// and checksum.
pub(crate) fn holds_attachment(body: &[u8]) -> bool {
    let string_end = |start: usize| {
        let word = body.get(start..start.checked_add(4)?)?;
        let length = u32::from_le_bytes(word.try_into().ok()?);
        (start + 4).checked_add(length as usize)
    };
    let header_end = string_end(16).and_then(string_end);
    header_end.and_then(|end| end.checked_add(12)).is_some_and(|least| least <= body.len())
}
