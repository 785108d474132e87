//! Fields as grids that viewers know: `foxglove.Grid` in the plane, `foxglove.VoxelGrid` in space.

use std::collections::BTreeMap;

use prost::Message;
use prost_types::FileDescriptorSet;

use super::frame::{origin, timestamp};
use super::schema::foxglove::{FLOAT32, Grid, PackedElementField, Pose, Vector2, Vector3, VoxelGrid};
use super::schema::units::{dimension_of, unit_text};
use super::schema::{Described, FRAME_ID};
use crate::observe::field::Field;
use crate::observe::measure::Column;

/// Bytes of a value.
const WIDTH: usize = 4;

/// Whether a channel of this description holds grids of space rather than of the plane.
pub(crate) fn is_of_space(description: &[u8]) -> bool {
    let set = FileDescriptorSet::decode(description).unwrap_or_default();
    set.file.iter().flat_map(|file| &file.message_type).any(|message| message.name() == VoxelGrid::TABLE.name)
}

/// What stands in the metadata of a channel: the units of `components`, in their order.
pub(crate) fn units(components: &[Column]) -> BTreeMap<String, String> {
    components.iter().map(|one| (format!("unit.{}", one.name), unit_text(one.unit))).collect()
}

/// `field` as viewers read it.
pub(crate) fn encode(field: &Field, tick: u64) -> Vec<u8> {
    let cell_stride = (WIDTH * field.components.len()) as u32;
    let row_stride = cell_stride * field.cells[0];
    let packed = |(place, one): (usize, &Column)| PackedElementField {
        name: one.name.clone(),
        offset: (WIDTH * place) as u32,
        r#type: FLOAT32,
    };
    let fields = field.components.iter().enumerate().map(packed).collect();
    let [x, y, z] = field.origin;
    let pose = Some(Pose { position: Some(Vector3 { x, y, z }), ..origin() });
    let (timestamp, frame_id) = (Some(timestamp(tick)), FRAME_ID.to_owned());
    let (column_count, data) = (field.cells[0], data(field));
    let [x, y, z] = field.side;
    if z == 0.0 {
        let cell_size = Some(Vector2 { x, y });
        return Grid {
            timestamp,
            frame_id,
            pose,
            column_count,
            cell_size,
            row_stride,
            cell_stride,
            fields,
            data,
        }
        .encode_to_vec();
    }
    let grid = VoxelGrid {
        timestamp,
        frame_id,
        pose,
        row_count: field.cells[1],
        column_count,
        cell_size: Some(Vector3 { x, y, z }),
        slice_stride: row_stride * field.cells[1],
        row_stride,
        cell_stride,
        fields,
        data,
    };
    grid.encode_to_vec()
}

/// Cell after cell, the first axis fastest, all components of a cell together.
fn data(field: &Field) -> Vec<u8> {
    let cells = field.values.first().map_or(0, Vec::len);
    let mut data = Vec::with_capacity(WIDTH * cells * field.values.len());
    for cell in 0..cells {
        for component in &field.values {
            data.extend_from_slice(&component[cell].to_le_bytes());
        }
    }
    data
}

/// The field in `message`, with `units` of its components; its name and time stand elsewhere. `None` where something is
/// missing or does not fit.
pub(crate) fn decode(message: &[u8], of_space: bool, units: &BTreeMap<String, String>) -> Option<Field> {
    let grid = if of_space {
        VoxelGrid::decode(message).ok()?
    } else {
        let flat = Grid::decode(message).ok()?;
        let Vector2 { x, y } = flat.cell_size?;
        let row_stride = flat.row_stride.max(1);
        VoxelGrid {
            timestamp: flat.timestamp,
            frame_id: flat.frame_id,
            pose: flat.pose,
            row_count: flat.data.len() as u32 / row_stride,
            column_count: flat.column_count,
            cell_size: Some(Vector3 { x, y, z: 0.0 }),
            slice_stride: flat.data.len() as u32,
            row_stride: flat.row_stride,
            cell_stride: flat.cell_stride,
            fields: flat.fields,
            data: flat.data,
        }
    };
    field_of(&grid, units)
}

fn field_of(grid: &VoxelGrid, units: &BTreeMap<String, String>) -> Option<Field> {
    let mut field = Field::default();
    let triple = |vector: &Vector3| [vector.x, vector.y, vector.z];
    field.origin = triple(grid.pose.as_ref()?.position.as_ref()?);
    field.side = triple(grid.cell_size.as_ref()?);
    let stride = grid.cell_stride as usize;
    let (columns, rows) = (u64::from(grid.column_count), u64::from(grid.row_count));
    let slice = columns * rows * u64::from(grid.cell_stride);
    let dense = u64::from(grid.row_stride) == columns * u64::from(grid.cell_stride)
        && u64::from(grid.slice_stride) == slice;
    if !dense || slice == 0 || !(grid.data.len() as u64).is_multiple_of(slice) {
        return None;
    }
    field.cells = [grid.column_count, grid.row_count, (grid.data.len() as u64 / slice) as u32];
    for packed in &grid.fields {
        let offset = packed.offset as usize;
        if packed.r#type != FLOAT32 || offset + WIDTH > stride {
            return None;
        }
        let unit = dimension_of(units.get(&format!("unit.{}", packed.name))?)?;
        field.components.push(Column { name: packed.name.clone(), unit });
        let value = |cell: &[u8]| f32::from_le_bytes([0, 1, 2, 3].map(|byte| cell[offset + byte]));
        field.values.push(grid.data.chunks_exact(stride).map(value).collect());
    }
    Some(field)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::field::Quantity;

    /// A velocity on a grid of three by two cells, so many of them deep.
    fn sample(layers: Option<u32>) -> Field {
        let dimension = if layers.is_some() { 3 } else { 2 };
        let cells = [3, 2, layers.unwrap_or(1)];
        let number = cells.iter().product::<u32>();
        let value = |component: usize, cell: u32| component as f32 * 100.0 + cell as f32;
        let (lower, depth) = if layers.is_some() { (7.0, 0.25) } else { (0.0, 0.0) };
        Field {
            origin: [-0.5, 1e-9, lower],
            side: [1.0 / 3.0, 2.0, depth],
            cells,
            components: Quantity::Velocity.components(dimension),
            values: (0..dimension).map(|k| (0..number).map(|cell| value(k, cell)).collect()).collect(),
            ..Default::default()
        }
    }

    #[test]
    fn a_field_comes_back_from_its_grid() {
        for layers in [None, Some(4)] {
            let field = sample(layers);
            let (units, bytes) = (units(&field.components), encode(&field, 7));
            assert_eq!(decode(&bytes, layers.is_some(), &BTreeMap::new()), None, "without units");
            assert_eq!(decode(&bytes, layers.is_some(), &units), Some(field));
        }
    }

    #[test]
    fn grids_that_do_not_fit_are_refused() {
        let field = sample(Some(4));
        let units = units(&field.components);
        let good = VoxelGrid::decode(encode(&field, 7).as_slice()).unwrap();
        let mut short = good.clone();
        short.data.pop();
        let mut sparse = good.clone();
        sparse.row_stride += 4;
        let mut outside = good.clone();
        outside.fields[2].offset = 9;
        let empty = VoxelGrid { column_count: 0, row_stride: 0, slice_stride: 0, ..good.clone() };
        for bad in [short, sparse, outside, empty] {
            assert_eq!(decode(&bad.encode_to_vec(), true, &units), None);
        }
    }
}
