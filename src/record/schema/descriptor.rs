//! Descriptions of messages, as they stand in the file: a `FileDescriptorSet` with everything
//! that a message refers to.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet, OneofDescriptorProto,
};

use super::{ALL, EnumTable, FieldTable, MessageTable};

/// The description of `table` and of all that it refers to, as bytes.
pub(crate) fn descriptor_set(table: &MessageTable) -> Vec<u8> {
    let mut set = FileDescriptorSet::default();
    add_file(&mut set, table);
    set.encode_to_vec()
}

/// A file that declares one message.
pub(crate) fn file(
    name: &str,
    package: &str,
    imports: Vec<String>,
    message: DescriptorProto,
) -> FileDescriptorProto {
    FileDescriptorProto {
        name: Some(name.to_owned()),
        package: Some(package.to_owned()),
        dependency: imports,
        message_type: vec![message],
        syntax: Some("proto3".to_owned()),
        ..Default::default()
    }
}

/// A field that holds one value of `kind`.
pub(crate) fn single_field(name: &str, number: i32, kind: Type) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(Label::Optional as i32),
        r#type: Some(kind as i32),
        ..Default::default()
    }
}

/// Adds the file of `table` behind the files that it imports.
fn add_file(set: &mut FileDescriptorSet, table: &MessageTable) {
    if set.file.iter().any(|file| file.name() == table.file) {
        return;
    }
    let mut imports: Vec<String> = Vec::new();
    for other in table.fields.iter().filter_map(|field| owner(field.of)) {
        if other.file != table.file && !imports.iter().any(|import| import == other.file) {
            imports.push(other.file.to_owned());
            add_file(set, other);
        }
    }
    set.file.push(file(table.file, table.package, imports, message(table)));
}

/// The message that is, or declares, what `full_name` names.
fn owner(full_name: &str) -> Option<&'static MessageTable> {
    let wanted = full_name.strip_prefix('.')?;
    let found = ALL.iter().find(|table| {
        wanted.strip_prefix(&table.full_name()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    });
    Some(found.expect("every message that a field names stands in the list of all messages"))
}

fn message(table: &MessageTable) -> DescriptorProto {
    let mut message = DescriptorProto {
        name: Some(table.name.to_owned()),
        enum_type: table.enums.iter().map(enumeration).collect(),
        ..Default::default()
    };
    for row in table.fields {
        let mut field = field(row);
        if field.proto3_optional == Some(true) {
            field.oneof_index = Some(message.oneof_decl.len() as i32);
            let name = Some(format!("_{}", field.name()));
            message.oneof_decl.push(OneofDescriptorProto { name, options: None });
        }
        message.field.push(field);
    }
    message
}

fn field(row: &FieldTable) -> FieldDescriptorProto {
    let name = row.name.strip_prefix("r#").unwrap_or(row.name);
    let mut words = row.kind.split(',').map(str::trim);
    let kind = kind(words.next().unwrap_or_default(), row.of);
    let mut field = single_field(name, row.tag, kind);
    match words.next() {
        Some("repeated") => field.label = Some(Label::Repeated as i32),
        Some("optional") => field.proto3_optional = (kind != Type::Message).then_some(true),
        Some(other) => unreachable!("`{other}` is no word for a field"),
        None => {}
    }
    if !row.of.is_empty() {
        field.type_name = Some(row.of.to_owned());
    }
    field
}

fn kind(word: &str, of: &str) -> Type {
    match word.split(' ').next().unwrap_or_default() {
        "double" => Type::Double,
        "int32" if !of.is_empty() => Type::Enum,
        "int32" => Type::Int32,
        "int64" => Type::Int64,
        "uint32" => Type::Uint32,
        "uint64" => Type::Uint64,
        "fixed32" => Type::Fixed32,
        "bool" => Type::Bool,
        "string" => Type::String,
        "bytes" => Type::Bytes,
        "message" => Type::Message,
        other => unreachable!("`{other}` is no kind of field"),
    }
}

