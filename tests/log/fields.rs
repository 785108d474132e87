//! Fields in a log, beside what grains that were put by hand should show.

use glam::{DVec2, DVec3};
use grainflow::engine::cell_counts::CellCount;
use grainflow::matter::clock::Clock;
use grainflow::matter::columns::Columns;
use grainflow::matter::gas::Gas;
use grainflow::matter::grain::Grain;
use grainflow::matter::grid::Grid;
use grainflow::observe::field::{Quantity, field};
use grainflow::record::reader::read_log;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::space::Vector;

use super::folder;
use super::sample::header;

/// What a cell should show, by another way: grains are looked for by their places.
fn expected_field<V: Vector>(
    quantity: Quantity,
    grid: &Grid<V>,
    grains: &Columns<V>,
    mass: f64,
) -> Vec<Vec<f32>> {
    let mut values = vec![Vec::new(); quantity.components(V::DIMENSION).len()];
    for cell in 0..grid.number_of_cells() as u32 {
        let inside = |row: &usize| {
            let away = grains.positions[*row] - grid.centre(cell);
            (0..V::DIMENSION).all(|axis| {
                let half = 0.5 * grid.side()[axis];
                away[axis] >= -half && away[axis] < half
            })
        };
        let rows: Vec<usize> = (0..grains.len()).filter(inside).collect();
        let number = rows.len() as f64;
        let mean = rows.iter().fold(V::ZERO, |sum, &row| sum + grains.velocities[row]) * (1.0 / number);
        let squares: f64 = rows.iter().map(|&row| (grains.velocities[row] - mean).length_squared()).sum();
        match quantity {
            Quantity::Density => {
                values[0].push((number * V::sphere_volume(1.0) / grid.cell_volume()) as f32);
            }
            Quantity::Velocity => (0..V::DIMENSION).for_each(|axis| values[axis].push(mean[axis] as f32)),
            Quantity::Temperature => values[0].push((mass * squares / number / V::DIMENSION as f64) as f32),
            _ => unreachable!("the others are counted"),
        }
    }
    values
}

/// Writes fields of placed grains, one of them in a cell of its own, and reads them back.
fn fields_are_exact<V: Vector>(cells: [u32; 3]) {
    let grid: Grid<V> = Grid::new(V::ZERO, V::from_fn(|_| 8.0), &cells, &[true, false, true]);
    let mut grains = Columns::default();
    // Quarters and whole numbers: sums are exact. Nobody is in the cells of large x.
    for id in 0..90_u32 {
        let place = |axis: usize| f64::from((id * [5, 11, 7][axis] + axis as u32) % 32) / 4.0;
        let position = V::from_fn(|axis| if axis == 0 { place(0) * 0.5 } else { place(axis) });
        grains.positions.push(position);
        grains.velocities.push(V::from_fn(|axis| f64::from((id * [3, 5, 13][axis]) % 8)));
        grains.ids.push(id);
    }
    grains.positions[0] = V::from_fn(|_| 7.75);
    let grain = Grain { diameter: 1.0, mass: 2.0 };
    let time = 0.1 + 0.2;
    let gas = Gas::restored(grid.clone(), grain, grains.clone(), Clock::restored(time, 0.0), 90);
    let counts: Vec<CellCount> = (0..grid.number_of_cells() as u64)
        .map(|cell| CellCount { collisions: cell, attempts: 3 * cell, bound: 0.5 * cell as f64 })
        .collect();
    let written = Quantity::ALL.map(|quantity| field(quantity, &gas, &counts));
    let folder = folder();
    let path = folder.path().join("log.mcap");
    let header = LogHeader { fields: (Quantity::ALL.to_vec(), V::DIMENSION), ..header() };
    let mut log = LogWriter::create(&path, &header).unwrap();
    let recording = Recording {
        values: &[time, 0.0, 0.0],
        state_hash: "",
        grains: 90,
        profiles: &[],
        frame: None,
        fields: &written,
    };
    log.recording(&recording).unwrap();
    log.finish().unwrap();
    let log = read_log(&path).unwrap();
    assert!(log.frames.is_empty() && log.fields.len() == 6);
    let near = |a: f32, b: f32| (a.is_nan() && b.is_nan()) || (a - b).abs() <= 2.0 * f32::EPSILON * b.abs();
    for (quantity, read) in Quantity::ALL.into_iter().zip(&log.fields) {
        assert_eq!((read.name.as_str(), read.time), (quantity.name(), time));
        assert_eq!((read.cells, read.components.clone()), (cells, quantity.components(V::DIMENSION)));
        assert!(
            (0..3).all(|axis| read.side[axis] == if axis < V::DIMENSION { grid.side()[axis] } else { 0.0 })
        );
        let values = match quantity {
            Quantity::Collisions => vec![counts.iter().map(|count| count.collisions as f32).collect()],
            Quantity::Attempts => vec![counts.iter().map(|count| count.attempts as f32).collect()],
            Quantity::Bound => vec![counts.iter().map(|count| count.bound as f32).collect()],
            other => expected_field(other, &grid, &grains, 2.0),
        };
        let pairs = read.values.iter().flatten().zip(values.iter().flatten());
        assert_eq!(values.iter().flatten().count(), read.values.iter().flatten().count());
        assert!(pairs.clone().all(|(&a, &b)| near(a, b)), "{}: {:?} {values:?}", read.name, read.values);
        let empty = pairs.filter(|(a, _)| a.is_nan()).count();
        assert_eq!(empty > 0, matches!(quantity, Quantity::Velocity | Quantity::Temperature));
    }
}

#[test]
fn fields_in_the_log_are_those_of_the_grains() {
    fields_are_exact::<DVec2>([4, 2, 1]);
    fields_are_exact::<DVec3>([4, 2, 3]);
}
