//! How large and heavy the grains of a log are.

use crate::matter::grain::Grain;
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// Sizes and masses of the grains of a log, and which grain is of which kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinds {
    /// `[species]`; one where all grains are alike.
    grains: Vec<Grain>,
    /// `[id]`, for frames, which do not say it; beyond the list a grain is of the first species, as poured ones are.
    species: Vec<u8>,
}

impl Kinds {
    /// The grains of `scenario`, of which states have told the `species` `[id]`.
    pub(crate) fn new<V: Vector>(scenario: &Scenario<V>, species: Vec<u8>) -> Self {
        let alike = scenario.species.is_empty();
        let grains = if alike { vec![scenario.grain] } else { scenario.species.clone() };
        Kinds { grains, species }
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
