use super::*;
use crate::engine::report::Totals;
use crate::observe::testing::{Bed, assert_resumes, random_positions, setting_of, show, smooth};
use crate::statistics::average;
use glam::{DVec2, DVec3};

fn at_rest<V: Vector>(bed: &Bed<V>, positions: Vec<V>) -> Gas<V> {
    let velocities = vec![V::ZERO; positions.len()];
    bed.gas(0.0, positions, velocities)
}

/// Standard errors that the mean g of independent grains is from 1: the worst bin, and all bins together.
fn deviations<V: Vector>(bed: &Bed<V>, grains: usize, room: impl Fn(V) -> V) -> [f64; 2] {
    let measure = PairCorrelation::new(&bed.setting).unwrap();
    let of = |k| random_positions(k, grains, bed.setting.size).into_iter().map(&room).collect();
    let replicas: Vec<Vec<f64>> = (0..120)
        .map(|k| {
            let [mut g, _] = measure.look(&at_rest(bed, of(k)));
            // The last bins hold most pairs; their mean is the whole.
            g.push(g.iter().rev().take(20).sum::<f64>() / 20.0);
            g
        })
        .collect();
    let mut deviations: Vec<f64> = (0..=measure.bins)
        .map(|bin| {
            let found = average(&replicas.iter().map(|row| row[bin]).collect::<Vec<_>>()).unwrap();
            // Bins that were nearly always empty tell nothing.
            let is_known = found.standard_error.unwrap() < 0.3;
            if is_known { (found.value - 1.0) / found.standard_error.unwrap() } else { 0.0 }
        })
        .collect();
    let whole = deviations.pop().unwrap().abs();
    [deviations.into_iter().map(f64::abs).fold(0.0, f64::max), whole]
}

/// Of a hundred Student bins with 119 degrees of freedom the worst is beyond 4.5 in one case of 600.
fn is_ideal([worst, whole]: [f64; 2]) -> bool {
    worst < 4.5 && whole < 4.0
}

#[test]
fn independent_grains_are_uncorrelated() {
    let mut flat = setting_of(DVec2::new(12.0, 15.0), [3, 3, 1]);
    let mut deep = setting_of(DVec3::new(6.0, 7.0, 8.0), [2, 2, 2]);
    assert!(is_ideal(deviations(&flat, 400, |p| p)));
    assert!(is_ideal(deviations(&deep, 300, |p| p)));
    for axis in [1, 0] {
        flat.walls(axis, smooth(), smooth());
        deep.walls(axis, smooth(), smooth());
        assert!(is_ideal(deviations(&flat, 400, |p| p)), "{axis}");
        assert!(is_ideal(deviations(&deep, 300, |p| p)), "{axis}");
    }
    // A radius away from the walls they are denser, unless that is where walls keep them.
    let inner = |p: DVec2| DVec2::new(0.5, 0.5) + p * (DVec2::new(11.0, 14.0) / DVec2::new(12.0, 15.0));
    assert!(!is_ideal(deviations(&flat, 400, inner)));
    flat.setting.counts_impacts = true;
    assert!(is_ideal(deviations(&flat, 400, inner)));
}

/// All pairs, one by one: weights and their squares.
fn by_all_pairs<V: Vector>(measure: &PairCorrelation<V>, gas: &Gas<V>) -> Vec<[f64; 2]> {
    let mut sums = vec![[0.0; 2]; measure.bins];
    for (k, &a) in gas.positions().iter().enumerate() {
        for &b in &gas.positions()[..k] {
            let separation = gas.grid().separation(a, b);
            let bin = (separation.length() / measure.width) as usize;
            if bin < measure.bins {
                let bounded = (0..V::DIMENSION).filter(|&axis| !gas.grid().is_periodic(axis));
                let weight: f64 =
                    bounded.map(|axis| 1.0 / (1.0 - separation[axis].abs() / measure.size[axis])).product();
                sums[bin][0] += weight;
                sums[bin][1] += weight * weight;
            }
        }
    }
    sums
}

fn agrees_with_all_pairs<V: Vector>(bed: &Bed<V>, grains: usize) {
    let measure = PairCorrelation::new(&bed.setting).unwrap();
    let gas = at_rest(bed, random_positions(grains as u64, grains, bed.setting.size));
    let found = measure.weights(&gas);
    for (found, expected) in found.iter().zip(by_all_pairs(&measure, &gas)) {
        assert!((found[0] - expected[0]).abs() < 1e-9 && (found[1] - expected[1]).abs() < 1e-9);
    }
    assert!(found.iter().map(|sum| sum[0]).sum::<f64>() > 10.0);
}

#[test]
fn no_pair_is_missed_and_none_counts_twice() {
    for size in [DVec2::new(10.0, 10.0), DVec2::new(23.0, 40.0), DVec2::new(100.0, 11.0)] {
        let mut bed = setting_of(size, [3, 3, 1]);
        for grains in [20, 300, 3000] {
            agrees_with_all_pairs(&bed, grains);
        }
        bed.walls(1, smooth(), smooth());
        agrees_with_all_pairs(&bed, 1000);
    }
    let mut bed = setting_of(DVec3::new(9.0, 21.0, 13.0), [2, 2, 2]);
    agrees_with_all_pairs(&bed, 2000);
    bed.walls(2, smooth(), smooth());
    agrees_with_all_pairs(&bed, 2000);
}

