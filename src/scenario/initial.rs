//! Builds the gas that a scenario begins with.
//!
//! Every grain draws from a stream of its own, named by seed and identity.

use super::model::{InitialPositions, InitialVelocities, Scenario};
use crate::matter::clock::Clock;
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::random::{Phase, Stream, Streams};
use crate::space::Vector;

/// Above this share of the capacity all cells start with equal numbers.
const CROWDED: f64 = 0.9;

/// Why a gas cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InitialError {
    /// The scenario starts from a log, and nobody read it.
    #[error("initial.positions names the log {0}, whose last state has to be read first")]
    LogNotRead(String),
    /// The log holds another number of grains.
    #[error(
        "initial.positions: the log's last state holds {found} grains, the scenario says {expected}; \
         set particles.count = {found}"
    )]
    Count {
        /// Grains in the log.
        found: usize,
        /// Grains in the scenario.
        expected: u32,
    },
    /// A grain of the log lies outside, or is not finite.
    #[error(
        "initial.positions: grain {id} of the log lies outside the box, or is not finite; use the log's domain.size"
    )]
    Outside {
        /// Its identity.
        id: u32,
    },
}

/// The gas that `scenario` begins with, before any equilibration. Where it starts from a log,
/// `saved` are the columns of that log's last state; otherwise they are not used.
pub fn build<V: Vector>(scenario: &Scenario<V>, saved: Option<Columns<V>>) -> Result<Gas<V>, InitialError> {
    let grid = scenario.grid();
    let positions = match &scenario.initial.positions {
        InitialPositions::Random => random_positions(scenario, &grid),
        InitialPositions::Lattice => even_positions(scenario, &grid),
        InitialPositions::Log(path) => {
            let saved = saved.ok_or_else(|| InitialError::LogNotRead(path.display().to_string()))?;
            return from_log(scenario, grid, saved);
        }
    };
    Ok(Gas::new(grid, scenario.grain, positions, velocities(scenario)))
}

/// Cells that begin with more grains than make them full; `None` where that stands in a log.
pub(super) fn cells_above_capacity<V: Vector>(scenario: &Scenario<V>) -> Option<usize> {
    let Some(capacity) = scenario.capacity() else { return Some(0) };
    let grid = scenario.grid();
    match scenario.initial.positions {
        InitialPositions::Log(_) => None,
        InitialPositions::Random if !is_crowded(scenario, &grid, capacity) => Some(0),
        _ => Some(even_counts(scenario, &grid).into_iter().filter(|&count| count > capacity).count()),
    }
}

/// Whether so much of the room is taken that places are not drawn again but shared out.
fn is_crowded<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>, capacity: u32) -> bool {
    let room = f64::from(capacity) * scenario.size.product() / grid.cell_volume();
    f64::from(scenario.count) > CROWDED * room
}

/// Gives `velocities` zero total momentum and exactly `temperature` = m⟨v²⟩/D of grains of `mass`.
///
/// A single grain keeps its direction: without momentum it would have no temperature.
/// Grains at rest stay at rest.
pub fn set_temperature<V: Vector>(velocities: &mut [V], mass: f64, temperature: f64) {
    let number = velocities.len() as f64;
    if velocities.len() > 1 {
        let mean =
            V::from_fn(|axis| compensated_sum(velocities.iter().map(|velocity| velocity[axis])) / number);
        for velocity in velocities.iter_mut() {
            *velocity -= mean;
        }
    }
    let mean_square = compensated_sum(velocities.iter().map(|velocity| velocity.length_squared()))
        / (number * V::DIMENSION as f64);
    if mean_square > 0.0 {
        let factor = (temperature / mass / mean_square).sqrt();
        for velocity in velocities.iter_mut() {
            *velocity = *velocity * factor;
        }
    }
}

/// Brings `gas` to rest as a whole and to `temperature` [mass·length²/time²]: see [`set_temperature`].
pub fn rescale<V: Vector>(gas: &mut Gas<V>, temperature: f64) {
    let mass = gas.grain.mass;
    set_temperature(gas.velocities_mut(), mass, temperature);
}

/// The temperature that a scenario states: T, m w²/3 for uniform velocities, 0 at rest.
pub fn stated_temperature<V: Vector>(scenario: &Scenario<V>) -> f64 {
    match scenario.initial.velocities {
        InitialVelocities::Maxwell(temperature) => temperature,
        InitialVelocities::Uniform(w) => scenario.grain.mass * w * w / 3.0,
        InitialVelocities::Rest => 0.0,
    }
}

/// Velocities `[id]` of the stated kind, momentum zero and temperature exact.
fn velocities<V: Vector>(scenario: &Scenario<V>) -> Vec<V> {
    let streams = Streams::new(scenario.seed).at(0, Phase::InitialVelocities);
    let draw = |component: fn(&mut Stream) -> f64| -> Vec<V> {
        let one = |id| {
            let mut random = streams.stream(id);
            V::from_fn(|_| component(&mut random))
        };
        (0..u64::from(scenario.count)).map(one).collect()
    };
    let mut velocities = match scenario.initial.velocities {
        InitialVelocities::Maxwell(_) => draw(Stream::gaussian),
        InitialVelocities::Uniform(_) => draw(Stream::symmetric),
        InitialVelocities::Rest => return vec![V::ZERO; scenario.count as usize],
    };
    set_temperature(&mut velocities, scenario.grain.mass, stated_temperature(scenario));
    velocities
}