fn enumeration(table: &EnumTable) -> EnumDescriptorProto {
    let value = |(number, name): (usize, &&str)| EnumValueDescriptorProto {
        name: Some((*name).to_owned()),
        number: Some(number as i32),
        options: None,
    };
    EnumDescriptorProto {
        name: Some(table.name.to_owned()),
        value: table.values.iter().enumerate().map(value).collect(),
        ..Default::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::field::{Field, Quantity};
    use crate::record::frame::{frame, point_cloud};
    use crate::record::grids::encode;
    use crate::record::schema::{Described, foxglove, grainflow};
    use crate::record::state::SavedState;
    use crate::record::walls::scene;
    use crate::record::{contents::Walls, saved};
    use glam::DVec3;
    use prost::encoding::{DecodeContext, WireType, decode_key, decode_varint, skip_field};

    /// Walks `bytes` by the description of `full_name` alone; the names of the fields met.
    fn walk(set: &FileDescriptorSet, full_name: &str, mut bytes: &[u8]) -> Vec<String> {
        let wanted = full_name.trim_start_matches('.');
        let file = set.file.iter().find(|file| {
            file.message_type.iter().any(|message| format!("{}.{}", file.package(), message.name()) == wanted)
        });
        let message = &file.unwrap_or_else(|| panic!("{full_name} is not described")).message_type[0];
        let mut seen = Vec::new();
        while !bytes.is_empty() {
            let (number, wire) = decode_key(&mut bytes).unwrap();
            let field = message.field.iter().find(|field| field.number() == number as i32);
            let field = field.unwrap_or_else(|| panic!("{full_name} has no field {number}"));
            assert_eq!(wire, wire_type(field), "{full_name}.{}", field.name());
            seen.push(format!("{}.{}", message.name(), field.name()));
            if field.r#type() == Type::Message {
                let length = decode_varint(&mut bytes).unwrap() as usize;
                let (inner, rest) = bytes.split_at(length);
                seen.extend(walk(set, field.type_name(), inner));
                bytes = rest;
            } else {
                skip_field(wire, number, &mut bytes, DecodeContext::default()).unwrap();
            }
        }
        seen
    }

    fn wire_type(field: &FieldDescriptorProto) -> WireType {
        let packed = field.label() == Label::Repeated;
        match field.r#type() {
            _ if packed => WireType::LengthDelimited,
            Type::Double => WireType::SixtyFourBit,
            Type::Fixed32 => WireType::ThirtyTwoBit,
            Type::String | Type::Bytes | Type::Message => WireType::LengthDelimited,
            _ => WireType::Varint,
        }
    }

    fn described<M: Described>(message: &M) -> Vec<String> {
        let set = FileDescriptorSet::decode(descriptor_set(&M::TABLE).as_slice()).unwrap();
        walk(&set, &M::TABLE.full_name(), &message.encode_to_vec())
    }

    fn state() -> SavedState<'static, DVec3> {
        let mut state =
            SavedState { time: 1.0, samples: vec![3], recordings: 2, next_id: 9, ..Default::default() };
        state.columns.to_mut().spins = Some(Vec::new());
        state.columns.to_mut().species = Some(Vec::new());
        state.columns.to_mut().insert(0, DVec3::ONE, DVec3::ONE, 8);
        state.memories = vec![("energy".to_owned(), vec![1.0])];
        state.engine.step = 5;
        state.totals.steps = 5;
        state.totals.counts.collisions = 6;
        state
    }

    #[test]
    fn what_is_written_follows_its_description() {
        let seen = described(&saved::part(&state(), 0..1));
        for field in ["State.time", "State.spins", "State.samples", "Engine.step", "Totals.wall_momentum"] {
            assert!(seen.iter().any(|name| name == field), "{field} in {seen:?}");
        }
        let cloud = point_cloud(&frame(1.0, &state().columns, None), 1_500_000_000);
        let seen = described(&cloud);
        for field in
            ["Timestamp.seconds", "PackedElementField.type", "PointCloud.point_stride", "Quaternion.w"]
        {
            assert!(seen.iter().any(|name| name == field), "{field} in {seen:?}");
        }
        let walls = Walls {
            sides: std::array::from_fn(|_| ["wall".to_owned(), "periodic".to_owned()]),
            ..Default::default()
        };
        assert!(described(&scene(&walls, 7)).iter().any(|name| name == "LinePrimitive.type"));
        let column =
            grainflow::ProfileColumn { name: "x".to_owned(), unit: "1".to_owned(), values: vec![1.0] };
        let profile = grainflow::Profile { time: 1.0, name: "p".to_owned(), columns: vec![column] };
        assert_eq!(described(&profile).len(), 6);
    }

    #[test]
    fn grids_follow_their_descriptions() {
        for (depth, table) in [(0.0, &foxglove::Grid::TABLE), (1.0, &foxglove::VoxelGrid::TABLE)] {
            let components = Quantity::Density.components(2);
            let (side, cells, values) = ([1.0, 1.0, depth], [2, 1, 1], vec![vec![0.5, 0.25]]);
            let field = Field { side, cells, components, values, ..Field::default() };
            let set = FileDescriptorSet::decode(descriptor_set(table).as_slice()).unwrap();
            let seen = walk(&set, &table.full_name(), &encode(&field, 1_500_000_000));
            for name in ["cell_size", "row_stride", "column_count", "fields", "data", "pose"] {
                assert!(seen.contains(&format!("{}.{name}", table.name)), "{name} in {seen:?}");
            }
        }
    }

    #[test]
    fn descriptions_are_complete_and_numbers_unique() {
        for table in ALL {
            let set = FileDescriptorSet::decode(descriptor_set(table).as_slice()).unwrap();
            for (index, file) in set.file.iter().enumerate() {
                for import in &file.dependency {
                    let before = &set.file[..index];
                    assert!(
                        before.iter().any(|other| other.name() == import),
                        "{import} before {}",
                        file.name()
                    );
                }
            }
            let message = &set.file.last().unwrap().message_type[0];
            assert_eq!(message.name(), table.name);
            let mut numbers: Vec<i32> = message.field.iter().map(|field| field.number()).collect();
            numbers.sort_unstable();
            numbers.dedup();
            assert_eq!(numbers.len(), table.fields.len(), "{}", table.name);
        }
    }

    #[test]
    fn fixed_numbers_are_described_as_such() {
        let field = |message: &MessageTable, name: &str| {
            let row = message.fields.iter().find(|row| row.name == name).unwrap();
            super::field(row)
        };
        assert_eq!(field(&foxglove::PointCloud::TABLE, "point_stride").r#type(), Type::Fixed32);
        assert_eq!(field(&foxglove::PackedElementField::TABLE, "offset").r#type(), Type::Fixed32);
        assert_eq!(field(&foxglove::PackedElementField::TABLE, "r#type").r#type(), Type::Enum);
        assert_eq!(field(&grainflow::State::TABLE, "species").proto3_optional, Some(true));
    }
}
