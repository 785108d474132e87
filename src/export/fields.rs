//! Continuum fields on a grid: what ParaView draws as an image.

use super::moment::Moment;
use super::volume::Volume;
use crate::record::contents::within_rounding;

/// A grid of equal cells, numbered with the first axis fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldGrid {
    /// Lower corner [length].
    pub origin: [f64; 3],
    /// Upper corner [length].
    pub end: [f64; 3],
    /// Sides of a cell [length]; along an axis that does not exist, the depth of the box.
    pub spacing: [f64; 3],
    /// Cells along each axis; 1 beyond D.
    pub cells: [usize; 3],
    /// D.
    pub dimension: usize,
}

/// Fields at one time, from wherever they come.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Simulated time [time].
    pub time: f64,
    /// The cells.
    pub grid: FieldGrid,
    /// The fields.
    pub fields: Vec<Field>,
    /// Whether their numbers have single precision.
    pub is_single: bool,
    /// What else is to be said.
    pub remark: Option<String>,
}

/// One field.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name, in snake case.
    pub name: String,
    /// Numbers for each cell: 1 or 3.
    pub components: usize,
    /// `[cell][component]`; NaN where it is not defined.
    pub values: Vec<f64>,
}

/// The most cells of a grid of fields.
pub const MOST_CELLS: usize = 1 << 24;

impl FieldGrid {
    /// The box `volume` in cells whose sides are as near to `side` [length] as whole cells allow; `None` where there
    /// would be more than [`MOST_CELLS`].
    pub fn new(volume: &Volume, side: f64) -> Option<Self> {
        let mut cells = [1; 3];
        for (axis, cells) in cells.iter_mut().enumerate().take(volume.dimension) {
            *cells = (volume.length(axis) / side).round().clamp(1.0, 1e9) as usize;
        }
        let total = cells.iter().try_fold(1_usize, |product, &count| product.checked_mul(count))?;
        (total <= MOST_CELLS).then(|| FieldGrid::of_cells(volume, cells))
    }

