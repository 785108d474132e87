//! Hits on walls against solutions by hand.

use super::drive::{Drive, STRUCTURES, close, faces, laws, near, restitution, vector, wall};
use glam::{DVec2, DVec3};
use grainflow::engine::event_driven::laws::Laws;
use grainflow::law::boundary::{Face, WallKind};
use grainflow::matter::grain::Grain;
use grainflow::space::Vector;

/// A box of 40 with walls of restitution `r` across the last axis.
fn walled<V: Vector>(r: f64, kind: WallKind<V>) -> Laws<V> {
    let mut laws = laws(V::from_fn(|_| 40.0));
    laws.boundary.axes[V::DIMENSION - 1] = faces(wall(r, kind), wall(r, kind));
    laws
}

fn up<V: Vector>(length: f64) -> V {
    V::along(V::DIMENSION - 1, length)
}

/// From a height of 20 at g = 10: 2 s; then 20 s · r, and r as much each time. Mass 2: p = 2 · 20 (1 + r) …
fn dropped<V: Vector>() {
    for structure in STRUCTURES {
        let mut laws = walled::<V>(0.5, WallKind::Smooth);
        laws.gravity = up(-10.0);
        laws.grain.mass = 2.0;
        let start = up::<V>(20.5) + V::along(0, 5.0);
        let mut ball = Drive::new(&laws, structure, &[(start, V::along(0, 0.3))]);
        ball.to(2.0 + 2.0 + 1.0 + 0.25);
        // 1/4 s into the third flight, which began at 20/8: 20/8/4 − 5/16 = 5/16.
        near(ball.position(0), V::along(0, 5.0 + 0.3 * 5.25) + up(0.5 + 0.3125));
        near(ball.velocity(0), V::along(0, 0.3) + up(0.0));
        assert_eq!((ball.events.wall_hits, ball.counts.collisions), (3, 0));
        // Downwards: 2 (20 + 10 + 5)(1 + 1/2).
        near(ball.counts.wall_momentum[V::DIMENSION - 1][0], up(-105.0));
        near(ball.counts.wall_momentum[V::DIMENSION - 1][1], V::ZERO);
    }
}

#[test]
fn a_dropped_ball_bounces() {
    dropped::<DVec2>();
    dropped::<DVec3>();
}

/// Up at 30 from the floor: 39 − 30 t + 5 t² = 0 at t = 3 − √1.2; there it has v = 10 √1.2.
#[test]
fn an_elastic_ball_meets_the_ceiling_too() {
    for structure in STRUCTURES {
        let mut laws = walled::<DVec2>(1.0, WallKind::Smooth);
        laws.gravity = up(-10.0);
        let mut ball = Drive::new(&laws, structure, &[(DVec2::new(5.0, 0.5), up(30.0))]);
        let rise = 3.0 - 1.2_f64.sqrt();
        ball.to(3.5 * rise);
        assert_eq!(ball.events.wall_hits, 3);
        near(ball.counts.wall_momentum[1][1], up(2.0 * 2.0 * 10.0 * 1.2_f64.sqrt()));
        near(ball.counts.wall_momentum[1][0], up(-60.0));
        let t = 0.5 * rise;
        // The ceiling's way down: 39 at v = −10 √1.2.
        close(ball.position(0).y, 39.5 - 10.0 * 1.2_f64.sqrt() * t - 5.0 * t * t);
    }
}

/// A wall that moves at (3, 1) turns the tangential velocity round in its own frame; r = 1/2 across.
fn rough<V: Vector>() {
    for structure in STRUCTURES {
        let moving = vector::<V>([3.0, 1.0, 0.0]) - up(vector::<V>([3.0, 1.0, 0.0])[V::DIMENSION - 1]);
        let laws = walled::<V>(0.5, WallKind::Rough { velocity: moving });
        let start = up::<V>(4.5) + V::along(0, 20.0);
        let mut ball = Drive::new(&laws, structure, &[(start, V::along(0, 1.0) + up(-2.0))]);
        ball.to(3.0);
        let after = moving * 2.0 - V::along(0, 1.0) + up(1.0);
        near(ball.velocity(0), after);
        near(ball.position(0), V::along(0, 22.0) + up(0.5) + after);
        let lost = V::along(0, 1.0) + up(-2.0) - after;
        near(ball.counts.wall_momentum[V::DIMENSION - 1][0], lost);
    }
}

#[test]
fn rough_walls_drag() {
    rough::<DVec2>();
    rough::<DVec3>();
}

