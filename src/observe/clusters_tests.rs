use super::*;
use crate::engine::report::Totals;
use crate::matter::grain::Grain;
use crate::observe::testing::{Bed, assert_resumes, random_positions, setting_of, show, smooth};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

fn census<V: Vector>(bed: &Bed<V>, positions: Vec<V>) -> Census {
    let velocities = vec![V::ZERO; positions.len()];
    let mut census = Census::of(&bed.gas(0.0, positions, velocities));
    census.sizes.sort_unstable();
    census
}

#[test]
fn placed_grains_with_known_clusters() {
    let bed = setting_of(DVec2::splat(10.0), [5, 5, 1]);
    // A pair across the face of x, a bent three, one alone: 1.09 links, 1.11 does not.
    let pair = [DVec2::new(0.3, 2.0), DVec2::new(9.3, 2.0)];
    let three = [DVec2::new(4.0, 6.0), DVec2::new(5.09, 6.0), DVec2::new(5.09, 7.09)];
    let alone = [DVec2::new(6.2, 6.0)];
    let positions: Vec<DVec2> = pair.into_iter().chain(three).chain(alone).collect();
    let state = (bed.gas(0.0, positions, vec![DVec2::ZERO; 6]), Totals::default());
    let mut measure = Clusters::new(&bed.setting);
    let third = 1.0 / 3.0;
    let expected = [3.0, 0.5, 2.0, 14.0 * third, 1.0, 5.0 * third, 0.0, 0.0];
    for (found, expected) in show(&mut measure, &state).into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    let (gas, totals) = &state;
    let profiles = measure.profiles(&Snapshot::new(gas, totals));
    // Sizes 1; 2 and 3.
    assert_eq!(profiles[0].values[..3], [vec![1.0, 2.0], vec![1.0, 1.0], vec![1.0, 2.0]]);
    assert_eq!(profiles[0].values[3], [1.0 / 6.0, 5.0 / 6.0]);
}

#[test]
fn every_grain_knows_the_size_of_its_cluster() {
    let bed = setting_of(DVec2::splat(10.0), [5, 5, 1]);
    let positions = vec![DVec2::new(0.3, 2.0), DVec2::new(4.0, 6.0), DVec2::new(9.3, 2.0)];
    let gas = bed.gas(0.0, positions.clone(), vec![DVec2::ZERO; 3]);
    assert_eq!(cluster_sizes(gas.grid(), &positions, &[1.0; 3]), [2, 1, 2]);
}

#[test]
fn a_chain_around_the_box_percolates_along_its_axis_alone() {
    let bed = setting_of(DVec3::splat(10.0), [5; 3]);
    let chain: Vec<DVec3> = (0..10).map(|k| DVec3::new(0.5, f64::from(k), 0.5)).collect();
    let whole = census(&bed, chain.clone());
    assert_eq!(whole, Census { sizes: vec![10], percolates: [false, true, false] });
    let broken = census(&bed, chain[1..].to_vec());
    assert_eq!(broken, Census { sizes: vec![9], percolates: [false; 3] });
    // A chain that crosses a face and ends does not.
    let crossing: Vec<DVec3> = (0..6).map(|k| DVec3::new(f64::from(7 + k) % 10.0, 5.0, 5.0)).collect();
    assert_eq!(census(&bed, crossing), Census { sizes: vec![6], percolates: [false; 3] });
}

#[test]
fn walls_do_not_link() {
    let mut bed = setting_of(DVec2::splat(10.0), [5, 5, 1]);
    let pair = vec![DVec2::new(0.5, 2.0), DVec2::new(9.5, 2.0)];
    assert_eq!(census(&bed, pair.clone()).sizes, [2]);
    bed.walls(0, smooth(), smooth());
    assert_eq!(census(&bed, pair).sizes, [1, 1]);
    let columns = Measure::<DVec2>::columns(&Clusters::new(&bed.setting));
    assert_eq!(columns.last().map(|column| column.name.as_str()), Some("percolates_y"));
    assert_eq!(columns.len(), 7);
}

#[test]
fn grains_of_a_mixture_link_by_their_surfaces() {
    let bed = setting_of(DVec2::splat(10.0), [5, 5, 1]);
    let places = [1.0, 2.6, 3.8].map(|x| DVec2::new(x, 5.0)).to_vec();
    let mut gas = bed.gas(0.0, places, vec![DVec2::ZERO; 3]);
    gas.species = vec![Grain { diameter: 1.0, mass: 1.0 }, Grain { diameter: 2.0, mass: 1.0 }];
    // Big and small link below 1.65; two small ones below 1.1.
    let species = gas.positions().iter().map(|p| u8::from(p.x < 2.0)).collect();
    gas.parts_mut().2.species = Some(species);
    let mut sizes = Census::of(&gas).sizes;
    sizes.sort_unstable();
    assert_eq!(sizes, [1, 2]);
}

#[test]
fn nobody_and_one() {
    let bed = setting_of(DVec2::splat(4.0), [2, 2, 1]);
    let of = |places: Vec<DVec2>| {
        let velocities = vec![DVec2::ZERO; places.len()];
        show(&mut Clusters::new(&bed.setting), &(bed.gas(0.0, places, velocities), Totals::default()))
    };
    let nobody = of(Vec::new());
    assert!(nobody[0] == 0.0 && nobody[1..6].iter().all(|value| value.is_nan()));
    assert_eq!(of(vec![DVec2::ONE]), [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn it_resumes() {
    let bed = setting_of(DVec3::splat(4.0), [2, 2, 2]);
    assert_resumes(|| Box::new(Clusters::new(&bed.setting)), &bed.random_states(4, 20));
}

/// Sizes by asking every pair.
fn slowly<V: Vector>(bed: &Bed<V>, positions: &[V]) -> Vec<u32> {
    let mut free: Vec<usize> = (0..positions.len()).collect();
    let mut sizes = Vec::new();
    while let Some(first) = free.pop() {
        let (mut cluster, mut done) = (vec![first], 0);
        while done < cluster.len() {
            let here = positions[cluster[done]];
            let is_linked =
                |other: &usize| bed.setting.grid.separation(here, positions[*other]).length() < 1.1;
            let (linked, rest) = free.into_iter().partition(is_linked);
            free = rest;
            let linked: Vec<usize> = linked;
            cluster.extend(linked);
            done += 1;
        }
        sizes.push(cluster.len() as u32);
    }
    sizes.sort_unstable();
    sizes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn random_grains_agree_with_the_slow_way(seed in 0_u64..1000, grains in 1_usize..150, side in 4.0_f64..12.0) {
        let flat = setting_of(DVec2::new(side, 9.0), [3, 3, 1]);
        let positions = random_positions(seed, grains, flat.setting.size);
        prop_assert_eq!(census(&flat, positions.clone()).sizes, slowly(&flat, &positions));
        let solid = setting_of(DVec3::new(5.0, side, 6.0), [2, 3, 2]);
        let positions = random_positions(seed, grains, solid.setting.size);
        prop_assert_eq!(census(&solid, positions.clone()).sizes, slowly(&solid, &positions));
    }
}
