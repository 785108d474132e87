//! Who gets into a cell: two copies of an exact gas, a step apart.

use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::report::calibration::Entry;
use crate::space::Vector;
use crate::statistics::{Estimate, standard_error};

/// The fewest attempts behind a value of p(ν).
const FEWEST_ATTEMPTS: u64 = 400;
/// No cell: a grain that is not there any more, or would leave the box.
const NOWHERE: u32 = u32::MAX;

/// A gas before a step.
#[derive(Clone, Debug)]
pub(super) struct Before<V: Vector> {
    columns: Columns<V>,
    time: f64,
}

/// Entries by the number of grains that a cell held before the step, `[grains]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Entries {
    counts: Vec<Counts>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Counts {
    attempts: u64,
    entered: u64,
    arrivals: u64,
}

impl Counts {
    fn add(&mut self, other: Counts) {
        self.attempts += other.attempts;
        self.entered += other.entered;
        self.arrivals += other.arrivals;
    }
}

impl<V: Vector> Before<V> {
    pub(super) fn of(gas: &Gas<V>) -> Self {
        Before { columns: gas.columns().clone(), time: gas.time() }
    }

    /// Counts who has got from one cell of `grid` into another, and who would have without the others; `after` is the
    /// same gas later. Flights that lead out of the box, where a wall is met or a side is open, are no attempts.
    pub(super) fn count(&self, after: &Gas<V>, grid: &Grid<V>, gravity: V, entries: &mut Entries) {
        let duration = after.time() - self.time;
        let mut occupancy = vec![0_u32; grid.number_of_cells()];
        let cells: Vec<u32> = self.columns.positions.iter().map(|&place| grid.cell_of(place)).collect();
        cells.iter().for_each(|&cell| occupancy[cell as usize] += 1);
        let mut cells_after = vec![NOWHERE; after.next_id() as usize];
        for (&id, &place) in after.ids().iter().zip(after.positions()) {
            cells_after[id as usize] = grid.cell_of(place);
        }
        for (row, &cell) in cells.iter().enumerate() {
            let now = cells_after[self.columns.ids[row] as usize];
            let way = self.columns.velocities[row] * duration + gravity * (0.5 * duration * duration);
            let wanted = cell_inside(grid, self.columns.positions[row] + way);
            if wanted != NOWHERE && wanted != cell {
                let counts = entries.of(occupancy[wanted as usize]);
                counts.attempts += 1;
                counts.entered += u64::from(now == wanted);
            }
            if now != NOWHERE && now != cell {
                entries.of(occupancy[now as usize]).arrivals += 1;
            }
        }
    }
}

/// The cell at `place`, which may be outside.
fn cell_inside<V: Vector>(grid: &Grid<V>, place: V) -> u32 {
    let place = grid.wrapped(place);
    let is_inside = (0..V::DIMENSION).all(|a| place[a] >= grid.origin()[a] && place[a] < grid.end()[a]);
    if is_inside { grid.cell_of(place) } else { NOWHERE }
}

impl Entries {
    fn of(&mut self, grains: u32) -> &mut Counts {
        let grains = grains as usize;
        if self.counts.len() <= grains {
            self.counts.resize(grains + 1, Counts::default());
        }
        &mut self.counts[grains]
    }

    fn sum(&self, grains: impl Iterator<Item = usize>) -> Counts {
        let mut sum = Counts::default();
        grains.filter_map(|grains| self.counts.get(grains)).for_each(|counts| sum.add(*counts));
        sum
    }
}

/// p(ν) from the entries of all runs; a grain makes up `grain_share` of the volume of a cell. Numbers of grains with
/// few attempts are taken together. The error is that of independent attempts, or what the runs scatter by where that
/// is more.
pub(super) fn curve(replicas: &[Entries], grain_share: f64) -> Vec<Entry> {
    let longest = replicas.iter().map(|entries| entries.counts.len()).max().unwrap_or(0);
    let all = |grains: usize| {
        let mut sum = Counts::default();
        replicas.iter().for_each(|entries| sum.add(entries.sum(grains..=grains)));
        sum
    };
    let mut spans: Vec<[usize; 2]> = Vec::new();
    let (mut first, mut attempts) = (0, 0);
    for grains in 0..longest {
        attempts += all(grains).attempts;
        if attempts >= FEWEST_ATTEMPTS {
            spans.push([first, grains + 1]);
            (first, attempts) = (grains + 1, 0);
        }
    }
    let entry = |&[first, end]: &[usize; 2]| {
        let (mut sum, mut weighted) = (Counts::default(), 0.0);
        for grains in first..end {
            let counts = all(grains);
            sum.add(counts);
            weighted += counts.attempts as f64 * grains as f64;
        }
        let tried = sum.attempts as f64;
        let probability = Estimate {
            value: sum.entered as f64 / tried,
            standard_error: Some(error(sum, replicas.iter().map(|entries| entries.sum(first..end)))),
        };
        let Counts { attempts, entered, arrivals } = sum;
        Entry { volume_fraction: grain_share * weighted / tried, attempts, entered, arrivals, probability }
    };
    spans.iter().map(entry).collect()
}

