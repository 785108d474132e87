//! What is looked at when a run is recorded.

use super::shown::Shown;
use crate::observe::measure::{Column, Dimension, Measure, Profile, Snapshot};
use crate::simulation::Simulation;
use crate::space::Vector;

/// Which measures are stored, and their columns.
#[derive(Clone, Debug)]
pub(super) struct Looks {
    /// `[measure]`: whether its series and profiles are stored.
    pub(super) stored: Vec<bool>,
    /// Columns of the series; the first is the time.
    pub(super) columns: Vec<Column>,
}

impl Looks {
    /// What the scenario of `simulation` wants to be stored.
    pub(super) fn of<V: Vector>(simulation: &mut Simulation<'_, V>) -> Self {
        let names = simulation.scenario().record.measures.as_ref();
        let is_stored = |name: &str| names.is_none_or(|names| names.iter().any(|n| n == name));
        let (measures, _) = simulation.observation();
        let stored: Vec<bool> = measures.iter().map(|measure| is_stored(measure.name())).collect();
        let mut columns =
            vec![Column { name: "time".to_owned(), unit: Dimension { time: 1, ..Dimension::default() } }];
        for (measure, _) in measures.iter().zip(&stored).filter(|(_, stored)| **stored) {
            columns.extend(measure.columns());
        }
        Looks { stored, columns }
    }

    /// Values of the columns, all of them at a full recording, and profiles of this moment where they are wanted. Measures of what
    /// happens between two looks begin anew.
    pub(super) fn take<V: Vector>(
        &self,
        measures: &mut [Box<dyn Measure<V>>],
        snapshot: &Snapshot<'_, V>,
        shown: Shown,
    ) -> (Vec<f64>, Vec<Profile>) {
        let (mut values, mut profiles) = (vec![snapshot.gas.time()], Vec::new());
        for (measure, _) in measures.iter_mut().zip(&self.stored).filter(|(_, stored)| **stored) {
            values.extend(if shown.full { measure.values(snapshot) } else { measure.brief_values(snapshot) });
            if shown.profiles {
                profiles.extend(measure.profiles(snapshot));
            }
        }
        (values, profiles)
    }
}
