//! The report of a log, made again.

use std::path::Path;

use serde_json::Map;

use super::{Failure, Work, write_file};
use crate::record::contents::RunLog;
use crate::record::reader::read_log;
use crate::record::summary::{SummaryError, summary_beside};
use crate::replay::selection::Selection;
use crate::replay::tables::tables_of;
use crate::report::render;

impl Work<'_> {
    /// Writes the report into `file`. Figures come from the summary beside the log, and belong to the whole run: those of a part
    /// would have to be measured again.
    pub(super) fn page(&self, file: &Path) -> Result<(), Failure> {
        let log = read_log(self.log)?;
        if let Some(missing) = &log.cut_off {
            eprintln!("note: {missing}");
        }
        let summary = match self.is_part {
            true => Map::new(),
            false => summary_beside(self.log).map_err(unusable)?.unwrap_or_default(),
        };
        if summary.is_empty() {
            let reason = match self.is_part {
                true => "a part of the run is shown, and they belong to all of it",
                false => "there is no summary.json beside the log",
            };
            eprintln!("note: the report has no figures: {reason}");
        }
        let log = part_of(log, self.selection);
        if log.series.is_empty() {
            let words = self.selection.words();
            return Err(Failure::Input(format!("--report: there is no recording {words}")));
        }
        write_file(file, &render(&log, &summary), self.force, "--report").map_err(Failure::from)
    }
}

fn unusable(error: SummaryError) -> Failure {
    Failure::Input(format!("{error}; take it away, and the report has no figures"))
}

/// The recordings of `log` that `selection` picks, with their frames and profiles.
fn part_of(mut log: RunLog, selection: Selection) -> RunLog {
    let mut picker = selection.picker();
    log.frames.retain(|frame| picker.takes(frame.time));
    let mut picker = selection.picker();
    let kept: Vec<bool> = log.series.iter().map(|row| picker.takes(row[0])).collect();
    let times: Vec<f64> =
        log.series.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(row, _)| row[0]).collect();
    log.fields.retain(|field| times.contains(&field.time));
    let mut hashes = kept.iter();
    log.state_hashes.retain(|_| hashes.next().is_some_and(|&kept| kept));
    let (frames, fields) = (std::mem::take(&mut log.frames), std::mem::take(&mut log.fields));
    let (metadata, scenario, walls) = (log.metadata.clone(), log.scenario.clone(), log.walls.clone());
    let species = std::mem::take(&mut log.species);
    let (state_hashes, cut_off) = (std::mem::take(&mut log.state_hashes), log.cut_off.clone());
    let tables = tables_of(log, selection);
    RunLog {
        metadata,
        scenario,
        columns: tables.columns,
        series: tables.series,
        state_hashes,
        profiles: tables.profiles,
        frames,
        fields,
        walls,
        species,
        cut_off,
    }
}
