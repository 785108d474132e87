//! `grainflow check`.

use std::path::Path;

use clap::Args;

use super::input::ScenarioInput;
use super::{Exit, complain};
use crate::machine::Machine;
use crate::run::check_beginning;
use crate::scenario::check::check_on;

/// Say what a scenario means, or all that is wrong with it; nothing runs
#[derive(Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    input: ScenarioInput,
}

pub(super) fn check(arguments: &CheckArguments) -> Exit {
    match arguments.input.load() {
        Ok(scenario) => {
            if let Err(error) = check_beginning(&scenario) {
                complain(&error);
                return Exit::BadInput;
            }
            println!("{}", check_on(&scenario, Machine::holding(Path::new("out"))));
            Exit::Done
        }
        Err(error) => {
            complain(&error);
            Exit::BadInput
        }
    }
}
