//! The volume fraction around each point of a frame.
//!
//! Matter is given to the nodes of a grid, to each in proportion to its nearness, and read off again in the same way: a
//! tent as wide as two cells. Cells that grains simply are counted in would show stripes wherever grains stand in rows.

use std::f64::consts::PI;

use super::colouring::Scalars;
use crate::record::contents::{Frame, Walls};

/// Sides of a cell are at least this long [diameter].
const LEAST_SIDE: f64 = 3.0;
/// Points that a cell should hold where the frame is as dense as on the average.
const WANTED_POINTS: f64 = 6.0;
/// A grid with more nodes than these is not made.
const MOST_NODES: f64 = 2_000_000.0;

/// ν around every point; a thinned frame is taken for a fair sample, so that each of its points stands for several grains.
/// `None` without points, or where they are spread too far for a grid.
pub(super) fn volume_fractions(frame: &Frame, walls: &Walls, diameters: &[f64]) -> Option<Scalars> {
    let axes = if walls.sides[2][0].is_empty() { 2 } else { 3 };
    let nodes = Nodes::around(frame, walls, axes, diameters.iter().copied().fold(0.0, f64::max))?;
    let stands_for = frame.grains.max(frame.positions.len() as u64) as f64 / frame.positions.len() as f64;
    let mut matter = vec![0.0; nodes.number()];
    for (position, diameter) in frame.positions.iter().zip(diameters) {
        let volume = stands_for * grain_volume(*diameter, axes);
        nodes.each_near(position, |node, weight| matter[node] += weight * volume);
    }
    let mut values = vec![f32::NAN; frame.positions.len()];
    for (value, position) in values.iter_mut().zip(&frame.positions) {
        let mut sum = None;
        nodes.each_near(position, |node, weight| {
            *sum.get_or_insert(0.0) += weight * matter[node] / nodes.volume(node);
        });
        *value = sum.map_or(f32::NAN, |sum: f64| sum as f32);
    }
    Some(Scalars { values, detail: nodes.cell_volume().powf(1.0 / axes as f64) })
}

/// Area of a disk or volume of a sphere.
fn grain_volume(diameter: f64, axes: usize) -> f64 {
    if axes == 2 { PI / 4.0 * diameter * diameter } else { PI / 6.0 * diameter.powi(3) }
}

/// Nodes along an axis.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// Where node 0 is [length].
    start: f64,
    /// From node to node [length].
    side: f64,
    count: usize,
    /// Whether the last node is followed by the first.
    wraps: bool,
    /// Whether matter can be on the inner side of the first and the last node alone.
    walls: [bool; 2],
}

/// The nodes of a grid over all points.
struct Nodes {
    lines: Vec<Line>,
}

impl Nodes {
    fn around(frame: &Frame, walls: &Walls, axes: usize, largest: f64) -> Option<Self> {
        let extent = extent(frame, axes)?;
        let volume: f64 = extent.iter().map(|[lower, upper]| (upper - lower).max(largest)).product();
        let wish = (WANTED_POINTS * volume / frame.positions.len() as f64).powf(1.0 / axes as f64);
        let side = wish.max(LEAST_SIDE * largest);
        if !side.is_finite() || side <= 0.0 {
            return None;
        }
        let shares: f64 =
            (0..axes).map(|axis| (1.0 + longest(walls, axis, extent[axis]) / side).ceil() + 1.0).product();
        if !shares.is_finite() || shares > MOST_NODES {
            return None;
        }
        Some(Nodes { lines: (0..axes).map(|axis| Line::new(walls, axis, extent[axis], side)).collect() })
    }

    fn number(&self) -> usize {
        self.lines.iter().map(|line| line.count).product()
    }

    fn cell_volume(&self) -> f64 {
        self.lines.iter().map(|line| line.side).product()
    }

    /// The space that gives its matter to `node` [length^D].
    fn volume(&self, mut node: usize) -> f64 {
        let mut volume = 1.0;
        for line in &self.lines {
            let place = node % line.count;
            let is_half = (line.walls[0] && place == 0) || (line.walls[1] && place + 1 == line.count);
            volume *= line.side * if is_half { 0.5 } else { 1.0 };
            node /= line.count;
        }
        volume
    }

