//! Goes through the frames or the states of a log one by one: memory for one of them is enough.

use std::ops::ControlFlow;
use std::path::Path;

use prost::Message;

use super::contents::Frame;
use super::error::LogError;
use super::frame::frame_of;
use super::saved::Assembly;
use super::scan::{Event, Fault, scan};
use super::schema::foxglove::PointCloud;
use super::schema::grainflow::State;
use super::schema::measures::{MeasuresMessage, TIME};
use super::schema::topic;
use super::state::SavedState;
use crate::space::Vector;

/// Shows every frame of the log at `path`, with the number of its recording, to `visit`, until that breaks off. A
/// frame whose recording was lost to damage is passed over.
pub fn each_frame(path: &Path, visit: &mut dyn FnMut(u32, Frame) -> ControlFlow<()>) -> Result<(), LogError> {
    // Number, time and grains of the last recording: its frame follows before the next one.
    let mut recording = None;
    scan(path, &mut |event| {
        match event {
            Event::Message { topic: topic::MEASURES, sequence, data, .. } => {
                let message = MeasuresMessage::decode(data, &[TIME]).map_err(Fault::damage)?;
                recording = Some((sequence, message.values[0], message.grains));
            }
            Event::Message { topic: topic::PARTICLES, sequence, data, .. } => {
                let Some((_, time, grains)) = recording.filter(|one| one.0 == sequence) else {
                    return Ok(());
                };
                let cloud = PointCloud::decode(data).map_err(Fault::damage)?;
                let frame = frame_of(&cloud)
                    .ok_or_else(|| Fault::damage("a frame lacks a field or part of a point"))?;
                return go_on(visit(sequence, Frame { time, grains, ..frame }));
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok(())
}

/// Shows every complete saved state of the log at `path` to `visit`, until that breaks off.
pub fn each_state<V: Vector>(
    path: &Path,
    visit: &mut dyn FnMut(SavedState<'static, V>) -> ControlFlow<()>,
) -> Result<(), LogError> {
    let mut assembly = Assembly::<V>::default();
    scan(path, &mut |event| {
        if let Event::Message { topic: topic::STATE, data, .. } = event {
            let part = State::decode(data).map_err(Fault::damage)?;
            if part.dimension as usize != V::DIMENSION {
                return Err(Fault::Dimension(part.dimension, V::DIMENSION));
            }
            if let Some(state) = assembly.add(&part).map_err(Fault::damage)? {
                return go_on(visit(state));
            }
        }
        Ok(())
    })?;
    Ok(())
}

fn go_on(flow: ControlFlow<()>) -> Result<(), Fault> {
    if flow.is_break() { Err(Fault::Enough) } else { Ok(()) }
}
