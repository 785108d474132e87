//! Fields: a quantity in every cell at one time.

use rayon::prelude::*;

use super::measure::Column;
use super::units::{ENERGY, PURE, VELOCITY, column};
use crate::engine::cell_counts::CellCount;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Cells a thread looks at, at a time.
const SPAN: usize = 1024;
/// Names of the components of a velocity, as in a picture of the grains.
const VELOCITIES: [&str; 3] = ["vx", "vy", "vz"];

/// What a field may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// ν: volume of the grains whose centres are in the cell, over that of the cell.
    Density,
    /// v̄: velocity of the centre of mass of the cell's grains [length/time]; NaN without grains.
    Velocity,
    /// Granular temperature Σ m|v − v̄|²/(D N) of the cell's N grains [mass·length²/time²]; NaN without grains.
    Temperature,
    /// Collisions of pairs since the last recording of fields.
    Collisions,
    /// Candidate pairs that were looked at since the last recording of fields.
    Attempts,
    /// The bound on relative speeds that the last step drew candidate pairs with [length/time].
    Bound,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Quantity; 6] = [
        Quantity::Density,
        Quantity::Velocity,
        Quantity::Temperature,
        Quantity::Collisions,
        Quantity::Attempts,
        Quantity::Bound,
    ];

    /// The name used in scenarios and logs.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Density => "density",
            Quantity::Velocity => "velocity",
            Quantity::Temperature => "temperature",
            Quantity::Collisions => "collisions",
            Quantity::Attempts => "attempts",
            Quantity::Bound => "bound",
        }
    }

    /// Whether an engine has to count for it.
    pub fn is_counted(self) -> bool {
        matches!(self, Quantity::Collisions) || self.is_of_candidates()
    }

    /// Whether only engines that draw candidate pairs have it.
    pub fn is_of_candidates(self) -> bool {
        matches!(self, Quantity::Attempts | Quantity::Bound)
    }

    /// Its components with their units, in a space of that dimension.
    pub fn components(self, dimension: usize) -> Vec<Column> {
        match self {
            Quantity::Velocity => VELOCITIES[..dimension].iter().map(|name| column(name, VELOCITY)).collect(),
            Quantity::Temperature => vec![column(self.name(), ENERGY)],
            Quantity::Bound => vec![column(self.name(), VELOCITY)],
            Quantity::Density | Quantity::Collisions | Quantity::Attempts => vec![column(self.name(), PURE)],
        }
    }
}

/// A quantity in every cell at one time, at the precision of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// What it shows: the name of a [`Quantity`].
    pub name: String,
    /// When [time].
    pub time: f64,
    /// Lower corner of the first cell [length]; z = 0 in 2D.
    pub origin: [f64; 3],
    /// Sides of a cell [length]; z = 0 in 2D.
    pub side: [f64; 3],
    /// Cells along each axis; one along z in 2D.
    pub cells: [u32; 3],
    /// Names and units of the components.
    pub components: Vec<Column>,
    /// `[component][cell]`, the first axis fastest.
    pub values: Vec<Vec<f32>>,
}

/// `quantity` in the cells of `gas`, in which `counts` `[cell]` were counted.
pub fn field<V: Vector>(quantity: Quantity, gas: &Gas<V>, counts: &[CellCount]) -> Field {
    let grid = gas.grid();
    let counted =
        |value: fn(&CellCount) -> f64| vec![counts.iter().map(|count| value(count) as f32).collect()];
    let in_cells = |value: &(dyn Fn(u32) -> f64 + Sync)| -> Vec<f32> {
        let cells = (0..grid.number_of_cells() as u32).into_par_iter().with_min_len(SPAN);
        cells.map(|cell| value(cell) as f32).collect()
    };
    let values = match quantity {
        Quantity::Density => vec![in_cells(&|cell| volume_fraction(gas, cell))],
        Quantity::Velocity => {
            (0..V::DIMENSION).map(|axis| in_cells(&|cell| mean_velocity(gas, cell)[axis])).collect()
        }
        Quantity::Temperature => vec![in_cells(&|cell| temperature(gas, cell))],
        Quantity::Collisions => counted(|count| count.collisions as f64),
        Quantity::Attempts => counted(|count| count.attempts as f64),
        Quantity::Bound => counted(|count| count.bound),
    };
    let (mut origin, mut side) = ([0.0; 3], [0.0; 3]);
    for axis in 0..V::DIMENSION {
        (origin[axis], side[axis]) = (grid.origin()[axis], grid.side()[axis]);
    }
    Field {
        name: quantity.name().to_owned(),
        time: gas.time(),
        origin,
        side,
        cells: grid.cells(),
        components: quantity.components(V::DIMENSION),
        values,
    }
}

fn volume_fraction<V: Vector>(gas: &Gas<V>, cell: u32) -> f64 {
    let volume = match gas.species.is_empty() {
        true => f64::from(gas.occupancy(cell)) * gas.grain.volume::<V>(),
        false => gas.rows(cell).map(|row| gas.grain_at(row).volume::<V>()).sum(),
    };
    volume / gas.grid().cell_volume()
}

/// NaN without grains.
fn mean_velocity<V: Vector>(gas: &Gas<V>, cell: u32) -> V {
    let (mut momentum, mut mass) = (V::ZERO, 0.0);
    for row in gas.rows(cell) {
        let grain = gas.grain_at(row).mass;
        momentum += gas.velocities()[row] * grain;
        mass += grain;
    }
    V::from_fn(|axis| momentum[axis] / mass)
}

/// NaN without grains.
fn temperature<V: Vector>(gas: &Gas<V>, cell: u32) -> f64 {
    let mean = mean_velocity(gas, cell);
    let square = |row: usize| (gas.velocities()[row] - mean).length_squared() * gas.grain_at(row).mass;
    let squares: f64 = gas.rows(cell).map(square).sum();
    squares / (V::DIMENSION as f64 * f64::from(gas.occupancy(cell)))
}
