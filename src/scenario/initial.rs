//! Builds the gas that a scenario begins with.
//!
//! Every grain draws from a stream of its own, named by seed and identity.

mod compressed;
mod in_cells;
mod insertion;
mod lattice;
mod saved;
mod species;
mod velocities;

use super::model::{InitialPositions, Scenario};
use crate::engine::event_driven::growth::GrowthError;
use crate::matter::clock::Clock;
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::space::Vector;
pub(super) use in_cells::cells_above_capacity;
pub(super) use insertion::has_room;
pub(super) use lattice::check as check_lattice;
pub use velocities::{rescale, stated_temperature};

/// Why a gas cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InitialError {
    /// The scenario starts from a log, and nobody read it.
    #[error("initial.positions names the log {0}, whose last state has to be read first")]
    LogNotRead(String),
    /// The log holds another number of grains.
    #[error(
        "initial.positions: the log's last state holds {found} grains, the scenario says {expected}; \
         set particles.count = {found}"
    )]
    Count {
        /// Grains in the log.
        found: usize,
        /// Grains in the scenario.
        expected: u32,
    },
    /// A grain of the log lies outside, or is not finite.
    #[error(
        "initial.positions: grain {id} of the log lies outside the box, or is not finite; use the log's domain.size"
    )]
    Outside {
        /// Its identity.
        id: u32,
    },
    /// Grains of the log overlap, and the engine knows hard grains only.
    #[error(
        "initial.positions: {number} overlaps of grains with each other or with walls in the log's last state, and \
         event-driven takes none; start from the log of an event-driven run, or with positions = \"compressed\""
    )]
    Overlaps {
        /// Pairs that overlap, and grains that overlap with walls.
        number: u64,
    },
    /// The log's grains are of other kinds than those of the scenario.
    #[error(
        "initial.positions: the grains of the log are {}, those of the scenario are not; give the \
         [[particles.species]] of the log's own scenario ({kind})",
        if *log_has { "of several species" } else { "all alike" }
    )]
    Species {
        /// Whether the log names species.
        log_has: bool,
        /// The engine of this scenario.
        kind: &'static str,
    },
    /// The log holds other numbers of its species.
    #[error(
        "initial.positions: the log's last state holds {} grains of its species, the scenario says {}; give the [[particles.species]] share = {}",
        sum_of(found),
        sum_of(expected),
        shares_of(found)
    )]
    Shares {
        /// Grains in the log `[species]`.
        found: Vec<u32>,
        /// Grains in the scenario `[species]`.
        expected: Vec<u32>,
    },
    /// No identities are left for further grains.
    #[error(
        "initial.positions: grain {id} of the log has an identity after which there are not enough for {to_come} poured \
         grains and the next one, up to 4294967295; lower source.count, or start from a log whose grains are numbered from 0"
    )]
    Identities {
        /// The last identity.
        id: u32,
        /// Grains that the source will pour.
        to_come: u32,
    },
    /// Grains do not come to their size.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// No regular lattice has room for the grains.
    #[error(
        "initial.positions: no regular lattice of these grains fits into the box; write \"compressed\", or take fewer \
         grains"
    )]
    Lattice,
}

/// Numbers of grains as a sum.
fn sum_of(counts: &[u32]) -> String {
    counts.iter().map(u32::to_string).collect::<Vec<_>>().join(" + ")
}

/// Shares that make these numbers of grains. A share is above 0: one so small that it makes no grain stands for none.
fn shares_of(counts: &[u32]) -> String {
    let share = |&count: &u32| if count == 0 { "1e-12".to_owned() } else { count.to_string() };
    counts.iter().map(share).collect::<Vec<_>>().join(", ")
}

/// The gas that `scenario` begins with, before any equilibration. Where it starts from a log,
/// `saved` are the columns of that log's last state; otherwise they are not used.
pub fn build<V: Vector>(scenario: &Scenario<V>, saved: Option<Columns<V>>) -> Result<Gas<V>, InitialError> {
    if let InitialPositions::Log(path) = &scenario.initial.positions {
        let saved = saved.ok_or_else(|| InitialError::LogNotRead(path.display().to_string()))?;
        return saved::gas(scenario, saved);
    }
    let species = species::species(scenario);
    let positions = positions(scenario, species.as_deref())?;
    let columns = Columns {
        velocities: velocities::velocities(scenario, species.as_deref()),
        ids: (0..scenario.count).collect(),
        spins: scenario.roughness.map(|_| vec![V::Spin::default(); positions.len()]),
        positions,
        species,
    };
    ready(scenario, columns)
}

/// Places `[id]`; for the event-driven engine and `compressed` without overlap.
fn positions<V: Vector>(scenario: &Scenario<V>, species: Option<&[u8]>) -> Result<Vec<V>, InitialError> {
    let hard = scenario.engine.kind.is_event_driven();
    match &scenario.initial.positions {
        InitialPositions::Random if hard && has_room(scenario) => {
            let places = insertion::places(scenario, &diameters(scenario, species));
            // A narrow box may have less room than its volume promises.
            places.map_or_else(|| compressed::places(scenario, species), Ok)
        }
        InitialPositions::Random if !hard => Ok(in_cells::random_positions(scenario, &scenario.grid())),
        InitialPositions::Lattice if hard => lattice::sites(scenario).ok_or(InitialError::Lattice),
        InitialPositions::Lattice => Ok(in_cells::even_positions(scenario, &scenario.grid())),
        _ => compressed::places(scenario, species),
    }
}

/// The diameter of every grain `[id]`, given its species `[id]` [length].
fn diameters<V: Vector>(scenario: &Scenario<V>, species: Option<&[u8]>) -> Vec<f64> {
    match species {
        None => vec![scenario.grain.diameter; scenario.count as usize],
        Some(species) => species.iter().map(|&of| scenario.species[usize::from(of)].diameter).collect(),
    }
}

/// The gas of these columns at time 0, in the scenario's cells.
fn ready<V: Vector>(scenario: &Scenario<V>, columns: Columns<V>) -> Result<Gas<V>, InitialError> {
    let last = columns.ids.iter().max().copied();
    let next_id = last.map_or(Some(0), |id| id.checked_add(1));
    let to_come = scenario.source.as_ref().map_or(0, |source| source.count);
    let next_id = next_id
        .filter(|next| next.checked_add(to_come).is_some())
        .ok_or(InitialError::Identities { id: last.unwrap_or(0), to_come })?;
    let mut gas = Gas::restored(scenario.grid(), scenario.grain, columns, Clock::default(), next_id);
    gas.species = scenario.species.clone();
    Ok(gas)
}

#[cfg(test)]
mod hard_tests;
#[cfg(test)]
mod tests;
