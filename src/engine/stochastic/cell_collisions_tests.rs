use super::*;
use crate::engine::stochastic::trial::{GRAIN, gas};
use crate::random::Streams;
use glam::DVec2;

const RULES: CellCollisionRules =
    CellCollisionRules { capacity: 4, restitution: 0.5, sweeps: 3, mass: GRAIN.mass };
const CELLS: [u32; 2] = [8, 6];
const PERIODIC: [bool; 2] = [true, false];

/// Some cells are full, some empty, most neither.
fn crowd(thermal: f64, seed: u64) -> Gas<DVec2> {
    let mut random = Streams::new(seed).at(1, Phase::InitialPositions).stream(0);
    let grains: Vec<u32> = (0..CELLS[0] * CELLS[1]).map(|_| (5.0 * random.uniform()) as u32).collect();
    gas(CELLS, PERIODIC, &grains, thermal, seed)
}

/// What the collisions of one sweep would do.
fn outcomes(gas: &Gas<DVec2>, parity: u32) -> Vec<Outcome<DVec2>> {
    let mut collisions = CellCollisions::default();
    collisions.find_active(gas, RULES.capacity);
    collisions.measure(gas);
    collisions.choose(gas, parity);
    let mut counts = Counts::default();
    let random = Streams::new(2).at(0, Phase::CellCollisions);
    let outcomes = collisions.collide(RULES, gas, parity, random, &mut counts);
    assert_eq!(outcomes.len() as u64, 2 * counts.cell_collisions);
    outcomes
}

/// The pairs (black, white) that collide, found by asking every cell about every cell beside it.
fn pairs_by_search(gas: &Gas<DVec2>, parity: u32) -> (Vec<(u32, u32)>, usize) {
    let grid = gas.grid();
    let grains = |cell: u32| gas.occupancy(cell);
    let mean = |cell: u32| gas.velocities()[gas.rows(cell)].iter().sum::<DVec2>() / f64::from(grains(cell));
    let is_white = |cell: u32| grid.coordinates(cell).iter().sum::<u32>() % 2 == parity;
    let cells = 0..grid.number_of_cells() as u32;
    let mut suits: Vec<(u32, u32, f64)> = Vec::new();
    for white in cells.clone().filter(|&cell| is_white(cell) && grains(cell) > 0) {
        let beside = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].into_iter().filter_map(|way| {
            let (axis, upwards) = (usize::from(way.x == 0.0), way.x + way.y > 0.0);
            let black = grid.neighbour(grid.coordinates(white), axis, upwards)?;
            let collide = grains(black) > 0 && grains(white).max(grains(black)) >= RULES.capacity;
            let approach = if collide { (mean(white) - mean(black)).dot(way) } else { 0.0 };
            (approach > 0.0).then_some((white, black, approach))
        });
        suits.extend(beside.max_by(|a, b| a.2.total_cmp(&b.2)));
    }
    let mut pairs = Vec::new();
    for black in cells {
        let of_it = suits.iter().filter(|suit| suit.1 == black);
        pairs.extend(of_it.max_by(|a, b| a.2.total_cmp(&b.2)).map(|&(white, black, _)| (black, white)));
    }
    let refused = suits.len() - pairs.len();
    (pairs, refused)
}

#[test]
fn a_cell_collides_once_in_a_sweep_and_with_the_fastest() {
    let (mut found, mut refused) = (0, 0);
    for (seed, parity) in (0..60).flat_map(|seed| [(seed, 0), (seed, 1)]) {
        let gas = crowd(1.0, seed);
        let outcomes = outcomes(&gas, parity);
        let (pairs, without) = pairs_by_search(&gas, parity);
        let mut cells: Vec<u32> = pairs.iter().flat_map(|&(black, white)| [black, white]).collect();
        cells.sort_unstable();
        assert_eq!(outcomes.iter().map(|outcome| outcome.cell).collect::<Vec<_>>(), cells);
        assert!(cells.windows(2).all(|pair| pair[0] < pair[1]));
        for &(black, white) in &pairs {
            let momentum = [black, white].map(|cell| {
                let outcome = outcomes.iter().find(|outcome| outcome.cell == cell).unwrap();
                outcome.kick * f64::from(gas.occupancy(cell))
            });
            assert!(momentum[0].length() > 0.0 && (momentum[0] + momentum[1]).length() < 1e-12);
        }
        (found, refused) = (found + pairs.len(), refused + without);
    }
    assert!(found > 300 && refused > 30, "{found} pairs, {refused} refused");
}

