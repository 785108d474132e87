//! The well-known messages that viewers draw, as Foxglove publishes them: grains as a
//! `foxglove.PointCloud`, fields as `foxglove.Grid` and `foxglove.VoxelGrid`, the box as a `foxglove.SceneUpdate`.
//!
//! Also what a log never holds is described, so that viewers find every field they look for.

use super::message;

/// `PackedElementField.NumericType`: an unsigned integer of 4 bytes.
pub(crate) const UINT32: i32 = 5;
/// `PackedElementField.NumericType`: a float of 4 bytes.
pub(crate) const FLOAT32: i32 = 7;
/// `LinePrimitive.Type`: a line that returns to its first point.
pub(crate) const LINE_LOOP: i32 = 1;

message! {
    /// A point in time.
    "google.protobuf" "google/protobuf/timestamp.proto" Timestamp {
        /// Whole seconds.
        seconds: i64 = 1 [int64],
        /// Nanoseconds, 0 … 999 999 999.
        nanos: i32 = 2 [int32],
    }
}

message! {
    /// A span of time.
    "google.protobuf" "google/protobuf/duration.proto" Duration {
        /// Whole seconds.
        seconds: i64 = 1 [int64],
        /// Nanoseconds.
        nanos: i32 = 2 [int32],
    }
}

message! {
    /// A vector in a plane.
    "foxglove" "foxglove/Vector2.proto" Vector2 {
        /// Along x.
        x: f64 = 1 [double],
        /// Along y.
        y: f64 = 2 [double],
    }
}

message! {
    /// A vector.
    "foxglove" "foxglove/Vector3.proto" Vector3 {
        /// Along x.
        x: f64 = 1 [double],
        /// Along y.
        y: f64 = 2 [double],
        /// Along z.
        z: f64 = 3 [double],
    }
}

message! {
    /// A point.
    "foxglove" "foxglove/Point3.proto" Point3 {
        /// Along x.
        x: f64 = 1 [double],
        /// Along y.
        y: f64 = 2 [double],
        /// Along z.
        z: f64 = 3 [double],
    }
}

message! {
    /// A rotation.
    "foxglove" "foxglove/Quaternion.proto" Quaternion {
        /// Component x.
        x: f64 = 1 [double],
        /// Component y.
        y: f64 = 2 [double],
        /// Component z.
        z: f64 = 3 [double],
        /// Component w.
        w: f64 = 4 [double],
    }
}

message! {
    /// A place and an orientation.
    "foxglove" "foxglove/Pose.proto" Pose {
        /// The place.
        position: Option<Vector3> = 1 [message, optional] ".foxglove.Vector3",
        /// The orientation.
        orientation: Option<Quaternion> = 2 [message, optional] ".foxglove.Quaternion",
    }
}

message! {
    /// A colour; each part lies in 0 … 1.
    "foxglove" "foxglove/Color.proto" Color {
        /// Red.
        r: f64 = 1 [double],
        /// Green.
        g: f64 = 2 [double],
        /// Blue.
        b: f64 = 3 [double],
        /// Opacity.
        a: f64 = 4 [double],
    }
}

message! {
    /// A key and its value.
    "foxglove" "foxglove/KeyValuePair.proto" KeyValuePair {
        /// The key.
        key: String = 1 [string],
        /// The value.
        value: String = 2 [string],
    }
}

message! {
    /// Where a field of a point stands among its bytes.
    "foxglove" "foxglove/PackedElementField.proto" PackedElementField {
        /// Its name.
        name: String = 1 [string],
        /// Bytes before it.
        offset: u32 = 2 [fixed32],
        /// How its bytes are read.
        r#type: i32 = 3 [int32] ".foxglove.PackedElementField.NumericType",
    }
    enum "NumericType" ["UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64"]
}

message! {
    /// A cloud of points.
    "foxglove" "foxglove/PointCloud.proto" PointCloud {
        /// When.
        timestamp: Option<Timestamp> = 1 [message, optional] ".google.protobuf.Timestamp",
        /// Frame of reference.
        frame_id: String = 2 [string],
        /// Where the origin of the points is.
        pose: Option<Pose> = 3 [message, optional] ".foxglove.Pose",
        /// Bytes from one point to the next.
        point_stride: u32 = 4 [fixed32],
        /// What a point is made of.
        fields: Vec<PackedElementField> = 5 [message, repeated] ".foxglove.PackedElementField",
        /// The points, little-endian.
        data: Vec<u8> = 6 [bytes = "vec"],
    }
}

