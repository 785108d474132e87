//! `heap`: the surface of a heap and the slope of its flanks (Müller 2001, section 3.5).

use std::collections::BTreeMap;

use super::layout::{self, Floor};
use super::measure::{Column, Figure, Measure, Profile, Snapshot};
use super::samples::figure;
use super::setting::Setting;
use super::units::{LENGTH, PURE, column};
use crate::matter::gas::Gas;
use crate::space::Vector;
use crate::statistics::{Estimate, StraightLine, straight_line};

/// Heights between which a flank counts as straight, in units of the largest.
const FLANK: std::ops::RangeInclusive<f64> = 0.2..=0.8;
/// Empty cells, one above the other, that part grains in flight from the heap below them.
const GAP: u32 = 2;

/// h(x), the highest grain in bins of one cell, and straight lines through its flanks.
///
/// Grains above a gap of two empty cells fly and do not count: the heap can be watched while it grows.
/// In 3D the bins are columns of cells, and the surface is the section through the highest
/// one along x, with the columns within one cell of it on either side.
#[derive(Clone, Copy, Debug)]
pub struct Heap {
    floor: Floor,
    /// The horizontal axis x.
    across: usize,
}

/// The surface along x.
struct Surface {
    /// Middles of the bins [length].
    positions: Vec<f64>,
    /// Heights h above the floor [length]; 0 where nothing lies.
    heights: Vec<f64>,
}

/// The flanks of a surface; slopes are positive when they fall away from the top.
struct Flanks {
    left: Option<Estimate>,
    right: Option<Estimate>,
    /// Largest h [length].
    height: f64,
}

impl Heap {
    /// The measure for `setting`, if grains fall on a floor and are poured there or can leave sideways.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        let floor = layout::floor(setting)?;
        let horizontal = || (0..V::DIMENSION).filter(|&axis| axis != floor.axis);
        let open = horizontal().find(|&axis| layout::has_open_side(setting, axis));
        if open.is_none() && !setting.is_poured {
            return None;
        }
        let walled = || horizontal().find(|&axis| !setting.boundary.is_periodic(axis));
        let across = open.or_else(walled).or_else(|| horizontal().next())?;
        Some(Heap { floor, across })
    }

    fn surface<V: Vector>(&self, gas: &Gas<V>) -> Surface {
        let grid = gas.grid();
        let columns = self.columns(gas);
        // In 2D there is no other horizontal axis, and its coordinate is 0 everywhere.
        let other = (0..3).find(|&axis| axis != self.floor.axis && axis != self.across).unwrap_or(2);
        let top = columns.iter().fold(
            (0.0, 0),
            |best, (place, &h)| {
                if h > best.0 { (h, place[other]) } else { best }
            },
        );
        let mut heights = vec![0.0_f64; grid.cells()[self.across] as usize];
        for (place, &h) in columns.iter().filter(|(place, _)| place[other].abs_diff(top.1) <= 1) {
            let bin = &mut heights[place[self.across] as usize];
            *bin = bin.max(h);
        }
        let middle = |bin: usize| grid.origin()[self.across] + (bin as f64 + 0.5) * grid.side()[self.across];
        Surface { positions: (0..heights.len()).map(middle).collect(), heights }
    }

    /// The highest grain that does not fly in every column of cells that holds one, by the
    /// coordinates of its lowest cell.
    fn columns<V: Vector>(&self, gas: &Gas<V>) -> BTreeMap<[u32; 3], f64> {
        let grid = gas.grid();
        let axis = self.floor.axis;
        let layers = grid.cells()[axis];
        // `[column]`: the first layer above the heap so far, and its highest grain.
        let mut columns: BTreeMap<[u32; 3], (u32, f64)> = BTreeMap::new();
        for layer in 0..layers {
            let coordinate = if self.floor.upwards > 0.0 { layer } else { layers - 1 - layer };
            for place in places_in_layer(grid.cells(), axis) {
                let mut cell = place;
                cell[axis] = coordinate;
                let rows = gas.rows(grid.cell_at(cell));
                let reached = columns.get(&place).map_or(0, |column| column.0);
                if rows.is_empty() || layer >= reached + GAP {
                    continue;
                }
                let positions = gas.positions()[rows].iter();
                let highest = positions.map(|&p| self.floor.height(p)).fold(0.0, f64::max);
                columns.insert(place, (layer + 1, highest));
            }
        }
        columns.into_iter().map(|(place, (_, height))| (place, height)).collect()
    }

    fn flanks<V: Vector>(&self, gas: &Gas<V>) -> Flanks {
        let Surface { positions, heights } = self.surface(gas);
        let (top, height) =
            heights.iter().enumerate().fold((0, 0.0), |best, (k, &h)| if h > best.1 { (k, h) } else { best });
        let line = |bins: std::ops::Range<usize>| -> Option<StraightLine> {
            let straight = bins.filter(|&k| FLANK.contains(&(heights[k] / height)));
            let (x, y): (Vec<f64>, Vec<f64>) = straight.map(|k| (positions[k], heights[k])).unzip();
            straight_line(&x, &y)
        };
        let falling = |line: StraightLine, sign: f64| Estimate {
            value: sign * line.slope,
            standard_error: line.slope_error,
        };
        Flanks {
            left: line(0..top).map(|line| falling(line, 1.0)),
            right: line(top + 1..heights.len()).map(|line| falling(line, -1.0)),
            height,
        }
    }
}

impl Flanks {
    /// Mean of both flanks, or the only one there is.
    fn slope(&self) -> Option<Estimate> {
        let (Some(left), Some(right)) = (self.left, self.right) else {
            return self.left.or(self.right);
        };
        let error = left.standard_error.zip(right.standard_error).map(|(a, b)| 0.5 * (a * a + b * b).sqrt());
        Some(Estimate { value: 0.5 * (left.value + right.value), standard_error: error })
    }
}

/// The coordinates of all cells in the lowest layer across `axis`.
fn places_in_layer(mut cells: [u32; 3], axis: usize) -> impl Iterator<Item = [u32; 3]> {
    cells[axis] = 1;
    let [x, y, z] = cells;
    (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])))
}

impl<V: Vector> Measure<V> for Heap {
    fn name(&self) -> &'static str {
        "heap"
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("heap_slope", PURE), column("heap_height", LENGTH)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let flanks = self.flanks(snapshot.gas);
        vec![flanks.slope().map_or(f64::NAN, |slope| slope.value), flanks.height]
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let Surface { positions, heights } = self.surface(snapshot.gas);
        vec![Profile {
            name: "heap-surface".to_owned(),
            time: snapshot.gas.time(),
            columns: vec![column("position", LENGTH), column("height", LENGTH)],
            values: vec![positions, heights],
        }]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, _from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let flanks = self.flanks(snapshot.gas);
        let height = Estimate { value: flanks.height, standard_error: None };
        let figures = vec![
            figure("heap_slope", flanks.slope()),
            figure("heap_slope_left", flanks.left),
            figure("heap_slope_right", flanks.right),
            figure("heap_height", Some(height)),
        ];
        (Vec::new(), figures)
    }
}

#[cfg(test)]
#[path = "heap_tests.rs"]
mod tests;
