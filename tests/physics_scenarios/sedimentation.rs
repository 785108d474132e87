//! Excluded volume (Müller 2001, figure 2.7): what carries load and what does not.

use std::collections::BTreeMap;

use grainflow::observe::moments::kinetic_energy;
use grainflow::statistics::{mean, standard_error};

use super::trial::{advance_until, column, figures, for_each, scenario, start};

const SEEDS: [u64; 16] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// Steps at the end of a run, a tenth of it, over which the energy of a bed at rest is averaged.
const LAST_STEPS: u32 = 1000;

/// The figures of runs, with the mean kinetic energy of their last steps as `kinetic_energy_mean`.
fn settled(seeds: &[u64], sets: &[&str]) -> Vec<BTreeMap<String, f64>> {
    for_each(seeds, |&seed| {
        let scenario = scenario("sedimentation", seed, sets);
        let mut simulation = start(&scenario);
        let (mut energy, mut steps) = (0.0, 0);
        advance_until(&mut simulation, |simulation| {
            if simulation.gas().time() > 1.8 && steps < LAST_STEPS {
                energy += kinetic_energy(simulation.gas());
                steps += 1;
            }
            false
        });
        let mut figures = figures(&mut simulation);
        figures.insert("kinetic_energy_mean".into(), energy / f64::from(steps));
        figures
    })
}

/// A hundred disks that fill their cells from below have their centre at 0.0016; a hexagonal
/// packing at rest has it at 0.0022. The grid may cost a quarter of a cell between the two.
fn stands(runs: &[BTreeMap<String, f64>]) -> bool {
    let heights = column(runs, "centre_of_mass_height");
    let mean = mean(&heights).unwrap();
    println!("centre of mass {mean:.6}: {heights:.6?}");
    (0.0016..=0.0019).contains(&mean) && heights.iter().all(|&height| height < 0.0021)
}

/// Kinetic energy per grain and unit of mass below 10⁻⁵ J/kg, with three standard errors: 4 mm/s, a drop from a
/// thousandth of a diameter. Single runs go on at 0.3 to 1.4 · 10⁻⁵: a few grains are always on their way to a place that
/// has become free.
fn rests(runs: &[BTreeMap<String, f64>]) -> bool {
    let energies = column(runs, "kinetic_energy_mean");
    println!("kinetic energy of all {energies:?}");
    (mean(&energies).unwrap() + 3.0 * standard_error(&energies).unwrap()) / 100.0 < 1e-5
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