/// Independent places `[id]`; with a capacity, a grain whose cell is full is drawn again.
fn random_positions<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>) -> Vec<V> {
    let streams = Streams::new(scenario.seed).at(0, Phase::InitialPositions);
    let Some(capacity) = scenario.capacity() else {
        let place = |id| place_in(V::ZERO, scenario.size, &mut streams.stream(id));
        return (0..u64::from(scenario.count)).map(place).collect();
    };
    if is_crowded(scenario, grid, capacity) {
        return even_positions(scenario, grid);
    }
    let mut occupancy = vec![0_u32; grid.number_of_cells()];
    let place = |id| {
        let mut random = streams.stream(id);
        loop {
            // Less than 0.9 of the places are taken: a few draws find one.
            let position = place_in(V::ZERO, scenario.size, &mut random);
            let occupancy = &mut occupancy[grid.cell_of(position) as usize];
            if *occupancy < capacity {
                *occupancy += 1;
                return position;
            }
        }
    };
    (0..u64::from(scenario.count)).map(place).collect()
}

/// Places `[id]` with counts per cell that differ by at most one, and are random inside a cell.
fn even_positions<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>) -> Vec<V> {
    let streams = Streams::new(scenario.seed).at(0, Phase::InitialPositions);
    let mut positions = Vec::with_capacity(scenario.count as usize);
    for (cell, count) in even_counts(scenario, grid).into_iter().enumerate() {
        let (low, high) = part_in_domain(scenario, grid, cell as u32);
        for _ in 0..count {
            let mut random = streams.stream(positions.len() as u64);
            positions.push(loop {
                let position = place_in(low, high - low, &mut random);
                // Rounding may put a place on the far edge, which is the next cell's.
                let below = (0..V::DIMENSION).all(|axis| position[axis] < high[axis]);
                if below && grid.cell_of(position) == cell as u32 {
                    break position;
                }
            });
        }
    }
    positions
}

/// Grains per cell `[cell]`: equal shares of the domain, the remainder spread evenly.
fn even_counts<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>) -> Vec<u32> {
    let cells = grid.number_of_cells();
    let extended = scenario.grid_size != scenario.size;
    let share = |cell: u32| {
        if !extended {
            return f64::from(scenario.count) / cells as f64;
        }
        // A vibrating wall extends the grid: cells at it lie partly outside the domain.
        let (low, high) = part_in_domain(scenario, grid, cell);
        let part = V::from_fn(|axis| (high[axis] - low[axis]).max(0.0)).product();
        f64::from(scenario.count) * part / scenario.size.product()
    };
    let mut counts: Vec<u32> = (0..cells as u32).map(|cell| share(cell) as u32).collect();
    let placed: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    let remainder = u64::from(scenario.count).saturating_sub(placed) as usize;
    if remainder > 0 {
        let mut ranking: Vec<(f64, u32)> =
            (0..cells as u32).map(|cell| (evenness(grid, cell) / share(cell).fract(), cell)).collect();
        ranking.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, cell) in ranking.into_iter().take(remainder) {
            counts[cell as usize] += 1;
        }
    }
    counts
}

/// A number in (0, 1] for each cell, such that the cells below any threshold are spread evenly
/// (the additive recurrence of the plastic number and its kin; Roberts 2018).
fn evenness<V: Vector>(grid: &Grid<V>, cell: u32) -> f64 {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2];
    let coordinates = grid.coordinates(cell);
    let sum: f64 = (0..V::DIMENSION).map(|axis| f64::from(coordinates[axis]) * STEPS[axis]).sum();
    1.0 - sum.fract()
}

/// The part of `cell` that lies in the domain: its lower and upper corner.
fn part_in_domain<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>, cell: u32) -> (V, V) {
    let centre = grid.centre(cell);
    let half = grid.side() * 0.5;
    let low = V::from_fn(|axis| (centre[axis] - half[axis]).max(0.0));
    let high = V::from_fn(|axis| (centre[axis] + half[axis]).min(scenario.size[axis]));
    (low, high)
}

/// A random place in the box of `size` with its lower corner at `low`.
fn place_in<V: Vector>(low: V, size: V, random: &mut Stream) -> V {
    V::from_fn(|axis| low[axis] + random.uniform() * size[axis])
}

fn from_log<V: Vector>(
    scenario: &Scenario<V>,
    grid: Grid<V>,
    saved: Columns<V>,
) -> Result<Gas<V>, InitialError> {
    if saved.len() != scenario.count as usize {
        return Err(InitialError::Count { found: saved.len(), expected: scenario.count });
    }
    for (row, &id) in saved.ids.iter().enumerate() {
        let position = saved.positions[row];
        let inside = |axis: usize| (grid.origin()[axis]..=grid.end()[axis]).contains(&position[axis]);
        if !(0..V::DIMENSION).all(inside) || !saved.velocities[row].is_finite() {
            return Err(InitialError::Outside { id });
        }
    }
    let next_id = saved.ids.iter().max().map_or(0, |&id| id + 1);
    Ok(Gas::restored(grid, scenario.grain, saved, Clock::default(), next_id))
}

/// A sum whose rounding does not grow with the number of terms (Neumaier 1974).
fn compensated_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}

#[cfg(test)]
mod tests;
