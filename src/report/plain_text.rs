//! What the text of a scenario says that this version does not take: enough for pictures and labels.

use toml_edit::{DocumentMut, Item};

/// What is found by the names that scenarios have always had.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlainText {
    /// Title.
    pub title: Option<String>,
    /// Name of the engine.
    pub engine: Option<String>,
    /// 2 or 3.
    pub dimension: Option<usize>,
    /// Sides of the box [length].
    pub size: Vec<f64>,
    /// Constant acceleration [length/time²].
    pub gravity: Vec<f64>,
    /// Diameter of a grain [length]; 1 where it is not found.
    pub diameter: f64,
    /// Names of the units of length, mass and time.
    pub units: [String; 3],
}

impl PlainText {
    /// What `scenario` says; nothing where it is not TOML.
    pub(super) fn of(scenario: &str) -> Self {
        let document = scenario.parse::<DocumentMut>().unwrap_or_default();
        let at = |path: &str| path.split('.').try_fold(document.as_item(), |item, key| item.get(key));
        let text = |path: &str| at(path).and_then(Item::as_str).map(str::to_owned);
        Self {
            title: text("title"),
            engine: text("engine.kind"),
            dimension: float(at("dimension")).map(|dimension| dimension as usize),
            size: numbers(at("domain.size")),
            gravity: numbers(at("gravity")),
            diameter: float(at("particles.diameter")).filter(|diameter| *diameter > 0.0).unwrap_or(1.0),
            units: ["length", "mass", "time"].map(|kind| {
                text(&format!("units.{kind}"))
                    .map_or_else(|| kind.to_owned(), |name| if name == "1" { String::new() } else { name })
            }),
        }
    }
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
