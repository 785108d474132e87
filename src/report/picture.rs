//! Pictures of the grains, coloured by speed.

use super::colour::ColourMap;
use super::raster::Raster;
use super::scene::{Scene, speed};
use crate::record::contents::{Frame, Walls};
use crate::scenario::kinds::Kinds;

/// The paper that grains lie on.
pub(super) const PAPER: [u8; 3] = [0xf7, 0xf5, 0xf0];
/// Walls.
const WALL: [u8; 3] = [0x3c, 0x3a, 0x36];
/// Sides that lead back into the box on the other side.
const PERIODIC: [u8; 3] = [0xc9, 0xc4, 0xb8];
/// Room around the box for its walls [pixel].
const FRAME: f64 = 5.0;
/// Grains are not drawn smaller than this [pixel].
pub(super) const LEAST_RADIUS: f64 = 0.9;

/// A picture of `frame` as a PNG file of `width` pixels: grains as discs of the diameters that `kinds` gives them,
/// from deep blue (at rest) to amber (the fastest two per cent), with the walls around them.
///
/// The aspect ratio is true; open sides are cut at the grains; spheres are seen along the second axis.
pub fn grains_png(frame: &Frame, walls: Option<&Walls>, kinds: &Kinds, width: u32) -> Vec<u8> {
    let scene = Scene::of(&[frame], walls, kinds.largest_diameter(), false);
    picture(frame, &scene, scene.speeds[0], kinds, f64::from(width)).png()
}

/// Places of the scene on the paper.
struct Projection<'a> {
    scene: &'a Scene,
    scale: f64,
    /// Width and height of the picture [pixel].
    size: [f64; 2],
}

impl Projection<'_> {
    /// Across, up [length] from the lower left corner of the window.
    fn flat(&self, position: [f64; 3]) -> [f64; 2] {
        let from = |axis: usize| position[axis] - self.scene.window[axis][0];
        match (self.scene.is_deep, self.scene.is_turned) {
            (true, _) => [from(0), from(2)],
            (false, false) => [from(0), from(1)],
            // Turned clockwise: up becomes right, left becomes up.
            (false, true) => [from(1), self.scene.span(0) - from(0)],
        }
    }

    fn pixel(&self, position: [f64; 3]) -> [f64; 2] {
        let [across, up] = self.flat(position);
        [FRAME + across * self.scale, self.size[1] - FRAME - up * self.scale]
    }
}

/// `frame` seen as `scene` says, with colours up to the speed `fastest`.
pub(super) fn picture(frame: &Frame, scene: &Scene, fastest: f64, kinds: &Kinds, width: f64) -> Raster {
    let inner = (width - 2.0 * FRAME).max(8.0);
    let height = (inner / scene.aspect()).clamp(4.0, 4.0 * width) + 2.0 * FRAME;
    let across = if scene.is_turned { scene.span(1) } else { scene.span(0) };
    let projection = Projection { scene, scale: inner / across, size: [width, height.round()] };
    let mut raster = Raster::new(width as usize, height.round() as usize, PAPER);
    for index in drawing_order(frame, scene.is_deep) {
        let position = frame.positions[index].map(f64::from);
        let velocity = frame.velocities.get(index).copied().unwrap_or_default();
        let colour = ColourMap::Speed.at(speed(velocity) / fastest);
        let colour = if scene.is_deep { in_haze(colour, position[1], scene.window[1]) } else { colour };
        let pixel = projection.pixel(position);
        let diameter = kinds.diameter(frame.ids.get(index).copied());
        let radius = (0.5 * diameter * projection.scale).max(LEAST_RADIUS);
        if scene.is_deep && radius > 2.0 {
            // A rim sets a sphere apart from those behind it.
            raster.disc(pixel, radius, darker(colour));
            raster.disc(pixel, radius - 0.8, colour);
        } else {
            raster.disc(pixel, 0.97 * radius, colour);
        }
    }
    paint_sides(&mut raster, &projection);
    raster
}