    /// The box `volume` in `cells`.
    pub fn of_cells(volume: &Volume, cells: [usize; 3]) -> Self {
        FieldGrid {
            origin: volume.lower,
            end: volume.upper,
            spacing: std::array::from_fn(|axis| volume.length(axis) / cells[axis] as f64),
            cells,
            dimension: volume.dimension,
        }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cells.iter().product()
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Volume (2D: area) of a cell [lengthᴰ].
    pub fn cell_volume(&self) -> f64 {
        self.spacing[..self.dimension].iter().product()
    }

    /// The cell that holds `position`; `None` outside of the box. A position on its upper side belongs to the last cell, and
    /// so does one that `is_single` and beyond that side by no more than its rounding.
    fn cell_of(&self, position: [f64; 3], is_single: bool) -> Option<usize> {
        let mut cell = 0;
        for axis in (0..self.dimension).rev() {
            let (lower, upper) = (self.origin[axis], self.end[axis]);
            let place = match is_single {
                true => within_rounding(position[axis], lower, upper),
                false => position[axis],
            };
            // Not the number of the cell: the division rounds, too.
            if !(lower..=upper).contains(&place) {
                return None;
            }
            let along = ((place - lower) / self.spacing[axis]) as usize;
            cell = cell * self.cells[axis] + along.min(self.cells[axis] - 1);
        }
        Some(cell)
    }
}

/// Sums over the grains of a cell.
#[derive(Clone, Copy, Default)]
struct Sums {
    grains: f64,
    volume: f64,
    mass: f64,
    momentum: [f64; 3],
    /// Σ m|v − v̄|².
    agitation: f64,
}

/// The fields of `moment` on `grid`: `number_density` [1/lengthᴰ], `volume_fraction`, `velocity` of the centre of mass
/// [length/time] and granular `temperature` Σ m|v − v̄|²/(D(n − 1)) [mass·length²/time²].
///
/// A thinned moment counts each grain for as many as it stands for. Velocities need a grain, temperatures two.
pub fn fields_of(moment: &Moment, grid: FieldGrid) -> Fields {
    let mut cells = vec![Sums::default(); grid.len()];
    let places: Vec<Option<usize>> =
        moment.positions.iter().map(|&position| grid.cell_of(position, moment.is_single)).collect();
    let within = || places.iter().enumerate().filter_map(|(row, place)| Some((row, (*place)?)));
    for (row, cell) in within() {
        let (sums, mass) = (&mut cells[cell], moment.masses[row]);
        sums.grains += 1.0;
        sums.volume += ball(moment.radii[row], grid.dimension);
        sums.mass += mass;
        sums.momentum.iter_mut().zip(moment.velocities[row]).for_each(|(sum, v)| *sum += mass * v);
    }
    for (row, cell) in within() {
        let sums = &mut cells[cell];
        let mean = sums.momentum.map(|momentum| momentum / sums.mass);
        let squares: f64 = moment.velocities[row].iter().zip(mean).map(|(v, mean)| (v - mean).powi(2)).sum();
        sums.agitation += moment.masses[row] * squares;
    }
    let stands_for = if moment.is_thinned() { moment.grains as f64 / moment.len() as f64 } else { 1.0 };
    let density = stands_for / grid.cell_volume();
    let scalar = |name: &str, of: &dyn Fn(&Sums) -> f64| field(name, 1, cells.iter().map(of).collect());
    let degrees = |sums: &Sums| grid.dimension as f64 * (sums.grains - 1.0);
    let velocity = cells.iter().flat_map(|sums| sums.momentum.map(|momentum| momentum / sums.mass)).collect();
    let fields = vec![
        scalar("number_density", &|sums| sums.grains * density),
        scalar("volume_fraction", &|sums| sums.volume * density),
        field("velocity", 3, velocity),
        scalar("temperature", &|sums| {
            if sums.grains < 2.0 { f64::NAN } else { sums.agitation / degrees(sums) }
        }),
    ];
    Fields { time: moment.time, grid, fields, is_single: moment.is_single, remark: moment.remark() }
}

fn field(name: &str, components: usize, values: Vec<f64>) -> Field {
    Field { name: name.to_owned(), components, values }
}

/// Area of a disk, volume of a sphere [lengthᴰ].
fn ball(radius: f64, dimension: usize) -> f64 {
    use std::f64::consts::PI;
    if dimension == 2 { PI * radius * radius } else { 4.0 / 3.0 * PI * radius.powi(3) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment() -> Moment {
        Moment {
            grains: 3,
            ids: vec![0, 1, 2],
            species: vec![0; 3],
            radii: vec![0.5; 3],
            masses: vec![2.0; 3],
            positions: vec![[0.5, 0.5, 0.0], [1.5, 1.0, 0.0], [4.0, 2.0, 0.0]],
            velocities: vec![[1.0, 3.0, 0.0], [3.0, 3.0, 0.0], [5.0, 0.0, 0.0]],
            ..Moment::default()
        }
    }

    fn grid() -> FieldGrid {
        let volume =
            Volume { lower: [0.0, 0.0, -0.5], upper: [4.0, 2.0, 0.5], periodic: [false; 3], dimension: 2 };
        FieldGrid::new(&volume, 2.1).unwrap()
    }

    #[test]
    fn a_cell_has_the_density_velocity_and_temperature_of_its_grains() {
        let fields = fields_of(&moment(), grid());
        assert_eq!(fields.grid.cells, [2, 1, 1]);
        let values = |name: &str| &fields.fields.iter().find(|field| field.name == name).unwrap().values;
        assert_eq!(values("number_density"), &[0.5, 0.25]);
        assert_eq!(values("velocity"), &[2.0, 3.0, 0.0, 5.0, 0.0, 0.0]);
        // 2 (1 + 1)/(2 · 1).
        assert_eq!(values("temperature")[0], 2.0);
        assert!(values("temperature")[1].is_nan());
        assert!((values("volume_fraction")[0] - std::f64::consts::PI / 8.0).abs() < 1e-15);
    }

    #[test]
    fn a_thinned_moment_keeps_its_density() {
        let fields = fields_of(&Moment { grains: 30, ..moment() }, grid());
        assert_eq!(fields.fields[0].values, [5.0, 2.5]);
        assert_eq!(fields.remark.as_deref(), Some("thinned: 3 of 30 grains"));
    }

    #[test]
    fn a_place_that_rounding_put_outside_belongs_to_the_last_cell() {
        // 0.6 as f32 is 0.60000002; the sides of 7 cells of a box of 0.6 do not add up to it either.
        let volume =
            Volume { lower: [-0.1, 0.0, -0.5], upper: [4.0, 0.6, 0.5], periodic: [false; 3], dimension: 2 };
        let grid = FieldGrid::of_cells(&volume, [1, 7, 1]);
        let rounded = |x: f64, y: f64| [f64::from(x as f32), f64::from(y as f32), 0.0];
        let rounded_out = rounded(-0.1, 0.6);
        assert!(rounded_out[0] < -0.1 && rounded_out[1] > 0.6);
        assert_eq!(grid.cell_of(rounded_out, true), Some(6));
        assert_eq!(grid.cell_of(rounded_out, false), None);
        assert_eq!(grid.cell_of([4.0, 0.6, 0.0], false), Some(6));
        // One step of single precision farther out is outside.
        let next = f64::from((0.6_f32).next_up());
        assert_eq!(grid.cell_of([1.0, next, 0.0], true), None);
    }

    #[test]
    fn what_lies_outside_counts_nowhere() {
        let mut moment = moment();
        moment.positions[0] = [-0.1, 0.5, 0.0];
        moment.positions[1][1] = f64::NAN;
        assert_eq!(fields_of(&moment, grid()).fields[0].values, [0.0, 0.25]);
    }
}
