//! `grainflow.Measures`: one recording of the series.
//!
//! Every column is a field of its own, by name, so that viewers plot `/measures.kinetic_energy`
//! without a key to it. The description is therefore made for each log. Fields 1 … 15 are the same in
//! all logs; columns follow from 16 on. Units stand in the metadata of the channel.

use std::collections::BTreeMap;

use prost::Message;
use prost::encoding::{self, DecodeContext, WireType};
use prost_types::field_descriptor_proto::Type;
use prost_types::{DescriptorProto, FileDescriptorSet};

use super::descriptor::{file, single_field};
use super::units::{dimension_of, unit_text};
use crate::observe::measure::Column;

/// Name of the message.
pub(crate) const NAME: &str = "grainflow.Measures";

/// Number of the field that holds the time.
pub(crate) const TIME: u32 = 1;
const STATE_HASH: u32 = 2;
const GRAINS_IN_GAS: u32 = 3;
const FIRST_COLUMN: u32 = 16;
/// Numbers that protobuf keeps for itself.
const RESERVED: std::ops::RangeInclusive<u32> = 19_000..=19_999;

/// One recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct MeasuresMessage {
    /// `[column]`; the first is the time.
    pub(crate) values: Vec<f64>,
    /// In hexadecimal digits.
    pub(crate) state_hash: String,
    /// Grains in the gas, whatever a thinned picture shows.
    pub(crate) grains: u64,
}

/// What is wrong with `columns` as fields of a message, if anything.
pub(crate) fn fault_of(columns: &[Column]) -> Option<String> {
    if columns.first().is_none_or(|column| column.name != "time") {
        return Some("the first column has to be `time`".to_owned());
    }
    for (index, column) in columns.iter().enumerate() {
        let name = column.name.as_str();
        let plain = name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        if !plain {
            return Some(format!("the column `{name}` is not in snake case"));
        }
        if matches!(name, "state_hash" | "grains_in_gas") {
            return Some(format!("the column `{name}` has the name of a field that every log has"));
        }
        if columns[..index].iter().any(|other| other.name == name) {
            return Some(format!("the column `{name}` is there twice"));
        }
    }
    None
}

/// The description of the message with these `columns`.
pub(crate) fn descriptor_set(columns: &[Column]) -> Vec<u8> {
    let mut fields = vec![
        single_field("time", TIME as i32, Type::Double),
        single_field("state_hash", STATE_HASH as i32, Type::String),
        single_field("grains_in_gas", GRAINS_IN_GAS as i32, Type::Uint64),
    ];
    for (index, column) in columns.iter().enumerate().skip(1) {
        fields.push(single_field(&column.name, number_of(index) as i32, Type::Double));
    }
    let message = DescriptorProto { name: Some("Measures".to_owned()), field: fields, ..Default::default() };
    FileDescriptorSet { file: vec![file("grainflow/Measures.proto", "grainflow", Vec::new(), message)] }
        .encode_to_vec()
}

/// The units of `columns`, by name.
pub(crate) fn units(columns: &[Column]) -> BTreeMap<String, String> {
    columns.iter().map(|column| (format!("unit.{}", column.name), unit_text(column.unit))).collect()
}

/// The columns of a log, from the description and the units that stand in it; `None` where they
/// make no sense.
pub(crate) fn columns_of(description: &[u8], units: &BTreeMap<String, String>) -> Option<Vec<(u32, Column)>> {
    let set = FileDescriptorSet::decode(description).ok()?;
    let message =
        set.file.iter().flat_map(|file| &file.message_type).find(|message| message.name() == "Measures")?;
    let mut columns = Vec::new();
    for field in &message.field {
        let number = field.number() as u32;
        if number == TIME || number >= FIRST_COLUMN {
            let unit = dimension_of(units.get(&format!("unit.{}", field.name()))?)?;
            columns.push((number, Column { name: field.name().to_owned(), unit }));
        }
    }
    columns.sort_by_key(|&(number, _)| number);
    Some(columns)
}

