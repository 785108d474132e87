//! Puts an engine together from a scenario.

use crate::engine::Engine;
use crate::engine::event_driven::laws::Growth;
use crate::engine::event_driven::{self, EventDriven};
use crate::engine::stochastic::Stochastic;
use crate::engine::stochastic::laws::{DenseGas, Laws};
use crate::law::boundary::Boundary;
use crate::law::impact::{ImpactLaw, Impacts};
use crate::law::restitution::{Constant, Restitution, RestitutionLaw};
use crate::random::Streams;
use crate::scenario::model::{EngineKind, HsmcRules, Scenario};
use crate::space::Vector;

/// The scenario's engine, under the given seed, boundary and gravity; `restitution` overrides
/// that of grains and cells.
pub fn engine<V: Vector>(
    scenario: &Scenario<V>,
    seed: u64,
    boundary: &Boundary<V>,
    gravity: V,
    restitution: Option<f64>,
) -> Box<dyn Engine<V>> {
    let law = restitution.map_or(scenario.restitution, |r| RestitutionLaw::Constant(Constant(r)));
    if scenario.engine.kind == EngineKind::EventDriven {
        return event_driven(scenario, seed, boundary, gravity, law);
    }
    match law {
        RestitutionLaw::Constant(law) => with_law(scenario, seed, boundary, gravity, law, restitution),
        RestitutionLaw::VelocityDependent(law) => {
            with_law(scenario, seed, boundary, gravity, law, restitution)
        }
    }
}

fn event_driven<V: Vector>(
    scenario: &Scenario<V>,
    seed: u64,
    boundary: &Boundary<V>,
    gravity: V,
    restitution: RestitutionLaw,
) -> Box<dyn Engine<V>> {
    let rules = scenario.engine.event_driven;
    let laws = event_driven::laws::Laws {
        grain: scenario.grain,
        species: scenario.species.clone(),
        restitution,
        roughness: scenario.roughness,
        gravity,
        size: scenario.size,
        boundary: *boundary,
        cure: rules.cure,
        growth: Growth::NONE,
        streams: Streams::new(seed),
        seed,
    };
    Box::new(EventDriven::new(laws, rules.structure))
}

fn with_law<V: Vector, R: Restitution + std::fmt::Debug>(
    scenario: &Scenario<V>,
    seed: u64,
    boundary: &Boundary<V>,
    gravity: V,
    restitution: R,
    cell_restitution: Option<f64>,
) -> Box<dyn Engine<V>> {
    let laws = Laws {
        grain: scenario.grain,
        restitution,
        impacts: Impacts::UNIFORM,
        gravity,
        boundary: *boundary,
        dense: dense_gas(scenario),
        streams: Streams::new(seed),
        seed,
    };
    let rules = (scenario.engine.kind == EngineKind::Hsmc).then(|| HsmcRules {
        cell_restitution: cell_restitution.unwrap_or(scenario.engine.hsmc.cell_restitution),
        ..scenario.engine.hsmc
    });
    // What equilibrates is elastic, and an elastic gas keeps to molecular chaos.
    let impact_law =
        if cell_restitution.is_none() { scenario.engine.impact_law.clone() } else { ImpactLaw::UNIFORM };
    let engine = Stochastic::new(laws, scenario.engine.time_step, rules)
        .with_impact_law(impact_law)
        .with_entry_probability(scenario.engine.entry_probability.clone());
    Box::new(engine)
}

/// What CBA and HSMC add to DSMC.
fn dense_gas<V: Vector>(scenario: &Scenario<V>) -> Option<DenseGas> {
    let largest_volume_fraction = match scenario.engine.kind {
        EngineKind::Dsmc | EngineKind::EventDriven => return None,
        EngineKind::Cba => V::LARGEST_LOCAL_FRACTION,
        EngineKind::Hsmc => V::LARGEST_LOCAL_FRACTION_HSMC,
    };
    Some(DenseGas {
        enskog_factor: scenario.engine.enskog_factor,
        transfer: scenario.engine.transfer,
        displacement_ratio: V::displacement_ratio(scenario.restitution.typical()),
        largest_volume_fraction,
    })
}
