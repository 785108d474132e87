//! One grain on a vibrating floor against the exact map from bounce to bounce.

use super::bounce::{Bounce, Floor};
use super::drive::{Drive, STRUCTURES, faces, laws, wall};
use glam::DVec2;
use grainflow::engine::Horizon;
use grainflow::law::boundary::WallKind;
use std::f64::consts::PI;

/// A grain that leaves `floor` in a box of height 40 as `bounce` says.
fn grain(floor: &Floor, structure: usize, bounce: Bounce) -> Drive<DVec2> {
    let mut laws = laws(DVec2::new(10.0, 40.0));
    laws.grain.diameter = 0.01;
    let frequency = floor.angular_frequency / (2.0 * PI);
    let vibrating = WallKind::Vibrating { amplitude: floor.amplitude, frequency };
    laws.boundary.axes[1] = faces(wall(floor.restitution, vibrating), wall(1.0, WallKind::Smooth));
    laws.gravity = DVec2::Y * -floor.gravity;
    // At time 0 on the parabola that leaves the floor at the time of the bounce.
    let t = -bounce.time;
    let height = floor.height(bounce.time) + bounce.velocity * t - 0.5 * floor.gravity * t * t;
    let start = DVec2::new(5.0, 0.005 + height);
    let velocity = DVec2::Y * (bounce.velocity - floor.gravity * t);
    Drive::new(&laws, STRUCTURES[structure], &[(start, velocity)])
}

/// The next bounce of the engine, by steps of `step` and by going back along the parabola.
fn next_bounce(grain: &mut Drive<DVec2>, floor: &Floor, step: f64) -> Bounce {
    let hits = grain.events.wall_hits;
    let (mut time, mut before) = (grain.gas.time(), grain.velocity(0).y);
    while grain.events.wall_hits == hits {
        (time, before) = (grain.gas.time(), grain.velocity(0).y);
        grain.step(Horizon { time: time + step, collisions: u64::MAX }).unwrap();
    }
    assert_eq!(grain.events.wall_hits, hits + 1, "two bounces in a step");
    // v′ − v + g (t − t₀) is the jump, which r and the velocity u(t_b) of the floor make of the fall v_b.
    // v_b = v − g (t_b − t₀) and v′_b = v′ + g (t − t_b): v′_b + r v_b = (1 + r) u(t_b) has t_b as its root.
    let (end, after) = (grain.gas.time(), grain.velocity(0).y);
    let lack = |t: f64| {
        let fall = before - floor.gravity * (t - time);
        let rise = after + floor.gravity * (end - t);
        rise + floor.restitution * fall - (1.0 + floor.restitution) * floor.velocity(t)
    };
    let (mut low, mut high) = (time, end);
    assert!(lack(low) * lack(high) <= 0.0, "the law of the bounce does not hold");
    let sign = lack(low).signum();
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if lack(middle) * sign > 0.0 { low = middle } else { high = middle }
    }
    Bounce { time: high, velocity: after + floor.gravity * (end - high) }
}

/// Aω²/g = 2, r = 0.6: chaotic, so that errors grow from bounce to bounce.
#[test]
fn ten_chaotic_bounces() {
    let floor = Floor { amplitude: 0.00497, angular_frequency: 20.0 * PI, gravity: 9.81, restitution: 0.6 };
    for structure in [0, 1] {
        let mut bounce = Bounce { time: 0.0, velocity: 1.0 };
        let mut engine = grain(&floor, structure, bounce);
        let mut disturbed = Bounce { velocity: bounce.velocity + 1e-9, ..bounce };
        let mut worst = 0.0_f64;
        for k in 0..10 {
            (bounce, disturbed) = (floor.next(bounce), floor.next(disturbed));
            let found = next_bounce(&mut engine, &floor, 1e-3);
            let error = (found.time - bounce.time).abs().max((found.velocity - bounce.velocity).abs());
            assert!(error < 1e-9, "{k} {found:?} {bounce:?}");
            worst = worst.max(error);
        }
        let growth = (disturbed.velocity - bounce.velocity).abs() / 1e-9;
        println!("ten bounces: worst error {worst:.1e}; disturbances grow {growth:.1}-fold");
        assert!(growth > 1e3, "not chaotic: {growth}");
    }
}

#[test]
fn ten_thousand_bounces_of_period_one() {
    let floor = Floor { amplitude: 0.003, angular_frequency: 20.0 * PI, gravity: 9.81, restitution: 0.5 };
    let orbit = floor.orbit(1).unwrap();
    for structure in [0, 1] {
        let mut engine = grain(&floor, structure, orbit);
        // The first bounce after time 0 is that of the orbit itself or of its next turn.
        let period = floor.period();
        let mut worst = [0.0_f64; 2];
        engine.to(orbit.time - 0.5 * period + period);
        let begun = engine.events.wall_hits;
        for k in 1..=10_000_u32 {
            // Half way between two bounces the grain is at rest, at the height of its turn.
            let time = orbit.time + (f64::from(k) + 0.5) * period;
            engine.to(time);
            assert_eq!(engine.events.wall_hits - begun, u64::from(k));
            let top = floor.height(orbit.time) + 0.5 * orbit.velocity.powi(2) / floor.gravity;
            let errors = [
                (engine.position(0).y - 0.005 - top).abs(),
                (engine.velocity(0).y + floor.gravity * (engine.gas.time() - time)).abs(),
            ];
            worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
            if [10, 100, 1000, 10_000].contains(&k) {
                println!(
                    "period one, {k} bounces: off by {:.1e} (height), {:.1e} (velocity)",
                    worst[0], worst[1]
                );
            }
        }
        // The clock's own resolution at t = 1000 is 10⁻¹³; g times that is a velocity of 10⁻¹².
        assert!(worst[0] < 1e-12 && worst[1] < 1e-11, "{worst:?}");
    }
}