/// Far spheres first.
fn drawing_order(frame: &Frame, is_deep: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..frame.positions.len()).collect();
    if is_deep {
        order.sort_by(|a, b| frame.positions[*b][1].total_cmp(&frame.positions[*a][1]));
    }
    order
}

/// Paler the farther away.
fn in_haze(colour: [u8; 3], depth: f64, window: [f64; 2]) -> [u8; 3] {
    let haze = 0.65 * ((depth - window[0]) / (window[1] - window[0])).clamp(0.0, 1.0);
    std::array::from_fn(|c| {
        let (near, far) = (f64::from(colour[c]), f64::from(PAPER[c]));
        (near + haze * (far - near)).round() as u8
    })
}

fn darker(colour: [u8; 3]) -> [u8; 3] {
    colour.map(|c| (f64::from(c) * 0.7) as u8)
}

/// Walls as thick lines, periodic sides as thin ones.
fn paint_sides(raster: &mut Raster, projection: &Projection<'_>) {
    let scene = projection.scene;
    let up = if scene.is_deep { 2 } else { 1 };
    for axis in [0, up] {
        for (side, kind) in scene.sides[axis].iter().enumerate() {
            let (colour, thickness) = match kind.as_str() {
                "" | "open" => continue,
                "periodic" => (PERIODIC, 1.0),
                _ => (WALL, 3.0),
            };
            let mut corners = [scene.window.map(|ends| ends[0]), scene.window.map(|ends| ends[1])];
            corners.iter_mut().for_each(|corner| corner[axis] = scene.window[axis][side]);
            let [first, second] = corners.map(|corner| projection.pixel(corner));
            let mut from = [first[0].min(second[0]), first[1].min(second[1])];
            let mut to = [first[0].max(second[0]), first[1].max(second[1])];
            // The line lies outside of the space of the grains.
            let across = usize::from(axis != 0) ^ usize::from(scene.is_turned);
            if from[across] < 0.5 * projection.size[across] {
                from[across] -= thickness;
            } else {
                to[across] += thickness;
            }
            raster.rectangle(from, to, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(file: &[u8]) -> (u32, u32) {
        let reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        (reader.info().width, reader.info().height)
    }

    fn walls(width: f64, height: f64) -> Walls {
        let side = || [String::from("wall"), String::from("periodic")];
        Walls { lower: [0.0; 3], upper: [width, height, 0.0], sides: [side(), side(), Default::default()] }
    }

    #[test]
    fn the_aspect_ratio_is_true() {
        let (frame, alike) = (Frame::default(), Kinds::of_diameter(1.0));
        assert_eq!(size(&grains_png(&frame, Some(&walls(40.0, 20.0)), &alike, 410)), (410, 210));
        // A tall tube lies on its side.
        assert_eq!(size(&grains_png(&frame, Some(&walls(20.0, 200.0)), &alike, 410)), (410, 50));
    }

    #[test]
    fn large_grains_are_drawn_large() {
        let kinds = Kinds::of_species(&[1.0, 4.0], vec![0, 1]);
        let frame = |id: u32| Frame {
            positions: vec![[10.0, 10.0, 0.0]],
            velocities: vec![[0.0; 3]],
            ids: vec![id],
            ..Frame::default()
        };
        let scene = Scene::of(&[&frame(0)], Some(&walls(20.0, 20.0)), 4.0, false);
        // Discs of 5 and 20 pixels in radius.
        let ink = |id: u32| {
            let colour = ColourMap::Speed.at(0.0);
            picture(&frame(id), &scene, 1.0, &kinds, 210.0).pixels_of(colour)
        };
        let ratio = ink(1) as f64 / ink(0) as f64;
        assert!((13.0..21.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn an_empty_picture_is_a_picture() {
        assert_eq!(size(&grains_png(&Frame::default(), None, &Kinds::of_diameter(1.0), 100)).0, 100);
    }
}
