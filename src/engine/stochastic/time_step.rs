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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::stochastic::trial::{DENSE, gas, laws};
    use crate::law::boundary::{AxisBoundary, Face, Wall, WallKind};
    use glam::DVec2;
    use std::f64::consts::PI;

    /// Forty grains in cells of side 2.
    fn forty() -> Gas<DVec2> {
        gas([4, 4], [true, true], &[3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2], 1.0, 1)
    }

    fn state(largest_speed: f64, collision_rate: f64) -> EngineState {
        EngineState { largest_speed, collision_rate, ..EngineState::default() }
    }

    fn step(choice: TimeStep, jumps_matter: bool, state: &EngineState) -> Result<(f64, bool), EngineError> {
        time_step(choice, &laws(None), jumps_matter, &forty(), state)
    }

    #[test]
    fn a_step_has_the_collisions_that_are_asked_for_where_no_cap_is_shorter() {
        let share = TimeStep::CollisionsPerParticle(0.1);
        // 0.1 · 40/2 pairs at 100 pairs per time.
        assert_eq!(step(share, true, &state(4.0, 100.0)), Ok((0.02, false)));
        // Half of a cell at the largest speed is the most.
        assert_eq!(step(share, true, &state(4.0, 1.0)), Ok((0.25, true)));
        assert_eq!(step(share, false, &state(4.0, 1.0)), Ok((2.0, false)));
        assert_eq!(step(share, false, &state(4.0, 0.0)), Ok((0.25, false)));
        assert_eq!(step(TimeStep::Crossing(0.25), true, &state(4.0, 100.0)), Ok((0.125, false)));
    }

    #[test]
    fn a_fall_and_a_fast_wall_shorten_a_step() {
        let share = TimeStep::CollisionsPerParticle(0.1);
        let slow = state(1.0, 1.0);
        let mut falling = laws(None);
        falling.gravity = DVec2::new(0.0, -100.0);
        // Half of √(2 · 2/100).
        let (duration, capped) = time_step(share, &falling, true, &forty(), &slow).unwrap();
        assert!((duration - 0.1).abs() < 1e-15 && capped);
        let wall = Wall { restitution: 1.0, kind: WallKind::Rough { velocity: DVec2::new(8.0, 0.0) } };
        let mut sheared = laws(None);
        sheared.boundary.axes[1] = AxisBoundary::Faces { lower: Face::Wall(wall), upper: Face::Open };
        assert_eq!(time_step(share, &sheared, true, &forty(), &slow), Ok((0.125, true)));
    }

    #[test]
    fn a_fixed_step_is_obeyed_or_refused() {
        let moving = state(4.0, 100.0);
        assert_eq!(step(TimeStep::Fixed(0.5), true, &moving), Ok((0.5, false)));
        assert!(matches!(
            step(TimeStep::Fixed(0.6), true, &moving),
            Err(EngineError::StepTooLong { step: 0.6, longest: 0.5, speed: 4.0, .. })
        ));
        // Without walls and cells to be jumped over, two collisions per grain are the most: 0.4 · 100 pairs.
        assert_eq!(step(TimeStep::Fixed(0.4), false, &moving), Ok((0.4, false)));
        assert!(matches!(
            step(TimeStep::Fixed(1.0), false, &moving),
            Err(EngineError::TooManyCollisions { step: 1.0, longest: 0.4, collisions: 5.0, .. })
        ));
    }

    #[test]
    fn there_is_no_step_where_nothing_moves() {
        let still = state(0.0, 0.0);
        for choice in [TimeStep::CollisionsPerParticle(0.1), TimeStep::Crossing(0.2)] {
            assert!(matches!(step(choice, true, &still), Err(EngineError::NothingMoves { .. })));
        }
    }

    #[test]
    fn a_thin_gas_expects_the_collisions_of_a_maxwell_gas_in_the_whole_box() {
        let mut grains = [0; 16];
        grains[0] = 4;
        grains[9] = 3;
        let thin = gas([4, 4], [true, true], &grains, 1.0, 1);
        let mut tally = Tally { collision_rate: 17.0, ..Tally::default() };
        thin.velocities().iter().for_each(|&velocity| tally.speeds.note(velocity));
        let mean = thin.velocities().iter().sum::<DVec2>() / 7.0;
        // T/m about the mean, n = 7/64, σ = 2d, ⟨|v_rel|⟩ = √(πT/m) in a plane, seven grains, two in each collision.
        let square = thin.velocities().iter().map(|&v| (v - mean).length_squared()).sum::<f64>() / 14.0;
        let expected = 3.5 * 7.0 / 64.0 * 2.0 * (PI * square).sqrt();
        let fastest = thin.velocities().iter().map(|v| v.length()).fold(0.0, f64::max);
        let (speed, rate) = pace(&laws(None), &thin, &tally);
        assert!(
            (speed - fastest).abs() < 1e-14 && (rate / expected - 1.0).abs() < 1e-12,
            "{rate} {expected}"
        );
        let (_, dense) = pace(&laws(Some(DENSE)), &thin, &tally);
        let fraction = 7.0 * PI / 4.0 / 64.0;
        assert!((dense / expected / DVec2::contact_correlation(fraction) - 1.0).abs() < 1e-12);
        // Where cells hold enough grains, their own temperatures have told.
        assert_eq!(pace(&laws(None), &forty(), &tally).1, 17.0);
    }
}