#[test]
fn of_two_that_are_as_fast_the_lower_cell_is_chosen() {
    // Full cells around the one in the middle, cell 5 of four by four.
    let mut grains = [0; 16];
    [1, 4, 5, 6, 9].into_iter().for_each(|cell| grains[cell] = 4);
    let mut gas = gas([4, 4], [false, false], &grains, 0.0, 1);
    let mut set = |cell: u32, velocity: DVec2| {
        let rows = gas.rows(cell);
        gas.velocities_mut()[rows].fill(velocity);
    };
    [1, 4, 6, 9].into_iter().for_each(|cell| set(cell, DVec2::ZERO));
    // It approaches those to the right of it and above it alike; as white it chooses, as black it is chosen.
    set(5, DVec2::ONE);
    let cells = |gas: &Gas<DVec2>, parity: u32| -> Vec<u32> {
        outcomes(gas, parity).iter().map(|outcome| outcome.cell).collect()
    };
    assert_eq!((cells(&gas, 0), cells(&gas, 1)), (vec![5, 6], vec![5, 6]));
}

#[test]
fn momentum_and_energy_stay_with_and_without_thermal_motion() {
    for (seed, thermal) in (0..30).flat_map(|seed| [(seed, 0.0), (seed, 1e-4), (seed, 1.0)]) {
        let mut gas = crowd(thermal, seed);
        let sums = |gas: &Gas<DVec2>| {
            let squares = gas.velocities().iter().map(|v| v.length_squared()).sum::<f64>();
            (gas.velocities().iter().sum::<DVec2>(), squares)
        };
        let (velocities, (momentum, energy)) = (gas.velocities().to_vec(), sums(&gas));
        let mut counts = Counts::default();
        CellCollisions::default().sweep(RULES, &mut gas, Streams::new(seed), 7, &mut counts);
        assert!(counts.cell_collisions > 3 && gas.velocities() != velocities);
        let (momentum_after, energy_after) = sums(&gas);
        assert!((momentum_after - momentum).length() < 1e-12 * velocities.len() as f64);
        assert!((energy_after / energy - 1.0).abs() < 1e-12, "thermal motion {thermal}");
    }
}

/// Single grains that make their cells full have no inner motion that could take what is lost.
#[test]
fn two_single_grains_lose_the_heat_of_their_collision() {
    let mut gas = gas([2, 1], [false, false], &[1, 1], 0.0, 1);
    gas.velocities_mut().copy_from_slice(&[DVec2::X, DVec2::NEG_X]);
    let rules = CellCollisionRules { capacity: 1, restitution: 0.0, sweeps: 2, ..RULES };
    CellCollisions::default().sweep(rules, &mut gas, Streams::new(3), 0, &mut Counts::default());
    let speeds: Vec<f64> = gas.velocities().iter().map(|v| v.length()).collect();
    assert!(speeds[0] < 0.999 && (speeds[0] - speeds[1]).abs() < 1e-15, "{speeds:?}");
}

fn field(grains: u32, thermal: f64) -> CellField<DVec2> {
    CellField { grains, velocity: DVec2::ZERO, thermal }
}

#[test]
fn heat_comes_back_by_one_factor_for_both_cells() {
    let heats = heats(&field(4, 3.0), &field(2, 1.0), 5.0);
    // (3 + 1) k² = 3 + 1 + 5.
    assert!(matches!(heats, (Heat::Scale(1.5), Heat::Scale(1.5))), "{heats:?}");
}

#[test]
fn cells_without_thermal_motion_share_heat_by_inner_degrees_of_freedom() {
    let of = |a: (u32, f64), b: (u32, f64), lost: f64| heats(&field(a.0, a.1), &field(b.0, b.1), lost);
    assert!(matches!(of((4, 0.0), (2, 0.0), 8.0), (Heat::Renew(6.0), Heat::Renew(2.0))));
    assert!(matches!(of((4, 0.0), (1, 0.0), 8.0), (Heat::Renew(8.0), Heat::Scale(1.0))));
    assert!(matches!(of((1, 0.0), (1, 0.0), 8.0), (Heat::Scale(1.0), Heat::Scale(1.0))));
    assert!(matches!(of((4, 0.0), (4, 0.0), 0.0), (Heat::Scale(1.0), Heat::Scale(1.0))));
    // What little thermal motion there is comes back with the heat.
    let limit = WEAKEST_THERMAL_SHARE * 8.0;
    assert!(matches!(of((4, limit), (2, 0.0), 8.0), (Heat::Scale(_), Heat::Scale(_))));
    let (Heat::Renew(a), Heat::Renew(b)) = of((4, 0.5 * limit), (2, 0.0), 8.0) else {
        panic!("too little thermal motion is scaled")
    };
    assert!((a + b - 8.0 - 0.5 * limit).abs() < 1e-14 && (a / b - 3.0).abs() < 1e-14);
}

#[test]
fn thermal_motion_that_begins_anew_has_no_mean_and_the_energy_it_was_given() {
    let mut random = Streams::new(1).at(0, Phase::CellCollisions).stream(0);
    for grains in [2, 3, 9] {
        let noise: Vec<DVec2> = zero_mean_noise(grains, 0.3, &mut random);
        assert!(noise.iter().sum::<DVec2>().length() < 1e-15);
        assert!((noise.iter().map(|v| v.length_squared()).sum::<f64>() - 0.3).abs() < 1e-15);
    }
}
