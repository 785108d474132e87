//! Runs, their logs, and logs made wrong on purpose.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use grainflow::run::resume::Resumption;
use grainflow::run::verify::{Extent, Verdict, VerifyError};
use grainflow::run::{Outcome, run};
use grainflow::scenario::model::AnyScenario;
use mcap::records::Record;
use serde_json::{Map, Value};

/// A place to work in.
pub(crate) struct Place(tempfile::TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Place(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

pub(crate) fn run_into(folder: &Path, scenario: &AnyScenario) -> Outcome {
    run(scenario, folder, false, &AtomicBool::new(false), &mut |_| {}).unwrap()
}

pub(crate) fn resume(log: &Path, sets: &[&str], folder: &Path) -> Outcome {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let resumption = Resumption::open(log, &sets).unwrap_or_else(|error| panic!("{error}"));
    resumption.run(folder, false, &AtomicBool::new(false), &mut |_| {}).unwrap()
}

pub(crate) fn verify(log: &Path) -> Result<Verdict, VerifyError> {
    grainflow::run::verify::verify(log, &AtomicBool::new(false), &mut |_| {})
}

/// What was found identical, and what is missing.
pub(crate) fn verified(log: &Path) -> (Extent, Option<String>) {
    match verify(log) {
        Ok(Verdict::Identical(extent, cut_off)) => (extent, cut_off),
        Ok(other) => panic!("{}: {other:?}", log.display()),
        Err(error) => panic!("{error}"),
    }
}

pub(crate) fn log_bytes(outcome: &Outcome) -> Vec<u8> {
    fs::read(outcome.folder.join("log.mcap")).unwrap()
}

/// The summary without what a run costs, and without where it was resumed.
pub(crate) fn figures(outcome: &Outcome) -> Map<String, Value> {
    let is_cost =
        |key: &str| key.ends_with("_second") || key.ends_with("_seconds") || key == "peak_memory_bytes";
    let mut figures = outcome.summary.clone();
    figures.retain(|key, _| !is_cost(key) && key != "resumed_at");
    figures
}

/// The log in `bytes` with other metadata and another scenario, and all checksums right.
pub(crate) fn rewritten(
    bytes: &[u8],
    metadata: impl Fn(&mut BTreeMap<String, String>),
    scenario: impl Fn(String) -> String,
) -> Vec<u8> {
    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
    for record in mcap::read::LinearReader::new(bytes).unwrap() {
        match record.unwrap() {
            Record::Metadata(mut record) => {
                metadata(&mut record.metadata);
                writer.write_metadata(&record).unwrap();
            }
            Record::Attachment { header, data, .. } => {
                let text = scenario(String::from_utf8(data.into_owned()).unwrap());
                let attachment = mcap::Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data: text.into_bytes().into(),
                };
                writer.attach(&attachment).unwrap();
            }
            _ => {}
        }
    }
    for message in mcap::MessageStream::new(bytes).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// Where the chunks of a log begin and end.
pub(crate) fn chunks(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    const MAGIC: usize = 8;
    const CHUNK: u8 = 0x06;
    let (mut chunks, mut start) = (Vec::new(), MAGIC);
    while start + 9 <= bytes.len() - MAGIC {
        let length = u64::from_le_bytes(bytes[start + 1..start + 9].try_into().unwrap()) as usize;
        let end = start + 9 + length;
        if bytes[start] == CHUNK {
            chunks.push(start..end);
        }
        start = end;
    }
    chunks
}

/// The log without one of its chunks.
pub(crate) fn without_chunk(bytes: &[u8], k: usize) -> Vec<u8> {
    let chunk = chunks(bytes)[k].clone();
    [&bytes[..chunk.start], &bytes[chunk.end..]].concat()
}

/// Numbers as bits: what is not defined is the same as itself.
pub(crate) fn bits<'a>(rows: impl IntoIterator<Item = &'a Vec<f64>>) -> Vec<Vec<u64>> {
    rows.into_iter().map(|row| row.iter().map(|value| value.to_bits()).collect()).collect()
}
