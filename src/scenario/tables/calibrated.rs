//! Laws that calibrations measure: `engine.impact_parameter` and `engine.hsmc.entry_probability`.

use crate::law::impact::ImpactLaw;
use crate::law::piecewise::PiecewiseLinear;
use crate::number::exact;
use crate::scenario::calibration_file::{Curve, ENTRY_PROBABILITY, IMPACT_PARAMETER};
use crate::scenario::reader::{Found, Section, kind};
use crate::scenario::schema;

/// Reads `engine.impact_parameter`.
pub(super) fn impact_law(engine: &Section<'_>) -> Option<ImpactLaw> {
    const KEY: &str = "impact_parameter";
    const FORMS: &str = "\"uniform\", { c = 0.3 }, { table = \"impact.csv\" } or { collisions_per_particle = [0.0, \
                         50.0], c = [0.0, 0.4] }";
    let Some(form) = table_of(engine, KEY, "uniform", FORMS, schema::IMPACT_PARAMETER)? else {
        return Some(ImpactLaw::UNIFORM);
    };
    if !form.has("collisions_per_particle")
        && !form.has("table")
        && form.item("c").is_some_and(|item| !item.is_array())
    {
        let [_, (name, bound)] = IMPACT_PARAMETER.columns;
        let Found::Value(c) = form.number(name, bound) else { return None };
        return Some(ImpactLaw::of(PiecewiseLinear::constant(c)));
    }
    curve(&form, IMPACT_PARAMETER, FORMS).map(ImpactLaw::of)
}

/// Reads `engine.hsmc.entry_probability`; `Some(None)` where a lack of room alone keeps grains out.
pub(super) fn entry_probability(hsmc: &Section<'_>) -> Option<Option<PiecewiseLinear>> {
    const KEY: &str = "entry_probability";
    const FORMS: &str = "\"step\", { table = \"entry.csv\" } or { volume_fraction = [0.0, 0.82], probability = [1.0, \
                         0.0] }";
    let Some(form) = table_of(hsmc, KEY, "step", FORMS, schema::ENTRY_PROBABILITY)? else {
        return Some(None);
    };
    curve(&form, ENTRY_PROBABILITY, FORMS).map(Some)
}

/// The table under `key`; `Some(None)` where it is missing or the `usual` word.
fn table_of<'a>(
    section: &Section<'a>,
    key: &str,
    usual: &str,
    forms: &str,
    keys: &[&str],
) -> Option<Option<Section<'a>>> {
    let Some(item) = section.item(key) else { return Some(None) };
    if item.as_str() == Some(usual) {
        return Some(None);
    }
    if !item.is_table_like() {
        section.mistake(key, format!("must be {forms}, not {}", kind(item)));
        return None;
    }
    Some(Some(section.section(key, keys)))
}

/// A curve through the points that two lists make. A `table` that still stands here could not be read, which
/// has been said.
fn curve(form: &Section<'_>, curve: Curve, forms: &str) -> Option<PiecewiseLinear> {
    let [(place_key, place_bound), (value_key, value_bound)] = curve.columns;
    if form.has("table") {
        if form.has(place_key) || form.has(value_key) {
            form.mistake_here(format!("takes exactly one form; write {forms}"));
        }
        return None;
    }
    if !form.has(place_key) && !form.has(value_key) {
        form.mistake_here(format!("says nothing; write {forms}"));
        return None;
    }
    let remedy = |other: &str| format!("give as many numbers as {other} has");
    let places = form.list(place_key, place_bound).required(form, place_key, &remedy(value_key));
    let values = form.list(value_key, value_bound).required(form, value_key, &remedy(place_key));
    let (places, values) = (places?, values?);
    if places.len() != values.len() {
        let message =
            format!("has {} numbers beside {} in {place_key}; give one for each", values.len(), places.len());
        form.mistake(value_key, message);
        return None;
    }
    if let Some(at) = places.windows(2).position(|pair| pair[0] >= pair[1]) {
        let (left, right) = (exact(places[at]), exact(places[at + 1]));
        form.mistake(place_key, format!("must rise, but {right} follows {left}; sort the points"));
        return None;
    }
    Some(PiecewiseLinear::through(places, values))
}
