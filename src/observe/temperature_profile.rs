//! `temperature-profile`: mean velocity, temperature and expected collisions in slices along an axis.

use super::layout;
use super::local_flow::LocalFlow;
use super::measure::{Column, Measure, Profile, Snapshot};
use super::setting::Setting;
use super::slices;
use super::species_temperature;
use super::units::{ENERGY, LENGTH, RATE, VELOCITY, column};
use crate::law::kinetic_theory::collision_frequency;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Mean velocity, temperature about the flow and the collision frequency of kinetic theory, in the slices of
/// [`DensityProfile`](super::density_profile::DensityProfile), at every recording.
///
/// The temperature is about a flow that is linear across the slice, v̄ + (x − x̄) ∂v/∂x, both fitted: the unbiased
/// Σ m|v − u|²/(D(N − 2)); NaN where fewer than three grains are. A flow that changes along the slice is in it. In mixtures the
/// temperatures of the species follow, `temperature_species_1` and so on. The collision frequency is that of a Maxwell gas of the slice's ν and T,
/// with g(ν) of an elastic fluid; NaN in mixtures.
#[derive(Clone, Copy, Debug)]
pub struct TemperatureProfile {
    axis: usize,
}

impl TemperatureProfile {
    /// The measure for `setting`; every one has it.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Self {
        TemperatureProfile { axis: layout::profile_axis(setting) }
    }

    /// Velocity of the centre of mass of each slice, `[slice]`; NaN where nobody is.
    fn velocities<V: Vector>(self, gas: &Gas<V>) -> Vec<V> {
        let mass = slices::sums(gas, self.axis, |row| gas.grain_at(row).mass);
        let momentum: Vec<Vec<f64>> = (0..V::DIMENSION)
            .map(|k| slices::sums(gas, self.axis, |row| gas.grain_at(row).mass * gas.velocities()[row][k]))
            .collect();
        (0..mass.len()).map(|slice| V::from_fn(|k| momentum[k][slice] / mass[slice])).collect()
    }

    /// Collisions per grain and time at these `temperatures`, `[slice]` [1/time].
    fn frequencies<V: Vector>(self, gas: &Gas<V>, temperatures: &[f64]) -> Vec<f64> {
        if !gas.species.is_empty() {
            return vec![f64::NAN; temperatures.len()];
        }
        let volume = gas.grid().size().product() / temperatures.len() as f64;
        let counts = slices::counts(gas, self.axis).into_iter();
        let fractions = counts.map(|count| f64::from(count) * gas.grain.volume::<V>() / volume);
        let frequency = |(fraction, &temperature): (f64, &f64)| {
            let correlation = V::contact_correlation(fraction.min(V::LARGEST_LOCAL_FRACTION));
            collision_frequency::<V>(gas.grain, fraction, temperature, correlation)
        };
        fractions.zip(temperatures).map(frequency).collect()
    }
}

impl<V: Vector> Measure<V> for TemperatureProfile {
    fn name(&self) -> &'static str {
        "temperature-profile"
    }

    fn is_costly(&self) -> bool {
        true
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let gas = snapshot.gas;
        let means = self.velocities(gas);
        let flow = LocalFlow::in_slices(gas, self.axis);
        let temperatures: Vec<f64> =
            flow.flows().iter().map(|flow| flow.map_or(f64::NAN, |flow| flow.temperature())).collect();
        let frequencies = self.frequencies(gas, &temperatures);
        let mut values = vec![slices::centres(gas, self.axis)];
        values.extend((0..V::DIMENSION).map(|k| means.iter().map(|mean| mean[k]).collect::<Vec<f64>>()));
        values.extend([temperatures, frequencies]);
        let of_species = species_temperature::temperatures_by_bin(gas, &flow);
        let species = gas.species.len();
        values.extend((0..species).map(|s| of_species.iter().map(|slice| slice[s]).collect::<Vec<f64>>()));
        let name = "temperature-profile".to_owned();
        vec![Profile { name, time: gas.time(), columns: columns::<V>(species), values }]
    }
}

