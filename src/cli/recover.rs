//! `grainflow recover`.

use std::path::PathBuf;

use clap::Args;

use super::{Exit, complain};
use crate::record::error::LogError;
use crate::record::recover::{Recovery, recover as recover_log};

/// Make a clean, indexed log of what is sound in a damaged one
///
/// The damaged log stays as it is. Of a log that is whole nothing is written.
#[derive(Args, Debug)]
pub(super) struct RecoverArguments {
    /// A log, or a run folder
    #[arg(value_name = "LOG")]
    log: PathBuf,

    /// The file to write [default: beside LOG, as in log.recovered.mcap]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn recover(arguments: &RecoverArguments) -> Exit {
    let log = match arguments.log.is_dir() {
        true => arguments.log.join("log.mcap"),
        false => arguments.log.clone(),
    };
    let clean = arguments.out.clone().unwrap_or_else(|| log.with_extension("recovered.mcap"));
    match recover_log(&log, &clean) {
        Ok(None) => {
            println!("{} is whole: nothing to recover, nothing written", log.display());
            Exit::Done
        }
        Ok(Some(recovery)) => {
            println!("{}wrote {}", words(&recovery), clean.display());
            Exit::Done
        }
        Err(error) => {
            complain(&error);
            if matches!(error, LogError::Create { .. } | LogError::Write { .. }) {
                return Exit::RunFailed;
            }
            Exit::BadInput
        }
    }
}

/// What was found, and what was lost.
fn words(recovery: &Recovery) -> String {
    let mut text = format!("{} messages are sound\n", recovery.messages);
    if recovery.damaged_parts > 0 {
        text += &format!("{} parts of the file are damaged and left out\n", recovery.damaged_parts);
    }
    if recovery.cut_off {
        text += "the file ends too early: what was not yet complete is lost\n";
    }
    for (topic, lost) in &recovery.lost {
        text += &format!("lost in between: {lost} messages of {topic}\n");
    }
    text + &match (recovery.whole_until, recovery.end) {
        (_, None) => "no recording is left\n".to_owned(),
        (None, Some(end)) => format!("whole up to t = {end:.6}, its last recording\n"),
        (Some(whole), Some(end)) => {
            format!("whole up to t = {whole:.6}; recordings with holes up to t = {end:.6}\n")
        }
    }
}
