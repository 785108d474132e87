//! A scenario of the event-driven engine, without the measures of a run.

use glam::{DVec2, DVec3};
use grainflow::engine::report::Totals;
use grainflow::engine::{Engine, EngineError, Horizon, NoLaps};
use grainflow::matter::gas::Gas;
use grainflow::matter::overlaps::overlaps;
use grainflow::observe::moments;
use grainflow::scenario::model::{AnyScenario, Scenario};
use grainflow::scenario::{Overrides, initial};
use grainflow::simulation::assembly;
use grainflow::space::Vector;

/// A space whose scenarios can be told apart from those of the other one.
pub(crate) trait Space: Vector {
    /// The scenario, if it is one of this space.
    fn of(scenario: AnyScenario) -> Option<Scenario<Self>>;
}

impl Space for DVec2 {
    fn of(scenario: AnyScenario) -> Option<Scenario<Self>> {
        if let AnyScenario::Two(scenario) = scenario { Some(scenario) } else { None }
    }
}

impl Space for DVec3 {
    fn of(scenario: AnyScenario) -> Option<Scenario<Self>> {
        if let AnyScenario::Three(scenario) = scenario { Some(scenario) } else { None }
    }
}

/// A gas under the engine of a scenario, and what has happened to it.
pub(crate) struct Trial<V: Vector> {
    pub(crate) scenario: Scenario<V>,
    pub(crate) gas: Gas<V>,
    pub(crate) totals: Totals<V>,
    engine: Box<dyn Engine<V>>,
}

/// The scenario written in `text`.
pub(crate) fn scenario<V: Space>(text: &str, seed: u64) -> Scenario<V> {
    let overrides = Overrides { seed: Some(seed), ..Overrides::default() };
    let scenario = grainflow::scenario::parse("made up", text, &overrides);
    V::of(scenario.unwrap_or_else(|error| panic!("{error}")))
        .expect("the scenario has the dimension of its test")
}

/// The text of a periodic event-driven gas at temperature 1: `count` grains of unit diameter and mass.
pub(crate) fn periodic<V: Vector>(count: u32, volume_fraction: f64, restitution: f64) -> String {
    let side = (f64::from(count) * V::UNIT_SPHERE_VOLUME / volume_fraction).powf(1.0 / V::DIMENSION as f64);
    format!(
        "dimension = {}\n[engine]\nkind = \"event-driven\"\n[domain]\nsize = {:?}\n[particles]\ncount = {count}\n\
         restitution = {restitution}\n[initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\ntime = 1.0\n",
        V::DIMENSION,
        vec![side; V::DIMENSION],
    )
}

impl<V: Space> Trial<V> {
    /// The start of the scenario written in `text`, without its equilibration.
    pub(crate) fn new(text: &str, seed: u64) -> Self {
        let scenario = scenario::<V>(text, seed);
        let gas = initial::build(&scenario, None).unwrap_or_else(|error| panic!("{error}"));
        let engine = assembly::engine(&scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
        Trial { scenario, gas, totals: Totals::default(), engine }
    }

    /// The same after so many elastic collisions per particle, again at temperature 1 and time 0.
    pub(crate) fn equilibrated(text: &str, seed: u64, collisions_per_particle: f64) -> Self {
        let mut trial = Self::new(text, seed);
        let Trial { scenario, .. } = &trial;
        let boundary = scenario.boundary.at_rest();
        let elastic = assembly::engine(scenario, seed + 1000, &boundary, V::ZERO, Some(1.0));
        let inelastic = std::mem::replace(&mut trial.engine, elastic);
        trial.advance_to(collisions_per_particle);
        initial::rescale(&mut trial.gas, 1.0);
        trial.gas.clock = Default::default();
        Trial { engine: inelastic, totals: Totals::default(), ..trial }
    }

    /// Goes on to so many collisions per particle.
    pub(crate) fn advance_to(&mut self, collisions_per_particle: f64) {
        self.try_to_advance_to(collisions_per_particle).unwrap_or_else(|error| panic!("{error}"));
    }

    /// The same, with what the engine has to say.
    pub(crate) fn try_to_advance_to(&mut self, collisions_per_particle: f64) -> Result<(), EngineError> {
        self.advance_to_either(f64::INFINITY, collisions_per_particle)
    }

    /// Goes on to this time or to so many collisions per particle, whichever comes first.
    pub(crate) fn advance_to_either(
        &mut self,
        time: f64,
        collisions_per_particle: f64,
    ) -> Result<(), EngineError> {
        let is_reached = |done: f64| done >= collisions_per_particle;
        while !is_reached(self.totals.collisions_per_particle) && self.gas.time() < time {
            let collisions =
                self.totals.collisions_until(self.gas.len(), collisions_per_particle, is_reached);
            self.step(Horizon { collisions, time })?;
        }
        Ok(())
    }

    fn step(&mut self, horizon: Horizon) -> Result<(), EngineError> {
        let grains = self.gas.len();
        let report = self.engine.step(&mut self.gas, horizon, &mut NoLaps)?;
        self.totals.add(&report, grains);
        Ok(())
    }

    /// Granular temperature.
    pub(crate) fn temperature(&self) -> f64 {
        moments::temperature(&self.gas)
    }

    /// Overlaps of grains with each other and with walls.
    pub(crate) fn invalid_states(&self) -> u64 {
        overlaps(&self.gas, self.scenario.boundary.fixed_walls())
    }
}
