//! The gases that engines and yardstick are timed on: elastic, ν = 0.25, ten grains per cell.

use grainflow::engine::{Horizon, NoLaps};
use grainflow::law::kinetic_theory::collision_frequency;
use grainflow::matter::grain::Grain;
use grainflow::scenario::model::AnyScenario;
use grainflow::scenario::{Overrides, initial, parse};
use grainflow::simulation::assembly;
use grainflow::space::Vector;

use super::yardstick::Yardstick;

/// Volume fraction of every case.
pub(crate) const VOLUME_FRACTION: f64 = 0.25;
/// Grains per cell of every case.
pub(crate) const PER_CELL: f64 = 10.0;

/// Side of the box and cells along it, an even number, for `grains` in D dimensions.
pub(crate) fn geometry<V: Vector>(grains: usize) -> (f64, usize) {
    let root = 1.0 / V::DIMENSION as f64;
    let side = (grains as f64 * V::UNIT_SPHERE_VOLUME / VOLUME_FRACTION).powf(root);
    let cells = (grains as f64 / PER_CELL).powf(root);
    (side, 2 * (0.5 * cells).round() as usize)
}

/// The yardstick with as many collisions per particle and step as the engines.
pub(crate) fn yardstick<V: Vector, const D: usize>(
    grains: usize,
    collisions_per_particle: f64,
) -> Yardstick<D> {
    let (side, cells) = geometry::<V>(grains);
    let grain = Grain { diameter: 1.0, mass: 1.0 };
    let g = V::contact_correlation(VOLUME_FRACTION);
    let duration = collisions_per_particle / collision_frequency::<V>(grain, VOLUME_FRACTION, 1.0, g);
    Yardstick::new(grains, side, cells, duration)
}

/// A scenario of one of the engines on the same gas.
pub(crate) fn scenario<V: Vector>(engine: &str, grains: usize, collisions_per_particle: f64) -> AnyScenario {
    let (side, cells) = geometry::<V>(grains);
    let sizes = vec![format!("{side:?}"); V::DIMENSION].join(", ");
    let text = format!(
        "dimension = {}\n[engine]\nkind = \"{engine}\"\ncell_size = {:?}\n\
         time_step = {{ collisions_per_particle = {collisions_per_particle} }}\n\
         [domain]\nsize = [{sizes}]\n[particles]\ncount = {grains}\nrestitution = 1.0\n\
         [initial]\nvelocities = {{ maxwell = 1.0 }}\n[run]\nsteps = 1\n",
        V::DIMENSION,
        side / cells as f64,
    );
    parse("bench", &text, &Overrides::default()).expect("the bench's scenario is right")
}

/// The gas of a scenario and the engine that advances it, as a closure that makes one step.
pub(crate) fn stepper(scenario: &AnyScenario) -> Box<dyn FnMut() + '_> {
    match scenario {
        AnyScenario::Two(scenario) => boxed(scenario),
        AnyScenario::Three(scenario) => boxed(scenario),
    }
}

fn boxed<V: Vector>(scenario: &grainflow::scenario::model::Scenario<V>) -> Box<dyn FnMut() + '_> {
    let mut gas = initial::build(scenario, None).expect("a random gas can be built");
    let mut engine = assembly::engine(scenario, scenario.seed, &scenario.boundary, scenario.gravity, None);
    Box::new(move || {
        engine.step(&mut gas, Horizon::NONE, &mut NoLaps).expect("an elastic gas goes on for ever");
    })
}
