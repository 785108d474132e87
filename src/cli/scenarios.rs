//! `grainflow scenarios`.

use clap::{Args, Subcommand};

use super::{Exit, complain};
use crate::scenario::builtin;

/// List the built-in scenarios, or print one as a file to start from
#[derive(Args, Debug)]
pub(super) struct ScenariosArguments {
    #[command(subcommand)]
    command: Option<ScenariosCommand>,
}

#[derive(Debug, Subcommand)]
enum ScenariosCommand {
    /// Print a built-in scenario as a file to start from
    Show {
        /// Its name
        name: String,
    },
}

pub(super) fn scenarios(arguments: &ScenariosArguments) -> Exit {
    match &arguments.command {
        None => {
            for (name, about) in builtin::list() {
                println!("{name:<14} {about}");
            }
            println!("\n`grainflow run NAME` runs one, `grainflow scenarios show NAME` prints it.");
            Exit::Done
        }
        Some(ScenariosCommand::Show { name }) => match builtin::text(name) {
            Some(text) => {
                print!("{text}");
                Exit::Done
            }
            None => {
                complain(&builtin::unknown(name));
                Exit::BadInput
            }
        },
    }
}