message! {
    /// A grid of cells in a plane.
    "foxglove" "foxglove/Grid.proto" Grid {
        /// When.
        timestamp: Option<Timestamp> = 1 [message, optional] ".google.protobuf.Timestamp",
        /// Frame of reference.
        frame_id: String = 2 [string],
        /// Where the lower corner of the first cell is.
        pose: Option<Pose> = 3 [message, optional] ".foxglove.Pose",
        /// Cells along x.
        column_count: u32 = 4 [fixed32],
        /// Sides of a cell.
        cell_size: Option<Vector2> = 5 [message, optional] ".foxglove.Vector2",
        /// Bytes from one row to the next.
        row_stride: u32 = 6 [fixed32],
        /// Bytes from one cell to the next.
        cell_stride: u32 = 7 [fixed32],
        /// What a cell holds.
        fields: Vec<PackedElementField> = 8 [message, repeated] ".foxglove.PackedElementField",
        /// The cells, x fastest, little-endian.
        data: Vec<u8> = 9 [bytes = "vec"],
    }
}

message! {
    /// A grid of cells in space.
    "foxglove" "foxglove/VoxelGrid.proto" VoxelGrid {
        /// When.
        timestamp: Option<Timestamp> = 1 [message, optional] ".google.protobuf.Timestamp",
        /// Frame of reference.
        frame_id: String = 2 [string],
        /// Where the lower corner of the first cell is.
        pose: Option<Pose> = 3 [message, optional] ".foxglove.Pose",
        /// Cells along y.
        row_count: u32 = 4 [fixed32],
        /// Cells along x.
        column_count: u32 = 5 [fixed32],
        /// Sides of a cell.
        cell_size: Option<Vector3> = 6 [message, optional] ".foxglove.Vector3",
        /// Bytes from one slice to the next.
        slice_stride: u32 = 7 [fixed32],
        /// Bytes from one row to the next.
        row_stride: u32 = 8 [fixed32],
        /// Bytes from one cell to the next.
        cell_stride: u32 = 9 [fixed32],
        /// What a cell holds.
        fields: Vec<PackedElementField> = 10 [message, repeated] ".foxglove.PackedElementField",
        /// The cells, x fastest, z slowest, little-endian.
        data: Vec<u8> = 11 [bytes = "vec"],
    }
}

message! {
    /// An arrow.
    "foxglove" "foxglove/ArrowPrimitive.proto" ArrowPrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Length of the shaft.
        shaft_length: f64 = 2 [double],
        /// Diameter of the shaft.
        shaft_diameter: f64 = 3 [double],
        /// Length of the head.
        head_length: f64 = 4 [double],
        /// Diameter of the head.
        head_diameter: f64 = 5 [double],
        /// Its colour.
        color: Option<Color> = 6 [message, optional] ".foxglove.Color",
    }
}

message! {
    /// A box.
    "foxglove" "foxglove/CubePrimitive.proto" CubePrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Its sides.
        size: Option<Vector3> = 2 [message, optional] ".foxglove.Vector3",
        /// Its colour.
        color: Option<Color> = 3 [message, optional] ".foxglove.Color",
    }
}

message! {
    /// An ellipsoid.
    "foxglove" "foxglove/SpherePrimitive.proto" SpherePrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Its sides.
        size: Option<Vector3> = 2 [message, optional] ".foxglove.Vector3",
        /// Its colour.
        color: Option<Color> = 3 [message, optional] ".foxglove.Color",
    }
}

message! {
    /// A cylinder or cone.
    "foxglove" "foxglove/CylinderPrimitive.proto" CylinderPrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Its sides.
        size: Option<Vector3> = 2 [message, optional] ".foxglove.Vector3",
        /// Scale of the bottom.
        bottom_scale: f64 = 3 [double],
        /// Scale of the top.
        top_scale: f64 = 4 [double],
        /// Its colour.
        color: Option<Color> = 5 [message, optional] ".foxglove.Color",
    }
}

message! {
    /// A line through points.
    "foxglove" "foxglove/LinePrimitive.proto" LinePrimitive {
        /// How the points are joined.
        r#type: i32 = 1 [int32] ".foxglove.LinePrimitive.Type",
        /// Where the origin of the points is.
        pose: Option<Pose> = 2 [message, optional] ".foxglove.Pose",
        /// Thickness.
        thickness: f64 = 3 [double],
        /// Whether the thickness is in pixels.
        scale_invariant: bool = 4 [bool],
        /// The points.
        points: Vec<Point3> = 5 [message, repeated] ".foxglove.Point3",
        /// Its colour.
        color: Option<Color> = 6 [message, optional] ".foxglove.Color",
        /// A colour for each point.
        colors: Vec<Color> = 7 [message, repeated] ".foxglove.Color",
        /// Points in drawing order.
        indices: Vec<u32> = 8 [fixed32, repeated],
    }
    enum "Type" ["LINE_STRIP", "LINE_LOOP", "LINE_LIST"]
}

