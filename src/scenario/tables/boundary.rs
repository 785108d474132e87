//! `[boundary]`.

use crate::law::boundary::WallKind;
use crate::scenario::bound::Bound;
use crate::scenario::reader::{Section, kind};
use crate::scenario::schema;
use crate::scenario::suggest::did_you_mean;
use crate::space::Vector;

/// One axis as read.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) enum AxisTable<V> {
    Periodic,
    Faces([FaceTable<V>; 2]),
}

/// One face as read.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) enum FaceTable<V> {
    Open,
    Wall(WallTable<V>),
}

/// A wall as read.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) struct WallTable<V> {
    pub(in crate::scenario) kind: WallKind<V>,
    /// `None` for the default.
    pub(in crate::scenario) restitution: Option<f64>,
    /// Whether a rough wall has a `velocity`, which changes the default restitution.
    pub(in crate::scenario) driven: bool,
}

const AXIS_FORMS: &str = "\"periodic\", \"open\", or both lower and upper";
const FACE_FORMS: &str = "\"open\" or { wall = \"smooth\" } (rough, statistical, vibrating)";

/// Reads `[boundary]`; an axis that is not named is periodic. `[axis]`, `None` for a wrong one.
pub(in crate::scenario) fn read<V: Vector>(root: &Section<'_>) -> [Option<AxisTable<V>>; 3] {
    let boundary = root.section("boundary", V::AXIS_NAMES);
    std::array::from_fn(|axis| match V::AXIS_NAMES.get(axis) {
        Some(name) => read_axis(&boundary, name, axis),
        None => Some(AxisTable::Periodic),
    })
}

fn read_axis<V: Vector>(boundary: &Section<'_>, name: &str, axis: usize) -> Option<AxisTable<V>> {
    let Some(item) = boundary.item(name) else { return Some(AxisTable::Periodic) };
    match item.as_str() {
        Some("periodic") => return Some(AxisTable::Periodic),
        Some("open") => return Some(AxisTable::Faces([FaceTable::Open; 2])),
        Some(text) => {
            let remedy = did_you_mean(text, ["periodic", "open"], &format!("write {AXIS_FORMS}"));
            boundary.mistake(name, format!("\"{text}\" is not known; {remedy}"));
            return None;
        }
        None => {}
    }
    let Some(table) = item.as_table_like() else {
        boundary.mistake(name, format!("must be {AXIS_FORMS}, not {}", kind(item)));
        return None;
    };
    if table.contains_key("wall") {
        let remedy = format!("write {name}.lower = {{ … }} and {name}.upper = {{ … }}");
        boundary.mistake(name, format!("a wall belongs to one face of the axis; {remedy}"));
        return None;
    }
    let axis_table = boundary.section(name, schema::FACES);
    let [lower, upper] = ["lower", "upper"].map(|side| read_face(&axis_table, side, axis));
    Some(AxisTable::Faces([lower?, upper?]))
}

fn read_face<V: Vector>(axis_table: &Section<'_>, side: &str, axis: usize) -> Option<FaceTable<V>> {
    let Some(item) = axis_table.item(side) else {
        axis_table.missing(
            side,
            format!("is missing: an axis has both faces or none; write {side} = {FACE_FORMS}"),
        );
        return None;
    };
    if let Some(text) = item.as_str() {
        match text {
            "open" => return Some(FaceTable::Open),
            "periodic" => axis_table
                .mistake(side, "an axis is periodic as a whole; write the axis itself = \"periodic\""),
            _ => {
                let remedy = did_you_mean(text, ["open"], &format!("write {FACE_FORMS}"));
                axis_table.mistake(side, format!("\"{text}\" is not known; {remedy}"));
            }
        }
        return None;
    }
    if !item.is_table_like() {
        axis_table.mistake(side, format!("must be {FACE_FORMS}, not {}", kind(item)));
        return None;
    }
    read_wall(axis_table, side, axis).map(FaceTable::Wall)
}

#[derive(Clone, Copy)]
enum WallName {
    Smooth,
    Rough,
    Statistical,
    Vibrating,
}

fn read_wall<V: Vector>(axis_table: &Section<'_>, side: &str, axis: usize) -> Option<WallTable<V>> {
    let names = [
        ("smooth", WallName::Smooth),
        ("rough", WallName::Rough),
        ("statistical", WallName::Statistical),
        ("vibrating", WallName::Vibrating),
    ];
    // Which keys may stand here depends on the kind, which is therefore read first.
    let name = axis_table.item(side).and_then(|item| item.as_table_like()?.get("wall")?.as_str());
    let known = name.and_then(|name| names.iter().find(|(known, _)| *known == name));
    let keys: &[&str] = match known {
        None => schema::WALL,
        Some((_, WallName::Smooth)) => &["wall", "restitution"],
        Some((_, WallName::Rough)) => &["wall", "restitution", "velocity"],
        Some((_, WallName::Statistical)) => &["wall", "restitution", "reversal_probability"],
        Some((_, WallName::Vibrating)) => &["wall", "restitution", "amplitude", "frequency"],
    };
    let wall = axis_table.section(side, keys);
    let restitution = wall.number("restitution", Bound::SHARE).optional();
    let name =
        wall.choice("wall", &names).required(&wall, "wall", "write { wall = \"smooth\" } or another kind");
    let kind = match name? {
        WallName::Smooth => Some(WallKind::Smooth),
        WallName::Rough => rough(&wall, axis),
        WallName::Statistical => wall
            .number("reversal_probability", Bound::SHARE)
            .required(&wall, "reversal_probability", "give the probability, such as 0.1")
            .map(|reversal_probability| WallKind::Statistical { reversal_probability }),
        WallName::Vibrating => vibrating(&wall),
    };
    Some(WallTable { kind: kind?, restitution: restitution?, driven: wall.has("velocity") })
}

fn rough<V: Vector>(wall: &Section<'_>, axis: usize) -> Option<WallKind<V>> {
    let velocity: V = wall.vector("velocity", Bound::ANY).or(V::ZERO)?;
    if velocity[axis] != 0.0 {
        let name = V::AXIS_NAMES[axis];
        wall.mistake(
            "velocity",
            format!(
                "{} along {name} would move the wall through its own plane; set the {name} component to 0",
                velocity[axis]
            ),
        );
        return None;
    }
    Some(WallKind::Rough { velocity })
}

fn vibrating<V: Vector>(wall: &Section<'_>) -> Option<WallKind<V>> {
    let amplitude = wall.number("amplitude", Bound::POSITIVE);
    let amplitude = amplitude.required(wall, "amplitude", "give the amplitude A of z = A sin 2πft");
    let frequency = wall.number("frequency", Bound::POSITIVE);
    let frequency = frequency.required(wall, "frequency", "give the frequency f of z = A sin 2πft");
    Some(WallKind::Vibrating { amplitude: amplitude?, frequency: frequency? })
}
