//! What was measured, found by name: columns of the series, profiles, figures of the summary.

use serde_json::{Map, Value};

use super::setup::Setup;
use crate::observe::measure::{Column, Profile};
use crate::record::contents::RunLog;
use crate::simulation::figures::{DEGREES_OF_FREEDOM, STANDARD_ERROR, trend_of};
use crate::statistics::Trend;

/// A run as its plots see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Evidence<'a> {
    /// The log.
    pub log: &'a RunLog,
    /// The summary.
    pub summary: &'a Map<String, Value>,
    /// The parameters.
    pub setup: &'a Setup,
}

impl<'a> Evidence<'a> {
    /// A figure of the summary; `None` where it is null or not there.
    pub(super) fn figure(&self, name: &str) -> Option<f64> {
        self.summary.get(name).and_then(Value::as_f64)
    }

    /// The standard error of a figure.
    pub(super) fn standard_error(&self, name: &str) -> Option<f64> {
        self.figure(&format!("{name}{STANDARD_ERROR}"))
    }

    /// Degrees of freedom of that error.
    pub(super) fn degrees_of_freedom(&self, name: &str) -> Option<f64> {
        self.figure(&format!("{name}{DEGREES_OF_FREEDOM}"))
    }

    /// What the series of a figure does; `None` where that was not tested.
    pub(super) fn trend(&self, name: &str) -> Option<Trend> {
        trend_of(self.summary, name)
    }

    /// What the series of a figure does, where it is not steady.
    pub(super) fn unsteady(&self, name: &str) -> Option<Trend> {
        self.trend(name).filter(|trend| !trend.is_steady())
    }

    /// The place and the unit of a column of the series.
    pub(super) fn column(&self, name: &str) -> Option<(usize, &'a Column)> {
        self.log.columns.iter().enumerate().find(|(_, column)| column.name == name)
    }

    /// One column of the series against another, where both are finite.
    pub(super) fn series(&self, x: usize, y: usize) -> Vec<[f64; 2]> {
        let rows = self.log.series.iter();
        let pairs = rows.filter_map(|row| Some([*row.get(x)?, *row.get(y)?]));
        pairs.filter(|pair| pair.iter().all(|v| v.is_finite())).collect()
    }

    /// All profiles of a name, in time.
    pub(super) fn profiles(&self, name: &str) -> Vec<&'a Profile> {
        self.log.profiles.iter().filter(|p| p.name == name && is_whole(p)).collect()
    }

    /// Names of all profiles, each once, in the order of the log.
    pub(super) fn profile_names(&self) -> Vec<&'a str> {
        let mut names: Vec<&str> = Vec::new();
        for profile in &self.log.profiles {
            if !names.contains(&profile.name.as_str()) {
                names.push(&profile.name);
            }
        }
        names
    }
}

/// Whether a profile has two columns and values for each.
fn is_whole(profile: &Profile) -> bool {
    profile.columns.len() >= 2 && profile.values.len() == profile.columns.len()
}

/// The column of a profile that is called `name`, else the one at `place`.
pub(super) fn values<'a>(profile: &'a Profile, name: &str, place: usize) -> &'a [f64] {
    let found = profile.columns.iter().position(|column| column.name == name).unwrap_or(place);
    profile.values.get(found).map_or(&[], Vec::as_slice)
}

/// Points of two columns, as far as both go.
pub(super) fn points(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
}

/// About `wanted` of `items`, evenly, with the last.
pub(super) fn spread<T: Copy>(items: &[T], wanted: usize) -> Vec<T> {
    if items.len() <= wanted {
        return items.to_vec();
    }
    (1..=wanted).map(|k| items[k * items.len() / wanted - 1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_ends_with_the_last() {
        let items: Vec<i32> = (0..100).collect();
        assert_eq!(spread(&items, 4), [24, 49, 74, 99]);
        assert_eq!(spread(&items[..3], 8), [0, 1, 2]);
    }
}
