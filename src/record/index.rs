//! Random access to the frames and the series of a log, however long it is: by the index at its end, or by one that is
//! made in one pass where the log has none because it was cut off or is still being written.

use std::path::Path;

use mcap::records::{Record, op};
use prost::Message;

use super::contents::{Frame, RunLog};
use super::error::LogError;
use super::frame::frame_of;
use super::scan::{Fault, holds_attachment};
use super::schema::foxglove::PointCloud;
use super::schema::grainflow::State;
use super::schema::measures::MeasuresMessage;

mod head;
mod places;
mod records;

use head::Head;
use places::{Indexed, Places, Spot};
use records::Records;

/// A log of which any frame can be read without those before it. Threads may share it.
#[derive(Debug)]
pub struct LogIndex {
    records: Records,
    head: Head,
    places: Places,
    /// Whether the index had to be made.
    was_made: bool,
}

/// What was recorded at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// The picture of the grains.
    pub frame: Frame,
    /// `[column]`: its row of the series.
    pub row: Vec<f64>,
}

impl LogIndex {
    /// Opens the log at `path`. One with an index is not read further; its checksums are looked at when a part is read.
    /// Another one is read once, and so is one whose ticks do not tell the times of its recordings; where it was cut off, what
    /// is complete is there and [`RunLog::cut_off`] says so.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let records = Records::open(path)?;
        match Self::by_summary(&records)? {
            Some((head, Indexed::Whole(places))) => Ok(LogIndex { records, head, places, was_made: false }),
            Some((_, Indexed::WithoutTimes)) => Ok(LogIndex { was_made: false, ..Self::by_pass(records)? }),
            Some((_, Indexed::Unfit)) | None => Self::by_pass(records),
        }
    }

    /// Metadata, scenario, columns, walls, and what is missing; no series, no frames.
    pub fn head(&self) -> &RunLog {
        &self.head.log
    }

    /// Whether the log had no index, or none that fits, so that it was read once from start to end.
    pub fn was_made(&self) -> bool {
        self.was_made
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.places.frames.len()
    }

    /// Number of rows of the series.
    pub fn recordings(&self) -> usize {
        self.places.recordings.len()
    }

    /// When frame `number` was taken: to a tick of the log, where these are much finer than the pauses between recordings,
    /// else as exactly as the messages say it [time].
    pub fn frame_time(&self, number: usize) -> Option<f64> {
        Some(self.places.frames.get(number)?.time)
    }

    /// The row of the series to which frame `number` belongs.
    pub fn recording_of(&self, number: usize) -> Option<usize> {
        Some(self.places.frames.get(number)?.recording as usize)
    }

    /// Frame `number` with its row of the series; `None` where there is no such frame.
    pub fn moment(&self, number: usize) -> Result<Option<Moment>, LogError> {
        let Some(place) = self.places.frames.get(number) else { return Ok(None) };
        let chunk = self.records.chunk(self.places.chunks[place.spot.chunk as usize])?;
        let (sequence, data) = self.find(&chunk, place.spot, self.head.particles)?;
        let cloud = PointCloud::decode(data).map_err(|error| self.damage(place.spot, error))?;
        let mut frame = frame_of(&cloud)
            .ok_or_else(|| self.damage(place.spot, "a frame lacks a field or part of a point"))?;
        let recording = self.places.recordings[place.recording as usize];
        let message = if recording.chunk == place.spot.chunk {
            self.measures(&chunk, recording, sequence)?
        } else {
            let other = self.records.chunk(self.places.chunks[recording.chunk as usize])?;
            self.measures(&other, recording, sequence)?
        };
        frame.time = message.values.first().copied().unwrap_or(f64::NAN);
        frame.grains = message.grains;
        Ok(Some(Moment { frame, row: message.values }))
    }

    /// Row `number` of the series, `[column]`; `None` where there is no such row.
    pub fn row(&self, number: usize) -> Result<Option<Vec<f64>>, LogError> {
        let Some(&spot) = self.places.recordings.get(number) else { return Ok(None) };
        let chunk = self.records.chunk(self.places.chunks[spot.chunk as usize])?;
        let (_, data) = self.find(&chunk, spot, self.head.measures)?;
        Ok(Some(self.decode(spot, data)?.values))
    }

    /// The species of every identity that stands in the last saved state, in rising identity; empty where the grains are alike
    /// or no state was saved.
    pub fn species(&self) -> Result<Vec<(u32, u8)>, LogError> {
        let mut species = Vec::new();
        for &spot in &self.places.states {
            let chunk = self.records.chunk(self.places.chunks[spot.chunk as usize])?;
            let (_, data) = self.find(&chunk, spot, self.head.states)?;
            let part = State::decode(data).map_err(|error| self.damage(spot, error))?;
            if part.first_row == 0 {
                species.clear();
            }
            let ids = part.ids.chunks_exact(4).map(|word| u32::from_le_bytes([0, 1, 2, 3].map(|k| word[k])));
            species.extend(ids.zip(part.species.unwrap_or_default()));
        }
        species.sort_unstable();
        Ok(species)
    }

    /// The index as it stands at the end of the file, if it is there.
    fn by_summary(records: &Records) -> Result<Option<(Head, Indexed)>, LogError> {
        let Some(summary) = records.summary() else { return Ok(None) };
        let mut head = Head::default();
        let mut start = mcap::MAGIC.len() as u64;
        while let Some(raw) = records.at(start)?.filter(|raw| ![op::CHUNK, op::DATA_END].contains(&raw.kind))
        {
            add(records, &mut head, start, raw.kind, &raw.body)?;
            start = raw.end;
        }
        // By number, so that the same log is always the same.
        let mut channels: Vec<_> = summary.channels.values().collect();
        channels.sort_by_key(|channel| channel.id);
        for channel in channels {
            let description = channel.schema.as_ref().map_or(&[][..], |schema| &schema.data);
            let taken = head.channel(channel.id, &channel.topic, description, &channel.metadata);
            taken.map_err(|fault| fault.at(records.path(), start))?;
        }
        if !head.is_log {
            return Ok(None);
        }
        let found = Places::by_summary(&summary, records, &head)?;
        if let Indexed::Whole(Places { walls: Some(chunk), .. }) = found {
            for record in records.chunk(chunk)? {
                head.add(&record).map_err(|fault| fault.at(records.path(), chunk))?;
            }
        }
        Ok(Some((head, found)))
    }

    /// An index made by reading everything once.
    fn by_pass(records: Records) -> Result<Self, LogError> {
        let (mut head, mut places) = (Head::default(), Places::default());
        let mut start = mcap::MAGIC.len() as u64;
        let mut data_ended = false;
        while !data_ended {
            let Some(raw) = records.at(start)? else { break };
            match raw.kind {
                op::CHUNK => {
                    let chunk = records.unpack(start, &raw.body)?;
                    places.begin_chunk(start);
                    for record in &chunk {
                        let taken = head.add(record).and_then(|()| places.add(record, &head));
                        taken.map_err(|fault| fault.at(records.path(), start))?;
                    }
                }
                op::DATA_END => data_ended = true,
                kind => add(&records, &mut head, start, kind, &raw.body)?,
            }
            start = raw.end;
        }
        if !head.is_log {
            return Err(Fault::NoHeader.at(records.path(), start));
        }
        places.pair();
        let what =
            if data_ended { "all that was recorded is there" } else { "what was complete before is there" };
        let length = records.length();
        head.log.cut_off = records
            .summary()
            .is_none()
            .then(|| format!("the log {} is cut off after {length} bytes; {what}", records.path().display()));
        Ok(LogIndex { records, head, places, was_made: true })
    }

    /// The message at `spot` among the records of its chunk: its place in the sequence, and its bytes.
    fn find<'a>(
        &self,
        chunk: &'a [Record<'static>],
        spot: Spot,
        channel: Option<u16>,
    ) -> Result<(u32, &'a [u8]), LogError> {
        let messages = chunk.iter().filter_map(|record| match record {
            Record::Message { header, data } if Some(header.channel_id) == channel => {
                Some((header.sequence, data.as_ref()))
            }
            _ => None,
        });
        let mut wanted = messages.skip(spot.rank as usize);
        wanted.next().ok_or_else(|| self.damage(spot, "a message of the index is not there"))
    }

    /// The recording at `spot`, which has to be the one with this `sequence`.
    fn measures(
        &self,
        chunk: &[Record<'static>],
        spot: Spot,
        sequence: u32,
    ) -> Result<MeasuresMessage, LogError> {
        let (found, data) = self.find(chunk, spot, self.head.measures)?;
        if found != sequence {
            return Err(self.damage(spot, "a frame and its row of the series do not belong together"));
        }
        self.decode(spot, data)
    }

    fn decode(&self, spot: Spot, data: &[u8]) -> Result<MeasuresMessage, LogError> {
        MeasuresMessage::decode(data, &self.head.numbers).map_err(|error| self.damage(spot, error))
    }

    fn damage(&self, spot: Spot, reason: impl ToString) -> LogError {
        self.records.damage(self.places.chunks[spot.chunk as usize], reason)
    }
}

/// Gives a record outside of chunks, found at `start`, to `head`.
fn add(records: &Records, head: &mut Head, start: u64, kind: u8, body: &[u8]) -> Result<(), LogError> {
    if kind == op::ATTACHMENT && !holds_attachment(body) {
        return Err(records.damage(start, "an attachment is too short"));
    }
    let record = mcap::parse_record(kind, body).map_err(|error| records.damage(start, error))?;
    head.add(&record).map_err(|fault| fault.at(records.path(), start))
}
