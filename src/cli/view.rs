//! `grainflow view`.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use clap::Args;

use super::{Exit, complain};
use crate::record::log_at;
use crate::view::{Limits, Server, ViewError, ViewedLog, export, wake};

/// Look at a log in the browser: play it, turn it, with its measures; no network is needed
///
/// The page is served to this machine alone, at an address with a token, until Ctrl-C.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct ViewArguments {
    /// A log or a run folder; two of them are shown side by side, in step
    #[arg(value_name = "LOG", required = true, num_args = 1..=2)]
    logs: Vec<PathBuf>,

    /// Port of 127.0.0.1 to listen on [default: one that is free]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    port: Option<u16>,

    /// Print the address of the page and open no browser
    #[arg(long)]
    no_browser: bool,

    /// Write the page to a file of its own, with some of the frames in it, and serve nothing
    #[arg(long, value_name = "PAGE", conflicts_with_all = ["port", "no_browser"])]
    export: Option<PathBuf>,

    /// Replace the file of --export if it is there
    #[arg(long, requires = "export")]
    force: bool,
}

const EXAMPLES: &str = "Examples:
  grainflow view out/heap-hsmc
  grainflow view out/cooling-hsmc out/cooling-event-driven    side by side
  grainflow view out/heap-hsmc --export heap.html             one file to pass on";

/// Set by Ctrl-C or SIGTERM, which is how a viewer ends.
static STOP: AtomicBool = AtomicBool::new(false);

pub(super) fn view(arguments: &ViewArguments) -> Exit {
    match show(arguments) {
        Ok(()) => Exit::Done,
        Err(error) => {
            complain(&error);
            if error.is_bad_input() { Exit::BadInput } else { Exit::RunFailed }
        }
    }
}

fn show(arguments: &ViewArguments) -> Result<(), ViewError> {
    let open = |path: &PathBuf| ViewedLog::open(&log_at(path));
    let logs = arguments.logs.iter().map(open).collect::<Result<Vec<_>, _>>()?;
    if let Some(page) = &arguments.export {
        for kept in export(&logs, page, arguments.force)? {
            println!("{}", kept.sentence());
        }
        println!("wrote {}", page.display());
        return Ok(());
    }
    let server = Server::bind(logs, arguments.port.unwrap_or(0), Limits::default())?;
    let port = server.port();
    // Without it Ctrl-C ends the program all the same, only less politely.
    let _ = ctrlc::set_handler(move || {
        STOP.store(true, SeqCst);
        wake(port);
    });
    let address = server.address();
    let is_open = !arguments.no_browser && open::that_detached(&address).is_ok();
    println!("{} {address}", if is_open { "a browser shows" } else { "open" });
    println!("Ctrl-C ends it");
    server.run(&STOP);
    Ok(())
}
