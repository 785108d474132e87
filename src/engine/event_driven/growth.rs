//! Growing spheres: dense states without overlap (Lubachevsky and Stillinger 1990; Miller 2004, equations 2.16 to 2.21).

use super::EventDriven;
use super::laws::{Growth, Laws};
use super::rules::{Cure, Structure};
use crate::engine::{Engine, EngineError, Horizon, NoLaps};
use crate::law::boundary::Boundary;
use crate::law::restitution::{Constant, RestitutionLaw};
use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::random::Streams;
use crate::space::Vector;

/// Rate at which radii grow, as a share of the thermal speed.
const GROWTH_SPEED: f64 = 0.05;
/// Share of the full size by which grains grow before their speeds are set back: collisions heat them.
const STRETCH: f64 = 0.02;
/// Collisions per particle in one stretch by which grains are known to be in each other's way.
const JAMMED: u64 = 4000;
/// Grains grow this much beyond their size, so that rounding leaves none of them in touch.
const SPARE: f64 = 1e-10;

/// Why grains have not come to their size.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GrowthError {
    /// They are in each other's way.
    #[error(
        "initial.positions: the grains jam at a diameter of {reached} while they grow to {wanted}; take fewer grains, a \
         larger domain.size, or positions = \"lattice\""
    )]
    Jammed {
        /// The diameter reached [length]; that of the first species where there are several.
        reached: f64,
        /// The diameter asked for [length].
        wanted: f64,
    },
    /// The engine says why.
    #[error("initial.positions: the grains cannot grow: {0}")]
    Engine(#[from] EngineError),
}

/// Lets the grains of `gas` grow, as an elastic gas without gravity in the box of `size` between `boundary`, until
/// they have `target_diameter` [length].
///
/// `gas.grain.diameter` is the diameter at the start, at which nothing overlaps, and ends as the target; the
/// diameters of all species are scaled along with it. Centres keep a radius away from walls while it grows.
/// Positions are then those of a state without overlap; velocities and the clock are of no further meaning.
pub fn grow<V: Vector>(
    gas: &mut Gas<V>,
    size: V,
    boundary: &Boundary<V>,
    target_diameter: f64,
    seed: u64,
) -> Result<(), GrowthError> {
    let full = target_diameter / gas.grain.diameter * (1.0 + SPARE);
    let enlarged = |grain: Grain| Grain { diameter: grain.diameter * full, ..grain };
    let (grain, species): (Grain, Vec<Grain>) =
        (enlarged(gas.grain), gas.species.iter().map(|&grain| enlarged(grain)).collect());
    let mut laws = Laws {
        grain,
        species,
        restitution: RestitutionLaw::Constant(Constant(1.0)),
        roughness: None,
        gravity: V::ZERO,
        size,
        boundary: *boundary,
        cure: Cure::default(),
        growth: Growth { start: 1.0 / full, rate: 0.0 },
        streams: Streams::new(seed),
        seed,
    };
    let shrunk = |grain: Grain| Grain { diameter: grain.diameter / (1.0 + SPARE), ..grain };
    while laws.growth.start < 1.0 && !gas.is_empty() {
        stretch(gas, &mut laws)?;
    }
    gas.grain = Grain { diameter: target_diameter, ..shrunk(laws.grain) };
    gas.species = laws.species.iter().map(|&grain| shrunk(grain)).collect();
    Ok(())
}

/// Lets all grains grow by one stretch, or to their full size.
fn stretch<V: Vector>(gas: &mut Gas<V>, laws: &mut Laws<V>) -> Result<(), GrowthError> {
    let diameter = laws.grain.diameter;
    // One diameter per time and axis: what heat the last stretch has brought is taken out again.
    let squares: f64 = gas.velocities().iter().map(|velocity| velocity.length_squared()).sum();
    let speed = (squares / (gas.len() * V::DIMENSION) as f64).sqrt();
    if speed > 0.0 {
        gas.velocities_mut().iter_mut().for_each(|velocity| *velocity = *velocity * (diameter / speed));
    }
    gas.clock = Default::default();
    // The diameter grows by twice what the radius does.
    laws.growth.rate = 2.0 * GROWTH_SPEED;
    let end = (laws.growth.start + STRETCH).min(1.0);
    let duration = (end - laws.growth.start) / laws.growth.rate;
    let mut engine = EventDriven::new(laws.clone(), Structure::Automatic);
    let (most, mut collisions) = (JAMMED * gas.len() as u64 / 2, 0);
    while gas.time() < duration {
        let horizon = Horizon { time: duration, collisions: u64::MAX };
        collisions += engine.step(gas, horizon, &mut NoLaps)?.counts.collisions;
        if collisions > most {
            let share = laws.growth.start + laws.growth.rate * gas.time();
            let [reached, wanted] = [diameter * share, diameter].map(|d| d / (1.0 + SPARE));
            return Err(GrowthError::Jammed { reached, wanted });
        }
    }
    laws.growth.start = end;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::grid::Grid;
    use crate::matter::overlaps::overlaps;
    use crate::random::Phase;
    use glam::{DVec2, DVec3};

    /// Points on a square lattice that grow to `volume_fraction`.
    fn dense<V: Vector>(per_axis: u32, volume_fraction: f64) -> (Gas<V>, Result<(), GrowthError>) {
        let number = per_axis.pow(V::DIMENSION as u32);
        let side =
            libm::pow(f64::from(number) * V::sphere_volume(1.0) / volume_fraction, 1.0 / V::DIMENSION as f64);
        let place = |k: u32| {
            V::from_fn(|axis| {
                (f64::from(k / per_axis.pow(axis as u32) % per_axis) + 0.5) * side / f64::from(per_axis)
            })
        };
        let streams = Streams::new(4).at(0, Phase::InitialVelocities);
        let velocity = |k: u32| {
            let mut random = streams.stream(u64::from(k));
            V::from_fn(|_| random.gaussian())
        };
        let grid = Grid::new(V::ZERO, V::from_fn(|_| side), &[4; 3], &[true; 3]);
        let grain = Grain { diameter: 0.5, mass: 1.0 };
        let mut gas =
            Gas::new(grid, grain, (0..number).map(place).collect(), (0..number).map(velocity).collect());
        let grown = grow(&mut gas, V::from_fn(|_| side), &Boundary::periodic(), 1.0, 3);
        (gas, grown)
    }

    #[test]
    fn dense_states_do_not_overlap() {
        let (flat, grown) = dense::<DVec2>(30, 0.8);
        assert_eq!((grown, flat.grain.diameter), (Ok(()), 1.0));
        assert_eq!(overlaps(&flat, [[false; 2]; 3]), 0);
        let (deep, grown) = dense::<DVec3>(10, 0.6);
        assert_eq!((grown, deep.grain.diameter), (Ok(()), 1.0));
        assert_eq!(overlaps(&deep, [[false; 2]; 3]), 0);
    }
}
