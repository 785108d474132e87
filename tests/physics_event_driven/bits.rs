//! The same bits, wherever somebody looks and wherever a run is taken up again.

use super::drive::{Drive, STRUCTURES, faces, laws, restitution, scattered, wall};
use glam::{DVec2, DVec3};
use grainflow::engine::Horizon;
use grainflow::engine::event_driven::laws::{Growth, Laws};
use grainflow::engine::event_driven::rules::{Cure, Structure};
use grainflow::law::boundary::{Face, WallKind};
use grainflow::law::roughness::Roughness;
use grainflow::matter::grain::Grain;
use grainflow::matter::state_hash::state_hash;
use grainflow::space::Vector;

/// A kind of matter with everything of one sort.
struct Matter<V> {
    name: &'static str,
    laws: Laws<V>,
    grains: Vec<(V, V)>,
    species: Vec<u8>,
}

impl<V: Vector> Matter<V> {
    fn gas(name: &'static str, per_axis: usize, spacing: f64) -> Self {
        let laws = laws::<V>(V::from_fn(|_| spacing * per_axis as f64));
        let grains = scattered::<V>(per_axis, spacing, 0.4 * (spacing - 1.0));
        Matter { name, laws, grains, species: Vec::new() }
    }

    /// Every sort.
    fn all(per_axis: usize, spacing: f64) -> Vec<Self> {
        let gas = |name| Self::gas(name, per_axis, spacing);
        let mut shaken = gas("shaken from below, open above, under contact time");
        shaken.laws.gravity = V::along(1, -0.3);
        let floor = wall(0.9, WallKind::Vibrating { amplitude: 0.2, frequency: 0.7 });
        shaken.laws.boundary.axes[1] = faces(floor, Face::Open);
        shaken.laws.cure.contact_time = Some(0.02);
        shaken.laws.restitution = restitution(0.8);
        let mut rough = gas("rough, mixed, rotated, between statistical walls");
        rough.laws.roughness = Some(Roughness { tangential_restitution: 0.3, reduced_inertia: 0.4 });
        rough.laws.species = vec![rough.laws.grain, Grain { diameter: 0.7, mass: 0.4 }];
        rough.species = (0..rough.grains.len()).map(|k| (k % 2) as u8).collect();
        let statistical = wall(0.9, WallKind::Statistical { reversal_probability: 0.4 });
        rough.laws.boundary.axes[0] = faces(statistical, statistical);
        rough.laws.cure = Cure { elastic_below: Some(0.01), rotation: Some(0.1), ..Cure::default() };
        rough.laws.restitution = restitution(0.8);
        let mut growing = gas("growing");
        growing.laws.growth = Growth { start: 0.9, rate: 0.01 };
        vec![gas("elastic"), shaken, rough, growing]
    }

    fn drive(&self, structure: Structure) -> Drive<V> {
        let mut drive = Drive::mixed(&self.laws, structure, &self.grains, &self.species);
        if self.laws.roughness.is_some() {
            drive.spin(&vec![V::Spin::default(); self.grains.len()]);
        }
        drive
    }
}

/// The rows in their order, all their numbers, and what was counted.
fn end_of<V: Vector>(drive: &Drive<V>) -> (String, Vec<u32>, u64, u64, String) {
    let counts = &drive.counts;
    let ids = drive.gas.ids().to_vec();
    let columns = drive.gas.columns();
    let rows = format!("{} {:?} {:?}", state_hash(&drive.gas), columns.velocities, columns.spins);
    (rows, ids, counts.collisions, counts.removed, format!("{:?}", drive.events))
}

const END: f64 = 8.0;

fn same_bits<V: Vector>(per_axis: usize, spacing: f64) {
    for matter in Matter::<V>::all(per_axis, spacing) {
        for structure in [Structure::Automatic, Structure::Cells, Structure::NeighbourLists] {
            let mut whole = matter.drive(structure);
            whole.to(END);
            let expected = end_of(&whole);
            let mut looked_at = matter.drive(structure);
            let mut k = 0;
            while looked_at.gas.time() < END {
                k += 1;
                let time = (looked_at.gas.time() + 0.003 * f64::from(k % 9)).min(END);
                let collisions = if k % 9 == 0 { 1 } else { u64::MAX };
                looked_at.step(Horizon { time: if k % 9 == 0 { END } else { time }, collisions }).unwrap();
            }
            assert_eq!(end_of(&looked_at), expected, "{} {structure:?}, looked at", matter.name);
            let mut restarted = matter.drive(structure);
            for cut in [0.0, 0.31, 1.7, 2.0, 4.4, 6.9, 7.99] {
                restarted.to(cut);
                restarted.restart();
            }
            restarted.to(END);
            assert_eq!(end_of(&restarted), expected, "{} {structure:?}, restarted", matter.name);
            assert!(whole.counts.collisions as usize > 4 * matter.grains.len(), "{}", matter.name);
            assert_eq!(whole.counts.removed > 0, matter.name.contains("open"), "{}", matter.name);
            assert_eq!(whole.events.cured > 0, matter.laws.cure != Cure::default(), "{}", matter.name);
        }
    }
}

#[test]
fn neither_horizons_nor_restarts_change_bits_in_2d() {
    same_bits::<DVec2>(20, 1.3);
}

#[test]
fn neither_horizons_nor_restarts_change_bits_in_3d() {
    same_bits::<DVec3>(8, 1.25);
}

/// Many years of lists that are renewed again and again, with restarts on the way: the rows keep their order.
#[test]
fn long_runs_with_lists_may_be_restarted() {
    let matter = Matter::<DVec2>::gas("lists", 18, 1.15);
    let mut whole = matter.drive(Structure::NeighbourLists);
    let mut restarted = matter.drive(Structure::NeighbourLists);
    for k in 1..=60 {
        whole.to(f64::from(k));
        restarted.to(f64::from(k));
        assert_eq!(end_of(&restarted), end_of(&whole), "{k}");
        restarted.restart();
    }
    assert!(whole.events.list_renewals > 10_000, "{:?}", whole.events.list_renewals);
}

/// Rounding apart, both structures find the same collisions for as long as rounding has not grown.
#[test]
fn cells_and_lists_find_the_same_collisions() {
    for matter in Matter::<DVec2>::all(16, 1.3) {
        let mut drives = STRUCTURES.map(|structure| matter.drive(structure));
        let mut worst = 0.0_f64;
        for k in 0..3 * matter.grains.len() {
            drives.iter_mut().for_each(|drive| drive.collide(1));
            let apart = (drives[0].gas.time() - drives[1].gas.time()).abs();
            assert!(apart < 1e-8, "{} {k} {apart}", matter.name);
            worst = worst.max(apart);
        }
        println!("{}: cells and lists, times to {worst:.1e}", matter.name);
    }
}
