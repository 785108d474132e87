//! Logs that another program has written again: with channels of its own, or in a compression that is not read here.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::sync::Arc;

use grainflow::record::error::LogError;
use grainflow::record::index::LogIndex;
use grainflow::record::reader::read_log;
use grainflow::record::recover::recover;
use mcap::records::Record;

use super::gas;
use super::logs::{Place, chunks, log_bytes, run_into, verified};

/// The log in `bytes` with a note, which has this `schema` or none, before every tenth message.
fn with_notes(bytes: &[u8], schema: Option<&Arc<mcap::Schema<'static>>>) -> Vec<u8> {
    let mut writer =
        mcap::WriteOptions::new().chunk_size(Some(4096)).create(Cursor::new(Vec::new())).unwrap();
    for record in mcap::read::LinearReader::new(bytes).unwrap() {
        match record.unwrap() {
            Record::Metadata(record) => writer.write_metadata(&record).unwrap(),
            Record::Attachment { header, data, .. } => {
                let (log_time, create_time) = (header.log_time, header.create_time);
                let (name, media_type) = (header.name, header.media_type);
                writer.attach(&mcap::Attachment { log_time, create_time, name, media_type, data }).unwrap();
            }
            _ => {}
        }
    }
    let notes = Arc::new(mcap::Channel {
        id: 77,
        topic: "/notes".to_owned(),
        schema: schema.cloned(),
        message_encoding: "json".to_owned(),
        metadata: BTreeMap::new(),
    });
    for (k, message) in mcap::MessageStream::new(bytes).unwrap().enumerate() {
        let message = message.unwrap();
        if k % 10 == 0 {
            let (log_time, publish_time) = (message.log_time, message.log_time);
            let (channel, sequence) = (Arc::clone(&notes), k as u32);
            let data = Cow::Borrowed(&b"{\"note\": 1}"[..]);
            writer.write(&mcap::Message { channel, sequence, log_time, publish_time, data }).unwrap();
        }
        writer.write(&message).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// The notes of a log, and what describes them.
fn notes(bytes: &[u8]) -> (usize, Option<String>) {
    let all = mcap::MessageStream::new(bytes).unwrap().map(Result::unwrap);
    let notes: Vec<_> = all.filter(|message| message.channel.topic == "/notes").collect();
    let encoding = notes[0].channel.schema.as_ref().map(|schema| schema.encoding.clone());
    (notes.len(), encoding)
}

/// The log in `bytes` whose chunks say that they are compressed by lz4.
fn relabelled(bytes: &[u8]) -> Vec<u8> {
    // Kind and length of the record, three times or lengths and a checksum, and then the name with its length.
    const NAME: usize = 9 + 8 + 8 + 8 + 4;
    let mut new = bytes[..8].to_vec();
    let mut end = 8;
    for chunk in chunks(bytes) {
        new.extend_from_slice(&bytes[end..chunk.start]);
        let record = &bytes[chunk.clone()];
        assert_eq!(&record[NAME..NAME + 8], b"\x04\0\0\0zstd");
        let length = record.len() as u64 - 9 - 1;
        new.push(record[0]);
        new.extend_from_slice(&length.to_le_bytes());
        new.extend_from_slice(&record[9..NAME]);
        new.extend_from_slice(b"\x03\0\0\0lz4");
        new.extend_from_slice(&record[NAME + 8..]);
        end = chunk.end;
    }
    new.extend_from_slice(&bytes[end..]);
    new
}

#[test]
fn channels_of_another_program_are_passed_over_and_survive_a_recovery() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("hsmc").with(&[]));
    let own = read_log(&whole.folder.join("log.mcap")).unwrap();
    let (log, clean) = (place.path("log.mcap"), place.path("clean.mcap"));
    let schema = mcap::Schema {
        id: 99,
        name: "note".to_owned(),
        encoding: "jsonschema".to_owned(),
        data: Cow::Borrowed(b"{}"),
    };
    for schema in [None, Some(Arc::new(schema))] {
        let mut bytes = with_notes(&log_bytes(&whole), schema.as_ref());
        let all = notes(&bytes);
        assert_eq!(all.1.as_deref(), schema.as_ref().map(|_| "jsonschema"));
        fs::write(&log, &bytes).unwrap();
        let read = read_log(&log).unwrap();
        assert_eq!((&read.state_hashes, &read.frames), (&own.state_hashes, &own.frames));
        assert!(read.cut_off.is_none());
        assert_eq!(verified(&log).0, verified(&whole.folder).0);
        assert_eq!(LogIndex::open(&log).unwrap().frames(), own.frames.len());
        assert_eq!(recover(&log, &clean).unwrap(), None);
        // One chunk less of what is ours; the notes elsewhere stay, and so does what describes them.
        let chunk = chunks(&bytes)[5].clone();
        bytes[chunk.end - 20] ^= 4;
        fs::write(&log, &bytes).unwrap();
        assert_eq!(recover(&log, &clean).unwrap().unwrap().damaged_parts, 1);
        let kept = notes(&fs::read(&clean).unwrap());
        assert!(kept.0 > 0 && kept.0 <= all.0 && kept.1 == all.1, "{kept:?} of {all:?}");
        fs::remove_file(&clean).unwrap();
    }
}

#[test]
fn chunks_of_lz4_are_named_and_nothing_in_them_is_called_lost() {
    let place = Place::new();
    let whole = run_into(&place.path("whole"), &gas("dsmc").with(&[]));
    let (log, clean) = (place.path("log.mcap"), place.path("clean.mcap"));
    fs::write(&log, relabelled(&log_bytes(&whole))).unwrap();
    let errors = [read_log(&log).map(drop), LogIndex::open(&log).map(drop), recover(&log, &clean).map(drop)];
    for error in errors.map(Result::unwrap_err) {
        assert!(matches!(error, LogError::Compression { .. }), "{error}");
        let said = error.to_string();
        assert!(said.contains("lz4") && said.contains("--compression zstd"), "{said}");
    }
    assert!(!clean.exists());
    // A wrong byte in the name of the compression is damage, and the rest is saved.
    let mut bytes = log_bytes(&whole);
    let third = chunks(&bytes)[3].start + 9 + 8 + 8 + 8 + 4 + 4;
    bytes[third] ^= 1;
    fs::write(&log, &bytes).unwrap();
    assert!(matches!(read_log(&log), Err(LogError::Damaged { .. })));
    assert_eq!(recover(&log, &clean).unwrap().unwrap().damaged_parts, 1);
}
