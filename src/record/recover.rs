//! Makes a clean log of what is sound in a damaged one.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::Path;

use mcap::McapError;
use mcap::records::{Channel, MessageHeader, Record, SchemaHeader, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::error::LogError;
use super::scan::{BLOCK, NO_SCHEMA, UNREAD_COMPRESSION, holds_attachment, length_limit, open, scan};
use super::schema;
use super::schema::measures::{MeasuresMessage, TIME};
use super::writer::options;

/// What a recovery found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recovery {
    /// Messages that stand in the new log.
    pub messages: u64,
    /// Chunks, and records outside of chunks, that were left out because their bytes are wrong.
    pub damaged_parts: u64,
    /// Whether the file ends too early, or cannot be followed beyond some place.
    pub cut_off: bool,
    /// Messages that are known to be missing, by topic.
    pub lost: BTreeMap<String, u64>,
    /// The last recording before the first hole [time]; nothing where there is no hole.
    pub whole_until: Option<f64>,
    /// The last recording [time]; nothing where there is none.
    pub end: Option<f64>,
}

/// Writes everything that is sound in the log `damaged` to the new log `clean`, whose metadata say
/// so under `recovered`; nothing, and `None`, where the log is whole. Chunks and attachments have checksums of their own;
/// the metadata and the descriptions have none, and are taken as they stand where they can be read at all.
pub fn recover(damaged: &Path, clean: &Path) -> Result<Option<Recovery>, LogError> {
    match scan(damaged, &mut |_| Ok(())) {
        Ok(None) => return Ok(None),
        // Nothing is wrong with it: it is not readable here.
        Err(error @ LogError::Compression { .. }) => return Err(error),
        Ok(Some(_)) | Err(_) => {}
    }
    if clean.exists() {
        return Err(LogError::Exists { path: clean.to_owned() });
    }
    // Descriptions stand at the start and again at the end: taken from wherever they are sound.
    let mut known = Known::default();
    let (damaged_parts, cut_off) = each_sound_record(damaged, &mut |record| {
        known.add(record);
        Ok(())
    })?;
    known.mark(damaged, damaged_parts)?;
    let mut recovery = Recovery { damaged_parts, cut_off, ..Recovery::default() };
    let written = write(damaged, clean, &mut known, &mut recovery);
    if written.is_err() {
        // Half a log would only mislead; if the system will not have it, it stays behind.
        let _ = std::fs::remove_file(clean);
    }
    written.map(|()| Some(recovery))
}

fn write(damaged: &Path, clean: &Path, known: &mut Known, recovery: &mut Recovery) -> Result<(), LogError> {
    let file =
        File::create_new(clean).map_err(|source| LogError::Create { path: clean.to_owned(), source })?;
    let failed = |source: mcap::McapError| LogError::write(clean, source);
    let mut writer = options().create(BufWriter::new(file)).map_err(failed)?;
    known.describe(&mut writer).map_err(failed)?;
    let mut count = Count::default();
    each_sound_record(damaged, &mut |record| match record {
        Record::Message { header, data } => {
            let Some(topic) = known.topic(&header) else { return Ok(()) };
            recovery.messages += 1;
            count.note(topic, &header, &data, recovery);
            writer.write_to_known_channel(&header, &data).map_err(failed)
        }
        _ => Ok(()),
    })?;
    count.conclude(known, recovery);
    writer.finish().map_err(failed)?;
    let mut file = writer.into_inner();
    file.flush().and_then(|()| file.get_ref().sync_all()).map_err(|source| failed(source.into()))
}

/// Counts messages and holes.
#[derive(Default)]
struct Count {
    /// By channel: messages that are there, and the place in the sequence that comes next.
    seen: BTreeMap<u16, (u64, u32)>,
}

impl Count {
    fn note(&mut self, topic: &str, header: &MessageHeader, data: &[u8], recovery: &mut Recovery) {
        let (count, next) = self.seen.entry(header.channel_id).or_default();
        if header.sequence > *next && schema::topic::COUNTED.contains(&topic) {
            *recovery.lost.entry(topic.to_owned()).or_default() += u64::from(header.sequence - *next);
            recovery.whole_until = recovery.whole_until.or(Some(recovery.end.unwrap_or(0.0)));
        }
        *count += 1;
        *next = header.sequence.saturating_add(1);
        if topic == schema::topic::MEASURES {
            // A message whose checksum holds but that has no time is not of a run.
            let time = MeasuresMessage::decode(data, &[TIME]).map(|message| message.values[0]);
            recovery.end = time.ok().or(recovery.end);
        }
    }

    /// Where the index is sound, it knows how many there were.
    fn conclude(&self, known: &Known, recovery: &mut Recovery) {
        for channel in &known.channels {
            let seen = self.seen.get(&channel.id).map_or(0, |(count, _)| *count);
            let all = known.counts.get(&channel.id).copied().unwrap_or(0);
            if all > seen {
                recovery.lost.insert(channel.topic.clone(), all - seen);
            }
        }
    }
}

