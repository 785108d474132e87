//! The page with frames in it: one file that needs neither the log nor a server.

use std::path::Path;

use serde_json::json;

use super::colouring::Colouring;
use super::error::ViewError;
use super::log::ViewedLog;
use super::packing::chosen;
use super::page::{self, Contents};
use crate::placing::write_whole;
use crate::record::contents::Frame;
use crate::record::error::LogError;
use crate::record::index::Moment;
use crate::record::is_log;
use crate::report::scene::speed;

/// What frames take in all, before the third that base64 adds [byte].
const MOST_BYTES: usize = 8_000_000;
/// Frames beyond these are left out, evenly.
const MOST_FRAMES: usize = 200;
/// Fewer frames than these do not move: grains are left out rather.
const FEWEST_FRAMES: usize = 40;
/// Grains of a frame beyond these are left out, the same ones in every frame.
const MOST_POINTS: usize = 20_000;
/// Rows of a series beyond these are left out, evenly.
const MOST_ROWS: usize = 1000;

/// What of a log stands in an exported page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exported {
    /// Frames in the page.
    pub frames: usize,
    /// Frames of the log.
    pub frames_in_log: usize,
    /// Most points of a frame in the page.
    pub points: usize,
    /// Most recorded points of such a frame.
    pub points_in_log: usize,
    /// Frames that would be there, were their bytes not wrong.
    pub damaged: usize,
}

