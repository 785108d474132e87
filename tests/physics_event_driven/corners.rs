//! Corners: nothing there, nothing moving, everything at once.

use super::drive::{Drive, STRUCTURES, close, faces, laws, near, restitution, wall};
use glam::{DVec2, DVec3};
use grainflow::engine::event_driven::laws::Growth;
use grainflow::engine::{EngineError, Horizon};
use grainflow::law::boundary::WallKind;
use grainflow::space::Vector;

#[test]
fn nothing_that_moves() {
    for structure in STRUCTURES {
        let laws = laws(DVec2::splat(10.0));
        for grains in [vec![], vec![(DVec2::splat(2.0), DVec2::ZERO), (DVec2::splat(7.0), DVec2::ZERO)]] {
            let mut still = Drive::new(&laws, structure, &grains);
            still.to(3.0);
            still.to(1e9);
            let error = still.step(Horizon::NONE).unwrap_err();
            assert!(matches!(error, EngineError::NothingMoves { .. }), "{error}");
        }
    }
}

#[test]
fn a_single_grain_flies_on() {
    for structure in STRUCTURES {
        let laws = laws(DVec3::new(3.0, 4.0, 5.0));
        let start = DVec3::new(0.1, 0.2, 0.3);
        let mut grain = Drive::new(&laws, structure, &[(start, DVec3::new(1.0, -0.5, 0.125))]);
        grain.to(1000.0);
        // 1000.1 = 333 · 3 + 1.1; 0.2 − 500 = −125 · 4 + 0.2; 0.3 + 125 = 25 · 5 + 0.3.
        let off = grain.position(0) - DVec3::new(1.1, 0.2, 0.3);
        assert!(off.length() < 1e-11, "{off}");
    }
}

/// A grain that comes into a box at rest.
#[test]
fn a_grain_poured_much_later_flies_on() {
    for structure in STRUCTURES {
        let mut gas = Drive::new(&laws(DVec2::splat(10.0)), structure, &[(DVec2::splat(2.0), DVec2::ZERO)]);
        gas.to(1e4);
        gas.gas.insert(DVec2::new(5.0, 2.0), DVec2::X * -0.5);
        gas.to(1e4 + 3.0);
        near(gas.position(1), DVec2::new(3.5, 2.0));
        gas.collide(1);
        assert!((gas.gas.time() - 1e4 - 4.0).abs() < 1e-10);
        near(gas.velocity(0), DVec2::X * -0.5);
    }
}

/// Neighbours of a square lattice fly at each other, all pairs at once, again and again.
fn mirrors<V: Vector>(per_axis: usize) {
    for structure in STRUCTURES {
        let laws = laws::<V>(V::from_fn(|_| 2.0 * per_axis as f64));
        let grains: Vec<(V, V)> = (0..per_axis.pow(V::DIMENSION as u32))
            .map(|k| {
                let site = |axis: usize| k / per_axis.pow(axis as u32) % per_axis;
                let sign = if site(0).is_multiple_of(2) { 1.0 } else { -1.0 };
                (V::from_fn(|axis| 2.0 * site(axis) as f64 + 0.5), V::along(0, sign))
            })
            .collect();
        let mut gas = Drive::new(&laws, structure, &grains);
        // A gap of 1 at a relative speed of 2; then the others, a gap of 2.
        for (time, rounds) in [(0.4, 0), (0.6, 1), (1.4, 1), (1.6, 2), (2.6, 3)] {
            gas.to(time);
            assert_eq!(gas.counts.collisions, rounds * grains.len() as u64 / 2, "{time}");
        }
        for (id, grain) in grains.iter().enumerate() {
            near(gas.velocity(id as u32), -grain.1);
        }
        let at_once = gas.counts.carried_momentum;
        close(at_once, 3.0 * grains.len() as f64);
    }
}

