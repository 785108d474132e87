//! Collisions of two and three grains against solutions by hand.

use super::drive::{Drive, STRUCTURES, close, laws, near, restitution, vector};
use glam::{DVec2, DVec3};
use grainflow::law::restitution::{RestitutionLaw, VelocityDependent};
use grainflow::law::roughness::Roughness;
use grainflow::matter::grain::Grain;
use grainflow::space::Vector;

fn in_a_row<V: Vector>() {
    // r = 1/2: 0 hits 1 at t = 1 (v: 1/4, 3/4); 1 hits 2 at 1 + 2/(3/4) (v: 3/16, 9/16); 0, 4/3 behind 1 and
    // faster by 1/16, hits it 64/3 later.
    for structure in STRUCTURES {
        let mut laws = laws::<V>(V::from_fn(|_| 100.0));
        laws.restitution = restitution(0.5);
        let at = |x: f64| vector::<V>([x, 20.0, 20.0]);
        let grains = [(at(10.0), V::along(0, 1.0)), (at(12.0), V::ZERO), (at(15.0), V::ZERO)];
        let mut row = Drive::new(&laws, structure, &grains);
        for (k, time) in [1.0, 1.0 + 8.0 / 3.0, 24.0 + 1.0].into_iter().enumerate() {
            row.collide(1);
            close(row.gas.time(), time);
            assert_eq!(row.counts.collisions, k as u64 + 1);
        }
        for (id, v) in [13.0 / 64.0, 15.0 / 64.0, 36.0 / 64.0].into_iter().enumerate() {
            near(row.velocity(id as u32), V::along(0, v));
        }
        // Impulses (1 + r)/2 v_n = 3/4, 9/16, 3/64 over a distance of 1.
        close(row.counts.carried_momentum, 0.75 + 0.5625 + 3.0 / 64.0);
        assert_eq!(row.events.impacts[0], 3);
    }
}

#[test]
fn three_in_a_row() {
    in_a_row::<DVec2>();
    in_a_row::<DVec3>();
}

/// Radii 1 and 0.5, masses 3 and 1; the offset 0.9 is 3/5 of 1.5: contact at 4/5 of it along x, k = (0.8, 0.6).
fn unequal<V: Vector>() {
    for structure in STRUCTURES {
        let mut laws = laws::<V>(V::from_fn(|_| 30.0));
        laws.restitution = restitution(0.5);
        laws.grain = Grain { diameter: 2.0, mass: 3.0 };
        laws.species = vec![laws.grain, Grain { diameter: 1.0, mass: 1.0 }];
        let grains = [(vector([10.0, 10.0, 4.0]), V::along(0, 1.0)), (vector([15.0, 10.9, 4.0]), V::ZERO)];
        let mut pair = Drive::mixed(&laws, structure, &grains, &[0, 1]);
        pair.collide(1);
        close(pair.gas.time(), 5.0 - 1.2);
        // v_n = 0.8 k; grain 1 loses 3/2 · 1/4 of it, grain 2 gets 3/2 · 3/4.
        near(pair.velocity(0), vector([1.0 - 0.24, -0.18, 0.0]));
        near(pair.velocity(1), vector([0.72, 0.54, 0.0]));
        // (1 + r) μ v_n = 3/2 · 3/4 · 0.8 over 1.5.
        close(pair.counts.carried_momentum, 0.9 * 1.5);
        // b/d = 0.6 on the border of two bins.
        assert_eq!(pair.events.impacts[23] + pair.events.impacts[24], 1);
    }
}

#[test]
fn unequal_grains_aslant() {
    unequal::<DVec2>();
    unequal::<DVec3>();
}

/// Head on at speed 2 above v0 = 1/8: r = 1/2 (1/16)^(1/4) = 1/4; at 2⁻⁸ v0 below: r = 1 − 1/2 · 2^(−8/5).
#[test]
fn slow_collisions_lose_less() {
    for structure in STRUCTURES {
        for (speed, r) in [(2.0, 0.25), (0.125 / 32.0, 1.0 - 0.5 * 0.5)] {
            let mut laws = laws(DVec2::splat(20.0));
            laws.restitution = RestitutionLaw::VelocityDependent(VelocityDependent { r0: 0.5, v0: 0.125 });
            let grains = [(DVec2::new(5.0, 5.0), DVec2::X * speed), (DVec2::new(8.0, 5.0), DVec2::ZERO)];
            let mut pair = Drive::new(&laws, structure, &grains);
            pair.collide(1);
            close(pair.gas.time() * speed, 2.0);
            near(pair.velocity(0), DVec2::X * (speed * (1.0 - r) / 2.0));
            near(pair.velocity(1), DVec2::X * (speed * (1.0 + r) / 2.0));
        }
    }
}

/// Perfectly rough discs, z = 1/2, φ = 1, r = 1: the velocity of the surfaces at the contact is turned round.
///
/// Grain 0 comes along x at 1, its surface and that of the other, spinning at 2, slide past each other at
/// ω(a₁ + a₂)/… with ω₁ = 0, ω₂ = 2: ω₂ × k/2 = y. P_t = −2 μ z/(1+z) g_t = −1/2 · 2/3 = −1/3 along y;
/// spins change by P_t/(z m a) = −1/3 · 4 = −4/3 each.
#[test]
fn rough_discs_turn_each_other() {
    for structure in STRUCTURES {
        let mut laws = laws(DVec2::splat(20.0));
        laws.roughness = Some(Roughness { tangential_restitution: 1.0, reduced_inertia: 0.5 });
        let grains = [(DVec2::new(5.0, 5.0), DVec2::X), (DVec2::new(8.0, 5.0), DVec2::ZERO)];
        let mut pair = Drive::new(&laws, structure, &grains);
        pair.spin(&[[0.0], [2.0]]);
        pair.collide(1);
        close(pair.gas.time(), 2.0);
        near(pair.velocity(0), DVec2::new(0.0, -1.0 / 3.0));
        near(pair.velocity(1), DVec2::new(1.0, 1.0 / 3.0));
        close(pair.spin_of(0)[0], -4.0 / 3.0);
        close(pair.spin_of(1)[0], 2.0 - 4.0 / 3.0);
        // What goes along the plane of contact carries no pressure.
        close(pair.counts.carried_momentum, 1.0);
    }
}

