//! The tables of a run, written again from its log.

use std::collections::BTreeMap;

use super::selection::Selection;
use super::units_of;
use crate::observe::measure::{Column, Profile};
use crate::record::contents::RunLog;
use crate::run::series::{profile_table, table};

/// A series and profiles, as a run stores them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// Columns of the series; the first is the time.
    pub columns: Vec<Column>,
    /// `[recording][column]`.
    pub series: Vec<Vec<f64>>,
    /// Profiles, in the order of their times.
    pub profiles: Vec<Profile>,
}

/// The part of `log` that `selection` names; a profile of the whole run stands at the time of its end.
pub fn tables_of(log: RunLog, selection: Selection) -> Tables {
    let mut picker = selection.picker();
    let mut series = log.series;
    let mut taken: Vec<f64> = Vec::new();
    let mut passed: Vec<f64> = Vec::new();
    series.retain(|row| {
        let takes = picker.takes(row[0]);
        if takes { &mut taken } else { &mut passed }.push(row[0]);
        takes
    });
    let mut profiles = log.profiles;
    // A profile goes with its recording; one that belongs to none goes by its time.
    profiles.retain(|profile| {
        let is = |times: &[f64]| times.iter().any(|time| time.to_bits() == profile.time.to_bits());
        is(&taken) || (!is(&passed) && selection.spans(profile.time))
    });
    Tables { columns: log.columns, series, profiles }
}

impl Tables {
    /// Leaves only the columns that `keeps` says, beside the time, and the profiles that belong to `measures`.
    pub fn narrow(&mut self, keeps: impl Fn(&str) -> bool, measures: &[String]) {
        let kept: Vec<usize> =
            (0..self.columns.len()).filter(|&k| k == 0 || keeps(&self.columns[k].name)).collect();
        self.columns = kept.iter().map(|&k| self.columns[k].clone()).collect();
        for row in &mut self.series {
            *row = kept.iter().map(|&k| row[k]).collect();
        }
        self.profiles.retain(|profile| measures.iter().any(|measure| belongs(&profile.name, measure)));
    }

    /// `series.csv`, with the units that the `metadata` of the log name.
    pub fn series_text(&self, metadata: &BTreeMap<String, String>) -> String {
        table(&self.columns, &units_of(metadata), self.series.iter().map(Vec::as_slice))
    }

    /// `profiles/<name>.csv` by name.
    pub fn profile_texts(&self, metadata: &BTreeMap<String, String>) -> BTreeMap<String, String> {
        let mut by_name: BTreeMap<&str, Vec<&Profile>> = BTreeMap::new();
        for profile in &self.profiles {
            by_name.entry(&profile.name).or_default().push(profile);
        }
        let units = units_of(metadata);
        by_name
            .into_iter()
            .map(|(name, profiles)| (name.to_owned(), profile_table(&profiles, &units)))
            .collect()
    }
}

/// Whether the profile `name` is one of `measure`: it has its name, or begins with it, as `pair-correlation-mean`.
fn belongs(name: &str, measure: &str) -> bool {
    name.strip_prefix(measure).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::measure::Dimension;

    fn profile(name: &str, time: f64) -> Profile {
        Profile { name: name.to_owned(), time, columns: Vec::new(), values: Vec::new() }
    }

    #[test]
    fn profiles_go_with_their_recordings() {
        let column = |name: &str| Column { name: name.to_owned(), unit: Dimension::default() };
        let log = RunLog {
            columns: ["time", "a", "b"].map(column).into(),
            series: (0..5).map(|k| vec![f64::from(k), 10.0, 20.0]).collect(),
            profiles: (0..5).map(|k| profile("heap-surface", f64::from(k))).collect(),
            ..RunLog::default()
        };
        let mut tables = tables_of(log, Selection { from: 1.0, to: 4.0, every: 2 });
        assert_eq!(tables.series.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 3.0]);
        assert_eq!(tables.profiles.iter().map(|one| one.time).collect::<Vec<_>>(), [1.0, 3.0]);
        tables.narrow(|name| name == "b", &["energy".to_owned()]);
        assert_eq!((tables.series[0].clone(), tables.profiles.len()), (vec![1.0, 20.0], 0));
        assert!(belongs("heap-surface", "heap") && !belongs("heaps", "heap"));
    }
}
