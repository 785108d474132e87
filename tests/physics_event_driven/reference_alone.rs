//! The reference simulator against what is known by hand: it has to be right before it judges.

use super::bounce::{Bounce, Floor};
use super::reference::{PairHit, Reference, SmoothWall};
use std::f64::consts::PI;

/// Whether the collisions are those of `expected`, to 10⁻¹².
fn assert_hits(hits: &[PairHit], expected: &[(f64, usize, usize)]) {
    assert_eq!(hits.len(), expected.len(), "{hits:?}");
    for (hit, &(time, i, j)) in hits.iter().zip(expected) {
        assert_eq!(hit.grains, [i, j], "{hits:?}");
        assert!((hit.time - time).abs() < 1e-12, "{hit:?} {time}");
    }
}

/// Numbers in [−1, 1) without a pattern (the fractional parts of multiples of irrational numbers, mixed).
fn scatter(k: usize) -> f64 {
    let x = ((k as f64 + 1.0) * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// A gas of grains of diameter 1 on a lattice of spacing 1.6, with scattered velocities.
fn gas<const D: usize>(per_side: usize, restitution: f64) -> Reference<D> {
    let mut gas = Reference::periodic([1.6 * per_side as f64; D], 1.0, restitution);
    for k in 0..per_side.pow(D as u32) {
        gas.positions.push(std::array::from_fn(|axis| {
            1.6 * ((k / per_side.pow(axis as u32) % per_side) as f64 + 0.5)
                + 0.2 * scatter(D * k + axis + 5000)
        }));
        gas.velocities.push(std::array::from_fn(|axis| scatter(D * k + axis)));
    }
    gas
}

#[test]
fn an_elastic_pair_swaps_around_the_ring_for_ever() {
    let mut ring = Reference::periodic([10.0, 7.0], 1.0, 1.0);
    ring.positions = vec![[2.0, 3.0], [5.0, 3.0]];
    ring.velocities = vec![[1.0, 0.0], [0.0, 0.0]];
    ring.run_to(20.5);
    // 2 to the first contact at t = 2; then the other goes 8 around the ring: t = 10, and 8 more each.
    assert_hits(&ring.pair_hits, &[(2.0, 0, 1), (10.0, 0, 1), (18.0, 0, 1)]);
    // Grain 1, at 3 when it is hit the last time, has moved on for 2.5.
    assert!((ring.positions[1][0] - 5.5).abs() < 1e-12 && (ring.positions[0][0] - 2.0).abs() < 1e-12);
    assert_eq!(ring.time, 20.5);
}

#[test]
fn three_in_a_row_lose_speed_as_they_should() {
    // r = 1/2: 0 hits 1 at t = 1 (v: 1/4, 3/4); 1 hits 2 at 1 + 2/(3/4) (v: 3/16, 9/16).
    let mut row = Reference::periodic([100.0, 50.0, 50.0], 1.0, 0.5);
    row.positions = vec![[10.0, 20.0, 20.0], [12.0, 20.0, 20.0], [15.0, 20.0, 20.0]];
    row.velocities = vec![[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
    row.run_collisions(3);
    let second = 1.0 + 8.0 / 3.0;
    // The first is then at 11 + 2/3, the second at 14: a gap of 4/3 at a speed of 1/16.
    assert_hits(&row.pair_hits, &[(1.0, 0, 1), (second, 1, 2), (second + 64.0 / 3.0, 0, 1)]);
    for (k, v) in [13.0 / 64.0, 15.0 / 64.0, 36.0 / 64.0].into_iter().enumerate() {
        assert!((row.velocities[k][0] - v).abs() < 1e-12, "{:?}", row.velocities);
    }
}

#[test]
fn unequal_grains_meet_aslant() {
    // Radii 1 and 0.5, masses 3 and 1; the offset 0.9 is 3/5 of 1.5: contact at 4/5 of it along x, k = (0.8, 0.6).
    let mut pair = Reference::periodic([30.0, 30.0], 1.0, 1.0);
    pair.diameters = vec![2.0, 1.0];
    pair.masses = vec![3.0, 1.0];
    pair.positions = vec![[10.0, 10.0], [15.0, 10.9]];
    pair.velocities = vec![[1.0, 0.0], [0.0, 0.0]];
    pair.run_collisions(1);
    assert_hits(&pair.pair_hits, &[(5.0 - 1.2, 0, 1)]);
    // v_n = 0.8 k; grain 1 loses 2 · 1/4 of it, grain 2 gets 2 · 3/4.
    let expected = [[1.0 - 0.32, -0.24], [0.96, 0.72]];
    for (v, expected) in pair.velocities.iter().zip(expected) {
        assert!((0..2).all(|axis| (v[axis] - expected[axis]).abs() < 1e-12));
    }
}

#[test]
fn a_grain_meets_an_image_boxes_away() {
    // The image at (34, 13) is the first on the way: (4, 3), the nearest to it, is passed at 50/√1325.
    let mut pair = Reference::periodic([10.0, 10.0], 1.0, 1.0);
    pair.positions = vec![[5.0, 5.0], [1.0, 2.0]];
    let length = 1325.0_f64.sqrt();
    pair.velocities = vec![[0.0, 0.0], [34.0 / length, 13.0 / length]];
    pair.run_collisions(1);
    assert_hits(&pair.pair_hits, &[(length - 1.0, 0, 1)]);
}

#[test]
fn an_elastic_gas_runs_back_to_where_it_came_from() {
    let mut gas = gas::<2>(4, 1.0);
    let (start, energy) = (gas.positions.clone(), gas.energy());
    gas.run_collisions(60);
    assert!((gas.energy() / energy - 1.0).abs() < 1e-12);
    assert!(gas.smallest_gap() > -1e-12);
    let turned = gas.time;
    gas.velocities.iter_mut().flatten().for_each(|component| *component *= -1.0);
    gas.run_to(2.0 * turned);
    assert!(gas.pair_hits.len() >= 119, "{}", gas.pair_hits.len());
    for (x, was) in gas.positions.iter().zip(&start) {
        assert!((0..2).all(|axis| (x[axis] - was[axis]).abs() < 1e-4), "{x:?} {was:?}");
    }
}

#[test]
fn a_gas_never_overlaps_and_keeps_its_momentum() {
    let mut gas = gas::<3>(3, 0.9);
    let before = [0, 1, 2].map(|axis| gas.momentum(axis));
    let mut energy = gas.energy();
    for count in 1..=300 {
        gas.run_collisions(count);
        assert!(gas.smallest_gap() > -1e-12 && gas.energy() < energy, "{count}");
        energy = gas.energy();
    }
    assert!((0..3).all(|axis| (gas.momentum(axis) - before[axis]).abs() < 1e-12));
}

fn floor(restitution: f64, amplitude: f64, angular_frequency: f64) -> SmoothWall {
    SmoothWall { axis: 1, upper: false, restitution, amplitude, angular_frequency, holds_surfaces: true }
}

/// A ball of diameter 1 over the floor, with its lowest point at `height`.
fn ball(wall: SmoothWall, height: f64, velocity: f64) -> Reference<2> {
    let mut ball = Reference::periodic([10.0, 40.0], 1.0, 1.0);
    ball.walls = vec![wall, SmoothWall { upper: true, amplitude: 0.0, ..wall }];
    ball.gravity = [0.0, -10.0];
    ball.positions = vec![[5.0, 0.5 + height]];
    ball.velocities = vec![[0.3, velocity]];
    ball
}

#[test]
fn a_dropped_ball_bounces_ever_lower() {
    // From 20 at g = 10: 2 s; then 2·20 r/10 s, and r as much each time.
    let mut ball = ball(floor(0.5, 0.0, 0.0), 20.0, 0.0);
    ball.run_to(5.9);
    let times: Vec<f64> = ball.wall_hits.iter().map(|hit| hit.time).collect();
    let mut expected = vec![2.0];
    let mut flight = 2.0;
    while expected[expected.len() - 1] + flight < 5.9 {
        expected.push(expected[expected.len() - 1] + flight);
        flight *= 0.5;
    }
    assert_eq!(times.len(), expected.len());
    assert!(times.iter().zip(&expected).all(|(t, e)| (t - e).abs() < 1e-12), "{times:?}");
    assert!((ball.positions[0][0] - (5.0 + 0.3 * 5.9)).abs() < 1e-12);
}

#[test]
fn an_elastic_ball_meets_the_ceiling_too() {
    // Up at 30 from the floor: 39 − 30t + 5t² = 0 at t = 3 − √1.2; by symmetry it is back after twice that.
    let mut ball = ball(floor(1.0, 0.0, 0.0), 0.0, 30.0);
    let energy = ball.energy();
    ball.run_to(9.0);
    let rise = 3.0 - 1.2_f64.sqrt();
    for (k, hit) in ball.wall_hits.iter().enumerate() {
        assert_eq!(hit.wall, (k + 1) % 2);
        assert!((hit.time - (k + 1) as f64 * rise).abs() < 1e-12, "{hit:?}");
    }
    assert_eq!(ball.wall_hits.len(), 4);
    assert!((ball.energy() / energy - 1.0).abs() < 1e-12);
}

#[test]
fn a_ball_on_a_vibrating_floor_follows_the_map() {
    let map = Floor { amplitude: 0.003, angular_frequency: 20.0 * PI, gravity: 10.0, restitution: 0.5 };
    let orbit = map.orbit(1).unwrap();
    for velocity in [orbit.velocity, 0.9 * orbit.velocity, 1.1 * orbit.velocity] {
        let mut bounce = Bounce { velocity, ..orbit };
        let mut ball = ball(floor(0.5, 0.003, 20.0 * PI), map.height(bounce.time), velocity);
        ball.time = bounce.time;
        ball.run_to(1.5);
        assert!(ball.wall_hits.len() > 10);
        for hit in &ball.wall_hits {
            bounce = map.next(bounce);
            assert!((hit.time - bounce.time).abs() < 1e-10, "{hit:?} {bounce:?}");
        }
    }
}
