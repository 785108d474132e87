//! `density-profile`: volume fraction in slices, at every recording.

use super::layout;
use super::measure::{Measure, Profile, Snapshot};
use super::setting::Setting;
use super::slices;
use super::units::{LENGTH, PURE, column};
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Volume fraction in slices of one cell along gravity; else across walls; else along the longest axis; in mixtures also that of
/// each species, `volume_fraction_species_1` and so on.
#[derive(Clone, Copy, Debug)]
pub struct DensityProfile {
    axis: usize,
}

impl DensityProfile {
    /// The measure for `setting`; every one has it.
    pub fn new<V: Vector>(setting: &Setting<V>) -> Self {
        DensityProfile { axis: layout::profile_axis(setting) }
    }
}

impl<V: Vector> Measure<V> for DensityProfile {
    fn name(&self) -> &'static str {
        "density-profile"
    }

    fn profiles(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<Profile> {
        let gas = snapshot.gas;
        let centres = slices::centres(gas, self.axis);
        let slice_volume = gas.grid().size().product() / centres.len() as f64;
        let fractions = if gas.species.is_empty() {
            let share = gas.grain.volume::<V>() / slice_volume;
            let counts = slices::counts(gas, self.axis);
            counts.into_iter().map(|count| f64::from(count) * share).collect()
        } else {
            slices::volumes(gas, self.axis).into_iter().map(|volume| volume / slice_volume).collect()
        };
        let mut columns = vec![column("position", LENGTH), column("volume_fraction", PURE)];
        let mut values = vec![centres, fractions];
        for (s, volumes) in volumes_by_species(gas, self.axis).into_iter().enumerate() {
            columns.push(column(&format!("volume_fraction_species_{}", s + 1), PURE));
            values.push(volumes.into_iter().map(|volume| volume / slice_volume).collect());
        }
        vec![Profile { name: "density-profile".to_owned(), time: gas.time(), columns, values }]
    }
}

/// Volume of the grains of each species in each slice, `[species][slice]` [lengthᴰ]; empty where all grains are alike.
fn volumes_by_species<V: Vector>(gas: &Gas<V>, axis: usize) -> Vec<Vec<f64>> {
    let Some(species) = &gas.columns().species else { return Vec::new() };
    let kinds = gas.species.iter().enumerate();
    kinds
        .map(|(s, grain)| {
            let share = |row: usize| if usize::from(species[row]) == s { grain.volume::<V>() } else { 0.0 };
            slices::sums(gas, axis, share)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::matter::grain::Grain;
    use crate::observe::testing::{assert_resumes, setting_of};
    use glam::DVec3;
    use std::f64::consts::PI;

    #[test]
    fn slices_of_known_content() {
        let bed = setting_of(DVec3::new(2.0, 4.0, 6.0), [1, 2, 3]);
        let mut positions = vec![DVec3::new(1.0, 1.0, 5.0); 4];
        positions.push(DVec3::new(1.0, 3.0, 1.0));
        let gas = bed.gas(2.5, positions, vec![DVec3::ZERO; 5]);
        let totals = Totals::default();
        let profiles = DensityProfile::new(&bed.setting).profiles(&Snapshot::new(&gas, &totals));
        assert_eq!(profiles[0].time, 2.5);
        assert_eq!(profiles[0].values[0], [1.0, 3.0, 5.0]);
        // A slice holds 16, a grain π/6.
        let expected = [PI / 96.0, 0.0, 4.0 * PI / 96.0];
        for (found, expected) in profiles[0].values[1].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn grains_of_a_mixture_fill_by_their_volumes() {
        let bed = setting_of(DVec3::new(2.0, 4.0, 6.0), [1, 2, 3]);
        let positions = vec![DVec3::new(1.0, 1.0, 5.0), DVec3::new(1.0, 3.0, 5.0)];
        let mut gas = bed.gas(0.0, positions, vec![DVec3::ZERO; 2]);
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 0.5, mass: 1.0 }];
        gas.parts_mut().2.species = Some(vec![0, 1]);
        let totals = Totals::default();
        let profiles = DensityProfile::new(&bed.setting).profiles(&Snapshot::new(&gas, &totals));
        assert!((profiles[0].values[1][2] - PI / 96.0 * 1.125).abs() < 1e-15);
        assert_eq!(profiles[0].values[1][..2], [0.0, 0.0]);
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert_resumes(|| Box::new(DensityProfile::new(&bed.setting)), &bed.random_states(4, 20));
    }
}
