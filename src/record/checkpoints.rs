//! What a log holds that can be checked by running its scenario again.

use std::ops::Range;
use std::path::Path;

use prost::Message;

use super::contents::Frame;
use super::error::LogError;
use super::frame::frame_of;
use super::saved::Assembly;
use super::scan::{Event, Fault, scan};
use super::schema::foxglove::PointCloud;
use super::schema::grainflow::State;
use super::schema::measures::{MeasuresMessage, columns_of};
use super::schema::topic;
use super::state::SavedState;
use crate::space::Vector;

/// Something that can be checked, or tells that something cannot.
pub(crate) enum Checkpoint<V: Vector> {
    /// The names of the columns of all recordings that follow.
    Columns(Vec<String>),
    /// A recording.
    Recording { values: Vec<f64>, state_hash: String, grains: u64 },
    /// The picture that belongs to the last recording.
    Frame(Frame),
    /// A saved state.
    State(Box<SavedState<'static, V>>),
    /// Messages of this topic that were lost before the log was recovered.
    Hole { topic: String, missing: Range<u32> },
}

/// Gives every checkpoint of the log at `path` to `visit`, in the order in which they stand there, until it
/// returns `false`.
pub(crate) fn each_checkpoint<V: Vector>(
    path: &Path,
    visit: &mut dyn FnMut(Checkpoint<V>) -> bool,
) -> Result<(), LogError> {
    let (mut assembly, mut numbers) = (Assembly::<V>::default(), Vec::new());
    let mut goes_on = true;
    scan(path, &mut |event| {
        if goes_on && let Some(checkpoint) = checkpoint(event, &mut assembly, &mut numbers)? {
            goes_on = visit(checkpoint);
        }
        Ok(())
    })?;
    Ok(())
}

fn checkpoint<V: Vector>(
    event: Event<'_>,
    assembly: &mut Assembly<V>,
    numbers: &mut Vec<u32>,
) -> Result<Option<Checkpoint<V>>, Fault> {
    Ok(match event {
        Event::Channel { topic: topic::MEASURES, description, metadata } => {
            let columns = columns_of(description, metadata)
                .ok_or_else(|| Fault::damage("the columns of the series have no proper units"))?;
            let (found, columns): (Vec<u32>, Vec<_>) = columns.into_iter().unzip();
            *numbers = found;
            Some(Checkpoint::Columns(columns.into_iter().map(|column| column.name).collect()))
        }
        Event::Message { topic: topic::MEASURES, data, .. } => {
            let message = MeasuresMessage::decode(data, numbers).map_err(Fault::damage)?;
            let MeasuresMessage { values, state_hash, grains } = message;
            Some(Checkpoint::Recording { values, state_hash, grains })
        }
        Event::Message { topic: topic::PARTICLES, data, .. } => {
            let cloud = PointCloud::decode(data).map_err(Fault::damage)?;
            frame_of(&cloud).map(Checkpoint::Frame)
        }
        Event::Message { topic: topic::STATE, data, .. } => {
            let part = State::decode(data).map_err(Fault::damage)?;
            assembly.add(&part).map_err(Fault::damage)?.map(|state| Checkpoint::State(Box::new(state)))
        }
        Event::Hole { topic, missing } => Some(Checkpoint::Hole { topic: topic.to_owned(), missing }),
        _ => None,
    })
}
