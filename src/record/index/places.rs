//! Where the messages of a log stand.

use mcap::Summary;
use mcap::records::{ChunkIndex, Record};

use super::head::Head;
use super::records::Records;
use crate::record::error::LogError;
use crate::record::scan::Fault;
use crate::record::schema::measures::{MeasuresMessage, TIME};
use crate::record::time_scale::tell_times;

/// The `rank`-th message of its channel in a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    /// Number of the chunk.
    pub(super) chunk: u32,
    /// Messages of the same channel before it in the chunk.
    pub(super) rank: u32,
}

/// Where a frame stands, and which recording it belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct FramePlace {
    /// When it was taken, to a tick of the log where the index says it [time].
    pub(super) time: f64,
    /// Number of its row of the series.
    pub(super) recording: u32,
    pub(super) spot: Spot,
}

/// Where everything stands.
#[derive(Debug, Default)]
pub(super) struct Places {
    /// `[chunk]`: where it begins [byte].
    pub(super) chunks: Vec<u64>,
    pub(super) recordings: Vec<Spot>,
    pub(super) frames: Vec<FramePlace>,
    /// Parts of saved states.
    pub(super) states: Vec<Spot>,
    /// Where the chunk begins that tells of the walls [byte].
    pub(super) walls: Option<u64>,
    /// `[recording]`: its time; empty where the index was not made here [time].
    times: Vec<f64>,
    /// Places in the sequence of recordings and, until they are paired, of frames.
    sequences: [Vec<u32>; 2],
    /// Messages of measures, particles and states in the chunk that is being read.
    ranks: [u32; 3],
}

/// What the index of a file is good for.
pub(super) enum Indexed {
    /// It says where everything stands, and when it was taken.
    Whole(Places),
    /// Its ticks are too coarse to say when: the messages have to.
    WithoutTimes,
    /// It does not fit together.
    Unfit,
}

impl Places {
    /// What the index of the file says.
    pub(super) fn by_summary(summary: &Summary, records: &Records, head: &Head) -> Result<Indexed, LogError> {
        let mut places = Places::default();
        let (mut ticks, mut frame_ticks) = (Vec::new(), Vec::new());
        let mut chunks: Vec<&ChunkIndex> = summary.chunk_indexes.iter().collect();
        chunks.sort_by_key(|chunk| chunk.chunk_start_offset);
        for index in chunks {
            let chunk = places.chunks.len() as u32;
            places.chunks.push(index.chunk_start_offset);
            let holds = |channel: Option<u16>| {
                channel.is_some_and(|id| index.message_index_offsets.contains_key(&id))
            };
            if holds(head.walls) {
                places.walls = Some(index.chunk_start_offset);
            }
            if ![head.measures, head.particles, head.states].into_iter().any(holds) {
                continue;
            }
            let Some(entries) = message_entries(index, records)? else { return Ok(Indexed::Unfit) };
            for Entries { channel, ticks: of_channel } in entries {
                for (rank, tick) in of_channel.into_iter().enumerate() {
                    let spot = Spot { chunk, rank: rank as u32 };
                    match Some(channel) {
                        id if id == head.measures => {
                            places.recordings.push(spot);
                            ticks.push(tick);
                        }
                        id if id == head.particles => {
                            let time = tick as f64 / head.time_scale();
                            places.frames.push(FramePlace { time, recording: 0, spot });
                            frame_ticks.push(tick);
                        }
                        id if id == head.states => places.states.push(spot),
                        _ => {}
                    }
                }
            }
        }
        // A frame belongs to the recording of the same tick: in a log of which parts were lost there may be none.
        let is_there = |tick: &u64| ticks.binary_search(tick).ok();
        let recordings: Option<Vec<usize>> = frame_ticks.iter().map(is_there).collect();
        let Some(recordings) = recordings.filter(|_| ticks.is_sorted()) else { return Ok(Indexed::Unfit) };
        if !tell_times(&ticks) {
            return Ok(Indexed::WithoutTimes);
        }
        for (place, recording) in places.frames.iter_mut().zip(recordings) {
            place.recording = recording as u32;
        }
        Ok(Indexed::Whole(places))
    }

    /// The chunk at `start` is the one that follows.
    pub(super) fn begin_chunk(&mut self, start: u64) {
        self.chunks.push(start);
        self.ranks = [0; 3];
    }

    /// Takes note of a record of the chunk that was begun last.
    pub(super) fn add(&mut self, record: &Record<'_>, head: &Head) -> Result<(), Fault> {
        let Record::Message { header, data } = record else { return Ok(()) };
        let chunk = self.chunks.len() as u32 - 1;
        let channels = [head.measures, head.particles, head.states];
        let Some(kind) = channels.iter().position(|id| *id == Some(header.channel_id)) else {
            return Ok(());
        };
        let spot = Spot { chunk, rank: self.ranks[kind] };
        self.ranks[kind] += 1;
        match kind {
            0 => {
                self.recordings.push(spot);
                self.sequences[0].push(header.sequence);
                let message = MeasuresMessage::decode(data, &[TIME]).map_err(Fault::damage)?;
                self.times.push(message.values[0]);
            }
            1 => {
                self.frames.push(FramePlace { time: f64::NAN, recording: 0, spot });
                self.sequences[1].push(header.sequence);
            }
            _ => self.states.push(spot),
        }
        Ok(())
    }

    /// Gives every frame its recording and the time of that; a frame whose recording was lost is left out.
    pub(super) fn pair(&mut self) {
        let [recordings, frames] = std::mem::take(&mut self.sequences);
        let times = std::mem::take(&mut self.times);
        let mut paired = Vec::with_capacity(frames.len());
        for (place, sequence) in self.frames.iter().zip(frames) {
            if let Ok(recording) = recordings.binary_search(&sequence) {
                let time = times[recording];
                paired.push(FramePlace { time, recording: recording as u32, ..*place });
            }
        }
        self.frames = paired;
    }
}

/// The messages of one channel in a chunk, in their order.
struct Entries {
    channel: u16,
    ticks: Vec<u64>,
}

/// What the index says of a chunk; `None` where it makes no sense.
fn message_entries(index: &ChunkIndex, records: &Records) -> Result<Option<Vec<Entries>>, LogError> {
    let Some(mut start) = index.chunk_start_offset.checked_add(index.chunk_length) else { return Ok(None) };
    let Some(end) = start.checked_add(index.message_index_length) else { return Ok(None) };
    let mut entries = Vec::new();
    while start < end {
        let Some(raw) = records.at(start)? else { return Ok(None) };
        let Ok(Record::MessageIndex(mut found)) = mcap::parse_record(raw.kind, &raw.body) else {
            return Ok(None);
        };
        found.records.sort_by_key(|entry| entry.offset);
        let ticks = found.records.iter().map(|entry| entry.log_time).collect();
        entries.push(Entries { channel: found.channel_id, ticks });
        start = raw.end;
    }
    Ok(Some(entries))
}
