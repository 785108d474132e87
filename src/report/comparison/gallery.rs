//! The grains of all engines at the same times: a row for a time, a column for an engine (as Müller 2001, figure 3.9).

use std::fmt::Write;

use super::{label, moment, with_unit};
use crate::comparison::model::Comparison;
use crate::number::number;
use crate::observe::measure::Dimension;
use crate::record::contents::Frame;
use crate::report::colour::ColourMap;
use crate::report::escape::escape;
use crate::report::evidence::spread;
use crate::report::picture::picture;
use crate::report::plot::colour_bar;
use crate::report::scene::Scene;

/// Rows.
const TIMES: usize = 4;
/// Width of all columns together [pixel].
const WIDTH: f64 = 1500.0;
/// Frames belong to one time where they are no farther apart than this share of it and of a pause between recordings.
const APART: f64 = 0.5;

/// The pictures; nothing where there are no frames.
pub(super) fn html(comparison: &Comparison) -> String {
    let columns: Vec<usize> =
        (0..comparison.contestants.len()).filter(|place| !frames(comparison, *place).is_empty()).collect();
    let Some(&first) = columns.iter().find(|place| **place == comparison.reference).or(columns.first())
    else {
        return String::new();
    };
    let rows: Vec<Row<'_>> = times(frames(comparison, first))
        .into_iter()
        .map(|time| {
            let frame = |place: &usize| nearest(frames(comparison, *place), time);
            Row { time, frames: columns.iter().map(frame).collect() }
        })
        .collect();
    let scenes: Vec<Scene> = columns.iter().map(|&place| scene(comparison, &columns, &rows, place)).collect();
    let mut html = format!("<div class=\"gallery\" style=\"--columns:{}\">\n", columns.len());
    for &place in &columns {
        let _ = writeln!(html, "<h3>{}</h3>", escape(label(comparison, place)));
    }
    for row in &rows {
        html.push_str(&row.html(comparison, &columns, &scenes));
    }
    html.push_str("</div>\n");
    html
}

/// Frames of about one time, one for each engine that has one.
struct Row<'a> {
    time: f64,
    /// `[column]`.
    frames: Vec<Option<&'a Frame>>,
}

fn frames(comparison: &Comparison, place: usize) -> &[Frame] {
    &comparison.contestants[place].frames
}

/// The times of the rows, of those with something to see.
fn times(frames: &[Frame]) -> Vec<f64> {
    let seen: Vec<f64> = frames.iter().filter(|f| !f.positions.is_empty()).map(|f| f.time).collect();
    spread(&seen, TIMES)
}

/// The view on an engine's grains: the same for all engines in the same box, at all times.
fn scene(comparison: &Comparison, columns: &[usize], rows: &[Row<'_>], place: usize) -> Scene {
    let own = &comparison.contestants[place];
    let is_same_box = |column: &usize| comparison.contestants[columns[*column]].walls == own.walls;
    let same: Vec<usize> = (0..columns.len()).filter(is_same_box).collect();
    let all: Vec<&Frame> =
        rows.iter().flat_map(|row| same.iter().filter_map(|&column| row.frames[column])).collect();
    Scene::of(&all, own.walls.as_ref(), own.kinds.largest_diameter(), false)
}

impl Row<'_> {
    /// Its pictures, in one scale of speeds.
    fn html(&self, comparison: &Comparison, columns: &[usize], scenes: &[Scene]) -> String {
        let shown: Vec<&Frame> = self.frames.iter().flatten().copied().collect();
        let fastest = Scene::of(&shown, None, 1.0, false).speeds.first().copied().unwrap_or(1.0);
        let width = (WIDTH / columns.len() as f64).clamp(240.0, 640.0);
        let mut html = format!("<p>{}</p>\n", escape(&moment(comparison, self.time)));
        for ((&place, frame), scene) in columns.iter().zip(&self.frames).zip(scenes) {
            let Some(frame) = frame else {
                html.push_str("<div class=\"nothing\">no recording</div>\n");
                continue;
            };
            let kinds = &comparison.contestants[place].kinds;
            let address = picture(frame, scene, fastest, kinds, width.round()).address();
            let when = moment(comparison, frame.time);
            let what = format!("The grains of {} at {when}", label(comparison, place));
            let _ = writeln!(html, "<img src=\"{address}\" alt=\"{}\">", escape(&what));
        }
        let speed = with_unit(comparison, "speed", Dimension { mass: 0, length: 1, time: -1 });
        html.push_str(&colour_bar(ColourMap::Speed, "0", &number(fastest, 3), &speed));
        html
    }
}

/// The frame nearest to `time`; none where the engine was not recorded about then.
fn nearest(frames: &[Frame], time: f64) -> Option<&Frame> {
    let apart = |frame: &&Frame| (frame.time - time).abs();
    let nearest = frames.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    let pause = frames.windows(2).map(|pair| pair[1].time - pair[0].time).fold(0.0, f64::max);
    (apart(&nearest) <= APART * time.abs().min(pause).max(f64::MIN_POSITIVE) || frames.len() == 1)
        .then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_belongs_to_a_time_that_was_recorded() {
        let at = |time: f64| Frame { time, ..Frame::default() };
        let frames = [at(0.0), at(1.0), at(2.1)];
        assert_eq!(nearest(&frames, 1.1).map(|frame| frame.time), Some(1.0));
        assert_eq!(nearest(&frames, 0.0).map(|frame| frame.time), Some(0.0));
        assert_eq!(nearest(&frames, 9.0), None);
        assert_eq!(nearest(&[], 1.0), None);
    }
}
