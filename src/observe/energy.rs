//! `energy`: kinetic energy, temperatures, collisions and grains at every recording.

use super::measure::{Column, Figure, Measure, Profile, Snapshot};
use super::moments::{
    energy_and_temperature, kinetic_energy, momentum, momentum_scale, rotational_energy, temperature,
};
use super::samples::figure;
use super::setting::Setting;
use super::species_temperature;
use super::units::{ENERGY, PURE, column};
use crate::space::Vector;
use crate::statistics::Estimate;

/// Energy and what it is made of, compared with the first state that it was shown.
///
/// * `temperature`: ⟨m|v − v̄|²⟩/D about the velocity v̄ of the centre of mass of all grains; it contains the flow;
/// * `granular_temperature`: about the local flow, as `local_flow` has it, in bins of 20 grains in 2D and
///   40 in 3D on the average over the box; NaN where no bin holds enough;
/// * `granular_temperature_species_1` and so on, in mixtures: that of each species, in the order of the scenario;
///   `temperature_ratio_species_2` and so on: over that of the first.
#[derive(Clone, Debug)]
pub struct Energy<V> {
    /// Whether nothing outside the gas can change its momentum.
    is_free: bool,
    /// z = I/(m a²) of rough grains.
    reduced_inertia: Option<f64>,
    /// Number of species; 0 where all grains are alike.
    species: usize,
    start: Option<Start<V>>,
}

/// The first state.
#[derive(Clone, Copy, Debug)]
struct Start<V> {
    kinetic_energy: f64,
    momentum: V,
    momentum_scale: f64,
}

impl<V: Vector> Energy<V> {
    /// The measure for `setting`; every one has it.
    pub fn new(setting: &Setting<V>) -> Self {
        let is_free = setting.boundary.is_fully_periodic() && setting.gravity == V::ZERO;
        let reduced_inertia = setting.roughness.map(|roughness| roughness.reduced_inertia);
        Energy { is_free, reduced_inertia, species: setting.species, start: None }
    }

    /// Values of the columns before those about the local flow.
    fn sums(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        self.remember_start(snapshot);
        let (gas, totals) = (snapshot.gas, snapshot.totals);
        let (energy, temperature) = energy_and_temperature(gas);
        let temperature = if gas.is_empty() { f64::NAN } else { temperature };
        let mut values = vec![energy, temperature, totals.collisions_per_particle, gas.len() as f64];
        values.extend(self.reduced_inertia.map(|z| rotational_energy(gas, z)));
        values
    }

    /// Names of the temperatures about the local flow, with units.
    fn local_columns(&self) -> Vec<Column> {
        let mut columns = vec![column("granular_temperature", ENERGY)];
        let by_species = |s: usize| column(&format!("granular_temperature_species_{s}"), ENERGY);
        columns.extend((1..=self.species).map(by_species));
        columns.extend((2..=self.species).map(|s| column(&format!("temperature_ratio_species_{s}"), PURE)));
        columns
    }

    /// The temperatures about the local flow; NaN where there are too few grains.
    fn local_values(&self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let (gas, flow) = (snapshot.gas, snapshot.local_flow());
        let mut values = vec![flow.temperature().unwrap_or(f64::NAN)];
        if self.species > 0 {
            let of_species = species_temperature::temperatures(gas, flow);
            values.extend(&of_species);
            values.extend(of_species.iter().skip(1).map(|temperature| temperature / of_species[0]));
            // A gas that was made without its species tells nothing of them.
            values.resize(2 * self.species, f64::NAN);
        }
        values
    }

    fn remember_start(&mut self, snapshot: &Snapshot<'_, V>) {
        self.start.get_or_insert_with(|| Start {
            kinetic_energy: kinetic_energy(snapshot.gas),
            momentum: momentum(snapshot.gas),
            momentum_scale: momentum_scale(snapshot.gas),
        });
    }