message! {
    /// Triangles.
    "foxglove" "foxglove/TriangleListPrimitive.proto" TriangleListPrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// The corners.
        points: Vec<Point3> = 2 [message, repeated] ".foxglove.Point3",
        /// Its colour.
        color: Option<Color> = 3 [message, optional] ".foxglove.Color",
        /// A colour for each point.
        colors: Vec<Color> = 4 [message, repeated] ".foxglove.Color",
        /// Points in drawing order.
        indices: Vec<u32> = 5 [fixed32, repeated],
    }
}

message! {
    /// A text.
    "foxglove" "foxglove/TextPrimitive.proto" TextPrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Whether it faces the viewer.
        billboard: bool = 2 [bool],
        /// Size of the letters.
        font_size: f64 = 3 [double],
        /// Whether that is in pixels.
        scale_invariant: bool = 4 [bool],
        /// Its colour.
        color: Option<Color> = 5 [message, optional] ".foxglove.Color",
        /// The text.
        text: String = 6 [string],
    }
}

message! {
    /// A model from elsewhere.
    "foxglove" "foxglove/ModelPrimitive.proto" ModelPrimitive {
        /// Where it is.
        pose: Option<Pose> = 1 [message, optional] ".foxglove.Pose",
        /// Its scale.
        scale: Option<Vector3> = 2 [message, optional] ".foxglove.Vector3",
        /// Its colour.
        color: Option<Color> = 3 [message, optional] ".foxglove.Color",
        /// Whether the colour replaces the model's own.
        override_color: bool = 4 [bool],
        /// Where it is found.
        url: String = 5 [string],
        /// Its kind.
        media_type: String = 6 [string],
        /// The model itself.
        data: Vec<u8> = 7 [bytes = "vec"],
    }
}

message! {
    /// Things in a scene that come and go together.
    "foxglove" "foxglove/SceneEntity.proto" SceneEntity {
        /// From when on.
        timestamp: Option<Timestamp> = 1 [message, optional] ".google.protobuf.Timestamp",
        /// Frame of reference.
        frame_id: String = 2 [string],
        /// Name; a later entity of that name replaces it.
        id: String = 3 [string],
        /// For how long; nothing: until it is replaced.
        lifetime: Option<Duration> = 4 [message, optional] ".google.protobuf.Duration",
        /// Whether it moves with its frame.
        frame_locked: bool = 5 [bool],
        /// What else there is to know.
        metadata: Vec<KeyValuePair> = 6 [message, repeated] ".foxglove.KeyValuePair",
        /// Arrows.
        arrows: Vec<ArrowPrimitive> = 7 [message, repeated] ".foxglove.ArrowPrimitive",
        /// Boxes.
        cubes: Vec<CubePrimitive> = 8 [message, repeated] ".foxglove.CubePrimitive",
        /// Ellipsoids.
        spheres: Vec<SpherePrimitive> = 9 [message, repeated] ".foxglove.SpherePrimitive",
        /// Cylinders.
        cylinders: Vec<CylinderPrimitive> = 10 [message, repeated] ".foxglove.CylinderPrimitive",
        /// Lines.
        lines: Vec<LinePrimitive> = 11 [message, repeated] ".foxglove.LinePrimitive",
        /// Triangles.
        triangles: Vec<TriangleListPrimitive> = 12 [message, repeated] ".foxglove.TriangleListPrimitive",
        /// Texts.
        texts: Vec<TextPrimitive> = 13 [message, repeated] ".foxglove.TextPrimitive",
        /// Models.
        models: Vec<ModelPrimitive> = 14 [message, repeated] ".foxglove.ModelPrimitive",
    }
}

message! {
    /// Takes an entity out of the scene.
    "foxglove" "foxglove/SceneEntityDeletion.proto" SceneEntityDeletion {
        /// When.
        timestamp: Option<Timestamp> = 1 [message, optional] ".google.protobuf.Timestamp",
        /// Which entities.
        r#type: i32 = 2 [int32] ".foxglove.SceneEntityDeletion.Type",
        /// The name.
        id: String = 3 [string],
    }
    enum "Type" ["MATCHING_ID", "ALL"]
}

message! {
    /// A change of the scene.
    "foxglove" "foxglove/SceneUpdate.proto" SceneUpdate {
        /// What goes.
        deletions: Vec<SceneEntityDeletion> = 1 [message, repeated] ".foxglove.SceneEntityDeletion",
        /// What comes.
        entities: Vec<SceneEntity> = 2 [message, repeated] ".foxglove.SceneEntity",
    }
}
