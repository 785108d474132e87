//! Places for the engines that know cells only: independent ones, and equal counts per cell.

use super::super::model::{InitialPositions, Scenario};
use crate::matter::grid::Grid;
use crate::random::{Phase, Stream, Streams};
use crate::space::Vector;

/// Above this share of the capacity all cells start with equal numbers.
const CROWDED: f64 = 0.9;

/// Cells that begin with more grains than make them full; `None` where only the places tell.
pub(in crate::scenario) fn cells_above_capacity<V: Vector>(scenario: &Scenario<V>) -> Option<usize> {
    let Some(capacity) = scenario.capacity() else { return Some(0) };
    let grid = scenario.grid();
    match scenario.initial.positions {
        InitialPositions::Log(_) => None,
        InitialPositions::Random if !is_crowded(scenario, &grid, capacity) => Some(0),
        InitialPositions::Compressed => None,
        _ => Some(even_counts(scenario, &grid).into_iter().filter(|&count| count > capacity).count()),
    }
}

/// Whether so much of the room is taken that places are not drawn again but shared out.
fn is_crowded<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>, capacity: u32) -> bool {
    let room = f64::from(capacity) * scenario.size.product() / grid.cell_volume();
    f64::from(scenario.count) > CROWDED * room
}

/// Independent places `[id]`; with a capacity, a grain whose cell is full is drawn again.
pub(super) fn random_positions<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>) -> Vec<V> {
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
pub(super) fn even_positions<V: Vector>(scenario: &Scenario<V>, grid: &Grid<V>) -> Vec<V> {
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
        let mut ranking: Vec<(f64, u32)> = (0..cells as u32)
            .map(|cell| (evenness::<V>(grid.coordinates(cell)) / share(cell).fract(), cell))
            .collect();
        ranking.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, cell) in ranking.into_iter().take(remainder) {
            counts[cell as usize] += 1;
        }
    }
    counts
}

/// A number in (0, 1] for each cell or site of a lattice, such that those below any threshold are spread evenly
/// (the additive recurrence of the plastic number and its kin; Roberts 2018).
pub(super) fn evenness<V: Vector>(coordinates: [u32; 3]) -> f64 {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2];
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
