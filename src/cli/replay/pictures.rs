//! The frames of a log as pictures.

use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

use super::{Failure, Work};
use crate::cli::run::{STOP, prepare};
use crate::export::target::Target;
use crate::record::overview::overview;
use crate::replay::film::{View, write_pictures};
use crate::replay::{scenario_of, walls_of};
use crate::scenario::kinds::Kinds;

impl Work<'_> {
    /// Writes pictures of `width` pixels into `folder`.
    pub(super) fn pictures(&self, folder: &Path, width: u32) -> Result<(), Failure> {
        let found = overview(self.log)?;
        let scenario = scenario_of(self.log, &found.metadata, &found.scenario)
            .map_err(|unknown| Failure::Input(unknown.to_string()))?;
        let mut picker = self.selection.picker();
        if !found.times.iter().any(|&time| picker.takes(time)) {
            let words = self.selection.words();
            return Err(Failure::Input(format!("--frames: there is no frame {words}")));
        }
        let target = Target::folder(folder, self.force, &["png"], "--frames")?;
        prepare(None).map_err(|error| Failure::Input(error.to_string()))?;
        let kinds = Kinds::of(&scenario, found.species);
        if kinds.are_untold() {
            eprintln!(
                "note: grains differ in size, but no saved state says which is which: all are drawn alike"
            );
        }
        let view = View { walls: Some(walls_of(&scenario)), kinds, width };
        let written = write_pictures(self.log, target.working(), self.selection, &view, &STOP)?;
        let pictures = written.map_err(|source| target.failed(source))?;
        if STOP.load(Relaxed) {
            return Err(Failure::Interrupted);
        }
        if let Some(missing) = &found.cut_off {
            eprintln!("note: {missing}");
        }
        println!("wrote {pictures} pictures to {}", target.settle()?.display());
        Ok(())
    }
}