    /// |P(t) − P(0)| / Σ m|v(0)|; `None` where walls or gravity change P, or nothing moved at the start.
    fn momentum_drift(&self, snapshot: &Snapshot<'_, V>) -> Option<f64> {
        let start = self.start.filter(|start| self.is_free && start.momentum_scale > 0.0)?;
        Some((momentum(snapshot.gas) - start.momentum).length() / start.momentum_scale)
    }
}

impl<V: Vector> Measure<V> for Energy<V> {
    fn name(&self) -> &'static str {
        "energy"
    }

    fn sample(&mut self, snapshot: &Snapshot<'_, V>) {
        self.remember_start(snapshot);
    }

    fn columns(&self) -> Vec<Column> {
        let mut columns = vec![
            column("kinetic_energy", ENERGY),
            column("temperature", ENERGY),
            column("collisions_per_particle", PURE),
            column("grains", PURE),
        ];
        columns.extend(self.reduced_inertia.map(|_| column("rotational_energy", ENERGY)));
        columns.extend(self.local_columns());
        columns
    }

    fn values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let mut values = self.sums(snapshot);
        values.extend(self.local_values(snapshot));
        values
    }

    fn brief_values(&mut self, snapshot: &Snapshot<'_, V>) -> Vec<f64> {
        let mut values = self.sums(snapshot);
        values.resize(Measure::<V>::columns(self).len(), f64::NAN);
        values
    }

    fn conclusion(&self, snapshot: &Snapshot<'_, V>, _from: f64) -> (Vec<Profile>, Vec<Figure>) {
        let exact = |value: Option<f64>| value.map(|value| Estimate { value, standard_error: None });
        let temperature = (!snapshot.gas.is_empty()).then(|| temperature(snapshot.gas));
        let mut figures = vec![
            figure("kinetic_energy_initial", exact(self.start.map(|start| start.kinetic_energy))),
            figure("kinetic_energy_final", exact(Some(kinetic_energy(snapshot.gas)))),
            figure("temperature", exact(temperature)),
            figure("momentum_drift", exact(self.momentum_drift(snapshot))),
        ];
        let rotation = self.reduced_inertia.map(|z| rotational_energy(snapshot.gas, z));
        figures.extend(rotation.map(|energy| figure("rotational_energy", exact(Some(energy)))));
        let local = self.local_columns().into_iter().zip(self.local_values(snapshot));
        figures.extend(local.map(|(column, value)| figure(&column.name, exact(Some(value)))));
        (Vec::new(), figures)
    }

    fn memory(&self) -> Vec<f64> {
        let Some(start) = self.start else { return Vec::new() };
        let mut memory = vec![start.kinetic_energy, start.momentum_scale];
        memory.extend(start.momentum.components());
        memory
    }

    fn recall(&mut self, memory: &[f64]) -> bool {
        self.start = match memory {
            [] => None,
            [kinetic_energy, momentum_scale, momentum @ ..] if momentum.len() == V::DIMENSION => {
                Some(Start {
                    kinetic_energy: *kinetic_energy,
                    momentum: V::from_fn(|axis| momentum[axis]),
                    momentum_scale: *momentum_scale,
                })
            }
            _ => return false,
        };
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::report::Totals;
    use crate::law::roughness::Roughness;
    use crate::matter::grain::Grain;
    use crate::observe::testing::{
        assert_resumes, figure_of, random_positions, random_velocities, setting_of, show, smooth,
    };
    use glam::{DVec2, DVec3};

    #[test]
    fn energy_and_drift_by_hand() {
        let mut bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let places = vec![DVec2::ONE, DVec2::splat(3.0)];
        let state = |time, v| (bed.gas(time, places.clone(), vec![DVec2::X, v]), Totals::default());
        let states = [state(0.0, -DVec2::X * 0.5), state(1.0, -DVec2::X)];
        let figure = |name| figure_of(&mut Energy::new(&bed.setting), &states, 0.0, name).0;
        // v̄ = 1/4: 2 (3/4)² / (2 · 2).
        assert_eq!(show(&mut Energy::new(&bed.setting), &states[0])[..2], [0.625, 0.281_25]);
        assert_eq!(figure("kinetic_energy_initial"), Some(0.625));
        assert_eq!(figure("kinetic_energy_final"), Some(1.0));
        assert_eq!(figure("temperature"), Some(0.5));
        // |0 − 1/2| / (1 + 1/2).
        assert_eq!(figure("momentum_drift"), Some(1.0 / 3.0));
        bed.walls(0, smooth(), smooth());
        let drift = figure_of(&mut Energy::new(&bed.setting), &states, 0.0, "momentum_drift");
        assert_eq!(drift.0, None);
    }

    #[test]
    fn rough_grains_have_energy_of_rotation() {
        let mut bed = setting_of(DVec2::splat(4.0), [1, 1, 1]);
        bed.setting.roughness = Some(Roughness { tangential_restitution: 0.0, reduced_inertia: 0.5 });
        let mut gas = bed.gas(0.0, vec![DVec2::ONE; 2], vec![DVec2::X; 2]);
        gas.parts_mut().2.spins = Some(vec![[4.0], [0.0]]);
        let state = (gas, Totals::default());
        // ½ · ½ · ¼ · 16.
        assert_eq!(show(&mut Energy::new(&bed.setting), &state)[4], 1.0);
        let figure = figure_of(&mut Energy::new(&bed.setting), &[state], 0.0, "rotational_energy");
        assert_eq!(figure, (Some(1.0), None));
    }

    #[test]
    fn a_flow_is_in_the_temperature_and_not_in_the_granular_one() {
        let bed = setting_of(DVec2::splat(20.0), [10, 10, 1]);
        let places = random_positions(1, 2000, DVec2::splat(20.0));
        let velocities = random_velocities(2, 2000).into_iter().zip(&places);
        let velocities = velocities.map(|(v, x): (DVec2, &DVec2)| v + DVec2::X * x.y).collect();
        let state = (bed.gas(0.0, places, velocities), Totals::default());
        let figure = |name| {
            figure_of(&mut Energy::new(&bed.setting), std::slice::from_ref(&state), 0.0, name).0.unwrap()
        };
        // (1 + 20²/12 + 1)/2, and 1 ± 1/√2000.
        assert!((figure("temperature") - 17.7).abs() < 0.8, "{}", figure("temperature"));
        assert!((figure("granular_temperature") - 1.0).abs() < 0.08, "{}", figure("granular_temperature"));
        let values = show(&mut Energy::new(&bed.setting), &state);
        assert_eq!(values[4], figure("granular_temperature"));
    }

    #[test]
    fn species_are_told_apart() {
        let mut bed = setting_of(DVec2::splat(20.0), [10, 10, 1]);
        bed.setting.species = 2;
        let mut gas = bed.gas(0.0, random_positions(1, 2000, DVec2::splat(20.0)), random_velocities(2, 2000));
        let heavy = Grain { diameter: 1.0, mass: 4.0 };
        gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, heavy];
        gas.parts_mut().2.species = Some((0..2000).map(|row| (row % 2) as u8).collect());
        let states = [(gas, Totals::default())];
        let figure = |name| figure_of(&mut Energy::new(&bed.setting), &states, 0.0, name).0.unwrap();
        assert!((figure("granular_temperature_species_1") - 1.0).abs() < 0.1);
        assert!((figure("granular_temperature_species_2") - 4.0).abs() < 0.4);
        let ratio = figure("granular_temperature_species_2") / figure("granular_temperature_species_1");
        assert_eq!(figure("temperature_ratio_species_2"), ratio);
    }

    #[test]
    fn it_resumes() {
        let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
        assert_resumes(|| Box::new(Energy::new(&bed.setting)), &bed.random_states(4, 20));
    }

    #[test]
    fn an_empty_box_has_no_temperature() {
        let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
        let values = show(&mut Energy::new(&bed.setting), &(bed.gas(0.0, vec![], vec![]), Totals::default()));
        assert!(values[1].is_nan() && values[0] == 0.0);
    }
}
