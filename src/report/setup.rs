//! What a report needs to know about the run beside its measures: read from the scenario's text and the summary.

use serde_json::{Map, Value};
use toml_edit::{DocumentMut, Item};

use super::number::unit;
use crate::observe::measure::{Column, Dimension};
use crate::record::contents::RunLog;

/// The parameters that plots, laws and references depend on; `None` where the scenario does not have them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setup {
    /// Title of the scenario, or its name.
    pub title: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the engine.
    pub engine: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Sides of the box [length].
    pub size: Vec<f64>,
    /// Constant acceleration [length/time²].
    pub gravity: Vec<f64>,
    /// Diameter of a grain [length].
    pub diameter: f64,
    /// Mass of a grain [mass].
    pub mass: f64,
    /// Constant normal restitution; `None` for another law.
    pub restitution: Option<f64>,
    /// N·V_p over the volume of the box.
    pub volume_fraction: Option<f64>,
    /// Side of a cell, as wished [length].
    pub cell_size: Option<f64>,
    /// Velocity along the first axis of the lower and upper wall of the second [length/time].
    pub wall_velocities: Option<[f64; 2]>,
    /// Whether every axis is periodic.
    pub is_periodic: bool,
    /// `[axis]`: whether that axis is periodic.
    pub periodic_axes: [bool; 3],
    /// Whether a side is open, so that grains can leave.
    pub has_open_side: bool,
    /// Whether collisions transfer momentum as Enskog theory asks for every restitution.
    pub is_transfer_corrected: bool,
    /// Grains that the source pours, and how many per time.
    pub source: Option<[f64; 2]>,
    /// Grains at the start.
    pub count: Option<f64>,
    /// Names of the units of length, mass and time.
    pub units: [String; 3],
}

impl Setup {
    /// Reads the parameters of `log`, with `summary` first where both have one.
    pub(crate) fn of(log: &RunLog, summary: &Map<String, Value>) -> Self {
        // A text that does not parse leaves the summary, which is enough for a plain report.
        let document = log.scenario.parse::<DocumentMut>().unwrap_or_default();
        let text = |key: &str| {
            let known = summary.get(key).and_then(Value::as_str).map(str::to_owned);
            known.or_else(|| log.metadata.get(key).cloned())
        };
        let figure = |key: &str| summary.get(key).and_then(Value::as_f64);
        let at = |path: &str| item(&document, path);
        let scenario = text("scenario").unwrap_or_else(|| "run".to_owned());
        let size = numbers(at("domain.size"));
        let dimension = figure("dimension").or_else(|| float(at("dimension")));
        let gravity = numbers(at("gravity"));
        let name = |key: &str, default: &str| {
            let named = at(&format!("units.{key}")).and_then(Item::as_str);
            named.map_or_else(|| default.to_owned(), |n| if n == "1" { String::new() } else { n.to_owned() })
        };
        Self {
            title: at("title").and_then(Item::as_str).map_or_else(|| scenario.clone(), str::to_owned),
            engine: text("engine")
                .or_else(|| at("engine.kind").and_then(Item::as_str).map(str::to_owned))
                .unwrap_or_else(|| "unknown engine".to_owned()),
            dimension: dimension.map_or(2, |d| d as usize),
            gravity,
            diameter: float(at("particles.diameter")).unwrap_or(1.0),
            mass: float(at("particles.mass")).unwrap_or(1.0),
            restitution: float(at("particles.restitution")),
            volume_fraction: figure("volume_fraction").or_else(|| float(at("particles.volume_fraction"))),
            cell_size: float(at("engine.cell_size")),
            wall_velocities: wall_velocities(&document),
            is_periodic: is_periodic(log, &document),
            periodic_axes: ["x", "y", "z"].map(|axis| is_axis_periodic(log, &document, axis)),
            has_open_side: has_open_side(log, &document),
            is_transfer_corrected: at("engine.transfer").and_then(Item::as_str) == Some("corrected"),
            source: float(at("source.count"))
                .zip(float(at("source.rate")))
                .map(|(count, rate)| [count, rate]),
            count: figure("particles_initial"),
            units: [name("length", "length"), name("mass", "mass"), name("time", "time")],
            scenario,
            size,
        }
    }

    /// Whether a constant force acts.
    pub(crate) fn has_gravity(&self) -> bool {
        self.gravity.iter().any(|g| *g != 0.0)
    }

    /// The axis along which a constant force acts, if it acts along one alone.
    pub(crate) fn gravity_axis(&self) -> Option<usize> {
        let mut axes = (0..self.gravity.len()).filter(|axis| self.gravity[*axis] != 0.0);
        axes.next().filter(|_| axes.next().is_none())
    }

    /// Whether grains fall without end: a force along a periodic axis.
    pub(crate) fn is_pipe(&self) -> bool {
        self.gravity_axis().is_some_and(|axis| self.periodic_axes.get(axis) == Some(&true))
    }

    /// Whether grains come to lie on something.
    pub(crate) fn has_floor(&self) -> bool {
        self.gravity_axis().is_some() && !self.is_pipe()
    }

