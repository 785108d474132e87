//! The file of a log as a row of records, each of which can be read alone.

use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use mcap::records::{Record, op};
use mcap::sans_io::summary_reader::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};
use mcap::{McapError, Summary};

use crate::record::error::LogError;
use crate::record::recover::chunk_records;
use crate::record::scan::{self, Fault, UNREAD_COMPRESSION, length_limit};

/// Kind and length in front of every record [byte].
const PREFIX: u64 = 9;

/// An open log; threads take turns to read from it.
#[derive(Debug)]
pub(super) struct Records {
    path: PathBuf,
    file: Mutex<File>,
    length: u64,
}

/// A record as it stands in the file.
pub(super) struct RawRecord {
    pub(super) kind: u8,
    pub(super) body: Vec<u8>,
    /// Where the next one begins [byte].
    pub(super) end: u64,
}

impl Records {
    pub(super) fn open(path: &Path) -> Result<Self, LogError> {
        let (file, length) = scan::open(path)?;
        Ok(Records { path: path.to_owned(), file: Mutex::new(file), length })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Length of the file when it was opened [byte].
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// The `count` bytes from `start` on; `None` where the file does not have them.
    pub(super) fn bytes(&self, start: u64, count: u64) -> Result<Option<Vec<u8>>, LogError> {
        if start.checked_add(count).is_none_or(|end| end > self.length) {
            return Ok(None);
        }
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let mut bytes = vec![0; count as usize];
        let read = file.seek(SeekFrom::Start(start)).and_then(|_| file.read_exact(&mut bytes));
        match read {
            Ok(()) => Ok(Some(bytes)),
            // It was longer when it was opened.
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(None),
            Err(source) => Err(LogError::Read { path: self.path.clone(), source }),
        }
    }

    /// The record at `start`; `None` where the file ends before it does.
    pub(super) fn at(&self, start: u64) -> Result<Option<RawRecord>, LogError> {
        let Some(prefix) = self.bytes(start, PREFIX)? else { return Ok(None) };
        let mut word = [0; 8];
        word.copy_from_slice(&prefix[1..]);
        let length = u64::from_le_bytes(word);
        let body = self.bytes(start + PREFIX, length)?;
        Ok(body.map(|body| RawRecord { kind: prefix[0], body, end: start + PREFIX + length }))
    }

    /// What the chunk at `start` holds, once its checksum is seen to hold.
    pub(super) fn chunk(&self, start: u64) -> Result<Vec<Record<'static>>, LogError> {
        let raw = self.at(start)?.filter(|raw| raw.kind == op::CHUNK);
        let raw = raw.ok_or_else(|| self.damage(start, "the chunk that should begin there is not there"))?;
        self.unpack(start, &raw.body)
    }

    /// What the chunk with this `body`, found at `start`, holds.
    pub(super) fn unpack(&self, start: u64, body: &[u8]) -> Result<Vec<Record<'static>>, LogError> {
        chunk_records(body, length_limit(self.length)).map_err(|error| match error {
            McapError::UnsupportedCompression(ref name) if name == UNREAD_COMPRESSION => {
                Fault::from(error).at(&self.path, start)
            }
            _ => self.damage(start, "the checksum of a chunk does not hold"),
        })
    }

    pub(super) fn damage(&self, position: u64, reason: impl ToString) -> LogError {
        Fault::damage(reason).at(&self.path, position)
    }

    /// The index at the end of the file; `None` where it is missing or makes no sense.
    pub(super) fn summary(&self) -> Option<Summary> {
        let options = SummaryReaderOptions::default()
            .with_file_size(self.length)
            .with_record_length_limit(length_limit(self.length));
        let mut reader = SummaryReader::new_with_options(options);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        while let Some(event) = reader.next_event() {
            match event.ok()? {
                SummaryReadEvent::ReadRequest(count) => {
                    let read = file.read(reader.insert(count)).ok()?;
                    reader.notify_read(read);
                }
                SummaryReadEvent::SeekRequest(to) => reader.notify_seeked(file.seek(to).ok()?),
            }
        }
        reader.finish()
    }
}
