//! grainflow: parse, run, exit code.

use std::process::ExitCode;

fn main() -> ExitCode {
    grainflow::cli::main()
}
