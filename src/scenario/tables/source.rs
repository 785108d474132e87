//! `[source]`.

use super::particles::MOST_GRAINS;
use crate::law::source::Source;
use crate::scenario::bound::{Bound, rounded};
use crate::scenario::reader::Section;
use crate::scenario::schema;
use crate::space::Vector;

/// What a source has to fit into; `None` for what is unknown.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) struct Surroundings<V> {
    pub(in crate::scenario) gravity: Option<V>,
    pub(in crate::scenario) size: Option<V>,
    pub(in crate::scenario) diameter: Option<f64>,
}

/// Reads `[source]`: `Some(None)` where there is none, `None` when it is wrong.
pub(in crate::scenario) fn read<V: Vector>(
    root: &Section<'_>,
    around: Surroundings<V>,
) -> Option<Option<Source<V>>> {
    let source = root.section("source", schema::SOURCE);
    if !source.exists() {
        return if root.has("source") { None } else { Some(None) };
    }
    let vertical = around.gravity.and_then(|gravity| vertical_axis(&source, gravity));
    let count = source.whole("count", 1, MOST_GRAINS);
    let count = count.required(&source, "count", "give the number of grains to pour");
    let rate =
        source.number("rate", Bound::POSITIVE).required(&source, "rate", "give grains per time, such as 0.5");
    let diameter = around.diameter.unwrap_or(1.0);
    let width = source.number("width", Bound::NOT_NEGATIVE).or(diameter);
    let height = source.number("height", Bound::POSITIVE).or(10.0 * diameter);
    let velocity = source.vector("velocity", Bound::ANY).or(V::ZERO);
    let position = source.numbers("position", V::DIMENSION - 1, Bound::ANY).optional();
    let (vertical, size) = (vertical?, around.size?);
    let position = place(&source, position?, vertical, size, width?)?;
    if height? >= size[vertical] {
        source.mistake(
            "height",
            format!(
                "{} is not below the height of the box, {}; lower it",
                rounded(height?),
                rounded(size[vertical])
            ),
        );
        return None;
    }
    Some(Some(Source {
        count: count? as u32,
        rate: rate?,
        position,
        width: width?,
        height: height?,
        velocity: velocity?,
    }))
}

/// The axis that gravity points down.
fn vertical_axis<V: Vector>(source: &Section<'_>, gravity: V) -> Option<usize> {
    let pulling: Vec<usize> = (0..V::DIMENSION).filter(|&axis| gravity[axis] != 0.0).collect();
    match pulling[..] {
        [axis] if gravity[axis] < 0.0 => Some(axis),
        _ => {
            let example = if V::DIMENSION == 2 { "[0.0, -1.0]" } else { "[0.0, 0.0, -1.0]" };
            source.mistake_here(format!(
                "pours along gravity, which must point down one axis; write gravity = {example} above the first [table]"
            ));
            None
        }
    }
}

/// The centre of the spout, which has to lie inside the box.
fn place<V: Vector>(
    source: &Section<'_>,
    horizontal: Option<Vec<f64>>,
    vertical: usize,
    size: V,
    width: f64,
) -> Option<V> {
    let axes: Vec<usize> = (0..V::DIMENSION).filter(|&axis| axis != vertical).collect();
    let mut position = size * 0.5;
    position[vertical] = 0.0;
    for (k, &axis) in axes.iter().enumerate() {
        if let Some(given) = &horizontal {
            position[axis] = given[k];
        }
        let (low, high) = (position[axis] - 0.5 * width, position[axis] + 0.5 * width);
        if low < 0.0 || high > size[axis] {
            source.mistake(
                "position",
                format!(
                    "the spout reaches from {} to {} along {}, beyond the box of {}; move it or make it narrower",
                    rounded(low),
                    rounded(high),
                    V::AXIS_NAMES[axis],
                    rounded(size[axis])
                ),
            );
            return None;
        }
    }
    Some(position)
}
