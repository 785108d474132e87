//! How long a step is.

use super::Step;
use super::cell_pairs::PairCollisions;
use super::laws::Laws;
use super::rules::TimeStep;
use super::tally::Tally;
use crate::engine::{EngineError, EngineState};
use crate::law::kinetic_theory;
use crate::law::restitution::Restitution;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// Below this mean occupancy, cells hold too few pairs to tell their temperature.
const FEWEST_GRAINS_PER_CELL: f64 = 0.5;

/// The length of the next step, and whether a cap shortened it.
pub(crate) fn time_step<V: Vector, R: Restitution>(
    choice: TimeStep,
    laws: &Laws<V, R>,
    jumps_matter: bool,
    gas: &Gas<V>,
    state: &EngineState,
) -> Result<(f64, bool), EngineError> {
    let speed = state.largest_speed.max(laws.boundary.largest_wall_speed());
    let side = gas.grid().shortest_side();
    let allowed = choice.largest_crossing();
    let longest = if jumps_matter { longest_step(laws, allowed, side, speed) } else { f64::INFINITY };
    let collisions = |step: f64| 2.0 * step * state.collision_rate.max(0.0) / gas.len().max(1) as f64;
    let wish = match choice {
        TimeStep::Fixed(step) if step > longest => {
            return Err(EngineError::StepTooLong { step, longest, speed, time: gas.time() });
        }
        // Where the crossing of a cell is no bound, the number of collisions is.
        TimeStep::Fixed(step) if !jumps_matter && collisions(step) > TimeStep::MOST_COLLISIONS => {
            let (collisions, most) = (collisions(step), TimeStep::MOST_COLLISIONS);
            let longest = step * most / collisions;
            return Err(EngineError::TooManyCollisions { step, longest, collisions, most, time: gas.time() });
        }
        TimeStep::Fixed(step) => step,
        TimeStep::CollisionsPerParticle(share) => {
            let pairs = 0.5 * share * gas.len() as f64;
            if state.collision_rate > 0.0 { pairs / state.collision_rate } else { f64::INFINITY }
        }
        TimeStep::Crossing(share) => share * side / speed,
    };
    let step = wish.min(longest);
    if step.is_finite() && step > 0.0 {
        return Ok((step, step < wish));
    }
    // No collisions to be expected and no cap: let grains cross their cells.
    let crossing = allowed * side / speed;
    if crossing.is_finite() {
        Ok((crossing, false))
    } else {
        Err(EngineError::NothingMoves { time: gas.time() })
    }
}

/// The `share` of min(L/v_max, √(2L/|g|)).
fn longest_step<V: Vector, R: Restitution>(laws: &Laws<V, R>, share: f64, side: f64, speed: f64) -> f64 {
    let gravity = laws.gravity.length();
    let falling = if gravity > 0.0 { (2.0 * side / gravity).sqrt() } else { f64::INFINITY };
    share * (side / speed).min(falling)
}

/// What the step after next needs to know, from what this one added up.
pub(crate) fn pace<V: Vector, R: Restitution>(
    laws: &Laws<V, R>,
    gas: &Gas<V>,
    tally: &Tally<V>,
) -> (f64, f64) {
    let speed = tally.speeds.largest_square.sqrt();
    let grains = gas.len() as f64;
    if grains >= FEWEST_GRAINS_PER_CELL * gas.grid().number_of_cells() as f64 {
        return (speed, tally.collision_rate);
    }
    (speed, global_collision_rate(laws, gas, tally))
}

/// Collisions per time of a Maxwell gas with the temperature and density of the whole box.
fn global_collision_rate<V: Vector, R: Restitution>(
    laws: &Laws<V, R>,
    gas: &Gas<V>,
    tally: &Tally<V>,
) -> f64 {
    let grains = gas.len() as f64;
    let mean = tally.speeds.sum_of_velocities * (1.0 / grains);
    let variance = tally.speeds.sum_of_squares / grains - mean.length_squared();
    let temperature = laws.grain.mass * variance.max(0.0) / V::DIMENSION as f64;
    let fraction = grains * laws.grain.volume::<V>() / gas.grid().size().product();
    let factor =
        laws.dense.map_or(1.0, |dense| V::contact_correlation(fraction.min(dense.largest_volume_fraction)));
    0.5 * grains * kinetic_theory::collision_frequency::<V>(laws.grain, fraction, temperature, factor)
}

/// Adds up what [`pace`] needs from a gas that no step has looked at yet.
pub(crate) fn measure<V: Vector, R: Restitution>(laws: &Laws<V, R>, gas: &Gas<V>) -> Tally<V> {
    let step = Step { number: 0, start: 0.0, duration: 0.0 };
    let collisions = PairCollisions::new(laws, gas.grid(), gas.offsets(), step);
    let mut tally = Tally::default();
    for cell in 0..gas.grid().number_of_cells() as u32 {
        let velocities = &gas.velocities()[gas.rows(cell)];
        tally.collision_rate += collisions.rate(cell, velocities);
        velocities.iter().for_each(|&velocity| tally.speeds.note(velocity));
    }
    tally
}
