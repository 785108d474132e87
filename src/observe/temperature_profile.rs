//! `temperature-profile`: mean velocity, temperature and expected collisions in slices along an axis.

use super::layout;
use super::measure::{Column, Measure, Profile, Snapshot};
use super::setting::Setting;
use super::slices;
use super::units::{ENERGY, LENGTH, RATE, VELOCITY, column};
use crate::law::kinetic_theory::collision_frequency;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Mean velocity, temperature about it and the collision frequency of kinetic theory, in the slices of
/// [`DensityProfile`](super::density_profile::DensityProfile), at every recording.
///
/// The temperature is the unbiased Σ m|v − v̄|²/(D(N − 1)), v̄ the velocity of the slice's centre of mass; NaN
/// where fewer than two grains are. The collision frequency is that of a Maxwell gas of the slice's ν and T,
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

    /// Temperature about these `means`, `[slice]` [mass·length²/time²].
    fn temperatures<V: Vector>(self, gas: &Gas<V>, means: &[V]) -> Vec<f64> {
        let squares = slices::sums(gas, self.axis, |row| {
            let slice = gas.grid().coordinate_of(gas.positions()[row], self.axis) as usize;
            gas.grain_at(row).mass * (gas.velocities()[row] - means[slice]).length_squared()
        });
        let counts = slices::counts(gas, self.axis);
        let temperature = |(square, count): (f64, u32)| {
            if count < 2 { f64::NAN } else { square / (V::DIMENSION as f64 * f64::from(count - 1)) }
        };
        squares.into_iter().zip(counts).map(temperature).collect()
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
        let temperatures = self.temperatures(gas, &means);
        let frequencies = self.frequencies(gas, &temperatures);
        let mut values = vec![slices::centres(gas, self.axis)];
        values.extend((0..V::DIMENSION).map(|k| means.iter().map(|mean| mean[k]).collect::<Vec<f64>>()));
        values.extend([temperatures, frequencies]);
        let name = "temperature-profile".to_owned();
        vec![Profile { name, time: gas.time(), columns: columns::<V>(), values }]
    }
}

fn columns<V: Vector>() -> Vec<Column> {
    let mut columns = vec![column("position", LENGTH)];
    columns.extend(V::AXIS_NAMES.iter().map(|axis| column(&format!("velocity_{axis}"), VELOCITY)));
    columns.extend([column("temperature", ENERGY), column("expected_collision_frequency", RATE)]);
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::matter::grain::Grain;
    use crate::observe::testing::{assert_resumes, setting_of};
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    fn profile<V: Vector>(setting: &Setting<V>, gas: &Gas<V>) -> Vec<Vec<f64>> {
        let totals = Totals::default();
        TemperatureProfile::new(setting).profiles(&Snapshot { gas, totals: &totals })[0].values.clone()
    }

    #[test]
    fn the_flow_of_a_slice_is_no_heat() {
        let bed = setting_of(DVec2::new(2.0, 6.0), [1, 3, 1]);
        // Below two that pass each other in a wind of 5; above one alone; nobody in the middle.
        let positions = vec![DVec2::new(0.5, 1.0), DVec2::new(1.5, 0.5), DVec2::new(1.0, 5.0)];
        let mut gas = bed.gas(0.0, positions, vec![DVec2::ZERO; 3]);
        let wind = [DVec2::new(6.0, 2.0), DVec2::new(4.0, 2.0), DVec2::new(7.0, -1.0)];
        gas.velocities_mut().copy_from_slice(&wind);
        let values = profile(&bed.setting, &gas);
        assert_eq!(values[0], [1.0, 3.0, 5.0]);
        assert_eq!((values[1][0], values[2][0]), (5.0, 2.0));
        assert_eq!((values[1][2], values[2][2]), (7.0, -1.0));
        // (1 + 1)/(2 · 1).
        assert_eq!(values[3][0], 1.0);
        // n σ g √(πT/m) with n = 2/4, σ = 2 d.
        let g = <DVec2 as Vector>::contact_correlation(PI / 8.0);
        assert!((values[4][0] - g * PI.sqrt()).abs() < 1e-14, "{}", values[4][0]);
        assert!(values[1][1].is_nan() && values[3][1].is_nan() && values[3][2].is_nan());
        assert!(values[4][1].is_nan() && values[4][2].is_nan());
    }

    #[test]
    fn a_mixture_moves_with_its_centre_of_mass() {
        let bed = setting_of(DVec3::new(2.0, 2.0, 6.0), [1, 1, 3]);
        let positions = vec![DVec3::splat(0.5), DVec3::splat(1.5)];
        let mut gas = bed.gas(0.0, positions, vec![DVec3::X * 4.0, DVec3::ZERO]);
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 1.0, mass: 3.0 }];
        gas.parts_mut().2.species = Some(vec![0, 1]);
        let values = profile(&bed.setting, &gas);
        assert_eq!(values[1][0], 1.0);
        // (9 + 3)/3.
        assert_eq!(values[4][0], 4.0);
        assert!(values[5][0].is_nan());
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert_resumes(|| Box::new(TemperatureProfile::new(&bed.setting)), &bed.random_states(4, 20));
    }
}
