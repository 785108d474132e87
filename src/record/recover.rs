//! Makes a clean log of what is sound in a damaged one.

use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::Path;

use mcap::records::{Channel, MessageHeader, Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::error::LogError;
use super::scan::{BLOCK, holds_attachment, length_limit, open};
use super::schema;
use super::writer::options;

/// What a recovery found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recovery {
    /// Messages that stand in the new log.
    pub messages: u64,
    /// Chunks, and records outside of chunks, that were left out because their bytes are wrong.
    pub damaged_chunks: u64,
    /// Whether the file ends too early, or cannot be followed beyond some place.
    pub cut_off: bool,
}

/// Writes everything that is sound in the log `damaged` to the new log `clean`, whose metadata say
/// so under `recovered`. Chunks and the scenario have checksums of their own; the metadata and the
/// descriptions have none, and are taken as they stand where they can be read at all.
pub fn recover(damaged: &Path, clean: &Path) -> Result<Recovery, LogError> {
    // Descriptions stand at the start and again at the end: taken from wherever they are sound.
    let mut known = Known::default();
    let mut recovery = each_sound_record(damaged, &mut |record| {
        known.add(record);
        Ok(())
    })?;
    let Some(mut metadata) = known.metadata.take() else {
        return Err(LogError::NoHeader { path: damaged.to_owned() });
    };
    let lost = recovery.damaged_chunks;
    metadata.metadata.insert("recovered".to_owned(), format!("{lost} damaged parts left out"));
    let file = File::create(clean).map_err(|source| LogError::Create { path: clean.to_owned(), source })?;
    let failed = |source: mcap::McapError| LogError::write(clean, source);
    let mut writer = options().create(BufWriter::new(file)).map_err(failed)?;
    writer.write_metadata(&metadata).map_err(failed)?;
    known.describe(&mut writer).map_err(failed)?;
    each_sound_record(damaged, &mut |record| match record {
        Record::Message { header, data } if known.has_channel(&header) => {
            recovery.messages += 1;
            writer.write_to_known_channel(&header, &data).map_err(failed)
        }
        _ => Ok(()),
    })?;
    writer.finish().map_err(failed)?;
    let mut file = writer.into_inner();
    file.flush().and_then(|()| file.get_ref().sync_all()).map_err(|source| failed(source.into()))?;
    Ok(recovery)
}

/// What is known of a log beside its messages.
#[derive(Default)]
struct Known {
    metadata: Option<mcap::records::Metadata>,
    scenario: Option<mcap::Attachment<'static>>,
    schemas: Vec<(u16, String, Vec<u8>)>,
    channels: Vec<Channel>,
}

impl Known {
    fn add(&mut self, record: Record<'_>) {
        match record {
            Record::Metadata(metadata) if metadata.name == schema::METADATA => self.metadata = Some(metadata),
            Record::Attachment { header, data, .. } => {
                self.scenario = Some(mcap::Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data: data.into_owned().into(),
                });
            }
            Record::Schema { header, data } if !self.schemas.iter().any(|one| one.0 == header.id) => {
                self.schemas.push((header.id, header.name, data.into_owned()));
            }
            Record::Channel(channel) if !self.channels.iter().any(|one| one.id == channel.id) => {
                self.channels.push(channel);
            }
            _ => {}
        }
    }

    fn has_channel(&self, header: &MessageHeader) -> bool {
        self.channels.iter().any(|channel| channel.id == header.channel_id)
    }

    fn describe(&mut self, writer: &mut mcap::Writer<BufWriter<File>>) -> mcap::McapResult<()> {
        if let Some(scenario) = &self.scenario {
            writer.attach(scenario)?;
        }
        for (id, name, data) in &self.schemas {
            writer.add_schema_with_id(*id, name, "protobuf", data)?;
        }
        self.channels.retain(|channel| self.schemas.iter().any(|one| one.0 == channel.schema_id));
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

/// Gives every record whose bytes are sound to `visit`, those of chunks included.
fn each_sound_record(
    path: &Path,
    visit: &mut dyn FnMut(Record<'_>) -> Result<(), LogError>,
) -> Result<Recovery, LogError> {
    let unreadable = |source| LogError::Read { path: path.to_owned(), source };
    let (mut file, length) = open(path)?;
    let limit = length_limit(length);
    let whole = LinearReaderOptions::default().with_emit_chunks(true).with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(whole);
    let mut recovery = Recovery::default();
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = file.read(reader.insert(wanted.clamp(1, BLOCK))).map_err(unreadable)?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { opcode: op::CHUNK, data }) => match chunk_records(data, limit) {
                Some(records) => records.into_iter().try_for_each(&mut *visit)?,
                None => recovery.damaged_chunks += 1,
            },
            Ok(LinearReadEvent::Record { opcode, data }) => match sound(opcode, data) {
                Some(record) => visit(record)?,
                None => recovery.damaged_chunks += 1,
            },
            Err(_) => {
                recovery.cut_off = true;
                break;
            }
        }
    }
    Ok(recovery)
}

fn sound(opcode: u8, data: &[u8]) -> Option<Record<'_>> {
    if opcode == op::ATTACHMENT && !holds_attachment(data) {
        return None;
    }
    mcap::parse_record(opcode, data).ok()
}

/// The records of a chunk whose checksum holds.
fn chunk_records(chunk: &[u8], limit: usize) -> Option<Vec<Record<'static>>> {
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
        match event.ok()? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = rest.read(reader.insert(wanted.clamp(1, BLOCK))).ok()?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { opcode, data } => {
                records.push(mcap::parse_record(opcode, data).ok()?.into_owned());
            }
        }
    }
    Some(records)
}
