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
