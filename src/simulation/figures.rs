//! The keys that the summary of every run has, whatever its scenario measures, and what each is.

use serde_json::{Map, Value};

use crate::observe::measure::Figure;
use crate::statistics::Trend;

/// What a key of a summary holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A text, or true and false.
    Text,
    /// A number of the run; null where it does not apply.
    Number,
    /// What an engine counts while it works, and shares of it; null where it does not apply.
    Counter,
    /// What the machine had to give: another number each time.
    Cost,
}

/// Every key, in the order in which pages and messages name them. All other keys of a summary are figures of its scenario.
pub const KEYS: [(&str, Kind); 44] = [
    ("scenario", Kind::Text),
    ("engine", Kind::Text),
    ("version", Kind::Text),
    ("end_reason", Kind::Text),
    ("interrupted", Kind::Text),
    ("failure", Kind::Text),
    ("state_hash", Kind::Text),
    ("dimension", Kind::Number),
    ("particles_initial", Kind::Number),
    ("particles_final", Kind::Number),
    ("volume_fraction", Kind::Number),
    ("seed", Kind::Number),
    ("threads", Kind::Number),
    ("numerics", Kind::Number),
    ("collisions_per_particle", Kind::Number),
    ("simulated_time", Kind::Number),
    ("resumed_at", Kind::Number),
    ("kinetic_energy_initial", Kind::Number),
    ("kinetic_energy_final", Kind::Number),
    ("temperature", Kind::Number),
    ("momentum_drift", Kind::Number),
    ("steps", Kind::Counter),
    ("steps_capped", Kind::Counter),
    ("events", Kind::Counter),
    ("wall_hits", Kind::Counter),
    ("cell_crossings", Kind::Counter),
    ("list_renewals", Kind::Counter),
    ("annulled_events", Kind::Counter),
    ("cured_share", Kind::Counter),
    ("invalid_states", Kind::Counter),
    ("collisions", Kind::Counter),
    ("candidates", Kind::Counter),
    ("cell_collisions", Kind::Counter),
    ("rejected_moves", Kind::Counter),
    ("cell_capacity", Kind::Counter),
    ("largest_occupancy", Kind::Counter),
    ("poured", Kind::Counter),
    ("removed", Kind::Counter),
    ("wall_seconds", Kind::Cost),
    ("equilibration_seconds", Kind::Cost),
    ("advancing_seconds", Kind::Cost),
    ("particle_steps_per_second", Kind::Cost),
    ("events_per_second", Kind::Cost),
    ("peak_memory_bytes", Kind::Cost),
];

/// What stands beside a figure in a summary, as endings of its name: standard error, degrees of freedom of that error,
/// whether the figure is steady (true, false or null), and what it does where it is not (`rising`, `falling`, `wandering`).
pub const ATTRIBUTES: [&str; 4] = [STANDARD_ERROR, DEGREES_OF_FREEDOM, STEADY, TREND];
/// Ending of the key of a standard error.
pub const STANDARD_ERROR: &str = "_standard_error";
/// Ending of the key of the degrees of freedom of a standard error.
pub const DEGREES_OF_FREEDOM: &str = "_degrees_of_freedom";
/// Ending of the key that says whether a figure is steady.
pub const STEADY: &str = "_steady";
/// Ending of the key that says what an unsteady figure does.
pub const TREND: &str = "_trend";

/// Whether `key` is an attribute of a figure, not a figure itself.
pub fn is_attribute(key: &str) -> bool {
    ATTRIBUTES.iter().any(|ending| key.ends_with(ending))
}

/// The figure `name` of a summary with what stands beside it; `None` where it is not there or null.
pub fn figure_of(summary: &Map<String, Value>, name: &str) -> Option<Figure> {
    let number = |ending: &str| summary.get(&format!("{name}{ending}")).and_then(Value::as_f64);
    Some(Figure {
        name: name.to_owned(),
        value: Some(number("")?),
        standard_error: number(STANDARD_ERROR),
        degrees_of_freedom: number(DEGREES_OF_FREEDOM),
        trend: trend_of(summary, name),
    })
}

