//! A frame as the page gets it: bytes that typed arrays are laid over.
//!
//! Little-endian: u32 points, columns, what follows (1: scalars, 2: diameters), axes; f64 time, grains, detail of
//! the scalars; f64 `[column]`; then f32 positions `[point][axis]`, speeds `[point]`, scalars `[point]`, diameters `[point]`.

use super::colouring::{Colouring, Scalars};
use super::log::ViewedLog;
use crate::record::contents::Frame;
use crate::record::index::Moment;
use crate::report::scene::speed;

/// Points beyond these are left out, the same ones in every frame.
pub(super) const MOST_POINTS: usize = 100_000;

/// `moment` of `log` with numbers for `colouring`.
pub(super) fn packed(log: &ViewedLog, moment: &Moment, colouring: Colouring) -> Vec<u8> {
    let Moment { frame, row } = moment;
    // Before points are left out: neighbours count.
    let scalars = colouring.scalars(log, frame);
    let diameters = log.is_mixture().then(|| log.diameters(frame));
    let points = chosen(frame, MOST_POINTS);
    let axes = log.axes();
    let mut bytes = Vec::with_capacity(64 + 8 * row.len() + 4 * points.len() * (axes + 3));
    let follows = u32::from(scalars.is_some()) + 2 * u32::from(diameters.is_some());
    for word in [points.len() as u32, row.len() as u32, follows, axes as u32] {
        bytes.extend_from_slice(&word.to_le_bytes());
    }
    let Scalars { values, detail } = scalars.unwrap_or_default();
    let grains = frame.grains.max(frame.positions.len() as u64) as f64;
    for number in [frame.time, grains, detail].iter().chain(row) {
        bytes.extend_from_slice(&number.to_le_bytes());
    }
    let mut put = |number: f32| bytes.extend_from_slice(&number.to_le_bytes());
    for &point in &points {
        frame.positions[point][..axes].iter().copied().for_each(&mut put);
    }
    for &point in &points {
        put(frame.velocities.get(point).map_or(0.0, |velocity| speed(*velocity) as f32));
    }
    if !values.is_empty() {
        points.iter().for_each(|&point| put(values[point]));
    }
    if let Some(diameters) = diameters {
        points.iter().for_each(|&point| put(diameters[point] as f32));
    }
    bytes
}

/// The points to show where `most` may be shown, in their order: the same grains in every frame as far as they are there.
pub(super) fn chosen(frame: &Frame, most: usize) -> Vec<usize> {
    let count = frame.positions.len();
    if count <= most {
        return (0..count).collect();
    }
    // A grain's number says where it started, so neighbours are told apart by mixing its bits; never twice the same.
    let mixed = |id: u32| (id ^ (id >> 15)).wrapping_mul(0x9e37_79b1);
    let rank = |point: usize| mixed(frame.ids.get(point).copied().unwrap_or(point as u32));
    let mut points: Vec<usize> = (0..count).collect();
    if most < count {
        points.select_nth_unstable_by_key(most, |&point| rank(point));
        points.truncate(most);
    }
    points.sort_unstable();
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grain_that_is_chosen_among_many_is_chosen_among_fewer() {
        let frame = |count: u32| Frame {
            positions: vec![[0.0; 3]; count as usize],
            ids: (0..count).collect(),
            ..Frame::default()
        };
        let (few, many) = (chosen(&frame(1000), 100), chosen(&frame(2000), 100));
        assert_eq!((few.len(), many.len()), (100, 100));
        assert!(many.iter().filter(|&&point| point < 1000).all(|point| few.contains(point)));
        assert_eq!(chosen(&frame(50), 100).len(), 50);
    }
}