/// What is known of a log beside its messages.
#[derive(Default)]
struct Known {
    metadata: Vec<mcap::records::Metadata>,
    attachments: Vec<mcap::Attachment<'static>>,
    schemas: Vec<(SchemaHeader, Vec<u8>)>,
    channels: Vec<Channel>,
    /// Messages by number of the channel, where the index says so.
    counts: BTreeMap<u16, u64>,
}

impl Known {
    fn add(&mut self, record: Record<'_>) {
        match record {
            Record::Metadata(metadata) => self.metadata.push(metadata),
            Record::Statistics(statistics) => self.counts = statistics.channel_message_counts,
            Record::Attachment { header, data, .. } => {
                self.attachments.push(mcap::Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data: data.into_owned().into(),
                });
            }
            Record::Schema { header, data } if !self.schemas.iter().any(|one| one.0.id == header.id) => {
                self.schemas.push((header, data.into_owned()));
            }
            Record::Channel(channel) if !self.channels.iter().any(|one| one.id == channel.id) => {
                self.channels.push(channel);
            }
            _ => {}
        }
    }

    /// Says in the metadata that the log was recovered; an error where there are none.
    fn mark(&mut self, damaged: &Path, damaged_parts: u64) -> Result<(), LogError> {
        let own = self.metadata.iter_mut().find(|one| one.name == schema::METADATA);
        let own = own.ok_or_else(|| LogError::NoHeader { path: damaged.to_owned() })?;
        let text = format!("{damaged_parts} damaged parts left out");
        own.metadata.insert(schema::RECOVERED_KEY.to_owned(), text);
        Ok(())
    }

    /// The topic of a message whose channel is known.
    fn topic(&self, header: &MessageHeader) -> Option<&str> {
        let channel = self.channels.iter().find(|channel| channel.id == header.channel_id)?;
        Some(&channel.topic)
    }

    fn describe(&mut self, writer: &mut mcap::Writer<BufWriter<File>>) -> mcap::McapResult<()> {
        for metadata in &self.metadata {
            writer.write_metadata(metadata)?;
        }
        for attachment in &self.attachments {
            writer.attach(attachment)?;
        }
        for (header, data) in &self.schemas {
            writer.add_schema_with_id(header.id, &header.name, &header.encoding, data)?;
        }
        self.channels.retain(|channel| {
            channel.schema_id == NO_SCHEMA || self.schemas.iter().any(|one| one.0.id == channel.schema_id)
        });
        for one in &self.channels {
            writer.add_channel_with_id(
                one.id,
                one.schema_id,
                &one.topic,
                &one.message_encoding,
                &one.metadata,
            )?;
        }
        Ok(())
    }
}

/// Gives every record whose bytes are sound to `visit`, those of chunks included. Returns how many parts are damaged, and
/// whether the file ends too early.
fn each_sound_record(
    path: &Path,
    visit: &mut dyn FnMut(Record<'_>) -> Result<(), LogError>,
) -> Result<(u64, bool), LogError> {
    let unreadable = |source| LogError::Read { path: path.to_owned(), source };
    let (mut file, length) = open(path)?;
    let limit = length_limit(length);
    let whole = LinearReaderOptions::default().with_emit_chunks(true).with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(whole);
    let (mut damaged_parts, mut cut_off) = (0, false);
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = file.read(reader.insert(wanted.clamp(1, BLOCK))).map_err(unreadable)?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { opcode: op::CHUNK, data }) => match chunk_records(data, limit) {
                Ok(records) => records.into_iter().try_for_each(&mut *visit)?,
                Err(McapError::UnsupportedCompression(compression)) if compression == UNREAD_COMPRESSION => {
                    return Err(LogError::Compression { path: path.to_owned(), compression });
                }
                Err(_) => damaged_parts += 1,
            },
            Ok(LinearReadEvent::Record { opcode, data }) => match sound(opcode, data) {
                Some(record) => visit(record)?,
                None => damaged_parts += 1,
            },
            Err(_) => {
                cut_off = true;
                break;
            }
        }
    }
    Ok((damaged_parts, cut_off))
}

fn sound(opcode: u8, data: &[u8]) -> Option<Record<'_>> {
    if opcode == op::ATTACHMENT && !holds_attachment(data) {
        return None;
    }
    mcap::parse_record(opcode, data).ok()
}

/// The records of a chunk whose checksum holds; else why there are none.
pub(crate) fn chunk_records(chunk: &[u8], limit: usize) -> Result<Vec<Record<'static>>, McapError> {
    let alone = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(alone);
    let mut input: Vec<u8> = vec![op::CHUNK];
    input.extend_from_slice(&(chunk.len() as u64).to_le_bytes());
    input.extend_from_slice(chunk);
    let mut rest = input.as_slice();
    let mut records = Vec::new();
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = rest.read(reader.insert(wanted.clamp(1, BLOCK)))?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { opcode, data } => {
                records.push(mcap::parse_record(opcode, data)?.into_owned());
            }
        }
    }
    Ok(records)
}
