//! `grainflow recover`.

use std::path::PathBuf;

use clap::Args;

use super::{Exit, complain};
use crate::number::plain;
use crate::record::error::LogError;
use crate::record::log_at;
use crate::record::recover::{Recovery, recover as recover_log};

/// Make a clean, indexed log of what is sound in a damaged one
#[derive(Args, Debug)]
#[command(after_help = "The damaged log stays as it is. Of a log that is whole nothing is written.")]
pub(super) struct RecoverArguments {
    /// A log, or a run folder
    #[arg(value_name = "LOG")]
    log: PathBuf,

    /// The file to write [default: log.recovered.mcap beside the log]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn recover(arguments: &RecoverArguments) -> Exit {
    let log = log_at(&arguments.log);
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
    let mut text = match recovery.messages {
        1 => "1 message is sound\n".to_owned(),
        messages => format!("{messages} messages are sound\n"),
    };
    match recovery.damaged_parts {
        0 => {}
        1 => text += "1 part of the file is damaged and left out\n",
        parts => text += &format!("{parts} parts of the file are damaged and left out\n"),
    }
    if recovery.cut_off {
        text += "the file ends too early: what was not yet complete is lost\n";
    }
    for (topic, lost) in &recovery.lost {
        let messages = if *lost == 1 { "message" } else { "messages" };
        text += &format!("lost: {lost} {messages} of {topic}\n");
    }
    text + &match (recovery.whole_until, recovery.end) {
        (_, None) => "no recording is left\n".to_owned(),
        (None, Some(end)) => format!("whole up to t = {}, its last recording\n", plain(end, 6)),
        (Some(whole), Some(end)) => {
            let [whole, end] = [whole, end].map(|time| plain(time, 6));
            format!("whole up to t = {whole}; recordings with holes up to t = {end}\n")
        }
    }
}
