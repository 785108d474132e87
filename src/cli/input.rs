//! Options that name a scenario and change it.

use clap::Args;

use crate::scenario::error::ScenarioError;
use crate::scenario::model::AnyScenario;
use crate::scenario::{Overrides, load};

/// A scenario and what to change in it.
#[derive(Args, Debug)]
pub(super) struct ScenarioInput {
    /// A scenario file, or the name of a built-in scenario (see `grainflow scenarios`)
    #[arg(value_name = "SCENARIO")]
    pub(super) scenario: String,

    /// Engine in place of the scenario's: dsmc, cba, hsmc or event-driven
    #[arg(long, value_name = "KIND")]
    pub(super) engine: Option<String>,

    /// Seed of all random numbers, from 0 to 2^63 - 1
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,

    /// Change one key, as in particles.count=500 or gravity[1]=-2; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) sets: Vec<String>,
}

impl ScenarioInput {
    /// The checked scenario.
    pub(super) fn load(&self) -> Result<AnyScenario, ScenarioError> {
        let overrides = Overrides { sets: self.sets.clone(), engine: self.engine.clone(), seed: self.seed };
        load(&self.scenario, &overrides)
    }
}