/// Writes the page of `logs` to `path`; what stands there is replaced only with `force`, once the new page is complete.
/// What was kept of each log.
pub fn export(logs: &[ViewedLog], path: &Path, force: bool) -> Result<Vec<Exported>, ViewError> {
    if path.exists() && (!force || path.is_dir() || is_log(path)) {
        return Err(ViewError::Exists(path.to_owned()));
    }
    let (mut parts, mut packs, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    for log in logs {
        let pack = Pack::of(log, MOST_BYTES / logs.len())?;
        let mut about = log.about(&pack.numbers);
        about["row_step"] = pack.row_step.into();
        about["embedded_rows"] = pack.rows.into();
        let name = if logs.len() > 1 { format!("{}: ", log.name()) } else { String::new() };
        about["remarks"] = json!([name + &pack.exported.sentence()]);
        parts.push(about);
        packs.push(pack.bytes);
        kept.push(pack.exported);
    }
    let about = json!({ "colours": page::colours(), "logs": parts });
    let text = page::html(logs, &Contents::Embedded(about, packs));
    let failed = |source| ViewError::Write { path: path.to_owned(), source };
    write_whole(path, text.as_bytes()).map_err(failed)?;
    Ok(kept)
}

impl Exported {
    /// What the page holds, in words.
    pub fn sentence(&self) -> String {
        let frames = match self.frames == self.frames_in_log {
            true => format!("all {} frames", self.frames),
            false => format!("{} of {} frames", self.frames, self.frames_in_log),
        };
        let points = match self.points == self.points_in_log {
            true => "every recorded grain".to_owned(),
            false => format!("at most {} of {} recorded grains", self.points, self.points_in_log),
        };
        let damaged = match self.damaged {
            0 => String::new(),
            1 => " One frame is damaged and left out.".to_owned(),
            damaged => format!(" {damaged} frames are damaged and left out."),
        };
        format!(
            "This page holds {frames}, with {points}, to a 65 000th of the box; the log holds more digits.{damaged}"
        )
    }
}

/// Frames and rows of a log as bytes.
struct Pack {
    /// Frames that were chosen.
    numbers: Vec<usize>,
    bytes: Vec<u8>,
    row_step: usize,
    rows: usize,
    exported: Exported,
}

impl Pack {
    /// As much of `log` as goes into `budget` bytes.
    fn of(log: &ViewedLog, budget: usize) -> Result<Self, ViewError> {
        let in_log = log.index().frames();
        let point_bytes = 2 * log.axes() + 3 + if log.is_mixture() { 4 } else { 0 };
        let most = log.most_points().clamp(1, MOST_POINTS);
        let count = (budget / (point_bytes * most)).clamp(FEWEST_FRAMES, MOST_FRAMES).min(in_log);
        let points = most.min(budget / (point_bytes * count.max(1)));
        let wanted = (0..count).map(|k| if count > 1 { k * (in_log - 1) / (count - 1) } else { k });
        let mut pack = Pack {
            numbers: Vec::new(),
            bytes: Vec::new(),
            row_step: 1,
            rows: 0,
            exported: Exported::default(),
        };
        pack.exported.frames_in_log = in_log;
        for number in wanted {
            let moment = match log.index().moment(number) {
                Ok(Some(moment)) => moment,
                Ok(None) => continue,
                Err(LogError::Damaged { .. }) => {
                    pack.exported.damaged += 1;
                    continue;
                }
                Err(error) => return Err(error.into()),
            };
            let shown = pack.put(log, &moment, points);
            pack.numbers.push(number);
            pack.exported.frames += 1;
            pack.exported.points = pack.exported.points.max(shown);
            pack.exported.points_in_log = pack.exported.points_in_log.max(moment.frame.positions.len());
        }
        pack.row_step = log.index().recordings().div_ceil(MOST_ROWS).max(1);
        for number in (0..log.index().recordings()).step_by(pack.row_step) {
            let row = log.row(number)?.unwrap_or_default();
            pack.rows += 1;
            row.iter().for_each(|value| pack.bytes.extend_from_slice(&value.to_le_bytes()));
        }
        Ok(pack)
    }

    /// Adds a frame: u32 points, columns, what follows (1 densities, 2 clusters, 4 diameters), axes; f64 time, grains, fastest,
    /// details of densities and clusters, `[column]`; u16 places, f32 diameters, u8 speeds, densities, clusters.
    fn put(&mut self, log: &ViewedLog, moment: &Moment, most: usize) -> usize {
        let Moment { frame, row } = moment;
        // Before grains are left out: neighbours count.
        let densities = Colouring::Density.scalars(log, frame);
        let clusters = Colouring::Clusters.scalars(log, frame);
        let diameters = log.is_mixture().then(|| log.diameters(frame));
        let points = chosen(frame, most);
        let follows = u32::from(densities.is_some())
            + 2 * u32::from(clusters.is_some())
            + 4 * u32::from(diameters.is_some());
        for word in [points.len() as u32, row.len() as u32, follows, log.axes() as u32] {
            self.bytes.extend_from_slice(&word.to_le_bytes());
        }
        let fastest = frame.velocities.iter().map(|velocity| speed(*velocity)).fold(0.0, f64::max);
        let grains = frame.grains.max(frame.positions.len() as u64) as f64;
        let detail =
            |scalars: &Option<super::colouring::Scalars>| scalars.as_ref().map_or(0.0, |one| one.detail);
        let head = [frame.time, grains, fastest, detail(&densities), detail(&clusters)];
        head.iter().chain(row).for_each(|number| self.bytes.extend_from_slice(&number.to_le_bytes()));
        self.put_places(log, frame, &points);
        if let Some(diameters) = diameters {
            points.iter().for_each(|&k| self.bytes.extend_from_slice(&(diameters[k] as f32).to_le_bytes()));
        }
        let velocity = |k: usize| frame.velocities.get(k).copied().unwrap_or_default();
        self.bytes.extend(points.iter().map(|&k| byte(speed(velocity(k)) / fastest)));
        if let Some(densities) = densities {
            self.bytes.extend(points.iter().map(|&k| byte(f64::from(densities.values[k]))));
        }
        if let Some(clusters) = clusters {
            let share = |k: usize| f64::from(clusters.values[k]).ln() / grains.max(2.0).ln();
            self.bytes.extend(points.iter().map(|&k| byte(share(k))));
        }
        self.align(8);
        points.len()
    }

    fn put_places(&mut self, log: &ViewedLog, frame: &Frame, points: &[usize]) {
        for &point in points {
            for axis in 0..log.axes() {
                let [lower, upper] = log.scene().window[axis];
                let share = (f64::from(frame.positions[point][axis]) - lower) / (upper - lower);
                let place = (share.clamp(0.0, 1.0) * 65535.0).round() as u16;
                self.bytes.extend_from_slice(&place.to_le_bytes());
            }
        }
        self.align(4);
    }

    /// Numbers begin at multiples of their length.
    fn align(&mut self, length: usize) {
        self.bytes.resize(self.bytes.len().next_multiple_of(length), 0);
    }
}

/// A share of 0 … 1 as a byte; what is not a number is 0.
fn byte(share: f64) -> u8 {
    (255.0 * share).clamp(0.0, 255.0).round() as u8
}
