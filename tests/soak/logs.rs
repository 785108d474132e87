//! Small logs, and wounds below their checksums.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use grainflow::run::run;
use grainflow::scenario::{Overrides, parse};
use mcap::records::Record;

use super::draw::Dice;
use super::{mutation, states};

/// A flat gas, a heap in space, exact dynamics with spins.
const SCENARIOS: [&str; 3] = [
    "dimension = 2\n[engine]\nkind = \"hsmc\"\n[domain]\nsize = [9.0, 9.0]\n[particles]\ncount = 20\nrestitution = 0.9\n\
     [initial]\nvelocities = { maxwell = 1.0 }\n[run]\nsteps = 4\n[record]\nframes = 2\nstates = 1\n",
    "dimension = 3\ngravity = [0.0, 0.0, -1.0]\n[engine]\nkind = \"dsmc\"\n[domain]\nsize = [6.0, 6.0, 20.0]\n[boundary]\n\
     z.lower = { wall = \"rough\" }\nz.upper = \"open\"\n[particles]\ncount = 5\nrestitution = 0.5\n[source]\ncount = 5\n\
     rate = 9.0\n[run]\nsteps = 5\n[record]\nframes = 2\nmeasures = [\"energy\"]\n",
    "dimension = 2\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = [9.0, 9.0]\n[particles]\ncount = 20\n\
     restitution = 0.9\ntangential_restitution = 0.5\n[initial]\nvelocities = { maxwell = 1.0 }\n[run]\ntime = 1.0\n\
     [record]\nframes = 2\nstates = 1\n",
];

/// The topic of saved states.
const STATES: &str = "/state";

/// The logs of small runs.
pub(crate) fn written(place: &Path) -> Result<Vec<Vec<u8>>, String> {
    let log = |(k, text): (usize, &&str)| {
        let folder = place.join(format!("run-{k}"));
        let scenario = parse("small", text, &Overrides::default()).map_err(|error| error.to_string())?;
        run(&scenario, &folder, false, &AtomicBool::new(false), &mut |_| {})
            .map_err(|error| error.to_string())?;
        fs::read(folder.join("log.mcap")).map_err(|error| error.to_string())
    };
    SCENARIOS.iter().enumerate().map(log).collect()
}

/// The first of these logs.
pub(crate) fn first(place: &Path) -> PathBuf {
    place.join("run-0/log.mcap")
}

/// `log` with wounds in messages, descriptions, metadata or the scenario, and with checksums that hold.
pub(crate) fn rewritten(dice: &mut Dice, log: &[u8]) -> Option<Vec<u8>> {
    let mut writer = mcap::WriteOptions::new().compression(None).create(Cursor::new(Vec::new())).ok()?;
    let wounded = dice.below(12);
    for (place, record) in mcap::read::ChunkFlattener::new(log).ok()?.enumerate() {
        let hit = place == wounded || dice.chance(0.05);
        put(&mut writer, dice, record.ok()?, hit)?;
    }
    writer.finish().ok()?;
    Some(writer.into_inner().into_inner())
}

/// `log` with wounds in its saved states only, and with checksums that hold.
pub(crate) fn with_wounded_states(dice: &mut Dice, log: &[u8]) -> Option<Vec<u8>> {
    let mut writer = mcap::WriteOptions::new().compression(None).create(Cursor::new(Vec::new())).ok()?;
    let mut of_states = None;
    for record in mcap::read::ChunkFlattener::new(log).ok()? {
        match record.ok()? {
            Record::Message { header, data } if Some(header.channel_id) == of_states => {
                let data = if dice.chance(0.7) { states::wounded(dice, &data) } else { data.to_vec() };
                writer.write_to_known_channel(&header, &data).ok()?;
            }
            record => {
                if let Record::Channel(channel) = &record
                    && channel.topic == STATES
                {
                    of_states = Some(channel.id);
                }
                put(&mut writer, dice, record, false)?;
            }
        }
    }
    writer.finish().ok()?;
    Some(writer.into_inner().into_inner())
}

fn put(
    writer: &mut mcap::Writer<Cursor<Vec<u8>>>,
    dice: &mut Dice,
    record: Record<'_>,
    hit: bool,
) -> Option<()> {
    let bytes = |dice: &mut Dice, data: &[u8]| if hit { mutation::bytes(dice, data) } else { data.to_vec() };
    match record {
        Record::Metadata(mut metadata) => {
            if hit {
                wound(dice, &mut metadata.metadata);
            }
            writer.write_metadata(&metadata).ok()
        }
        Record::Attachment { header, data, .. } => {
            let data = bytes(dice, &data);
            let (log_time, create_time) = (header.log_time, header.create_time);
            let (name, media_type) = (header.name, header.media_type);
            writer
                .attach(&mcap::Attachment { log_time, create_time, name, media_type, data: data.into() })
                .ok()
        }
        Record::Schema { header, data } => writer
            .add_schema_with_id(header.id, &header.name, &header.encoding, &bytes(dice, &data))
            .ok()
            .map(drop),
        Record::Channel(mut one) => {
            if hit {
                wound(dice, &mut one.metadata);
            }
            // Descriptions stand in chunks and in the summary: the first is the one that counts.
            let _ = writer.add_channel_with_id(
                one.id,
                one.schema_id,
                &one.topic,
                &one.message_encoding,
                &one.metadata,
            );
            Some(())
        }
        Record::Message { mut header, data } => {
            if hit && dice.chance(0.2) {
                header.sequence = header.sequence.wrapping_sub(1);
            }
            writer.write_to_known_channel(&header, &bytes(dice, &data)).ok()
        }
        _ => Some(()),
    }
}

/// A value of the table changes, or one goes.
fn wound(dice: &mut Dice, table: &mut BTreeMap<String, String>) {
    let keys: Vec<String> = table.keys().cloned().collect();
    if keys.is_empty() {
        return;
    }
    let key = &keys[dice.below(keys.len())];
    if dice.chance(0.3) {
        table.remove(key);
    } else if let Some(value) = table.get_mut(key) {
        *value = mutation::text(dice, value, &keys);
    }
}