fn columns<V: Vector>(species: usize) -> Vec<Column> {
    let mut columns = vec![column("position", LENGTH)];
    columns.extend(V::AXIS_NAMES.iter().map(|axis| column(&format!("velocity_{axis}"), VELOCITY)));
    columns.extend([column("temperature", ENERGY), column("expected_collision_frequency", RATE)]);
    columns.extend((1..=species).map(|s| column(&format!("temperature_species_{s}"), ENERGY)));
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::matter::grain::Grain;
    use crate::observe::testing::{assert_resumes, random_positions, random_velocities, setting_of};
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    fn profile<V: Vector>(setting: &Setting<V>, gas: &Gas<V>) -> Vec<Vec<f64>> {
        let totals = Totals::default();
        TemperatureProfile::new(setting).profiles(&Snapshot::new(gas, &totals))[0].values.clone()
    }

    #[test]
    fn the_flow_of_a_slice_is_no_heat() {
        let bed = setting_of(DVec2::new(2.0, 6.0), [1, 3, 1]);
        // Below three in a wind of 5 that grows with height; above one alone; none in the middle.
        let heights = [0.5, 1.0, 1.5, 5.0];
        let positions = heights.iter().map(|&y| DVec2::new(1.0, y)).collect();
        let mut gas = bed.gas(0.0, positions, vec![DVec2::ZERO; 4]);
        let wind = [4.0, 5.0, 6.0].map(|x| DVec2::new(x, 2.0));
        gas.velocities_mut()[..3].copy_from_slice(&wind);
        gas.velocities_mut()[1].y += 3.0;
        gas.velocities_mut()[3] = DVec2::new(7.0, -1.0);
        let values = profile(&bed.setting, &gas);
        assert_eq!(values[0], [1.0, 3.0, 5.0]);
        assert_eq!((values[1][0], values[2][0]), (5.0, 3.0));
        assert_eq!((values[1][2], values[2][2]), (7.0, -1.0));
        // (1 + 4 + 1)/(2 · 1) of the three about their line, which is level in y.
        assert!((values[3][0] - 3.0).abs() < 1e-12, "{}", values[3][0]);
        // n σ g √(πT/m) with n = 3/4, σ = 2 d.
        let g = <DVec2 as Vector>::contact_correlation(3.0 * PI / 16.0);
        assert!((values[4][0] - 1.5 * g * (3.0 * PI).sqrt()).abs() < 1e-12, "{}", values[4][0]);
        assert!(values[1][1].is_nan() && values[3][1].is_nan() && values[3][2].is_nan());
        assert!(values[4][1].is_nan() && values[4][2].is_nan());
    }

    #[test]
    fn slices_of_a_sheared_gas_are_as_hot_as_those_of_one_at_rest() {
        let size = DVec3::new(12.0, 12.0, 24.0);
        let bed = setting_of(size, [3, 3, 6]);
        let positions = random_positions(1, 3000, size);
        let mut gas = bed.gas(0.0, positions, random_velocities(2, 3000));
        let at_rest = profile(&bed.setting, &gas)[4].clone();
        let heights: Vec<f64> = gas.positions().iter().map(|place| place.z).collect();
        gas.velocities_mut().iter_mut().zip(heights).for_each(|(v, z)| v.x += 2.0 * z);
        for (sheared, resting) in profile(&bed.setting, &gas)[4].iter().zip(at_rest) {
            // 500 grains a slice; about the mean alone (2 · 4)²/12/3 would be added.
            assert!((sheared - resting).abs() < 1e-9 && (resting - 1.0).abs() < 0.15, "{sheared} {resting}");
        }
    }

    #[test]
    fn a_mixture_moves_with_its_centre_of_mass_and_shows_its_species() {
        let bed = setting_of(DVec3::new(2.0, 2.0, 6.0), [1, 1, 3]);
        let positions = [0.5, 1.5, 0.5, 1.5].map(DVec3::splat).repeat(2);
        let velocities = [vec![DVec3::X * 4.0; 4], vec![DVec3::ZERO; 4]].concat();
        let mut gas = bed.gas(0.0, positions, velocities);
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 1.0, mass: 3.0 }];
        gas.parts_mut().2.species = Some(vec![0, 0, 0, 0, 1, 1, 1, 1]);
        let values = profile(&bed.setting, &gas);
        assert_eq!(values[1][0], 1.0);
        // 4 (9 + 3)/(3 · 6).
        assert!((values[4][0] - 8.0 / 3.0).abs() < 1e-12, "{}", values[4][0]);
        assert_eq!(values.len(), 8);
        // Of 25/8 T₁ + 3/8 T₂ = 12 and 3/8 T₁ + 17/8 T₂ = 4.
        assert!(
            (values[6][0] - 24.0 / 6.5).abs() < 1e-12 && (values[7][0] - 8.0 / 6.5).abs() < 1e-12,
            "{values:?}"
        );
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert_resumes(|| Box::new(TemperatureProfile::new(&bed.setting)), &bed.random_states(4, 20));
    }
}
