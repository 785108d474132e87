//! The box and its walls as a scene that viewers draw.

use super::contents::Walls;
use super::frame::{origin, timestamp};
use super::schema::FRAME_ID;
use super::schema::foxglove::{
    Color, KeyValuePair, LINE_LOOP, LinePrimitive, Point3, SceneEntity, SceneUpdate,
};

const AXES: [&str; 3] = ["x", "y", "z"];
const SIDES: [&str; 2] = ["lower", "upper"];
/// Width of the lines [pixels].
const THICKNESS: f64 = 2.0;

/// The scene: a line along every side that is not open, walls dark and periodic sides faint. What
/// the lines cannot say stands in the metadata.
pub(crate) fn scene(walls: &Walls, tick: u64) -> SceneUpdate {
    let mut lines = Vec::new();
    for axis in 0..3 {
        for side in 0..2 {
            let color = match walls.sides[axis][side].as_str() {
                "" | "open" => continue,
                "periodic" => Color { r: 0.6, g: 0.6, b: 0.6, a: 0.4 },
                _ => Color { r: 0.2, g: 0.2, b: 0.25, a: 1.0 },
            };
            lines.push(LinePrimitive {
                r#type: LINE_LOOP,
                pose: Some(origin()),
                thickness: THICKNESS,
                scale_invariant: true,
                points: outline(walls, axis, side),
                color: Some(color),
                ..Default::default()
            });
        }
    }
    let entity = SceneEntity {
        timestamp: Some(timestamp(tick)),
        frame_id: FRAME_ID.to_owned(),
        id: "box".to_owned(),
        metadata: metadata(walls),
        lines,
        ..Default::default()
    };
    SceneUpdate { deletions: Vec::new(), entities: vec![entity] }
}

/// The walls that a scene holds; `None` where it is another scene.
pub(crate) fn walls_of(scene: &SceneUpdate) -> Option<Walls> {
    let entity = scene.entities.iter().find(|entity| entity.id == "box")?;
    let value = |key: &str| Some(entity.metadata.iter().find(|pair| pair.key == key)?.value.as_str());
    let mut walls =
        Walls { lower: corner(value("lower")?)?, upper: corner(value("upper")?)?, ..Default::default() };
    for (axis, sides) in AXES.into_iter().zip(&mut walls.sides) {
        for (side, kind) in SIDES.into_iter().zip(sides) {
            *kind = value(&format!("{axis}.{side}"))?.to_owned();
        }
    }
    Some(walls)
}

fn metadata(walls: &Walls) -> Vec<KeyValuePair> {
    let pair = |key: &str, value: String| KeyValuePair { key: key.to_owned(), value };
    let mut pairs = vec![pair("lower", text(&walls.lower)), pair("upper", text(&walls.upper))];
    for (axis, sides) in AXES.into_iter().zip(&walls.sides) {
        for (side, kind) in SIDES.into_iter().zip(sides) {
            pairs.push(pair(&format!("{axis}.{side}"), kind.clone()));
        }
    }
    pairs
}

/// The corners of one side of the box, in order around it; in 2D two of the four coincide.
fn outline(walls: &Walls, axis: usize, side: usize) -> Vec<Point3> {
    let bounds = [walls.lower, walls.upper];
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |(along_first, along_second): (usize, usize)| {
        let mut at = [0.0; 3];
        at[axis] = bounds[side][axis];
        at[first] = bounds[along_first][first];
        at[second] = bounds[along_second][second];
        Point3 { x: at[0], y: at[1], z: at[2] }
    };
    [(0, 0), (1, 0), (1, 1), (0, 1)].into_iter().map(corner).collect()
}

fn text(corner: &[f64; 3]) -> String {
    corner.map(|coordinate| coordinate.to_string()).join(" ")
}

fn corner(text: &str) -> Option<[f64; 3]> {
    let coordinates: Option<Vec<f64>> = text.split(' ').map(|word| word.parse().ok()).collect();
    coordinates?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_come_back_from_their_scene() {
        let sides = [["periodic", "periodic"], ["wall", "open"], ["", ""]];
        let walls = Walls {
            lower: [-0.1, 1e-300, 0.0],
            upper: [1.0 / 3.0, 2e19, 0.0],
            sides: sides.map(|axis| axis.map(str::to_owned)),
        };
        let scene = scene(&walls, 0);
        assert_eq!(scene.entities[0].lines.len(), 3);
        assert_eq!(walls_of(&scene), Some(walls));
        assert_eq!(walls_of(&SceneUpdate::default()), None);
    }
}