/// Standard error of entered/attempts.
fn error(sum: Counts, replicas: impl Iterator<Item = Counts>) -> f64 {
    // Half an entry and half a refusal more, so that it does not vanish where all or none got in.
    let share = (sum.entered as f64 + 0.5) / (sum.attempts as f64 + 1.0);
    let independent = (share * (1.0 - share) / sum.attempts as f64).sqrt();
    let shares: Vec<f64> = replicas
        .filter(|counts| counts.attempts > 0)
        .map(|counts| counts.entered as f64 / counts.attempts as f64)
        .collect();
    standard_error(&shares).map_or(independent, |scatter| scatter.max(independent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::grain::Grain;
    use glam::DVec2;

    const GRAIN: Grain = Grain { diameter: 0.1, mass: 1.0 };

    fn grid() -> Grid<DVec2> {
        Grid::new(DVec2::ZERO, DVec2::new(4.0, 1.0), &[4, 1], &[true, false])
    }

    fn gas(places: &[f64], speeds: &[f64]) -> Gas<DVec2> {
        let positions = places.iter().map(|&x| DVec2::new(x, 0.5)).collect();
        let velocities = speeds.iter().map(|&v| DVec2::new(v, 0.0)).collect();
        Gas::new(grid(), GRAIN, positions, velocities)
    }

    #[test]
    fn entries_are_counted_by_hand() {
        // Grain 0 flies from cell 0 into cell 1, which holds two; grain 1 is stopped on the same way; grain 2 is pushed
        // from cell 1 into the empty cell 2; grain 3 stays; grain 4 passes the periodic end into cell 0, which holds two.
        let before = gas(&[0.8, 0.9, 1.9, 1.2, 3.9], &[0.5, 0.5, 0.0, 0.0, 0.4]);
        let mut after = gas(&[1.3, 0.9, 2.1, 1.2, 0.3], &[0.0; 5]);
        after.clock.advance(1.0);
        let mut entries = Entries::default();
        Before::of(&before).count(&after, &grid(), DVec2::ZERO, &mut entries);
        let counted = |attempts, entered, arrivals| Counts { attempts, entered, arrivals };
        assert_eq!(entries.counts, [counted(0, 0, 1), counted(0, 0, 0), counted(3, 2, 2)]);
    }

    #[test]
    fn flights_into_walls_are_no_attempts() {
        let mut before = gas(&[0.5], &[0.0]);
        before.velocities_mut()[0] = DVec2::new(0.0, 3.0);
        let mut after = gas(&[0.5], &[0.0]);
        after.clock.advance(1.0);
        let mut entries = Entries::default();
        Before::of(&before).count(&after, &grid(), DVec2::ZERO, &mut entries);
        assert!(entries.counts.is_empty());
        // Against its velocity, gravity carries it nowhere either.
        Before::of(&before).count(&after, &grid(), DVec2::new(2.0, -6.0), &mut entries);
        assert_eq!(entries.counts[0].attempts, 1);
    }

    #[test]
    fn rare_numbers_of_grains_are_taken_together() {
        let counts = |attempts, entered| Counts { attempts, entered, arrivals: attempts };
        let one = Entries { counts: vec![counts(300, 300), counts(100, 0), counts(500, 250), counts(3, 0)] };
        let curve = curve(&[one.clone(), one], 0.1);
        assert_eq!(curve.len(), 2);
        assert_eq!((curve[0].attempts, curve[0].entered), (600, 600));
        assert!((curve[1].volume_fraction - 0.1 * (200.0 + 2000.0) / 1200.0).abs() < 1e-12);
        let p = 500.0 / 1200.0;
        assert!((curve[1].probability.value - p).abs() < 1e-12);
        let expected = f64::sqrt(p * (1.0 - p) / 1200.0);
        assert!((curve[1].probability.standard_error.unwrap() / expected - 1.0).abs() < 1e-2);
        assert!(curve[0].probability.standard_error.unwrap() > 0.0);
    }
}
