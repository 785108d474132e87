//! What a log says before its first recording, and which of its channels is which.

use std::collections::BTreeMap;

use mcap::records::Record;
use prost::Message;

use crate::record::contents::RunLog;
use crate::record::scan::{Fault, check_format};
use crate::record::schema::foxglove::SceneUpdate;
use crate::record::schema::measures::columns_of;
use crate::record::schema::{self, topic};
use crate::record::walls::walls_of;

/// Everything but what is recorded time after time.
#[derive(Debug, Default)]
pub(super) struct Head {
    /// Metadata, scenario, columns and walls; no series, no frames.
    pub(super) log: RunLog,
    /// Whether the header of a log was there.
    pub(super) is_log: bool,
    /// Numbers of the fields of the columns.
    pub(super) numbers: Vec<u32>,
    /// Numbers of the channels.
    pub(super) measures: Option<u16>,
    pub(super) particles: Option<u16>,
    pub(super) states: Option<u16>,
    pub(super) walls: Option<u16>,
    /// Descriptions by number.
    schemas: BTreeMap<u16, Vec<u8>>,
}

impl Head {
    /// Takes from `record` what belongs here.
    pub(super) fn add(&mut self, record: &Record<'_>) -> Result<(), Fault> {
        match record {
            Record::Metadata(record) if record.name == schema::METADATA => {
                check_format(&record.metadata)?;
                self.is_log = true;
                self.log.metadata = record.metadata.clone();
            }
            Record::Attachment { header, data, .. } if header.name == schema::SCENARIO => {
                self.log.scenario = String::from_utf8(data.to_vec()).map_err(Fault::damage)?;
            }
            Record::Schema { header, data } => {
                self.schemas.insert(header.id, data.to_vec());
            }
            Record::Channel(one) => {
                let description = self.schemas.get(&one.schema_id).cloned().unwrap_or_default();
                self.channel(one.id, &one.topic, &description, &one.metadata)?;
            }
            Record::Message { header, data } if Some(header.channel_id) == self.walls => {
                let scene = SceneUpdate::decode(data.as_ref()).map_err(Fault::damage)?;
                self.log.walls = walls_of(&scene);
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes in a channel with the `description` of its messages.
    pub(super) fn channel(
        &mut self,
        id: u16,
        topic: &str,
        description: &[u8],
        metadata: &BTreeMap<String, String>,
    ) -> Result<(), Fault> {
        match topic {
            topic::MEASURES => {
                let columns = columns_of(description, metadata)
                    .ok_or_else(|| Fault::damage("the columns of the series have no proper units"))?;
                (self.numbers, self.log.columns) = columns.into_iter().unzip();
                self.measures = Some(id);
            }
            topic::PARTICLES => self.particles = Some(id),
            topic::STATE => self.states = Some(id),
            topic::WALLS => self.walls = Some(id),
            _ => {}
        }
        Ok(())
    }

    /// Ticks of the log per unit of time.
    pub(super) fn time_scale(&self) -> f64 {
        let text = self.log.metadata.get(schema::TIME_SCALE_KEY);
        text.and_then(|text| text.parse().ok()).filter(|scale| *scale > 0.0).unwrap_or(1e9)
    }
}
