//! The messages of a log: each is written down once, as a Rust struct and as the description
//! that stands in the file.

pub(crate) mod descriptor;
pub(crate) mod foxglove;
pub(crate) mod grainflow;
pub(crate) mod measures;
pub(crate) mod units;

use sha2::{Digest, Sha256};

/// The newest form of a log that this program writes and reads.
pub(crate) const FORMAT: u32 = 1;
/// Name of the metadata record that holds everything known about the run.
pub(crate) const METADATA: &str = "grainflow";
/// Metadata key: the form of the log.
pub(crate) const FORMAT_KEY: &str = "format";
/// Metadata key: ticks of `log_time` per unit of simulated time.
pub(crate) const TIME_SCALE_KEY: &str = "time_scale";
/// Metadata key: SHA-256 of the scenario's text, in hexadecimal digits.
pub(crate) const DIGEST_KEY: &str = "scenario_sha256";
/// Metadata key of logs that were recovered from damaged ones: messages may be missing.
pub(crate) const RECOVERED_KEY: &str = "recovered";
/// Name of the metadata records that say where a run was resumed with changes; one for each time.
pub(crate) const RESUMPTION: &str = "grainflow.resumption";
/// Name of the attachment that holds the scenario.
pub(crate) const SCENARIO: &str = "scenario.toml";
/// How the names of attachments begin that hold the scenarios of earlier parts.
pub(crate) const EARLIER_SCENARIO: &str = "scenario-before-";
/// The one frame of reference.
pub(crate) const FRAME_ID: &str = "world";

/// SHA-256 of a text, in hexadecimal digits.
pub(crate) fn digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Where the kinds of messages go.
pub(crate) mod topic {
    pub(crate) const MEASURES: &str = "/measures";
    /// What stands before the name of a field.
    pub(crate) const FIELDS: &str = "/fields/";
    pub(crate) const PARTICLES: &str = "/particles";
    pub(crate) const PROFILES: &str = "/profiles";
    pub(crate) const STATE: &str = "/state";
    pub(crate) const WALLS: &str = "/walls";

    /// Where messages are numbered one after the other: a number that is missing is a message that is missing. What
    /// belongs to a recording has the number of that.
    pub(crate) const COUNTED: [&str; 3] = [MEASURES, PROFILES, STATE];
}

/// A message that is described in the file.
pub(crate) trait Described: prost::Message + Default {
    /// Its description.
    const TABLE: MessageTable;
}

/// What a message is made of.
#[derive(Debug)]
pub(crate) struct MessageTable {
    /// Such as `foxglove`.
    pub(crate) package: &'static str,
    /// Such as `Pose`.
    pub(crate) name: &'static str,
    /// The file that declares it, such as `foxglove/Pose.proto`.
    pub(crate) file: &'static str,
    /// Fields, in the order of declaration.
    pub(crate) fields: &'static [FieldTable],
    /// Enumerations declared inside.
    pub(crate) enums: &'static [EnumTable],
}

impl MessageTable {
    /// Such as `foxglove.Pose`.
    pub(crate) fn full_name(&self) -> String {
        format!("{}.{}", self.package, self.name)
    }
}

/// A field of a message.
#[derive(Debug)]
pub(crate) struct FieldTable {
    /// Its number: never given to another field.
    pub(crate) tag: i32,
    /// Its name; `r#` in front of Rust's own words.
    pub(crate) name: &'static str,
    /// The words that prost is given, such as `double, repeated`.
    pub(crate) kind: &'static str,
    /// Full name of the message or enumeration that it holds, or empty.
    pub(crate) of: &'static str,
}

/// An enumeration declared inside a message.
#[derive(Debug)]
pub(crate) struct EnumTable {
    /// Its name.
    pub(crate) name: &'static str,
    /// Names of the values 0, 1, 2 …
    pub(crate) values: &'static [&'static str],
}

/// Declares a message: the struct that prost encodes and the table that describes it.
///
/// `name: Type = tag [words for prost] "full name of what it holds"`; an `int32` that holds
/// something is an enumeration.
macro_rules! message {
    (
        $(#[$doc:meta])*
        $package:literal $file:literal $name:ident {
            $( $(#[$field_doc:meta])* $field:ident: $type:ty = $tag:tt [$($kind:tt)+] $($of:literal)? ),* $(,)?
        }
        $( enum $enum:literal [$($value:literal),*] )?
    ) => {
        $(#[$doc])*
        #[derive(Clone, PartialEq, prost::Message)]
        pub(crate) struct $name {
            $( $(#[$field_doc])* #[prost($($kind)+, tag = $tag)] pub(crate) $field: $type, )*
        }

        impl $crate::record::schema::Described for $name {
            const TABLE: $crate::record::schema::MessageTable = $crate::record::schema::MessageTable {
                package: $package,
                name: stringify!($name),
                file: $file,
                fields: &[ $( $crate::record::schema::FieldTable {
                    tag: $tag,
                    name: stringify!($field),
                    kind: stringify!($($kind)+),
                    of: concat!($($of)?),
                } ),* ],
                enums: &[ $( $crate::record::schema::EnumTable {
                    name: $enum,
                    values: &[$($value),*],
                } )? ],
            };
        }
    };
}
pub(crate) use message;

/// Every message that a description may refer to.
pub(crate) const ALL: &[MessageTable] = &[
    foxglove::Timestamp::TABLE,
    foxglove::Duration::TABLE,
    foxglove::Vector2::TABLE,
    foxglove::Vector3::TABLE,
    foxglove::Point3::TABLE,
    foxglove::Quaternion::TABLE,
    foxglove::Pose::TABLE,
    foxglove::Color::TABLE,
    foxglove::KeyValuePair::TABLE,
    foxglove::PackedElementField::TABLE,
    foxglove::PointCloud::TABLE,
    foxglove::Grid::TABLE,
    foxglove::VoxelGrid::TABLE,
    foxglove::ArrowPrimitive::TABLE,
    foxglove::CubePrimitive::TABLE,
    foxglove::SpherePrimitive::TABLE,
    foxglove::CylinderPrimitive::TABLE,
    foxglove::LinePrimitive::TABLE,
    foxglove::TriangleListPrimitive::TABLE,
    foxglove::TextPrimitive::TABLE,
    foxglove::ModelPrimitive::TABLE,
    foxglove::SceneEntity::TABLE,
    foxglove::SceneEntityDeletion::TABLE,
    foxglove::SceneUpdate::TABLE,
    grainflow::ProfileColumn::TABLE,
    grainflow::Profile::TABLE,
    grainflow::Engine::TABLE,
    grainflow::Totals::TABLE,
    grainflow::Events::TABLE,
    grainflow::Memory::TABLE,
    grainflow::Beginning::TABLE,
    grainflow::State::TABLE,
];
