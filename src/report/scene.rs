//! What part of space the pictures and the player show, and how fast is fast.

use crate::record::contents::{Frame, Walls};

/// A view on the grains that stays the same for all frames of a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scene {
    /// `[axis]`: lower and upper end of what is shown [length].
    pub window: [[f64; 2]; 3],
    /// `[axis][side]` kind of the sides, as in [`Walls`].
    pub sides: [[String; 2]; 3],
    /// Whether there is a third dimension to see.
    pub is_deep: bool,
    /// Whether the second axis is drawn to the right, because the box is a tall tube.
    pub is_turned: bool,
    /// `[frame]`: the speed at the upper end of the colours [length/time].
    pub speeds: Vec<f64>,
}

/// A box this much taller than wide is drawn lying.
const TALL: f64 = 2.2;

impl Scene {
    /// The view on `frames`; `own_speeds` lets every frame have its own scale of speeds where they differ much.
    pub(crate) fn of(frames: &[&Frame], walls: Option<&Walls>, diameter: f64, own_speeds: bool) -> Self {
        let extent = extent(frames, diameter);
        let mut window = extent;
        let mut sides = <[[String; 2]; 3]>::default();
        if let Some(walls) = walls {
            sides = walls.sides.clone();
            for axis in 0..3 {
                let ends = [walls.lower[axis], walls.upper[axis]];
                for (side, end) in ends.into_iter().enumerate() {
                    // An open side has nothing to see beyond the grains.
                    if walls.sides[axis][side] != "open" || extent[axis][0] > extent[axis][1] {
                        window[axis][side] = end;
                    }
                }
            }
        }
        for ends in &mut window {
            let is_range = ends[0].is_finite() && ends[1].is_finite() && ends[0] < ends[1];
            if !is_range {
                *ends = [0.0, diameter];
            }
        }
        let is_deep = walls.map_or_else(
            || frames.iter().any(|f| f.positions.iter().any(|p| p[2] != 0.0)),
            |walls| !walls.sides[2][0].is_empty(),
        );
        let speeds = speeds(frames, own_speeds);
        Self { is_deep, is_turned: is_turned(is_deep, &window), window, sides, speeds }
    }

    /// Widens the view until it shows what `other` shows, with the greater of both scales of speed.
    pub(super) fn include(&mut self, other: &Self) {
        for (ends, more) in self.window.iter_mut().zip(&other.window) {
            *ends = [ends[0].min(more[0]), ends[1].max(more[1])];
        }
        self.is_deep |= other.is_deep;
        self.is_turned = is_turned(self.is_deep, &self.window);
        let fastest = self.speeds.iter().chain(&other.speeds).copied().fold(0.0, f64::max);
        self.speeds.iter_mut().for_each(|speed| *speed = fastest);
    }

    /// Length of what is shown along `axis`.
    pub(crate) fn span(&self, axis: usize) -> f64 {
        self.window[axis][1] - self.window[axis][0]
    }

    /// Width over height of the picture.
    pub(crate) fn aspect(&self) -> f64 {
        let across = if self.is_deep { self.span(0) / self.span(2) } else { self.span(0) / self.span(1) };
        if self.is_turned { 1.0 / across } else { across }
    }
}

/// Whether a plane is so tall that it is drawn lying.
fn is_turned(is_deep: bool, window: &[[f64; 2]; 3]) -> bool {
    let span = |axis: usize| window[axis][1] - window[axis][0];
    !is_deep && span(1) > TALL * span(0)
}

/// Smallest box around all grains, with room of a diameter.
fn extent(frames: &[&Frame], diameter: f64) -> [[f64; 2]; 3] {
    let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for position in frames.iter().flat_map(|f| &f.positions) {
        for (ends, value) in extent.iter_mut().zip(position) {
            let value = f64::from(*value);
            *ends = [ends[0].min(value - diameter), ends[1].max(value + diameter)];
        }
    }
    extent
}

/// Speed of a grain.
pub(crate) fn speed(velocity: [f32; 3]) -> f64 {
    velocity.iter().map(|v| f64::from(*v) * f64::from(*v)).sum::<f64>().sqrt()
}

/// The speed that 98 % of the grains do not exceed, of every frame; of all together unless `own`.
fn speeds(frames: &[&Frame], own: bool) -> Vec<f64> {
    let quantile = |frame: &&Frame| {
        let mut speeds: Vec<f64> =
            frame.velocities.iter().map(|v| speed(*v)).filter(|s| s.is_finite()).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.get(speeds.len().saturating_sub(1) * 98 / 100).copied().unwrap_or(0.0)
    };
    let each: Vec<f64> = frames.iter().map(quantile).collect();
    let most = each.iter().copied().fold(0.0, f64::max);
    let least = each.iter().copied().fold(f64::INFINITY, f64::min);
    // Nothing moves at all: any scale does.
    let held = |value: f64| if value > 0.0 { value } else { 1.0 };
    if own && most > 3.0 * least {
        each.into_iter().map(held).collect()
    } else {
        vec![held(most); each.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(positions: Vec<[f32; 3]>, speed: f32) -> Frame {
        let velocities = vec![[speed, 0.0, 0.0]; positions.len()];
        Frame { positions, velocities, ..Frame::default() }
    }

    fn walls(sides: [&str; 3]) -> Walls {
        let sides = sides.map(|s| [s.to_owned(), s.to_owned()]);
        Walls { lower: [0.0; 3], upper: [400.0, 160.0, 0.0], sides }
    }

    #[test]
    fn open_sides_end_at_the_grains() {
        let frame = frame(vec![[100.0, 5.0, 0.0], [300.0, 60.0, 0.0]], 1.0);
        let scene = Scene::of(&[&frame], Some(&walls(["open", "wall", ""])), 1.0, false);
        assert_eq!(scene.window[0], [99.0, 301.0]);
        assert_eq!(scene.window[1], [0.0, 160.0]);
        assert!(!scene.is_deep && !scene.is_turned);
    }

    #[test]
    fn nothing_to_see_is_survived() {
        for scene in [
            Scene::of(&[], None, 1.0, true),
            Scene::of(&[&frame(Vec::new(), 0.0)], Some(&walls(["open", "open", ""])), 1.0, true),
        ] {
            assert!(scene.window.iter().all(|w| w[1] > w[0] && w[0].is_finite()));
        }
    }

    #[test]
    fn speeds_have_one_scale_or_their_own() {
        let (fast, slow) = (frame(vec![[0.0; 3]; 5], 8.0), frame(vec![[0.0; 3]; 5], 1.0));
        let scale = |own| Scene::of(&[&fast, &slow], None, 1.0, own).speeds;
        assert_eq!(scale(false), [8.0, 8.0]);
        assert_eq!(scale(true), [8.0, 1.0]);
    }
}
