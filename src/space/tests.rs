use super::*;
use crate::random::{Phase, Streams};

fn stream() -> Stream {
    Streams::new(11).at(0, Phase::Collisions).stream(0)
}

/// ⟨cos²θ⟩ of the normal against the approach is 2/3 for uniform b in 2D, 1/2 in the disc.
fn mean_normal_square<V: Vector>() -> f64 {
    let mut random = stream();
    let draws = 200_000;
    let direction = V::from_fn(|axis| [0.6, -0.48, 0.64][axis]);
    let direction = direction * (1.0 / direction.length());
    let mut sum = 0.0;
    for _ in 0..draws {
        let exchange = V::exchange(direction, &mut random);
        let cosine = exchange.dot(direction);
        // −(g·n)n of |g| = 1: its squared length is −g·(−(g·n)n).
        assert!(cosine <= 0.0 && (exchange.length_squared() + cosine).abs() < 1e-12);
        sum += exchange.length_squared();
    }
    sum / f64::from(draws)
}

#[test]
fn impact_parameter_has_the_moments_of_molecular_chaos() {
    // Standard errors: 0.30/√200000 and 0.29/√200000, below 7e-4.
    assert!((mean_normal_square::<DVec2>() - 2.0 / 3.0).abs() < 2.1e-3);
    assert!((mean_normal_square::<DVec3>() - 0.5).abs() < 2.1e-3);
}

/// Offset of the centres across the approach, in units of d: the normal without its part along `direction`.
fn offsets<V: Vector>(direction: V, draws: u32) -> impl Iterator<Item = V> {
    let mut random = stream();
    (0..draws).map(move |_| {
        let exchange = V::exchange(direction, &mut random);
        let normal = exchange * (1.0 / exchange.length());
        normal - direction * normal.dot(direction)
    })
}

/// Whether `sum` of `draws` values of this mean and second moment is within four standard errors.
fn agrees(sum: f64, draws: u32, mean: f64, second: f64) -> bool {
    let n = f64::from(draws);
    (sum / n - mean).abs() < 4.0 * ((second - mean * mean) / n).sqrt()
}

#[test]
fn impact_parameters_are_uniform_in_two_dimensions() {
    let draws = 200_000;
    let (mut first, mut second, mut fourth) = (0.0, 0.0, 0.0);
    for offset in offsets(DVec2::new(0.6, -0.8), draws) {
        let b = offset.dot(DVec2::new(0.8, 0.6));
        first += b;
        second += b * b;
        fourth += b.powi(4);
    }
    assert!(agrees(first, draws, 0.0, 1.0 / 3.0));
    assert!(agrees(second, draws, 1.0 / 3.0, 1.0 / 5.0));
    assert!(agrees(fourth, draws, 1.0 / 5.0, 1.0 / 9.0));
}

/// ⟨b²⟩ = 1/2 and ⟨b⁴⟩ = 1/3 for the radius; for two axes across, ⟨p⟩ = 0, ⟨p²⟩ = 1/4, ⟨pq⟩ = 0,
/// ⟨p⁴⟩ = 1/8, ⟨p²q²⟩ = 1/24. A uniform b would have ⟨b²⟩ = 1/3, and ⟨b⟩ = 1/2 in place of 2/3.
#[test]
fn impact_parameters_are_uniform_in_the_disc_in_three_dimensions() {
    let draws = 200_000;
    for direction in [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.36, 0.48, -0.8), DVec3::NEG_Z] {
        let (along_p, along_q) = direction.any_orthonormal_pair();
        let mut sums = [0.0; 7];
        for offset in offsets(direction, draws) {
            let (p, q, b) = (offset.dot(along_p), offset.dot(along_q), offset.length());
            let values = [b, b * b, b.powi(4), p, q, p * p, p * q];
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        let means = [2.0 / 3.0, 0.5, 1.0 / 3.0, 0.0, 0.0, 0.25, 0.0];
        let seconds = [0.5, 1.0 / 3.0, 0.2, 0.25, 0.25, 0.125, 1.0 / 24.0];
        for k in 0..sums.len() {
            assert!(agrees(sums[k], draws, means[k], seconds[k]), "moment {k} along {direction}");
        }
    }
}