/// Neighbours of a grain of a cubic lattice in each bin, from g.
fn neighbours<V: Vector>(per_axis: usize, spacing: f64) -> (Vec<f64>, f64) {
    let bed = setting_of(V::from_fn(|_| spacing * per_axis as f64), [4; 3]);
    let number = per_axis.pow(V::DIMENSION as u32);
    let place = |k: usize, axis: usize| (k / per_axis.pow(axis as u32) % per_axis) as f64 * spacing;
    let positions = (0..number).map(|k| V::from_fn(|axis| place(k, axis) + 0.3)).collect();
    let measure = PairCorrelation::new(&bed.setting).unwrap();
    let [g, _] = measure.look(&at_rest(&bed, positions));
    let sphere = |bin: usize| V::sphere_volume(2.0 * bin as f64 * measure.width);
    let density = (number - 1) as f64 / bed.setting.size.product();
    let found = g.iter().enumerate().map(|(bin, g)| g * density * (sphere(bin + 1) - sphere(bin))).collect();
    (found, measure.width)
}

/// Points of the lattice of unit spacing with a coordinate up to ±5 and this squared distance.
fn points(dimension: u32, square: i64) -> usize {
    let coordinate = |k: i64, axis: u32| k / 11_i64.pow(axis) % 11 - 5;
    let square_of = |k: i64| (0..dimension).map(|axis| coordinate(k, axis).pow(2)).sum::<i64>();
    (0..11_i64.pow(dimension)).filter(|&k| square_of(k) == square).count()
}

#[test]
fn a_lattice_has_its_shells() {
    // No two shells of spacing 1.03 share a bin, and none falls on an edge.
    for (dimension, (found, width)) in
        [(2, neighbours::<DVec2>(12, 1.03)), (3, neighbours::<DVec3>(11, 1.03))]
    {
        let mut expected = vec![0; found.len()];
        for square in 1..25 {
            let bin = (1.03 * f64::from(square).sqrt() / width) as usize;
            if bin < found.len() {
                expected[bin] += points(dimension, i64::from(square));
            }
        }
        assert_eq!(expected[20], 2 * dimension as usize);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected as f64).abs() < 1e-9, "{found} {expected}");
        }
    }
    // One lattice vector longer, the first shell is gone from its bin.
    assert_eq!(neighbours::<DVec2>(12, 1.06).0[20], 0.0);
}

#[test]
fn small_boxes_and_few_grains() {
    let mut bed = setting_of(DVec2::new(3.0, 20.0), [1, 4, 1]);
    assert_eq!(PairCorrelation::new(&bed.setting).unwrap().bins, 30);
    bed.walls(0, smooth(), smooth());
    bed.setting.counts_impacts = true;
    assert_eq!(PairCorrelation::new(&bed.setting).unwrap().bins, 20);
    let narrow = setting_of(DVec2::new(0.05, 20.0), [1, 4, 1]);
    assert!(PairCorrelation::new(&narrow.setting).is_none());
    for grains in [0, 1] {
        let measure = PairCorrelation::new(&bed.setting).unwrap();
        let [g, errors] = measure.look(&at_rest(&bed, vec![DVec2::ONE; grains]));
        assert!(g.iter().chain(&errors).all(|x| x.is_nan()));
    }
}

#[test]
fn recordings_are_averaged_and_resume() {
    let bed = setting_of(DVec2::splat(8.0), [2, 2, 1]);
    let states = bed.random_states(20, 200);
    assert_resumes(|| Box::new(PairCorrelation::new(&bed.setting).unwrap()), &states);
    let mut measure = PairCorrelation::new(&bed.setting).unwrap();
    states.iter().for_each(|state| drop(show(&mut measure, state)));
    let (gas, totals) = (&states[19].0, Totals::default());
    let (profiles, _) = measure.conclusion(&Snapshot::new(gas, &totals), 10.0);
    let late: Vec<f64> = states[10..].iter().map(|(gas, _)| measure.look(gas)[0][50]).collect();
    // The ends stand for half as much time.
    let late = late.iter().sum::<f64>() - 0.5 * (late[0] + late[9]);
    assert!((profiles[0].values[1][50] - late / 9.0).abs() < 1e-14 && profiles[0].values[2][50] > 0.0);
}

#[test]
fn threads_change_no_bit() {
    let mut bed = setting_of(DVec3::splat(12.0), [3, 3, 3]);
    bed.walls(0, smooth(), smooth());
    let gas = at_rest(&bed, random_positions(4, 3000, bed.setting.size));
    let measure = PairCorrelation::new(&bed.setting).unwrap();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| measure.look(&gas))
    };
    assert_eq!(with(1), with(5));
}