    /// The 2ᴰ nodes around `position` with their shares in it, which add up to 1; none for a place that is not a number.
    fn each_near(&self, position: &[f32; 3], mut visit: impl FnMut(usize, f64)) {
        if position.iter().any(|x| !x.is_finite()) {
            return;
        }
        for corner in 0..1_usize << self.lines.len() {
            let (mut node, mut weight, mut stride) = (0, 1.0, 1);
            for (axis, line) in self.lines.iter().enumerate() {
                let (place, share) = line.near(f64::from(position[axis]), corner >> axis & 1);
                node += stride * place;
                weight *= share;
                stride *= line.count;
            }
            visit(node, weight);
        }
    }
}

impl Line {
    fn new(walls: &Walls, axis: usize, [lower, upper]: [f64; 2], side: f64) -> Self {
        let Some(span) = closed_span(walls, axis) else {
            let count = ((upper - lower) / side).floor() as usize + 2;
            return Line { start: lower, side, count, wraps: false, walls: [false; 2] };
        };
        let cells = (span / side).floor().max(1.0) as usize;
        let wraps = walls.sides[axis][0] == "periodic";
        let count = if wraps { cells } else { cells + 1 };
        Line { start: walls.lower[axis], side: span / cells as f64, count, wraps, walls: [!wraps; 2] }
    }

    /// The node below `place` (`upper` 0) or above it (1), and its share.
    fn near(&self, place: f64, upper: usize) -> (usize, f64) {
        let cells = if self.wraps { self.count } else { self.count - 1 };
        let along = ((place - self.start) / self.side).clamp(0.0, cells as f64);
        let below = (along.floor() as usize).min(cells.saturating_sub(1));
        let share = along - below as f64;
        ((below + upper) % self.count, if upper == 0 { 1.0 - share } else { share })
    }
}

/// Length of the box along `axis`, if neither side is open [length].
fn closed_span(walls: &Walls, axis: usize) -> Option<f64> {
    let span = walls.upper[axis] - walls.lower[axis];
    let is_closed = walls.sides[axis].iter().all(|kind| kind != "open");
    (is_closed && span.is_finite() && span > 0.0).then_some(span)
}

/// What a line of nodes has to cover [length].
fn longest(walls: &Walls, axis: usize, [lower, upper]: [f64; 2]) -> f64 {
    closed_span(walls, axis).unwrap_or(upper - lower)
}

/// `[axis]`: the least and the greatest place of all points [length].
fn extent(frame: &Frame, axes: usize) -> Option<Vec<[f64; 2]>> {
    let mut extent = vec![[f64::INFINITY, f64::NEG_INFINITY]; axes];
    for position in frame.positions.iter().filter(|position| position.iter().all(|x| x.is_finite())) {
        for (ends, place) in extent.iter_mut().zip(position) {
            let place = f64::from(*place);
            *ends = [ends[0].min(place), ends[1].max(place)];
        }
    }
    extent.iter().all(|[lower, upper]| lower <= upper).then_some(extent)
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
        assert!((f64::from(mean) - PI / 16.0).abs() < 0.002, "{mean}");
        assert!(found.detail >= LEAST_SIDE);
    }

    #[test]
    fn points_of_a_thinned_frame_stand_for_several_grains() {
        let frame = Frame { grains: 1200, ..lattice() };
        let found = volume_fractions(&frame, &walls(40.0, "wall"), &[1.0; 400]).unwrap();
        let mean = found.values.iter().sum::<f32>() / 400.0;
        assert!((f64::from(mean) - 3.0 * PI / 16.0).abs() < 0.04, "{mean}");
    }

    #[test]
    fn rows_of_grains_make_no_stripes() {
        // A column of four grains in one place for every corner of cells of side 2, as at rest in HSMC: ν = π/4.
        let frame = Frame {
            positions: lattice().positions.into_iter().flat_map(|place| [place; 4]).collect(),
            grains: 1600,
            ..Frame::default()
        };
        let found = volume_fractions(&frame, &walls(40.0, "wall"), &[1.0; 1600]).unwrap();
        // Counts in cells of side 3 would be of one row here and of two there.
        let worst = found.values.iter().map(|value| (f64::from(*value) - PI / 4.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.15, "{worst}");
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