/// The same in space: the spin about z makes the same, and what lies along k and along x is left.
#[test]
fn rough_spheres_turn_each_other() {
    for structure in STRUCTURES {
        let mut laws = laws(DVec3::splat(20.0));
        laws.roughness = Some(Roughness { tangential_restitution: 1.0, reduced_inertia: 0.5 });
        let at = DVec3::new(5.0, 5.0, 5.0);
        let grains = [(at, DVec3::X), (at + DVec3::X * 3.0, DVec3::ZERO)];
        let mut pair = Drive::new(&laws, structure, &grains);
        pair.spin(&[[7.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
        pair.collide(1);
        near(pair.velocity(0), DVec3::new(0.0, -1.0 / 3.0, 0.0));
        near(pair.velocity(1), DVec3::new(1.0, 1.0 / 3.0, 0.0));
        for (id, spin) in [(0, [7.0, 0.0, -4.0 / 3.0]), (1, [0.0, 0.0, 2.0 - 4.0 / 3.0])] {
            (0..3).for_each(|k| close(pair.spin_of(id)[k], spin[k]));
        }
    }
}

/// Two in a ring of 2, 3 and 4 cells: a gap of s ahead and L − 2 − s behind. Elastic, they swap for ever.
fn ring<V: Vector>() {
    for structure in STRUCTURES {
        for side in [2.1, 2.5, 3.1, 3.7, 4.2] {
            let laws = laws::<V>(V::from_fn(|_| side));
            // Head on along every axis in turn; the other coordinates wrap, too.
            for (axis, sideways) in (0..V::DIMENSION).flat_map(|axis| [(axis, 0.0), (axis, 0.9)]) {
                let start = V::from_fn(|k| if k == axis { side - 0.3 } else { 0.05 });
                let drift = V::from_fn(|k| if k == axis { 0.0 } else { sideways });
                let gap = 0.4 * (side - 2.0);
                let ahead = (side - 0.3 + 1.0 + gap) - side;
                let other = V::from_fn(|k| if k == axis { ahead } else { 0.05 });
                let mut pair =
                    Drive::new(&laws, structure, &[(start, drift + V::along(axis, 1.0)), (other, drift)]);
                let mut time = gap;
                // A rounding of the direction grows with every collision, by up to 1 + 2 · 2.2.
                for k in 0..if sideways == 0.0 { 12 } else { 3 } {
                    pair.collide(1);
                    assert!((pair.gas.time() - time).abs() < 1e-12, "{side} {k} {}", pair.gas.time());
                    near(pair.velocity((k + 1) % 2), drift + V::along(axis, 1.0));
                    time += side - 2.0;
                }
            }
        }
    }
}

#[test]
fn pairs_in_tiny_periodic_boxes() {
    ring::<DVec2>();
    ring::<DVec3>();
}

/// In a box of a single cell, 1.5 wide, two stand (0.75, 0.75) apart: along (1, 0) the offset is 3/4, contact at
/// 0.75 − √(1 − 9/16); the next time it is an image on the other side.
fn one_cell<V: Vector>() {
    for structure in STRUCTURES {
        let laws = laws::<V>(V::from_fn(|_| 1.5));
        let (one, other) = (vector::<V>([0.2, 0.3, 0.1]), vector::<V>([0.95, 1.05, 0.1]));
        for sign in [1.0, -1.0] {
            let mut pair = Drive::new(&laws, structure, &[(one, V::along(0, sign)), (other, V::ZERO)]);
            pair.collide(1);
            let ahead = (1.0_f64 - 0.5625).sqrt();
            close(pair.gas.time(), 0.75 - ahead);
            // k = (√7/4, ±3/4); v_n = √7/4. By symmetry the image above and the one below are met together.
            assert!((pair.energy() - 0.5).abs() < 1e-15);
            let normal = pair.velocity(1) * (1.0 / ahead);
            close(normal.length(), 1.0);
            close(normal[0], sign * ahead);
            close(normal[1].abs(), 0.75);
        }
    }
}

#[test]
fn pairs_in_a_single_cell() {
    one_cell::<DVec2>();
    one_cell::<DVec3>();
}

/// A fast grain in a large box meets an image boxes away: (34, 13) from it, passing the nearest ones.
#[test]
fn a_long_way_to_a_collision() {
    for structure in STRUCTURES {
        let laws = laws(DVec2::splat(10.0));
        let length = 1325.0_f64.sqrt();
        let grains = [
            (DVec2::new(5.0, 5.0), DVec2::ZERO),
            (DVec2::new(1.0, 2.0), DVec2::new(34.0, 13.0) * (1.0 / length)),
        ];
        let mut pair = Drive::new(&laws, structure, &grains);
        pair.collide(1);
        close(pair.gas.time(), length - 1.0);
        // Head on: what moved stands.
        near(pair.velocity(1), DVec2::ZERO);
    }
}
