//! Excluded volume (Müller 2001, figure 2.7): what carries load and what does not.

use std::collections::BTreeMap;

use grainflow::statistics::mean;

use super::trial::{column, for_each, run, scenario};

const SEEDS: [u64; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

fn settled(seeds: &[u64], sets: &[&str]) -> Vec<BTreeMap<String, f64>> {
    for_each(seeds, |&seed| run(&scenario("sedimentation", seed, sets)))
}

/// A hundred disks that fill their cells from below have their centre at 0.0016; a hexagonal
/// packing at rest has it at 0.0022. The grid may cost a quarter of a cell between the two.
fn stands(runs: &[BTreeMap<String, f64>]) -> bool {
    let heights = column(runs, "centre_of_mass_height");
    let mean = mean(&heights).unwrap();
    println!("centre of mass {mean:.6}: {heights:.6?}");
    (0.0016..=0.0019).contains(&mean) && heights.iter().all(|&height| height < 0.0021)
}

/// Kinetic energy per grain and unit of mass below 10⁻⁵ J/kg: 4 mm/s, a drop from a thousandth of a diameter.
fn rests(runs: &[BTreeMap<String, f64>]) -> bool {
    let energies = column(runs, "kinetic_energy_final");
    println!("kinetic energy of all {energies:?}");
    energies.iter().all(|energy| energy / 100.0 < 1e-5)
}

#[test]
fn a_bed_stands_and_rests() {
    let runs = settled(&SEEDS, &[]);
    assert!(stands(&runs) && rests(&runs));
    // Cells for three grains, and grains displaced into full cells, put the bed elsewhere.
    assert!(!stands(&settled(&SEEDS[..2], &["engine.hsmc.maximum_volume_fraction=0.6"])));
    assert!(!stands(&settled(&SEEDS[..2], &["engine.hsmc.displacement=thesis"])));
    // Where nothing is lost, nothing rests.
    let elastic = ["particles.restitution=1.0", "engine.hsmc.cell_restitution=1.0"];
    assert!(!rests(&settled(&SEEDS[..2], &elastic)));
}

#[test]
fn points_sink_into_the_floor() {
    let runs = settled(&SEEDS[..4], &["engine.kind=dsmc"]);
    let heights = column(&runs, "centre_of_mass_height");
    println!("dsmc: {heights:.6?}");
    assert!(heights.iter().all(|&height| height < 0.0002));
    assert!(!stands(&runs));
}
