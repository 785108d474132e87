//! Dense states without overlap: a dilute gas of small grains that grow.

use super::super::model::Scenario;
use super::{InitialError, diameters, insertion, ready};
use crate::engine::event_driven::growth;
use crate::matter::clock::Clock;
use crate::matter::columns::Columns;
use crate::matter::gas::Gas;
use crate::random::{Phase, Streams};
use crate::space::Vector;

/// The volume fraction at which growth begins, at most.
const DILUTE: [f64; 4] = [0.0, 0.0, 0.3, 0.2];
/// Where small grains find no room, as in a narrow box, they are made smaller by this factor.
const SMALLER: f64 = 0.8;
/// Names the streams of the velocities with which grains grow, beside step 0 of those with which a run begins.
const GROWING: u64 = 1;

/// Places `[id]` for grains of these `species` `[id]` at their full size.
pub(super) fn places<V: Vector>(
    scenario: &Scenario<V>,
    species: Option<&[u8]>,
) -> Result<Vec<V>, InitialError> {
    let mut gas = dilute(scenario, species)?;
    let seed = Streams::new(scenario.seed).derived_seed(Phase::InitialPositions);
    if gas.grain.diameter < scenario.grain.diameter {
        let (size, quiet) = (scenario.size, scenario.boundary.at_rest());
        growth::grow(&mut gas, size, &quiet, scenario.grain.diameter, seed)?;
    }
    let mut places = vec![V::ZERO; gas.len()];
    for (&id, &position) in gas.ids().iter().zip(gas.positions()) {
        places[id as usize] = position;
    }
    Ok(places)
}

/// A gas of grains that are small enough to be put in one by one, moving at about a diameter per unit of time.
fn dilute<V: Vector>(scenario: &Scenario<V>, species: Option<&[u8]>) -> Result<Gas<V>, InitialError> {
    let full = diameters(scenario, species);
    let thinner = (DILUTE[V::DIMENSION] / scenario.volume_fraction()).powf(1.0 / V::DIMENSION as f64);
    let mut scale = thinner.min(1.0);
    let positions = loop {
        let small: Vec<f64> = full.iter().map(|diameter| diameter * scale).collect();
        match insertion::places(scenario, &small) {
            Some(places) => break places,
            None => scale *= SMALLER,
        }
    };
    let streams = Streams::new(scenario.seed).at(GROWING, Phase::InitialVelocities);
    let speed = scenario.grain.diameter;
    let velocity = |id: usize| {
        let mut random = streams.stream(id as u64);
        let mass = species.map_or(scenario.grain, |of| scenario.species[usize::from(of[id])]).mass;
        let lightness = (scenario.grain.mass / mass).sqrt();
        V::from_fn(|_| random.gaussian() * lightness * speed)
    };
    let number = positions.len();
    let columns = Columns {
        velocities: (0..number).map(velocity).collect(),
        positions,
        ids: (0..number as u32).collect(),
        spins: None,
        species: species.map(<[u8]>::to_vec),
    };
    let mut gas = ready(scenario, columns)?;
    gas.clock = Clock::default();
    gas.grain.diameter *= scale;
    for grain in &mut gas.species {
        grain.diameter *= scale;
    }
    Ok(gas)
}