/// The number of the field of column `index`.
fn number_of(index: usize) -> u32 {
    let number = match index {
        0 => TIME,
        _ => FIRST_COLUMN + index as u32 - 1,
    };
    if number >= *RESERVED.start() { number + 1000 } else { number }
}

impl MeasuresMessage {
    /// The message as bytes; every column is written, also where it is 0.
    pub(crate) fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(96 + 10 * self.values.len());
        for (index, value) in self.values.iter().enumerate() {
            encoding::double::encode(number_of(index), value, &mut bytes);
        }
        encoding::string::encode(STATE_HASH, &self.state_hash, &mut bytes);
        encoding::uint64::encode(GRAINS_IN_GAS, &self.grains, &mut bytes);
        bytes
    }

    /// Reads a message whose columns have these `numbers`; a column that it lacks is NaN.
    pub(crate) fn decode(mut bytes: &[u8], numbers: &[u32]) -> Result<Self, prost::DecodeError> {
        let mut message = MeasuresMessage { values: vec![f64::NAN; numbers.len()], ..Default::default() };
        while !bytes.is_empty() {
            let (number, wire) = encoding::decode_key(&mut bytes)?;
            message.merge(number, wire, &mut bytes, numbers)?;
        }
        Ok(message)
    }

    fn merge(
        &mut self,
        number: u32,
        wire: WireType,
        bytes: &mut &[u8],
        numbers: &[u32],
    ) -> Result<(), prost::DecodeError> {
        let context = DecodeContext::default();
        match (number, numbers.binary_search(&number)) {
            (STATE_HASH, _) => encoding::string::merge(wire, &mut self.state_hash, bytes, context),
            (GRAINS_IN_GAS, _) => encoding::uint64::merge(wire, &mut self.grains, bytes, context),
            (_, Ok(column)) => encoding::double::merge(wire, &mut self.values[column], bytes, context),
            (_, Err(_)) => encoding::skip_field(wire, number, bytes, context),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::measure::Dimension;

    fn columns(names: &[&str]) -> Vec<Column> {
        let unit = Dimension { mass: 1, length: 2, time: -2 };
        names.iter().map(|name| Column { name: (*name).to_owned(), unit }).collect()
    }

    #[test]
    fn columns_come_back_from_description_and_units() {
        let columns = columns(&["time", "kinetic_energy", "pressure"]);
        let back = columns_of(&descriptor_set(&columns), &units(&columns)).unwrap();
        assert_eq!(back.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1, 16, 17]);
        assert_eq!(back.into_iter().map(|(_, column)| column).collect::<Vec<_>>(), columns);
    }

    #[test]
    fn numbers_keep_out_of_the_reserved_range() {
        let numbers: Vec<u32> = (0..20_000).map(number_of).collect();
        assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(!numbers.iter().any(|number| RESERVED.contains(number)));
    }

    #[test]
    fn values_come_back_bit_for_bit_and_unknown_fields_are_passed_over() {
        let values = vec![0.5, -0.0, f64::from_bits(0x7ff8_0000_0000_1234)];
        let message = MeasuresMessage { values, state_hash: "ab".to_owned(), grains: 7 };
        let mut bytes = message.encode();
        encoding::double::encode(40, &1.0, &mut bytes);
        let back = MeasuresMessage::decode(&bytes, &[1, 16, 17]).unwrap();
        assert_eq!(back.state_hash, "ab");
        assert_eq!(back.grains, 7);
        let bits = |message: &MeasuresMessage| message.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back), bits(&message));
    }

    #[test]
    fn columns_that_cannot_be_fields_are_refused() {
        assert_eq!(fault_of(&columns(&["time", "a"])), None);
        for bad in
            [&["a"][..], &[], &["time", "A"], &["time", "a", "a"], &["time", "state_hash"], &["time", ""]]
        {
            assert!(fault_of(&columns(bad)).is_some(), "{bad:?}");
        }
    }
}
