//! Turns the boundary as read into the boundary of a run, and finds the box that walls sweep.

use super::reader::Section;
use super::tables::boundary::{AxisTable, FaceTable, WallTable};
use crate::law::boundary::{AxisBoundary, Boundary, Face, Wall, WallKind};
use crate::space::Vector;

/// Fills in the restitution of walls: r, or for a driven rough wall 1 − (1 − r)ν (Müller 2001, 3.7).
pub(super) fn resolve<V: Vector>(
    axes: [Option<AxisTable<V>>; 3],
    restitution: f64,
    volume_fraction: f64,
) -> Option<Boundary<V>> {
    let face = |face: FaceTable<V>| match face {
        FaceTable::Open => Face::Open,
        FaceTable::Wall(WallTable { kind, restitution: given, driven }) => {
            let usual = if driven { 1.0 - (1.0 - restitution) * volume_fraction } else { restitution };
            Face::Wall(Wall { restitution: given.unwrap_or(usual), kind })
        }
    };
    let mut resolved = Boundary::periodic();
    for (axis, table) in axes.into_iter().enumerate() {
        resolved.axes[axis] = match table? {
            AxisTable::Periodic => AxisBoundary::Periodic,
            AxisTable::Faces([lower, upper]) => {
                AxisBoundary::Faces { lower: face(lower), upper: face(upper) }
            }
        };
    }
    Some(resolved)
}

/// Origin and size of the grid: the domain with the strokes of vibrating walls.
pub(super) fn swept_box<V: Vector>(boundary: &Boundary<V>, size: V) -> (V, V) {
    let (mut origin, mut grid_size) = (V::ZERO, size);
    for (axis, side, wall) in boundary.walls() {
        if let WallKind::Vibrating { amplitude, .. } = wall.kind {
            grid_size[axis] += amplitude;
            if side == 0 {
                origin[axis] -= amplitude;
            }
        }
    }
    (origin, grid_size)
}

/// Notes walls whose strokes meet.
pub(super) fn check_strokes<V: Vector>(root: &Section<'_>, boundary: &Boundary<V>, size: V) -> Option<()> {
    let (_, grid_size) = swept_box(boundary, size);
    let mut sound = Some(());
    for axis in 0..V::DIMENSION {
        let strokes = grid_size[axis] - size[axis];
        if strokes >= size[axis] {
            let name = V::AXIS_NAMES[axis];
            root.mistake(
                &format!("boundary.{name}"),
                format!(
                    "the amplitudes of its walls, {strokes}, leave no room in a box of {}; lower them",
                    size[axis]
                ),
            );
            sound = None;
        }
    }
    sound
}
