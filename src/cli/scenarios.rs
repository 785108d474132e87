//! `grainflow scenarios`.

use clap::{Args, Subcommand};

use super::{Exit, complain};
use crate::scenario::{Overrides, builtin, load, trust};

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

/// Where the engine of a built-in scenario is known to be wrong.
fn known_faults(name: &str) -> Vec<String> {
    let doubts = load(name, &Overrides::default()).map(|scenario| trust::doubts(&scenario));
    let doubts = doubts.unwrap_or_default().into_iter().filter(|doubt| doubt.is_warning);
    doubts.map(|doubt| doubt.brief).collect()
}

pub(super) fn scenarios(arguments: &ScenariosArguments) -> Exit {
    match &arguments.command {
        None => {
            for (name, about) in builtin::list() {
                println!("{name:<14} {about}");
                for fault in known_faults(name) {
                    println!("{:<14}   known fault: {fault}", "");
                }
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
