//! Copies what a log holds before one of its states into the log that goes on from there.

use std::path::Path;

use prost::Message;

use super::error::LogError;
use super::reader::profile;
use super::scan::{Event, Fault, scan};
use super::schema::grainflow::State;
use super::schema::measures::{MeasuresMessage, columns_of};
use super::schema::topic;
use super::writer::LogWriter;
use crate::observe::measure::{Column, Profile};

/// What was copied.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Copied {
    /// `[recording][column]`, in the columns of the new log.
    pub(crate) series: Vec<Vec<f64>>,
    /// The state hash of the last recording.
    pub(crate) last_hash: String,
    /// Profiles, in the order they were written.
    pub(crate) profiles: Vec<Profile>,
}

/// Copies every message of the log `old` that stands before number `state` in the sequence of its states into `new`, which
/// has just been begun and has these `columns`. Series are matched by the names of their columns; one that the old log
/// lacks is NaN.
pub(crate) fn copy_before(
    old: &Path,
    state: u32,
    new: &mut LogWriter,
    columns: &[Column],
) -> Result<Copied, LogError> {
    let mut copy = Copy { new, columns, numbers: Vec::new(), places: Vec::new(), copied: Copied::default() };
    let mut reached = false;
    scan(old, &mut |event| {
        match event {
            Event::Channel { topic: topic::MEASURES, description, metadata } => {
                let found = columns_of(description, metadata)
                    .ok_or_else(|| Fault::damage("the columns of the series have no proper units"))?;
                copy.match_columns(found);
            }
            Event::Message { topic: topic::STATE, sequence, .. } if sequence == state => reached = true,
            Event::Message { topic, sequence, log_time, data } if !reached => {
                copy.message(topic, sequence, log_time, data)?;
            }
            _ => {}
        }
        Ok(())
    })?;
    copy.new.flush()?;
    Ok(copy.copied)
}

struct Copy<'a> {
    new: &'a mut LogWriter,
    columns: &'a [Column],
    /// Numbers of the fields of the old columns.
    numbers: Vec<u32>,
    /// `[new column]`: which of the old ones it is.
    places: Vec<Option<usize>>,
    copied: Copied,
}

impl Copy<'_> {
    fn match_columns(&mut self, old: Vec<(u32, Column)>) {
        let place = |column: &Column| old.iter().position(|(_, other)| other == column);
        self.places = self.columns.iter().map(place).collect();
        self.numbers = old.into_iter().map(|(number, _)| number).collect();
    }

    fn message(&mut self, topic: &str, sequence: u32, tick: u64, data: &[u8]) -> Result<(), Fault> {
        // Chunks end where they ended: before a recording and before a state.
        let begins = match topic {
            topic::MEASURES => true,
            topic::STATE => State::decode(data).map_err(Fault::damage)?.first_row == 0,
            _ => false,
        };
        if begins {
            self.new.flush().map_err(Fault::Other)?;
        }
        match topic {
            // The new log has begun with it.
            topic::WALLS => return Ok(()),
            topic::MEASURES => {
                let mut message = MeasuresMessage::decode(data, &self.numbers).map_err(Fault::damage)?;
                let value = |place: &Option<usize>| place.map_or(f64::NAN, |place| message.values[place]);
                message.values = self.places.iter().map(value).collect();
                let data = message.encode();
                self.copied.series.push(message.values);
                self.copied.last_hash = message.state_hash;
                return self.new.copy(topic, sequence, tick, data).map_err(Fault::Other);
            }
            topic::PROFILES => self.copied.profiles.push(profile(data)?),
            _ => {}
        }
        self.new.copy(topic, sequence, tick, data.to_vec()).map_err(Fault::Other)
    }
}
