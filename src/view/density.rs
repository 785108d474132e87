//! The volume fraction around each point of a frame: that of the cell it stands in.

use std::f64::consts::PI;

use super::colouring::Scalars;
use crate::record::contents::{Frame, Walls};

/// Sides of a cell are at least this long [diameter].
const LEAST_SIDE: f64 = 3.0;
/// Points that a cell should hold where the frame is as dense as on the average.
const WANTED_POINTS: f64 = 6.0;

/// ν around every point, in cells of equal size; a thinned frame is taken for a fair sample, so that each of its points stands
/// for several grains. `None` without points or box.
pub(super) fn volume_fractions(frame: &Frame, walls: &Walls, diameters: &[f64]) -> Option<Scalars> {
    let axes = if walls.sides[2][0].is_empty() { 2 } else { 3 };
    let largest = diameters.iter().copied().fold(0.0, f64::max);
    let (lower, span) = extent(frame, axes)?;
    let volume: f64 = span.iter().take(axes).map(|side| side.max(largest)).product();
    let wish = (WANTED_POINTS * volume / frame.positions.len() as f64).powf(1.0 / axes as f64);
    let side = wish.max(LEAST_SIDE * largest);
    if !side.is_finite() || side <= 0.0 {
        return None;
    }
    let cut: Vec<(f64, f64)> = (0..axes).map(|axis| cells_along(walls, axis, lower[axis], side)).collect();
    let cell_of = |position: &[f32; 3]| -> [i64; 3] {
        let mut cell = [0; 3];
        for (axis, (start, side)) in cut.iter().enumerate() {
            cell[axis] = ((f64::from(position[axis]) - start) / side).floor() as i64;
        }
        cell
    };
    let cell_volume: f64 = cut.iter().map(|(_, side)| side).product();
    let stands_for = frame.grains.max(frame.positions.len() as u64) as f64 / frame.positions.len() as f64;
    let mut points: Vec<([i64; 3], usize)> =
        frame.positions.iter().enumerate().map(|(point, position)| (cell_of(position), point)).collect();
    points.sort_unstable();
    let mut values = vec![f32::NAN; frame.positions.len()];
    for cell in points.chunk_by(|a, b| a.0 == b.0) {
        let matter: f64 = cell.iter().map(|(_, point)| grain_volume(diameters[*point], axes)).sum();
        for (_, point) in cell {
            if frame.positions[*point].iter().all(|x| x.is_finite()) {
                values[*point] = (stands_for * matter / cell_volume) as f32;
            }
        }
    }
    Some(Scalars { values, detail: cell_volume.powf(1.0 / axes as f64) })
}

/// Area of a disk or volume of a sphere.
fn grain_volume(diameter: f64, axes: usize) -> f64 {
    if axes == 2 { PI / 4.0 * diameter * diameter } else { PI / 6.0 * diameter.powi(3) }
}

/// Lower corner and sides of the smallest box around all points.
fn extent(frame: &Frame, axes: usize) -> Option<([f64; 3], [f64; 3])> {
    let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in &frame.positions {
        for axis in 0..axes {
            let place = f64::from(position[axis]);
            if place.is_finite() {
                lower[axis] = lower[axis].min(place);
                upper[axis] = upper[axis].max(place);
            }
        }
    }
    let is_there = (0..axes).all(|axis| lower[axis] <= upper[axis]);
    is_there.then(|| (lower, std::array::from_fn(|axis| upper[axis] - lower[axis])))
}

/// Where the cells along `axis` begin and how long they are: whole ones between two sides that are not open.
fn cells_along(walls: &Walls, axis: usize, lower: f64, side: f64) -> (f64, f64) {
    let span = walls.upper[axis] - walls.lower[axis];
    let is_closed = walls.sides[axis].iter().all(|kind| kind != "open") && span.is_finite() && span > 0.0;
    if is_closed { (walls.lower[axis], span / (span / side).floor().max(1.0)) } else { (lower, side) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walls(size: f64, kind: &str) -> Walls {
        let sides = [[kind; 2], [kind; 2], [""; 2]].map(|axis| axis.map(str::to_owned));
        Walls { lower: [0.0; 3], upper: [size, size, 0.0], sides }
    }

    /// Disks of diameter 1 on a square lattice of side 2: ν = π/16.
    fn lattice() -> Frame {
        let positions: Vec<[f32; 3]> =
            (0..400).map(|k| [1.0 + 2.0 * (k % 20) as f32, 1.0 + 2.0 * (k / 20) as f32, 0.0]).collect();
        Frame { grains: 400, positions, ..Frame::default() }
    }

    #[test]
    fn a_lattice_has_its_volume_fraction_everywhere() {
        let found = volume_fractions(&lattice(), &walls(40.0, "periodic"), &[1.0; 400]).unwrap();
        let mean = found.values.iter().sum::<f32>() / 400.0;
        assert!((f64::from(mean) - PI / 16.0).abs() < 0.01, "{mean}");
        assert!(found.detail >= LEAST_SIDE);
    }

    #[test]
    fn points_of_a_thinned_frame_stand_for_several_grains() {
        let frame = Frame { grains: 1200, ..lattice() };
        let found = volume_fractions(&frame, &walls(40.0, "wall"), &[1.0; 400]).unwrap();
        let mean = found.values.iter().sum::<f32>() / 400.0;
        assert!((f64::from(mean) - 3.0 * PI / 16.0).abs() < 0.03, "{mean}");
    }

    #[test]
    fn damaged_points_have_no_density() {
        let mut frame = lattice();
        frame.positions[7] = [f32::NAN, 1.0, 0.0];
        frame.positions[8] = [f32::INFINITY, 1.0, 0.0];
        let found = volume_fractions(&frame, &walls(40.0, "open"), &[1.0; 400]).unwrap();
        assert!(found.values[7].is_nan() && found.values[8].is_nan() && found.values[9].is_finite());
        assert_eq!(volume_fractions(&Frame::default(), &walls(40.0, "open"), &[]), None);
    }
}
