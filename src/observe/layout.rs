//! What kind of place a setting is: where it is sheared, which way things fall, what they fall on.

use super::setting::Setting;
use crate::law::boundary::{Face, Wall, WallKind};
use crate::space::Vector;

/// Two walls that move past each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shear<V> {
    /// The axis normal to the walls.
    pub(crate) axis: usize,
    /// Unit vector of the upper wall's velocity relative to the lower one.
    pub(crate) direction: V,
    /// That velocity's magnitude v [length/time].
    pub(crate) speed: f64,
    /// Velocity of the lower wall along `direction` [length/time].
    pub(crate) lower: f64,
}

/// A wall that things fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Floor {
    /// The axis normal to the wall.
    pub(crate) axis: usize,
    /// Where the wall stands on that axis, a vibrating one on average [length].
    pub(crate) place: f64,
    /// +1 when heights grow with the coordinate, −1 when the wall is at the upper end of the axis.
    pub(crate) upwards: f64,
}

impl Floor {
    /// Height of `position` above the wall [length].
    pub(crate) fn height<V: Vector>(self, position: V) -> f64 {
        (position[self.axis] - self.place) * self.upwards
    }
}

/// The first axis whose walls move past each other.
pub(crate) fn shear<V: Vector>(setting: &Setting<V>) -> Option<Shear<V>> {
    (0..V::DIMENSION).find_map(|axis| {
        let [Face::Wall(lower), Face::Wall(upper)] = setting.boundary.faces(axis)? else {
            return None;
        };
        let lower = velocity_along(lower, axis);
        let relative = velocity_along(upper, axis) - lower;
        let speed = relative.length();
        let direction = relative * (1.0 / speed);
        (speed > 0.0).then(|| Shear { axis, direction, speed, lower: lower.dot(direction) })
    })
}

fn velocity_along<V: Vector>(wall: Wall<V>, axis: usize) -> V {
    match wall.kind {
        WallKind::Rough { velocity } => velocity - V::along(axis, velocity[axis]),
        WallKind::Smooth | WallKind::Statistical { .. } | WallKind::Vibrating { .. } => V::ZERO,
    }
}

/// The axis along which gravity is strongest.
pub(crate) fn gravity_axis<V: Vector>(setting: &Setting<V>) -> Option<usize> {
    strongest(setting, |_| true)
}

/// The periodic axis along which grains fall for ever: that of a pipe.
pub(crate) fn pipe_axis<V: Vector>(setting: &Setting<V>) -> Option<usize> {
    strongest(setting, |axis| setting.boundary.is_periodic(axis))
}

fn strongest<V: Vector>(setting: &Setting<V>, admits: impl Fn(usize) -> bool) -> Option<usize> {
    let pull = |axis: usize| setting.gravity[axis].abs();
    // Of equally strong axes the first.
    (0..V::DIMENSION)
        .rev()
        .filter(|&axis| pull(axis) > 0.0 && admits(axis))
        .max_by(|&a, &b| pull(a).total_cmp(&pull(b)))
}

/// The wall that gravity points at.
pub(crate) fn floor<V: Vector>(setting: &Setting<V>) -> Option<Floor> {
    let axis = gravity_axis(setting)?;
    let [lower, upper] = setting.boundary.faces(axis)?;
    let falls_down = setting.gravity[axis] < 0.0;
    let (face, place, upwards) =
        if falls_down { (lower, 0.0, 1.0) } else { (upper, setting.size[axis], -1.0) };
    matches!(face, Face::Wall(_)).then_some(Floor { axis, place, upwards })
}

/// Whether grains can leave through a side of `axis`.
pub(crate) fn has_open_side<V: Vector>(setting: &Setting<V>, axis: usize) -> bool {
    setting.boundary.faces(axis).is_some_and(|faces| faces.iter().any(|face| matches!(face, Face::Open)))
}

/// The axis that profiles run along: of gravity, of shear, of the first wall, or the longest.
pub(crate) fn profile_axis<V: Vector>(setting: &Setting<V>) -> usize {
    let longest = || {
        (1..V::DIMENSION)
            .fold(0, |best, axis| if setting.size[axis] > setting.size[best] { axis } else { best })
    };
    gravity_axis(setting)
        .or_else(|| shear(setting).map(|shear| shear.axis))
        .or_else(|| setting.boundary.walls().next().map(|(axis, _, _)| axis))
        .unwrap_or_else(longest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::testing::{rough, setting_of, smooth};
    use glam::{DVec2, DVec3};

    #[test]
    fn shear_is_a_difference_of_velocities() {
        let mut bed = setting_of(DVec3::new(4.0, 6.0, 8.0), [2, 3, 4]);
        assert_eq!(shear(&bed.setting), None);
        bed.walls(2, rough(DVec3::new(0.0, -1.0, 0.0)), rough(DVec3::new(0.0, 2.0, 0.0)));
        let found = shear(&bed.setting).unwrap();
        assert_eq!(found, Shear { axis: 2, direction: DVec3::Y, speed: 3.0, lower: -1.0 });
        assert_eq!(profile_axis(&bed.setting), 2);
        bed.walls(2, rough(DVec3::Y), rough(DVec3::Y));
        assert_eq!(shear(&bed.setting), None);
    }

    #[test]
    fn floors_and_pipes() {
        let mut bed = setting_of(DVec2::new(4.0, 6.0), [2, 3, 1]);
        assert_eq!(profile_axis(&bed.setting), 1);
        bed.setting.gravity = DVec2::new(0.5, -1.0);
        assert_eq!((pipe_axis(&bed.setting), floor(&bed.setting)), (Some(1), None));
        bed.walls(1, smooth(), Face::Open);
        assert_eq!(pipe_axis(&bed.setting), Some(0));
        let ground = floor(&bed.setting).unwrap();
        assert_eq!(ground.height(DVec2::new(1.0, 2.5)), 2.5);
        assert!(has_open_side(&bed.setting, 1) && !has_open_side(&bed.setting, 0));
        bed.setting.gravity = DVec2::new(0.0, 1.0);
        assert_eq!(floor(&bed.setting), None);
        bed.walls(1, Face::Open, smooth());
        assert_eq!(floor(&bed.setting).unwrap().height(DVec2::new(1.0, 2.5)), 3.5);
    }
}
