//! How large and heavy the grains of a log are.

use super::model::{AnyScenario, Scenario};
use crate::matter::grain::Grain;
use crate::space::Vector;

/// Sizes and masses of the grains of a log, and which grain is of which kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinds {
    /// `[species]`; one where all grains are alike.
    grains: Vec<Grain>,
    /// `[id]`, for frames, which do not say it; beyond the list a grain is of the first species, as poured ones are.
    species: Vec<u8>,
}

impl Default for Kinds {
    /// Grains of unit diameter.
    fn default() -> Self {
        Kinds::of_diameter(1.0)
    }
}

impl Kinds {
    /// The grains of `scenario`, of which states have told the `species` `[id]`.
    pub(crate) fn new<V: Vector>(scenario: &Scenario<V>, species: Vec<u8>) -> Self {
        let alike = scenario.species.is_empty();
        let grains = if alike { vec![scenario.grain] } else { scenario.species.clone() };
        Kinds { grains, species }
    }

    /// Grains that are all of this `diameter` [length], of unit mass.
    pub fn of_diameter(diameter: f64) -> Self {
        Kinds { grains: vec![Grain { diameter, mass: 1.0 }], species: Vec::new() }
    }

    /// Grains of these `diameters` `[species]` [length], of unit mass, which are of the `species` `[id]`.
    #[cfg(test)]
    pub(crate) fn of_species(diameters: &[f64], species: Vec<u8>) -> Self {
        Kinds { grains: diameters.iter().map(|&diameter| Grain { diameter, mass: 1.0 }).collect(), species }
    }

    /// The grains of `scenario`, of which states have told the `species` `[id]`.
    pub fn of(scenario: &AnyScenario, species: Vec<u8>) -> Self {
        match scenario {
            AnyScenario::Two(scenario) => Kinds::new(scenario, species),
            AnyScenario::Three(scenario) => Kinds::new(scenario, species),
        }
    }

    /// Whether grains differ in size, and no state says which is which.
    pub(crate) fn are_untold(&self) -> bool {
        self.differ() && self.species.is_empty()
    }

    /// Whether grains differ in size, and it is known which is which.
    pub(crate) fn are_told(&self) -> bool {
        self.differ() && !self.species.is_empty()
    }

    fn differ(&self) -> bool {
        self.diameters().any(|diameter| diameter != self.grains[0].diameter)
    }

    /// Diameters of the species [length].
    pub(crate) fn diameters(&self) -> impl Iterator<Item = f64> + '_ {
        self.grains.iter().map(|grain| grain.diameter)
    }

    /// Diameter of the largest species [length].
    pub(crate) fn largest_diameter(&self) -> f64 {
        self.diameters().fold(0.0, f64::max)
    }

    /// Diameter of a point of a frame, whose `id` a damaged frame may lack [length].
    pub(crate) fn diameter(&self, id: Option<u32>) -> f64 {
        self.grain(id.map_or(0, |id| self.species_of(id))).diameter
    }

    /// The species of the grain `id`.
    pub(crate) fn species_of(&self, id: u32) -> u8 {
        self.species.get(id as usize).copied().unwrap_or(0)
    }

    /// Diameter and mass of a species; of the first one where the log names one that the scenario does not.
    pub(crate) fn grain(&self, species: u8) -> Grain {
        self.grains.get(usize::from(species)).copied().unwrap_or(self.grains[0])
    }
}
