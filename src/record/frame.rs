//! Pictures of the grains: thinned to what a viewer can draw, and packed as a point cloud.

use super::contents::Frame;
use super::schema::FRAME_ID;
use super::schema::foxglove::{
    FLOAT32, PackedElementField, PointCloud, Pose, Quaternion, Timestamp, UINT32, Vector3,
};
use crate::matter::columns::Columns;
use crate::space::Vector;

/// Points per frame unless the scenario asks for all.
pub const USUAL_POINTS: usize = 20_000;

/// Bytes per point: x, y, z, vx, vy, vz and id, 4 each.
const STRIDE: usize = 28;
const FLOAT_FIELDS: [&str; 6] = ["x", "y", "z", "vx", "vy", "vz"];

/// The picture of `grains` at `time` [time], of at most `most_points` points, in rising identity.
///
/// The choice is a function of the identities alone and later pictures of fewer grains, or with
/// fewer points, keep the same ones: a grain that is seen stays in sight.
pub fn frame<V: Vector>(time: f64, grains: &Columns<V>, most_points: Option<usize>) -> Frame {
    let mut rows: Vec<u32> = match most_points {
        Some(most) if most < grains.len() => chosen(&grains.ids, most),
        _ => (0..grains.len() as u32).collect(),
    };
    rows.sort_unstable_by_key(|&row| grains.ids[row as usize]);
    let rows: Vec<usize> = rows.into_iter().map(|row| row as usize).collect();
    Frame {
        time,
        grains: grains.len() as u64,
        positions: rows.iter().map(|&row| single_precision(grains.positions[row])).collect(),
        velocities: rows.iter().map(|&row| single_precision(grains.velocities[row])).collect(),
        ids: rows.iter().map(|&row| grains.ids[row]).collect(),
    }
}

/// Rows of the `most` grains that come first in an order that spreads neighbouring identities apart.
fn chosen(ids: &[u32], most: usize) -> Vec<u32> {
    // Multiples of the golden ratio fill 0 … 2³² evenly and never twice.
    let rank = |row: u32| ids[row as usize].wrapping_mul(0x9E37_79B1);
    let mut rows: Vec<u32> = (0..ids.len() as u32).collect();
    if most < rows.len() {
        rows.select_nth_unstable_by_key(most, |&row| rank(row));
        rows.truncate(most);
    }
    rows
}

fn single_precision<V: Vector>(vector: V) -> [f32; 3] {
    let mut components = [0.0; 3];
    for (axis, component) in components.iter_mut().enumerate().take(V::DIMENSION) {
        *component = vector[axis] as f32;
    }
    components
}

/// The moment of `tick` nanoseconds.
pub(crate) fn timestamp(tick: u64) -> Timestamp {
    Timestamp { seconds: (tick / 1_000_000_000) as i64, nanos: (tick % 1_000_000_000) as i32 }
}

/// No shift, no rotation.
pub(crate) fn origin() -> Pose {
    Pose {
        position: Some(Vector3::default()),
        orientation: Some(Quaternion { w: 1.0, ..Default::default() }),
    }
}

