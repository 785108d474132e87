use super::*;
use crate::engine::report::Totals;
use crate::observe::testing::{Bed, assert_resumes, random_positions, setting_of, show, smooth};
use crate::statistics::average;
use glam::{DVec2, DVec3};

fn at_rest<V: Vector>(bed: &Bed<V>, positions: Vec<V>) -> Gas<V> {
    let velocities = vec![V::ZERO; positions.len()];
    bed.gas(0.0, positions, velocities)
}

/// Whether S of random grains that were moved by `change` is 1 in every shell, within 4.5 standard errors.
fn is_ideal<V: Vector>(bed: &Bed<V>, grains: usize, change: impl Fn(usize, &mut Vec<V>)) -> bool {
    let measure = StructureFactor::new(&bed.setting).unwrap();
    let replicas: Vec<Vec<f64>> = (0..150)
        .map(|k| {
            let mut positions = random_positions(k, grains, bed.setting.size);
            change(grains, &mut positions);
            measure.look(&at_rest(bed, positions))
        })
        .collect();
    (0..measure.shells.len()).all(|shell| {
        let found = average(&replicas.iter().map(|row| row[shell]).collect::<Vec<_>>()).unwrap();
        let error = found.standard_error.unwrap();
        // That of a moment: S √(2/n), and 150 of them.
        let expected = (2.0 / measure.shells[shell].waves / 150.0).sqrt();
        assert!((error / expected - 1.0).abs() < 0.5, "{error} {expected}");
        (found.value - 1.0).abs() < 4.5 * error
    })
}

#[test]
fn independent_grains_make_white_noise() {
    let mut flat = setting_of(DVec2::new(20.0, 33.0), [4, 4, 1]);
    let deep = setting_of(DVec3::new(7.0, 8.0, 9.0), [2, 2, 2]);
    assert!(is_ideal(&flat, 300, |_, _| ()));
    assert!(is_ideal(&deep, 200, |_, _| ()));
    // The tenth part of the grains beside their neighbours: S = 1 + 2 · 30/300 in long waves.
    let paired = |grains: usize, places: &mut Vec<DVec2>| places.copy_within(0..grains / 10, grains / 2);
    assert!(!is_ideal(&flat, 300, paired));
    flat.walls(0, smooth(), smooth());
    assert!(is_ideal(&flat, 300, |_, _| ()));
}

#[test]
fn a_lattice_is_seen_at_its_reciprocal_vectors_alone() {
    // Spacing 4 in a square of 64: 256 grains, peaks at multiples of 16.
    let bed = setting_of(DVec2::splat(64.0), [4, 4, 1]);
    let place = |k: u32| DVec2::new(f64::from(k % 16), f64::from(k / 16)) * 4.0 + DVec2::new(0.37, 1.21);
    let gas = at_rest(&bed, (0..256).map(place).collect());
    let measure = StructureFactor::new(&bed.setting).unwrap();
    let unit = 2.0 * PI / 64.0;
    let mut peaks = 0.0;
    for (wave, power) in measure.waves.waves().into_iter().zip(measure.waves.powers(gas.positions())) {
        let n = wave.vector / unit;
        let is_peak = n.x.round() as i64 % 16 == 0 && n.y.round() as i64 % 16 == 0;
        let expected = if is_peak { 256.0 } else { 0.0 };
        // Peaks beyond the grid enter with 3⁻⁶ of their amplitude, which is as high, at either end of either axis.
        assert!((power / 256.0 - expected).abs() < 256.0 * 4.0 * 3.0_f64.powi(-6), "{n}: {power}");
        peaks += if is_peak { wave.number } else { 0.0 };
    }
    assert_eq!(peaks, 25.0);
    let found = measure.look(&gas);
    // Shell 16 has four peaks among its waves, shell 23 (16 √2 = 22.6) four, shell 32 four.
    for (shell, s) in found.iter().enumerate() {
        let peaks = if [16, 23, 32].contains(&(shell + 1)) { 4.0 } else { 0.0 };
        assert!((s * measure.shells[shell].waves - 256.0 * peaks).abs() < 0.1 * 256.0, "{shell} {s}");
    }
    assert_eq!(found.len(), 32);
}

#[test]
fn large_boxes_have_long_waves_alone() {
    let points = |size: DVec3| grid_points(&setting_of(size, [1, 1, 1]).setting);
    assert_eq!(points(DVec3::splat(59.0)), [128, 128, 128]);
    assert_eq!(points(DVec3::splat(1000.0)).iter().product::<usize>(), POINTS);
    assert_eq!(points(DVec3::new(1e6, 2.0, 30.0)), [2048, 8, 64]);
    let bed = setting_of(DVec2::new(1e5, 10.0), [1, 1, 1]);
    let measure = StructureFactor::new(&bed.setting).unwrap();
    assert_eq!(measure.shells.len(), 512);
    assert!(measure.shells.iter().all(|shell| shell.waves == 2.0));
    assert!((measure.shells[511].wavenumber / (512.0 * 2.0 * PI / 1e5) - 1.0).abs() < 1e-12);
    assert_eq!(grid_points(&setting_of(DVec2::splat(1e5), [1, 1, 1]).setting), [2048, 2048, 1]);
}

#[test]
fn walls_few_grains_or_none() {
    let mut bed = setting_of(DVec2::splat(16.0), [2, 2, 1]);
    let measure = StructureFactor::new(&bed.setting).unwrap();
    assert!(measure.look(&at_rest(&bed, vec![])).iter().all(|s| s.is_nan()));
    // One grain: 1 for every wave, but for what the grid takes for another wave.
    let one = measure.look(&at_rest(&bed, vec![DVec2::new(3.3, 15.999)]));
    assert!(one.iter().all(|s| (s - 1.0).abs() < 8.0 * 3.0_f64.powi(-6)));
    assert!((one[0] - 1.0).abs() < 1e-6);
    bed.walls(0, smooth(), smooth());
    assert_eq!(StructureFactor::new(&bed.setting).unwrap().shells[0].waves, 2.0);
    bed.walls(1, smooth(), smooth());
    assert!(StructureFactor::new(&bed.setting).is_none());
}

#[test]
fn recordings_are_averaged_and_resume() {
    let bed = setting_of(DVec2::splat(16.0), [2, 2, 1]);
    let states = bed.random_states(20, 200);
    assert_resumes(|| Box::new(StructureFactor::new(&bed.setting).unwrap()), &states);
    let mut measure = StructureFactor::new(&bed.setting).unwrap();
    states.iter().for_each(|state| drop(show(&mut measure, state)));
    let (gas, totals) = (&states[19].0, Totals::default());
    let (profiles, _) = measure.conclusion(&Snapshot::new(gas, &totals), 10.0);
    let late: Vec<f64> = states[10..].iter().map(|(gas, _)| measure.look(gas)[2]).collect();
    // The ends stand for half as much time.
    let late = late.iter().sum::<f64>() - 0.5 * (late[0] + late[9]);
    assert!((profiles[0].values[1][2] - late / 9.0).abs() < 1e-14 && profiles[0].values[2][2] > 0.0);
}
