//! Options that name a scenario and change it.

use clap::Args;

use crate::scenario::error::{Mistake, Place, ScenarioError};
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
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,

    /// Change one key, as in particles.count=500 or gravity[1]=-2; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) sets: Vec<String>,
}

/// The seed that `text` is.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    let wrong = |_| format!("give a whole number from 0 to {} (2^63 - 1)", i64::MAX);
    text.parse().map_err(wrong)
}

impl ScenarioInput {
    /// The checked scenario.
    pub(super) fn load(&self) -> Result<AnyScenario, ScenarioError> {
        if let Some(conflict) = self.conflict() {
            return Err(conflict);
        }
        let overrides = Overrides { sets: self.sets.clone(), engine: self.engine.clone(), seed: self.seed };
        load(&self.scenario, &overrides)
    }
    /// A key that two options set: which of them is meant nobody can know.
    fn conflict(&self) -> Option<ScenarioError> {
        let options =
            [("--engine", "engine.kind", self.engine.is_some()), ("--seed", "seed", self.seed.is_some())];
        let key = |set: &String| set.split('=').next().map(|key| key.trim().to_owned());
        let mistake = |(order, set): (usize, &String)| {
            let (option, ..) =
                options.iter().find(|(_, name, given)| *given && key(set).as_deref() == Some(name))?;
            let place = Place::Option { order, name: format!("--set #{} '{set}'", order + 1) };
            let message = format!("is also set by {option}; leave one of them out");
            Some(Mistake { place, key: key(set)?, message })
        };
        let mistakes: Vec<Mistake> = self.sets.iter().enumerate().filter_map(mistake).collect();
        (!mistakes.is_empty()).then(|| ScenarioError { file: self.scenario.clone(), mistakes })
    }
}
