//! The last state of a log as the beginning of another run.

use super::super::model::Scenario;
use super::{InitialError, ready};
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::matter::overlaps::overlaps;
use crate::space::Vector;

/// The gas of the grains in `saved`, if they fit into the scenario.
pub(super) fn gas<V: Vector>(scenario: &Scenario<V>, mut saved: Columns<V>) -> Result<Gas<V>, InitialError> {
    if saved.len() != scenario.count as usize {
        return Err(InitialError::Count { found: saved.len(), expected: scenario.count });
    }
    let grid = scenario.grid();
    for (row, &id) in saved.ids.iter().enumerate() {
        let position = saved.positions[row];
        let inside = |axis: usize| (grid.origin()[axis]..=grid.end()[axis]).contains(&position[axis]);
        if !(0..V::DIMENSION).all(inside) || !saved.velocities[row].is_finite() {
            return Err(InitialError::Outside { id });
        }
    }
    let kinds = scenario.species.len();
    let known = match &saved.species {
        None => kinds == 0,
        Some(species) => species.iter().all(|&species| usize::from(species) < kinds),
    };
    if !known {
        let kind = scenario.engine.kind.name();
        return Err(InitialError::Species { log_has: saved.species.is_some(), kind });
    }
    if let Some(species) = &saved.species {
        let mut found = vec![0; kinds];
        species.iter().for_each(|&species| found[usize::from(species)] += 1);
        if found != scenario.species_counts {
            return Err(InitialError::Shares { found, expected: scenario.species_counts.clone() });
        }
    }
    if scenario.roughness.is_none() {
        saved.spins = None;
    } else if saved.spins.is_none() {
        saved.spins = Some(vec![V::Spin::default(); saved.len()]);
    }
    let gas = ready(scenario, saved)?;
    if scenario.engine.kind.is_event_driven() {
        let number = overlaps(&gas, scenario.boundary.fixed_walls());
        if number > 0 {
            return Err(InitialError::Overlaps { number });
        }
    }
    Ok(gas)
}