/// `frame` as viewers read it.
pub(crate) fn point_cloud(frame: &Frame, tick: u64) -> PointCloud {
    let mut fields: Vec<PackedElementField> = Vec::new();
    for (index, name) in FLOAT_FIELDS.into_iter().enumerate() {
        fields.push(PackedElementField { name: name.to_owned(), offset: 4 * index as u32, r#type: FLOAT32 });
    }
    fields.push(PackedElementField { name: "id".to_owned(), offset: 24, r#type: UINT32 });
    let mut data = Vec::with_capacity(STRIDE * frame.ids.len());
    for ((position, velocity), id) in frame.positions.iter().zip(&frame.velocities).zip(&frame.ids) {
        for component in position.iter().chain(velocity) {
            data.extend_from_slice(&component.to_le_bytes());
        }
        data.extend_from_slice(&id.to_le_bytes());
    }
    PointCloud {
        timestamp: Some(timestamp(tick)),
        frame_id: FRAME_ID.to_owned(),
        pose: Some(origin()),
        point_stride: STRIDE as u32,
        fields,
        data,
    }
}

/// The frame that `cloud` holds, by the names of its fields; its time and number of grains stand
/// elsewhere. `None` where a field is missing or does not fit.
pub(crate) fn frame_of(cloud: &PointCloud) -> Option<Frame> {
    let stride = usize::try_from(cloud.point_stride).ok().filter(|&stride| stride > 0)?;
    let offset = |name: &str, kind: i32| {
        let field = cloud.fields.iter().find(|field| field.name == name && field.r#type == kind)?;
        usize::try_from(field.offset).ok().filter(|offset| offset + 4 <= stride)
    };
    let mut floats = [0; 6];
    for (slot, name) in floats.iter_mut().zip(FLOAT_FIELDS) {
        *slot = offset(name, FLOAT32)?;
    }
    let id = offset("id", UINT32)?;
    if !cloud.data.len().is_multiple_of(stride) {
        return None;
    }
    let points = cloud.data.len() / stride;
    let mut frame = Frame {
        positions: Vec::with_capacity(points),
        velocities: Vec::with_capacity(points),
        ids: Vec::with_capacity(points),
        ..Frame::default()
    };
    for point in cloud.data.chunks_exact(stride) {
        let word = |offset: usize| -> [u8; 4] { [0, 1, 2, 3].map(|byte| point[offset + byte]) };
        let component = |field: usize| f32::from_le_bytes(word(floats[field]));
        frame.positions.push([0, 1, 2].map(component));
        frame.velocities.push([3, 4, 5].map(component));
        frame.ids.push(u32::from_le_bytes(word(id)));
    }
    Some(frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn grains(ids: impl Iterator<Item = u32>) -> Columns<DVec2> {
        let mut columns = Columns::default();
        for id in ids {
            columns.insert(0, DVec2::new(f64::from(id), 0.5), DVec2::new(-0.0, 1e-3), id);
        }
        columns
    }

    #[test]
    fn a_frame_comes_back_from_its_point_cloud() {
        let full = frame(1.5, &grains(0..50), None);
        assert_eq!(full.ids, (0..50).collect::<Vec<u32>>());
        let back = frame_of(&point_cloud(&full, 7)).unwrap();
        assert_eq!(Frame { time: 1.5, grains: 50, ..back }, full);
        let empty = frame(0.0, &grains(0..0), Some(10));
        assert_eq!(frame_of(&point_cloud(&empty, 0)).unwrap(), empty);
    }

    #[test]
    fn thinning_is_exact_nested_and_even() {
        let all = grains(0..10_000);
        let many = frame(0.0, &all, Some(2000));
        let few = frame(0.0, &all, Some(500));
        assert_eq!((many.grains, many.ids.len(), few.ids.len()), (10_000, 2000, 500));
        assert!(few.ids.iter().all(|id| many.ids.binary_search(id).is_ok()));
        // Every span of 100 identities has its share of 20, give or take a few.
        for span in 0..100 {
            let share = many.ids.iter().filter(|&&id| id / 100 == span).count();
            assert!((18..=22).contains(&share), "span {span} has {share}");
        }
    }

    #[test]
    fn clouds_that_do_not_fit_are_refused() {
        let good = point_cloud(&frame(0.0, &grains(0..5), None), 0);
        let mut short = good.clone();
        short.data.pop();
        let mut nameless = good.clone();
        nameless.fields[3].name.clear();
        let mut outside = good.clone();
        outside.fields[6].offset = 25;
        let flat = PointCloud { point_stride: 0, ..good };
        for bad in [short, nameless, outside, flat] {
            assert!(frame_of(&bad).is_none());
        }
    }
}