#[test]
fn displacement_ratio_is_the_momentum_share() {
    for r in [0.0, 0.5, 0.9, 1.0] {
        // Midpoint rule over impact parameters b (2D) and b² (3D).
        let n = 200_000;
        let (mut normal2, mut after2, mut normal3, mut after3) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..n {
            let u = (f64::from(k) + 0.5) / f64::from(n);
            normal2 += (1.0 - u * u).sqrt();
            after2 += (r * r * (1.0 - u * u) + u * u).sqrt();
            normal3 += (1.0 - u).sqrt();
            after3 += (r * r * (1.0 - u) + u).sqrt();
        }
        let half = 0.5 * (1.0 + r);
        assert!((DVec2::displacement_ratio(r) - half * normal2 / after2).abs() < 1e-4);
        assert!((DVec3::displacement_ratio(r) - half * normal3 / after3).abs() < 1e-4);
    }
}

#[test]
fn spins_move_points_and_impulses_spin() {
    // A wheel that turns to the left: its rightmost point goes up, a push up there turns it on.
    assert_eq!(DVec2::spin_velocity([2.0], DVec2::new(3.0, 1.0)), DVec2::new(-2.0, 6.0));
    assert_eq!(DVec2::torque(DVec2::new(3.0, 1.0), DVec2::new(-1.0, 5.0)), [16.0]);
    let (spin, arm) = ([1.0, -2.0, 3.0], DVec3::new(4.0, 5.0, -6.0));
    assert_eq!(DVec3::spin_velocity(spin, arm), DVec3::new(-3.0, 18.0, 13.0));
    assert_eq!(DVec3::torque(DVec3::from_array(spin), arm), [-3.0, 18.0, 13.0]);
    assert_eq!(DVec3::add_spin(spin, [1.0, 1.0, 2.0], -0.5), [0.5, -2.5, 2.0]);
}

/// Turned vectors keep their length; the sine of the angle has the moments of a uniform angle.
fn turning<V: Vector>(vector: V) {
    let (mut random, draws, largest) = (stream(), 100_000, 0.7);
    let (mut first, mut second) = (0.0, 0.0);
    for _ in 0..draws {
        let [turned, back] = vector.turns(largest, &mut random);
        for v in [turned, back] {
            assert!((v.length_squared() / vector.length_squared() - 1.0).abs() < 4e-15);
        }
        assert!(
            ((turned + back) - vector * (turned.dot(vector) * 2.0 / vector.length_squared())).length()
                < 1e-13
        );
        let angle = libm::acos((turned.dot(vector) / vector.length_squared()).min(1.0));
        assert!(angle <= largest + 1e-12);
        first += angle;
        second += angle * angle;
    }
    assert!(agrees(first, draws, largest / 2.0, largest * largest / 3.0));
    assert!(agrees(second, draws, largest * largest / 3.0, largest.powi(4) / 5.0));
    assert_eq!(V::ZERO.turns(largest, &mut random), [V::ZERO; 2]);
}

#[test]
fn a_turn_is_uniform_in_its_angle() {
    turning(DVec2::new(3.0, -1.0));
    turning(DVec3::new(3.0, -1.0, 0.5));
    turning(DVec3::NEG_Z * 1e-9);
}

#[test]
fn a_turn_prefers_no_side() {
    let (mut random, draws) = (stream(), 100_000);
    let (mut left, mut up, mut aslant) = (0.0, 0.0, 0.0);
    for _ in 0..draws {
        left += DVec2::X.turns(0.5, &mut random)[0].y;
        let turned = DVec3::Z.turns(0.5, &mut random)[0];
        let length = turned.truncate().length();
        up += (turned.x / length).powi(2);
        aslant += turned.x * turned.y / (length * length);
    }
    // ⟨sin²θ⟩ = 1/2 − sin(2·0.5)/(4·0.5); on the circle ⟨cos²⟩ = 1/2, ⟨cos⁴⟩ = 3/8, ⟨cos² sin²⟩ = 1/8.
    assert!(agrees(left, draws, 0.0, 0.5 - libm::sin(1.0) / 2.0));
    assert!(agrees(up, draws, 0.5, 0.375));
    assert!(agrees(aslant, draws, 0.0, 0.125));
}

#[test]
fn tangents_complete_the_basis() {
    for n in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.36, 0.48, -0.8)] {
        let (a, b) = tangents(n);
        assert!(a.dot(b).abs() < 1e-15 && a.dot(n).abs() < 1e-15 && b.dot(n).abs() < 1e-15);
        assert!((a.length() - 1.0).abs() < 1e-15 && (b.length() - 1.0).abs() < 1e-15);
    }
}
