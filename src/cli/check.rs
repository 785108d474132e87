//! `grainflow check`.

use clap::Args;

use super::input::ScenarioInput;
use super::{Exit, complain};
use crate::scenario::check::check_for_memory;
use crate::stopwatch::available_memory_bytes;

/// Say what a scenario means, or all that is wrong with it; nothing runs
#[derive(Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    input: ScenarioInput,
}

pub(super) fn check(arguments: &CheckArguments) -> Exit {
    match arguments.input.load() {
        Ok(scenario) => {
            println!("{}", check_for_memory(&scenario, available_memory_bytes()));
            Exit::Done
        }
        Err(error) => {
            complain(&error);
            Exit::BadInput
        }
    }
}