#[test]
fn everything_at_once() {
    mirrors::<DVec2>(6);
    mirrors::<DVec3>(4);
}

/// In touch from the start: those that part are left alone, those that approach collide at once, and those that
/// slide along each other are no trouble.
#[test]
fn grains_in_touch() {
    for structure in STRUCTURES {
        for edge in [3.0, 8.999] {
            // The second also across the edge of the box, where images are shifted.
            for (relative, collisions) in
                [(DVec2::X, 0), (-DVec2::X, 1), (DVec2::Y, 0), (DVec2::new(-1e-17, 1.0), 1)]
            {
                let laws = laws(DVec2::splat(9.5));
                let grains =
                    [(DVec2::new(edge, 2.0), DVec2::ZERO), (DVec2::new((edge + 1.0) % 9.5, 2.0), relative)];
                let mut pair = Drive::new(&laws, structure, &grains);
                pair.to(0.01);
                let rounding = edge != 3.0 && relative.x.abs() < 0.5;
                assert!(pair.counts.collisions == collisions || rounding, "{edge} {relative}");
                assert!(pair.counts.collisions <= 1);
            }
        }
    }
}

/// Touching grains slide past each other across the edge of the box at all angles; rounding decides which of them meet.
#[test]
fn grazing_pairs_do_not_stall() {
    for structure in STRUCTURES {
        let side = 9.7;
        let mut laws = laws(DVec2::splat(side));
        for growth in [Growth::NONE, Growth { start: 0.9, rate: 0.01 }] {
            laws.growth = growth;
            for k in 0..2000_u32 {
                let (sine, cosine) = (0.001 * f64::from(k)).sin_cos();
                let apart = DVec2::new(cosine, sine) * growth.start;
                let one = DVec2::new(side - 0.3, 0.2 + 0.1 * sine);
                let other = one + apart;
                let wrapped = DVec2::new(other.x.rem_euclid(side), other.y.rem_euclid(side));
                let sliding = DVec2::new(-sine, cosine) - DVec2::new(cosine, sine) * growth.rate;
                let grains = [(one, DVec2::new(0.1, 0.2)), (wrapped, DVec2::new(0.1, 0.2) + sliding)];
                Drive::new(&laws, structure, &grains).to(0.01);
            }
        }
    }
}

#[test]
fn what_is_not_a_number_is_named() {
    for structure in STRUCTURES {
        let laws = laws(DVec2::splat(10.0));
        for lost in [f64::NAN, f64::INFINITY] {
            let grains = [
                (DVec2::new(2.0, 2.0), DVec2::X),
                (DVec2::new(5.0, 5.0), DVec2::new(lost, 1.0)),
                (DVec2::new(7.0, 2.0), DVec2::Y),
            ];
            let mut gas = Drive::new(&laws, structure, &grains);
            let error = gas.try_to(5.0).unwrap_err();
            assert!(matches!(error, EngineError::NotFinite { id: 1, .. }), "{lost} {error}");
        }
    }
}

/// At rest on a floor under gravity: contact without end, which is named and not waited for.
#[test]
fn a_grain_at_rest_on_the_floor_is_a_collapse() {
    for structure in STRUCTURES {
        for kind in [WallKind::Smooth, WallKind::Vibrating { amplitude: 1e-3, frequency: 0.1 }] {
            for r in [0.0, 0.5] {
                let mut laws = laws(DVec2::splat(10.0));
                laws.gravity = DVec2::Y * -1.0;
                laws.restitution = restitution(0.9);
                laws.boundary.axes[1] = faces(wall(r, kind), wall(1.0, WallKind::Smooth));
                let mut grain = Drive::new(&laws, structure, &[(DVec2::new(5.0, 0.5), DVec2::ZERO)]);
                let error = grain.try_to(50.0).unwrap_err();
                assert!(matches!(error, EngineError::Collapse { id: 0, .. }), "{kind:?} {r} {error}");
            }
        }
    }
}