/// Of n elastic hits on walls of reversal probability p, np reverse; σ = √(np(1 − p)).
#[test]
fn statistical_walls_reverse_their_share() {
    for structure in STRUCTURES {
        for p in [0.0, 0.3, 1.0] {
            let laws = walled::<DVec2>(1.0, WallKind::Statistical { reversal_probability: p });
            let mut ball =
                Drive::new(&laws, structure, &[(DVec2::new(5.0, 0.5 + 19.5), DVec2::new(1.0, 39.0))]);
            let (mut reversed, mut last, hits) = (0, 1.0, 20_000);
            for k in 0..hits {
                // The height of 39 is crossed once per time unit.
                ball.to(f64::from(k) + 1.0);
                let v = ball.velocity(0);
                close(v.x.abs(), 1.0);
                assert!((v.y.abs() - 39.0).abs() < 1e-12);
                reversed += i32::from(v.x * last < 0.0);
                last = v.x;
            }
            assert_eq!(ball.events.wall_hits, hits as u64);
            let expected = p * f64::from(hits);
            let sigma = (expected * (1.0 - p)).sqrt();
            println!("reversed {reversed} of {hits} at p = {p}");
            assert!((f64::from(reversed) - expected).abs() <= 3.0 * sigma, "{reversed} {p}");
        }
    }
}

/// Floor at A sin 2πft, f = 1/8, A = 1: at t = 8 it is at 0 and rises at π/4. A grain timed to meet it there.
fn vibrating<V: Vector>() {
    let speed = std::f64::consts::TAU / 8.0;
    for structure in STRUCTURES {
        let laws = walled::<V>(0.5, WallKind::Vibrating { amplitude: 1.0, frequency: 0.125 });
        let start = |height: f64| up::<V>(height) + V::along(0, 5.0);
        let mut floor = Drive::new(&laws, structure, &[(start(16.5), up(-2.0))]);
        floor.to(8.5);
        // v′ = u − r (v − u).
        let after = speed + 0.5 * (2.0 + speed);
        near(floor.velocity(0), up(after));
        near(floor.position(0), start(0.5 + 0.5 * after));
        near(floor.counts.wall_momentum[V::DIMENSION - 1][0], up(-2.0 - after));
        // The ceiling at 40 + A sin moves away then.
        let mut ceiling = Drive::new(&laws, structure, &[(start(40.0 - 16.5), up(2.0))]);
        ceiling.to(8.5);
        let after = speed - 0.5 * (2.0 - speed);
        near(ceiling.velocity(0), up(after));
        near(ceiling.counts.wall_momentum[V::DIMENSION - 1][1], up(2.0 - after));
    }
}

#[test]
fn vibrating_walls_hit() {
    vibrating::<DVec2>();
    vibrating::<DVec3>();
}

/// Three on the way to an open side; the first is gone at 5/1, and the second does not meet it any more.
#[test]
fn grains_leave_by_an_open_side() {
    for structure in STRUCTURES {
        let mut laws = laws(DVec2::splat(40.0));
        laws.boundary.axes[0] = faces(Face::Open, Face::Open);
        let at = |x: f64| DVec2::new(x, 20.0);
        // 1 would catch up with 0 at x = 42; 2 leaves by the other side at 20.
        let grains = [(at(35.0), DVec2::X), (at(32.0), DVec2::X * 1.25), (at(10.0), DVec2::X * -0.5)];
        let mut gas = Drive::new(&laws, structure, &grains);
        gas.to(4.9);
        assert_eq!((gas.gas.len(), gas.counts.removed), (3, 0));
        gas.to(5.1);
        assert_eq!((gas.gas.len(), gas.counts.removed), (2, 1));
        gas.to(6.5);
        assert_eq!((gas.gas.ids(), gas.counts.removed), (&[2][..], 2));
        gas.to(25.0);
        assert_eq!((gas.gas.len(), gas.counts.removed, gas.counts.collisions), (0, 3, 0));
        gas.to(1000.0);
    }
}

/// A column of two under gravity: the lower stands up from the floor into the upper one. Masses 1 and 3.
///
/// Lower from 0.5 at v = 6, upper from 2.5 at rest, both falling alike: they meet at 1/6 in their own frame,
/// v: −3 and 3, both less g/6.
fn column<V: Vector>() {
    for structure in STRUCTURES {
        let mut laws = walled::<V>(1.0, WallKind::Smooth);
        laws.gravity = up(-10.0);
        laws.species = vec![laws.grain, Grain { diameter: 1.0, mass: 3.0 }];
        laws.restitution = restitution(1.0);
        let at = |height: f64| up::<V>(height) + V::along(0, 5.0);
        let grains = [(at(0.5), up(6.0)), (at(2.5), V::ZERO)];
        let mut column = Drive::mixed(&laws, structure, &grains, &[0, 1]);
        column.collide(1);
        close(column.gas.time(), 1.0 / 6.0);
        near(column.velocity(0), up(-3.0 - 10.0 / 6.0));
        near(column.velocity(1), up(3.0 - 10.0 / 6.0));
        // μ = 3/4, v_n = 6: 2 · 3/4 · 6 over 1.
        close(column.counts.carried_momentum, 9.0);
    }
}

#[test]
fn a_column_under_gravity() {
    column::<DVec2>();
    column::<DVec3>();
}
