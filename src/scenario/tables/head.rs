//! What stands above the first table, with `[domain]` and `[units]`.

use crate::scenario::bound::Bound;
use crate::scenario::model::Units;
use crate::scenario::reader::{Found, Section};
use crate::scenario::schema;
use crate::space::Vector;

/// What stands above the first table.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct Head<V> {
    pub(in crate::scenario) title: Option<String>,
    pub(in crate::scenario) seed: Option<u64>,
    pub(in crate::scenario) gravity: Option<V>,
}

/// The dimension; where it is missing or wrong, that of `domain.size`, so that reading can go on.
pub(in crate::scenario) fn dimension(root: &Section<'_>) -> u64 {
    let found = match root.item("dimension").and_then(|item| item.as_integer()) {
        Some(value) if value != 2 && value != 3 => {
            root.mistake("dimension", format!("{value} is out of bounds; give 2 (disks) or 3 (spheres)"));
            None
        }
        _ => root.whole("dimension", 2, 3).required(root, "dimension", "write dimension = 2 or 3"),
    };
    found.unwrap_or_else(|| {
        let size = root.item("domain").and_then(|domain| domain.as_table_like()?.get("size")?.as_array());
        if size.is_some_and(|size| size.len() == 3) { 3 } else { 2 }
    })
}

/// Reads title, seed and gravity; `name` stands for a missing title.
pub(in crate::scenario) fn read<V: Vector>(root: &Section<'_>, name: &str) -> Head<V> {
    Head {
        title: label(root, "title", name, 200),
        seed: root.whole("seed", 0, i64::MAX as u64).or(1),
        gravity: gravity(root),
    }
}

/// Zero where there is none; not known where it stands below a table by mistake, so that nothing else misses it.
fn gravity<V: Vector>(root: &Section<'_>) -> Option<V> {
    match root.vector("gravity", Bound::ANY) {
        Found::Missing if root.holds_below("gravity") => None,
        found => found.or(V::ZERO),
    }
}

/// Reads `domain.size`.
pub(in crate::scenario) fn size<V: Vector>(root: &Section<'_>) -> Option<V> {
    let domain = root.section("domain", schema::DOMAIN);
    let example = if V::DIMENSION == 2 { "[40.0, 40.0]" } else { "[40.0, 40.0, 40.0]" };
    if root.has("domain") && !domain.exists() {
        return None;
    }
    domain.vector("size", Bound::POSITIVE).required(
        &domain,
        "size",
        &format!("write size = {example} into [domain]"),
    )
}

/// Reads `[units]`.
pub(in crate::scenario) fn units(root: &Section<'_>) -> Option<Units> {
    let units = root.section("units", schema::UNITS);
    let [length, mass, time] = ["length", "mass", "time"].map(|key| label(&units, key, key, 20));
    Some(Units { length: length?, mass: mass?, time: time? })
}

/// A short text on one line.
fn label(section: &Section<'_>, key: &str, default: &str, longest: usize) -> Option<String> {
    let text = match section.text(key, &format!("{key} = \"…\"")) {
        Found::Value(text) => text,
        Found::Missing => default,
        Found::Wrong => return None,
    };
    let length = text.chars().count();
    if length == 0 || length > longest || text.chars().any(char::is_control) {
        section.mistake(
            key,
            format!("must be one line of 1 to {longest} characters; shorten it or leave it out"),
        );
        return None;
    }
    Some(text.to_owned())
}