/// What a summary says of the series of the figure `name`; `None` where that was not tested.
pub fn trend_of(summary: &Map<String, Value>, name: &str) -> Option<Trend> {
    match summary.get(&format!("{name}{STEADY}"))?.as_bool()? {
        true => Some(Trend::Steady),
        false => {
            let word = summary.get(&format!("{name}{TREND}")).and_then(Value::as_str);
            Some(word.and_then(Trend::of_name).unwrap_or(Trend::Wandering))
        }
    }
}

/// Runs of which at most this share may fail a test of steadiness by chance.
const BY_CHANCE: f64 = 0.05;

/// Whether a figure is steady in several runs of the same case, given the `trends` of those that tested it: where not more
/// than one in twenty is not. `None` where no run tested it; where they do different things it wanders.
pub fn trend_of_runs(trends: impl Iterator<Item = Trend>) -> Option<Trend> {
    let trends: Vec<Trend> = trends.collect();
    let unsteady: Vec<Trend> = trends.iter().copied().filter(|trend| !trend.is_steady()).collect();
    if unsteady.len() as f64 <= BY_CHANCE * trends.len() as f64 {
        return (!trends.is_empty()).then_some(Trend::Steady);
    }
    let first = unsteady[0];
    Some(if unsteady.iter().all(|trend| *trend == first) { first } else { Trend::Wandering })
}

/// Names of the figures of a summary, in its order: what has a place for a standard error, be there one or not.
pub fn figures_of(summary: &Map<String, Value>) -> impl Iterator<Item = &str> {
    let names = summary.keys().filter(|name| summary.contains_key(&format!("{name}{STANDARD_ERROR}")));
    names.map(String::as_str)
}

/// Whether every summary has this key.
pub fn is_of_every_run(name: &str) -> bool {
    KEYS.iter().any(|(key, _)| *key == name)
}

/// The keys that hold numbers.
pub fn numbers() -> impl Iterator<Item = &'static str> + Clone {
    KEYS.iter().filter(|(_, kind)| *kind != Kind::Text).map(|(key, _)| *key)
}

/// What an engine counts.
pub fn counters() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter(|(_, kind)| *kind == Kind::Counter).map(|(key, _)| *key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_steady_together_where_no_more_than_chance_are_not() {
        use Trend::{Falling, Rising, Steady, Wandering};
        let of = |trends: &[Trend]| trend_of_runs(trends.iter().copied());
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[Steady, Steady]), Some(Steady));
        assert_eq!(of(&[Steady, Rising, Steady]), Some(Rising));
        assert_eq!(of(&[Falling, Rising]), Some(Wandering));
        assert_eq!(of(&[vec![Steady; 39], vec![Rising]].concat()), Some(Steady));
        assert_eq!(of(&[vec![Steady; 38], vec![Rising; 3]].concat()), Some(Rising));
    }

    #[test]
    fn a_figure_comes_back_from_a_summary() {
        let summary = serde_json::json!({
            "pressure": 0.5, "pressure_standard_error": 0.01, "pressure_degrees_of_freedom": 17.5,
            "pressure_steady": false, "pressure_trend": "rising", "lone": 2.0, "none": null,
        });
        let summary = summary.as_object().unwrap();
        let pressure = figure_of(summary, "pressure").unwrap();
        assert_eq!((pressure.value, pressure.standard_error), (Some(0.5), Some(0.01)));
        assert_eq!((pressure.degrees_of_freedom, pressure.trend), (Some(17.5), Some(Trend::Rising)));
        assert_eq!(figure_of(summary, "lone").unwrap().trend, None);
        assert_eq!(figure_of(summary, "none"), None);
        assert_eq!(figures_of(summary).collect::<Vec<_>>(), ["pressure"]);
    }
}
