//! A view that stays the same for many pictures, without holding their frames.

use super::picture::picture;
use super::scene::Scene;
use crate::record::contents::{Frame, Walls};
use crate::scenario::kinds::Kinds;

/// First shown every frame, then asked for their pictures: all have the same window and the same colours.
#[derive(Clone, Debug)]
pub struct Camera {
    walls: Option<Walls>,
    kinds: Kinds,
    scene: Option<Scene>,
}

impl Camera {
    /// A camera before the box `walls` with grains of these `kinds`.
    pub fn new(walls: Option<Walls>, kinds: Kinds) -> Self {
        Camera { walls, kinds, scene: None }
    }

    /// Makes sure that `frame` fits in; one without grains fits anyway.
    pub fn see(&mut self, frame: &Frame) {
        if frame.positions.is_empty() {
            return;
        }
        let more = Scene::of(&[frame], self.walls.as_ref(), self.kinds.largest_diameter(), false);
        match &mut self.scene {
            Some(scene) => scene.include(&more),
            None => self.scene = Some(more),
        }
    }

    /// A picture of `frame`, `width` pixels wide, as a PNG file.
    pub fn png(&self, frame: &Frame, width: u32) -> Vec<u8> {
        let alone = || Scene::of(&[frame], self.walls.as_ref(), self.kinds.largest_diameter(), false);
        let scene = self.scene.clone().unwrap_or_else(alone);
        picture(frame, &scene, scene.speeds[0], &self.kinds, f64::from(width)).png()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_a_growing_heap_have_one_size() {
        let frame = |height: f32| Frame {
            positions: vec![[0.0, 0.0, 0.0], [4.0, height, 0.0]],
            velocities: vec![[1.0, 0.0, 0.0]; 2],
            ..Frame::default()
        };
        let mut camera = Camera::new(None, Kinds::default());
        let frames = [Frame::default(), frame(2.0), frame(6.0)];
        frames.iter().for_each(|frame| camera.see(frame));
        let size = |frame: &Frame| {
            let file = camera.png(frame, 200);
            let reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
            (reader.info().width, reader.info().height)
        };
        // 190 pixels for a width of 6; the height is 8.
        assert_eq!(frames.each_ref().map(size), [(200, 263); 3]);
    }
}
