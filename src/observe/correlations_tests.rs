use super::*;
use crate::engine::report::Totals;
use crate::observe::testing::{
    assert_resumes, random_positions, random_velocities, setting_of, show, smooth,
};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

fn profile<V: Vector>(setting: &Setting<V>, gas: &Gas<V>) -> Vec<Vec<f64>> {
    let totals = Totals::default();
    let mut measure = Correlations::new(setting).unwrap();
    measure.profiles(&Snapshot::new(gas, &totals))[0].values.clone()
}

/// One grain in the middle of each raster cell of a square of 16, moving along `direction` as sin kx.
fn mode(direction: DVec2) -> Vec<Vec<f64>> {
    let bed = setting_of(DVec2::splat(16.0), [4, 4, 1]);
    let places = (0..256).map(|k| DVec2::new(f64::from(k % 16) + 0.5, f64::from(k / 16) + 0.5)).collect();
    let mut gas = bed.gas(0.0, places, vec![DVec2::ZERO; 256]);
    let velocities: Vec<DVec2> =
        gas.positions().iter().map(|p| direction * (2.0 * (TAU * p.x / 16.0).sin())).collect();
    gas.velocities_mut().copy_from_slice(&velocities);
    profile(&bed.setting, &gas)
}

/// Row `row` of A²/2 ⟨cos(kx) x²/r²⟩ and A²/2 ⟨cos(kx) y²/r²⟩ over raster vectors, A = 2 and k = 2π/16.
fn expected(row: i32) -> (f64, f64) {
    let (mut number, mut along, mut across) = (0.0, 0.0, 0.0);
    for (x, y) in (-8..8).flat_map(|x| (-8..8).map(move |y| (f64::from(x), f64::from(y)))) {
        if x.hypot(y).round() as i32 == row {
            let wave = 2.0 * (TAU * x / 16.0).cos() / (x * x + y * y);
            number += 1.0;
            along += wave * x * x;
            across += wave * y * y;
        }
    }
    (along / number, across / number)
}

#[test]
fn shear_and_compression_are_known_exactly() {
    let (shear, compression) = (mode(DVec2::Y), mode(DVec2::X));
    assert_eq!(shear[0].len(), 9);
    for row in 1..9 {
        let (along, across) = expected(row as i32);
        // u_y u_y of the shear lies along r by y²/r², across r by x²/r²; of the compression the other way.
        assert!((shear[2][row] - across).abs() < 1e-13 && (shear[3][row] - along).abs() < 1e-13, "{row}");
        assert!((compression[2][row] - along).abs() < 1e-13, "{row}");
        assert!((compression[3][row] - across).abs() < 1e-13, "{row}");
        assert!(shear[1][row].abs() < 1e-13);
    }
    // One grain in each raster cell has no partner there.
    assert!((shear[1][0] + 1.0).abs() < 1e-13 && shear[2][0].abs() < 1e-13);
}

#[test]
fn a_density_wave_is_known_exactly() {
    // Two grains in every other column of the raster: δn = ±n̄, G_nn/n̄² = ±1 in turn.
    let bed = setting_of(DVec3::splat(6.0), [3; 3]);
    let places = (0..108).map(|k| {
        DVec3::new(f64::from(2 * (k % 3)) + 0.5, f64::from(k / 3 % 6) + 0.5, f64::from(k / 18) + 0.5)
    });
    let places: Vec<DVec3> = places.collect();
    let gas = bed.gas(0.0, [places.clone(), places].concat(), vec![DVec3::ZERO; 216]);
    let values = profile(&bed.setting, &gas);
    // Nearest raster vectors with |r| < 1.5: 2 · (1, 0, 0), 4 across; 4 (0, 1, 1), 8 (1, 1, 0).
    let expected = f64::from(-2 + 4 + 4 - 8) / 18.0;
    assert!((values[1][1] - expected).abs() < 1e-13, "{}", values[1][1]);
}

fn independent<V: Vector>(side: f64) {
    let size = V::from_fn(|_| side);
    let bed = setting_of(size, [2, 2, 2]);
    let grains = 20_000;
    let gas = bed.gas(0.0, random_positions(3, grains, size), random_velocities(4, grains));
    let values = profile(&bed.setting, &gas);
    let (n, cells) = (grains as f64, side.powi(V::DIMENSION as i32));
    let reach = side as i32 / 2;
    for row in 0..values[0].len() {
        let (mut vectors, mut axes) = (0.0, [0; 3]);
        let range = |axis: usize| if axis < V::DIMENSION { -reach..reach } else { 0..1 };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    axes[..].copy_from_slice(&[x, y, z]);
                    let square: i32 = axes.iter().map(|x| x * x).sum();
                    vectors += f64::from(u8::from(f64::from(square).sqrt().round() as usize == row));
                }
            }
        }
        // N²/2 · vectors/cells pairs, each of unit variance; bias −1/N of N grains without common momentum.
        let error = (2.0 * cells / (n * n * vectors)).sqrt();
        for (column, values) in values.iter().enumerate().skip(1) {
            assert!((values[row] + 1.0 / n).abs() < 4.0 * error, "{column} {row}: {} {error}", values[row]);
        }
    }
}

#[test]
fn independent_grains_are_not_correlated() {
    independent::<DVec2>(64.0);
    independent::<DVec3>(20.0);
}

#[test]
fn walls_nobody_and_one() {
    let mut bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
    let mut measure = Correlations::new(&bed.setting).unwrap();
    show(&mut measure, &(bed.gas(0.0, vec![], vec![]), Totals::default()));
    let one = profile(&bed.setting, &bed.gas(0.0, vec![DVec2::ONE], vec![DVec2::X]));
    assert!(one[1].iter().all(|g| (g + 1.0).abs() < 1e-14) && one[2].iter().all(|g| g.abs() < 1e-14));
    bed.walls(0, smooth(), smooth());
    assert!(Correlations::new(&bed.setting).is_none());
}

#[test]
fn it_resumes() {
    let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
    assert_resumes(|| Box::new(Correlations::new(&bed.setting).unwrap()), &bed.random_states(4, 20));
}
