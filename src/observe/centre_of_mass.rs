//! `centre-of-mass`: how high grains lie above their floor (Müller 2001, section 3.7).

use super::layout::{self, Floor};
use super::measure::{Cadence, Column, Figure, Measure, Profile, Snapshot};
use super::moments;
use super::samples::{Samples, figure, steady_mean};
use super::setting::Setting;
use super::units::{LENGTH, column};
use crate::matter::gas::Gas;
use crate::space::Vector;
use crate::statistics::Estimate;

/// Mean height of the grains above the wall that gravity points at; above its mean place if it vibrates.
#[derive(Clone, Debug)]
pub struct CentreOfMass {
    floor: Floor,
    samples: Samples,
}

impl CentreOfMass {
    /// The measure for `setting`, if gravity points at a wall.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Option<Self> {
        Some(CentreOfMass { floor: layout::floor(setting)?, samples: Samples::new(1) })
    }

    /// The height [length]; NaN without grains.
    fn height<V: Vector>(&self, gas: &Gas<V>) -> f64 {
        if gas.species.is_empty() {
            return moments::sum(gas.positions(), |&position| self.floor.height(position)) / gas.len() as f64;
        }
        let mass = moments::sum_rows(gas.len(), |row| gas.grain_at(row).mass);
        let weighted = |row: usize| gas.grain_at(row).mass * self.floor.height(gas.positions()[row]);
        moments::sum_rows(gas.len(), weighted) / mass
    }
}

impl<V: Vector> Measure<V> for CentreOfMass {
    fn name(&self) -> &'static str {
        "centre-of-mass"
    }

    fn cadence(&self) -> Cadence {
        Cadence::Spread
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.samples.push(snapshot.gas.time(), &[self.height(snapshot.gas)]);
    }

    fn columns(&self) -> Vec<Column> {
        vec![column("centre_of_mass_height", LENGTH)]
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        vec![self.height(snapshot.gas)]
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let value = self.height(snapshot.gas);
        let samples = self.samples.with(snapshot.gas.time(), &[value]);
        let mean = steady_mean(&samples.since(from), |row| row[1]);
        let figures = vec![
            figure("centre_of_mass_height", Some(Estimate { value, standard_error: None })),
            figure("centre_of_mass_mean_height", mean),
        ];
        (Vec::new(), figures)
    }

    fn memory(&self) -> Vec<f64> {
        self.samples.memory().to_vec()
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.samples.recall(memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::law::boundary::Face;
    use crate::matter::grid::Grid;
    use crate::observe::testing::{Bed, assert_resumes, figure_of, setting_of, smooth};
    use glam::{DVec2, DVec3};

    fn bed() -> Bed<DVec3> {
        let mut bed = setting_of(DVec3::splat(8.0), [4, 4, 4]);
        bed.setting.gravity = DVec3::new(0.0, 0.0, -1.0);
        bed.walls(2, smooth(), Face::Open);
        bed
    }

    #[test]
    fn the_mean_height_at_the_end_and_on_average() {
        let bed = bed();
        let state = |time: f64, top: f64| {
            let positions = vec![DVec3::new(3.0, 1.0, top), DVec3::new(5.0, 6.0, 1.0)];
            (bed.gas(time, positions, vec![DVec3::ZERO; 2]), Totals::default())
        };
        let states = [state(0.0, 7.0), state(1.0, 5.0), state(2.0, 2.0)];
        let mut measure = CentreOfMass::new(&bed.setting).unwrap();
        assert_eq!(figure_of(&mut measure, &states, 1.0, "centre_of_mass_height"), (Some(1.5), None));
        let (mean, error) = figure_of(&mut measure, &states, 1.0, "centre_of_mass_mean_height");
        assert_eq!(mean, Some(2.25));
        assert!((error.unwrap() - 0.75).abs() < 1e-15);
    }

    #[test]
    fn a_vibrating_floor_counts_from_its_mean_place() {
        let mut bed = bed();
        let (origin, size) = (DVec3::new(0.0, 0.0, -1.0), DVec3::new(8.0, 8.0, 9.0));
        bed.setting.grid = Grid::new(origin, size, &[4, 4, 4], &[true; 3]);
        let states = [(bed.gas(0.0, vec![DVec3::splat(2.5)], vec![DVec3::ZERO]), Totals::default())];
        let mut measure = CentreOfMass::new(&bed.setting).unwrap();
        assert_eq!(figure_of(&mut measure, &states, 0.0, "centre_of_mass_height").0, Some(2.5));
    }

    #[test]
    fn it_needs_a_floor() {
        let mut bed = setting_of(DVec2::splat(8.0), [4, 4, 1]);
        bed.setting.gravity = DVec2::new(0.0, -1.0);
        assert!(CentreOfMass::new(&bed.setting).is_none());
    }

    #[test]
    fn it_resumes() {
        let bed = bed();
        let make = || Box::new(CentreOfMass::new(&bed.setting).unwrap()) as Box<dyn Measure<DVec3>>;
        assert_resumes(make, &bed.random_states(30, 20));
    }
}
