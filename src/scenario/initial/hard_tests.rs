//! States of hard grains: nothing overlaps, numbers and temperatures are exact.

use glam::{DVec2, DVec3};

use super::*;
use crate::matter::overlaps::overlaps;
use crate::scenario::model::AnyScenario;
use crate::scenario::{Overrides, parse};

const HEAD: &str =
    "[engine]\nkind = 'event-driven'\n[run]\ntime = 1\n[initial]\nvelocities = { maxwell = 1.7 }\n";
const MIXTURE: &str =
    "species = [{ diameter = 1, mass = 1, share = 2 }, { diameter = 1.4, mass = 3, share = 1 }]\n";

fn flat(sets: &[&str], particles: &str) -> Scenario<DVec2> {
    let text = format!(
        "dimension = 2\n{HEAD}[domain]\nsize = [20, 30]\n[particles]\nrestitution = 0.9\n{particles}"
    );
    let overrides = Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Default::default() };
    match parse("flat", &text, &overrides).unwrap_or_else(|error| panic!("{error}")) {
        AnyScenario::Two(scenario) => scenario,
        AnyScenario::Three(_) => unreachable!("the dimension is 2"),
    }
}

fn deep(sets: &[&str], particles: &str) -> Scenario<DVec3> {
    let text = format!(
        "dimension = 3\n{HEAD}[domain]\nsize = [8, 9, 10]\n[particles]\nrestitution = 0.9\n{particles}"
    );
    let overrides = Overrides { sets: sets.iter().map(ToString::to_string).collect(), ..Default::default() };
    match parse("deep", &text, &overrides).unwrap_or_else(|error| panic!("{error}")) {
        AnyScenario::Three(scenario) => scenario,
        AnyScenario::Two(_) => unreachable!("the dimension is 3"),
    }
}

/// Builds the state of `scenario` and asserts that it is one of hard grains.
fn hard<V: Vector>(scenario: &Scenario<V>) -> Gas<V> {
    let gas = build(scenario, None).unwrap();
    assert_eq!(gas.len(), scenario.count as usize);
    // Open faces keep their distance as well.
    let walls = std::array::from_fn(|axis| [!scenario.boundary.is_periodic(axis); 2]);
    assert_eq!(overlaps(&gas, walls), 0);
    gas
}

const WALLS: &str = "boundary.x={lower={wall='smooth'},upper={wall='smooth'}}";
const OPEN: &str = "boundary.y='open'";

#[test]
fn grains_put_in_one_by_one_do_not_overlap() {
    for particles in ["volume_fraction = 0.4\n", &format!("volume_fraction = 0.38\n{MIXTURE}")] {
        for sets in [&[][..], &[WALLS], &[WALLS, OPEN]] {
            hard(&flat(sets, particles));
            let thinner = [sets, &["particles.volume_fraction=0.29"]].concat();
            hard(&deep(&thinner, particles));
        }
    }
    assert!(has_room(&flat(&[], "volume_fraction = 0.4\n")));
    assert!(!has_room(&flat(&[], "volume_fraction = 0.42\n")));
}

#[test]
fn lattices_do_not_overlap_up_to_dense_packings() {
    let lattice = "initial.positions=lattice";
    for count in [1, 7, 150, 599, 600, 620] {
        for sets in [&[lattice][..], &[lattice, WALLS], &[lattice, WALLS, OPEN]] {
            hard(&flat(sets, &format!("count = {count}\n")));
        }
    }
    for count in [1, 50, 700, 850] {
        for sets in [&[lattice][..], &[lattice, WALLS]] {
            hard(&deep(sets, &format!("count = {count}\n")));
        }
    }
}

#[test]
fn a_mixture_has_exact_numbers_and_an_exact_temperature() {
    let scenario = flat(&[], &format!("count = 100\n{MIXTURE}"));
    assert_eq!(scenario.species_counts, [67, 33]);
    let gas = hard(&scenario);
    let species = gas.columns().species.as_ref().unwrap();
    assert_eq!(species.iter().filter(|&&species| species == 1).count(), 33);
    // Mixed in space: both halves have some of each.
    let large = (0..100).filter(|&row| species[row] == 1 && gas.positions()[row].y < 15.0).count();
    assert!((8..26).contains(&large), "{large}");
    let mass = |row: usize| gas.grain_at(row).mass;
    let energy: f64 = (0..100).map(|row| mass(row) * gas.velocities()[row].length_squared()).sum();
    assert!((energy / 200.0 / 1.7 - 1.0).abs() < 1e-13, "{}", energy / 200.0);
    let momentum = (0..100).fold(DVec2::ZERO, |sum, row| sum + gas.velocities()[row] * mass(row));
    assert!(momentum.length() < 1e-12, "{momentum}");
    let volume = std::f64::consts::FRAC_PI_4 * (67.0 + 33.0 * 1.96);
    assert!((scenario.volume_fraction() - volume / 600.0).abs() < 1e-14);
}

#[test]
fn rough_grains_begin_without_spin_and_smooth_ones_have_none() {
    assert_eq!(hard(&flat(&[], "count = 3\n")).columns().spins, None);
    let rough = flat(&[], "count = 3\ntangential_restitution = 0.5\n");
    assert_eq!(rough.roughness.unwrap().reduced_inertia, 0.5);
    assert_eq!(hard(&rough).columns().spins, Some(vec![[0.0]; 3]));
    assert_eq!(deep(&[], "count = 3\ntangential_restitution = 0\n").roughness.unwrap().reduced_inertia, 0.4);
}

#[test]
fn overlaps_of_a_log_are_counted_and_refused() {
    let scenario = flat(&["initial={positions={log='a.mcap'}}"], "count = 3\n");
    let columns = |x: f64| Columns {
        positions: vec![DVec2::ONE, DVec2::new(x, 1.0), DVec2::new(19.9, 1.0)],
        velocities: vec![DVec2::ONE; 3],
        ids: vec![0, 1, 2],
        spins: None,
        species: None,
    };
    assert_eq!(build(&scenario, Some(columns(1.9))), Err(InitialError::Overlaps { number: 1 }));
    assert!(build(&scenario, Some(columns(2.0))).is_ok());
}