    /// Whether nothing drives the gas, so that it ages by its collisions.
    pub(crate) fn is_undriven(&self) -> bool {
        !self.has_gravity() && self.source.is_none() && self.wall_velocities.is_none()
    }

    /// The unit of a quantity in the names of the scenario.
    pub(crate) fn unit(&self, dimension: Dimension) -> String {
        unit(dimension, &self.units)
    }

    /// "name [unit]" of a column.
    pub(crate) fn label(&self, column: &Column) -> String {
        self.with_unit(&super::number::in_words(&column.name), column.unit)
    }

    /// "name [unit]".
    pub(crate) fn with_unit(&self, name: &str, dimension: Dimension) -> String {
        let unit = self.unit(dimension);
        // "time [time]" says nothing.
        if unit.is_empty() || unit == name { name.to_owned() } else { format!("{name} [{unit}]") }
    }

    /// The unit of length (0), mass (1) or time (2) behind a number: one without a name is called a unit.
    pub(crate) fn named(&self, kind: usize) -> String {
        let kinds = ["length", "mass", "time"];
        if self.units[kind] == kinds[kind] {
            format!("{} units", kinds[kind])
        } else {
            self.units[kind].clone()
        }
    }

    /// The label of a time axis.
    pub(crate) fn time_label(&self) -> String {
        self.with_unit("time", Dimension { time: 1, ..Dimension::default() })
    }

    /// The label of a length.
    pub(crate) fn length_label(&self, name: &str) -> String {
        self.with_unit(name, Dimension { length: 1, ..Dimension::default() })
    }
}

/// The item at a dotted path.
fn item<'a>(document: &'a DocumentMut, path: &str) -> Option<&'a Item> {
    path.split('.').try_fold(document.as_item(), |item, key| item.get(key))
}

/// A number, whole or not.
fn float(item: Option<&Item>) -> Option<f64> {
    let item = item?;
    item.as_float().or_else(|| item.as_integer().map(|whole| whole as f64))
}

/// All numbers of an array.
fn numbers(item: Option<&Item>) -> Vec<f64> {
    let values = item.and_then(Item::as_array).into_iter().flatten();
    values.filter_map(|v| v.as_float().or_else(|| v.as_integer().map(|whole| whole as f64))).collect()
}

fn wall_velocities(document: &DocumentMut) -> Option<[f64; 2]> {
    let along = |side: &str| numbers(item(document, &format!("boundary.y.{side}.velocity"))).first().copied();
    let [lower, upper] = [along("lower"), along("upper")];
    (lower.is_some() || upper.is_some()).then(|| [lower.unwrap_or(0.0), upper.unwrap_or(0.0)])
}

/// From the recorded box; from the scenario's text for a log without one.
fn is_periodic(log: &RunLog, document: &DocumentMut) -> bool {
    if let Some(walls) = &log.walls {
        return walls.sides.iter().flatten().all(|side| side.is_empty() || side == "periodic");
    }
    let sides = item(document, "boundary").and_then(Item::as_table_like);
    sides.is_some_and(|sides| sides.iter().all(|(_, side)| side.as_str() == Some("periodic")))
}

/// From the recorded box; from the scenario's text for a log without one.
fn is_axis_periodic(log: &RunLog, document: &DocumentMut, axis: &str) -> bool {
    let place = ["x", "y", "z"].iter().position(|name| *name == axis).unwrap_or(0);
    log.walls.as_ref().map_or_else(
        || item(document, &format!("boundary.{axis}")).and_then(Item::as_str) == Some("periodic"),
        |walls| walls.sides[place].iter().all(|side| side == "periodic"),
    )
}

fn has_open_side(log: &RunLog, document: &DocumentMut) -> bool {
    log.walls.as_ref().map_or_else(
        || item(document, "boundary").is_some_and(|sides| sides.to_string().contains("\"open\"")),
        |walls| walls.sides.iter().flatten().any(|side| side == "open"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_read_from_the_text() {
        let scenario = "title = \"Shear\"\ndimension = 2\n[domain]\nsize = [40, 20.5]\n[boundary]\nx = \"periodic\"\n\
                        y.lower = { wall = \"rough\", velocity = [-0.5, 0] }\n\
                        y.upper = { wall = \"rough\", velocity = [0.5, 0] }\n\
                        [particles]\ndiameter = 2\nrestitution = 0.9\n[units]\nlength = \"d\"";
        let log = RunLog { scenario: scenario.to_owned(), ..RunLog::default() };
        let setup = Setup::of(&log, &Map::new());
        assert_eq!(setup.size, [40.0, 20.5]);
        assert_eq!(setup.wall_velocities, Some([-0.5, 0.5]));
        assert_eq!((setup.diameter, setup.restitution), (2.0, Some(0.9)));
        assert!(!setup.is_periodic && !setup.has_gravity());
        assert_eq!(setup.length_label("height"), "height [d]");
    }

    #[test]
    fn a_broken_text_is_survived() {
        let log = RunLog { scenario: "= [".to_owned(), ..RunLog::default() };
        assert_eq!(Setup::of(&log, &Map::new()).title, "run");
    }
}
