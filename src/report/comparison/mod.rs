//! The page of a comparison: its sections in the order of a reader's questions.

mod costs;
mod curves;
mod figures;
mod gallery;
pub(super) mod judgement;
mod origin;
mod summit;
mod verdicts;

use super::page::{document, section};
use super::unit::unit;
use crate::comparison::model::Comparison;
use crate::number::in_words;
use crate::observe::measure::{Column, Dimension};

/// The whole page.
pub(super) fn page(comparison: &Comparison) -> String {
    let mut body = summit::html(comparison);
    body.push_str(&section("The same moments", &gallery::html(comparison)));
    body.push_str(&section("Where they agree", &verdicts::html(comparison)));
    body.push_str(&section("What they cost", &costs::html(comparison)));
    body.push_str(&section("In the course of time", &curves::series(comparison)));
    body.push_str(&section("Profiles, spectra, distributions", &curves::profiles(comparison)));
    body.push_str(&section("Figures", &figures::html(comparison)));
    body.push_str(&section("How it was made", &origin::html(comparison)));
    document(&comparison.title, &body, &comparison.version)
}

/// What the contestant at `place` is called.
fn label(comparison: &Comparison, place: usize) -> &str {
    comparison.contestants.get(place).map_or("?", |contestant| contestant.label.as_str())
}

/// What the others are subtracted from.
fn reference(comparison: &Comparison) -> &str {
    label(comparison, comparison.reference)
}

/// "name [unit]" of a column.
fn labelled(comparison: &Comparison, column: &Column) -> String {
    with_unit(comparison, &in_words(&column.name), column.unit)
}

/// "name [unit]".
fn with_unit(comparison: &Comparison, name: &str, dimension: Dimension) -> String {
    let unit = unit(dimension, &comparison.units);
    // "time [time]" says nothing.
    if unit.is_empty() || unit == name { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// "t = 3.5", with the unit of time where it has a name.
fn moment(comparison: &Comparison, time: f64) -> String {
    let unit = if comparison.units[2] == "time" { "" } else { &comparison.units[2] };
    format!("t = {} {unit}", crate::number::number(time, 4)).trim_end().to_owned()
}
