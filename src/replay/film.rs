//! The frames of a log as pictures with one view.

use std::io;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::selection::Selection;
use crate::record::contents::Walls;
use crate::record::error::LogError;
use crate::record::walk::each_frame;
use crate::report::Camera;
use crate::scenario::kinds::Kinds;

/// Writes a PNG file `frame-<number>.png` of `width` pixels for every frame of the log at `path` that `selection` picks
/// into `folder`; returns how many, or why the disk did not take one. Goes through the log twice: all pictures show the same window.
pub fn write_pictures(
    path: &Path,
    folder: &Path,
    selection: Selection,
    view: &View,
    stop: &AtomicBool,
) -> Result<io::Result<u64>, LogError> {
    let mut camera = Camera::new(view.walls.clone(), view.kinds.clone());
    let mut picker = selection.picker();
    each_frame(path, &mut |_, frame| {
        if picker.takes(frame.time) {
            camera.see(&frame);
        }
        go_on(stop)
    })?;
    let mut picker = selection.picker();
    let mut written = Ok(0);
    each_frame(path, &mut |number, frame| {
        if !picker.takes(frame.time) {
            return ControlFlow::Continue(());
        }
        let place = folder.join(format!("frame-{number:06}.png"));
        let result = std::fs::write(place, camera.png(&frame, view.width));
        match (result, &mut written) {
            (Ok(()), Ok(pictures)) => *pictures += 1,
            (Ok(()), Err(_)) => {}
            (Err(failure), _) => {
                written = Err(failure);
                return ControlFlow::Break(());
            }
        }
        go_on(stop)
    })?;
    Ok(written)
}

/// How pictures are taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// The box.
    pub walls: Option<Walls>,
    /// Sizes of the grains.
    pub kinds: Kinds,
    /// Width of a picture [pixel].
    pub width: u32,
}

fn go_on(stop: &AtomicBool) -> ControlFlow<()> {
    if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
