//! Two hundred grains against the reference simulator, event by event.

use super::drive::{Drive, STRUCTURES, faces, laws, restitution, scatter, scattered, wall};
use super::reference::{Reference, SmoothWall};
use glam::{DVec2, DVec3};
use grainflow::engine::event_driven::laws::Laws;
use grainflow::engine::event_driven::rules::Structure;
use grainflow::law::boundary::WallKind;
use grainflow::law::restitution::{Constant, RestitutionLaw};
use grainflow::matter::grain::Grain;
use grainflow::space::Vector;
use grainflow::statistics::average;

/// What is compared.
struct Setup<V> {
    laws: Laws<V>,
    grains: Vec<(V, V)>,
    species: Vec<u8>,
}

impl<V: Vector> Setup<V> {
    fn new(per_axis: usize, spacing: f64) -> Self {
        let laws = laws::<V>(V::from_fn(|_| spacing * per_axis as f64));
        let grains = scattered::<V>(per_axis, spacing, 0.4 * (spacing - 1.0));
        Setup { laws, grains, species: Vec::new() }
    }

    fn with_restitution(mut self, r: f64) -> Self {
        self.laws.restitution = restitution(r);
        self
    }

    /// A field along the second axis, between a floor and a ceiling.
    fn in_a_field(mut self, g: f64) -> Self {
        self.laws.gravity = V::along(1, -g);
        let smooth = wall(0.9, WallKind::Smooth);
        self.laws.boundary.axes[1] = faces(smooth, smooth);
        self
    }

    fn mixed(mut self) -> Self {
        self.laws.species =
            vec![self.laws.grain, Grain { diameter: 0.5, mass: 0.2 }, Grain { diameter: 0.8, mass: 3.0 }];
        self.species = (0..self.grains.len()).map(|k| (k % 3) as u8).collect();
        self
    }

    /// Other velocities.
    fn replica(mut self, number: usize) -> Self {
        for (k, (_, velocity)) in self.grains.iter_mut().enumerate() {
            *velocity = V::from_fn(|axis| scatter(3 * k + axis + 1000 * number));
        }
        self
    }

    fn drive(&self, structure: Structure) -> Drive<V> {
        Drive::mixed(&self.laws, structure, &self.grains, &self.species)
    }

    fn reference<const D: usize>(&self) -> Reference<D> {
        let array = |v: V| std::array::from_fn(|axis| v[axis]);
        let RestitutionLaw::Constant(Constant(r)) = self.laws.restitution else { unreachable!() };
        let mut reference = Reference::periodic(array(self.laws.size), 1.0, r);
        reference.gravity = array(self.laws.gravity);
        for (axis, side, wall) in self.laws.boundary.walls() {
            reference.walls.push(SmoothWall {
                axis,
                upper: side == 1,
                restitution: wall.restitution,
                amplitude: 0.0,
                angular_frequency: 0.0,
                holds_surfaces: true,
            });
        }
        reference.positions = self.grains.iter().map(|grain| array(grain.0)).collect();
        reference.velocities = self.grains.iter().map(|grain| array(grain.1)).collect();
        if !self.species.is_empty() {
            let kind = |&species: &u8| self.laws.species[species as usize];
            reference.diameters = self.species.iter().map(|s| kind(s).diameter).collect();
            reference.masses = self.species.iter().map(|s| kind(s).mass).collect();
        }
        reference
    }
}

/// The first `collisions` of both: partners and times. Grains touch where they have collided, and nowhere else.
fn same_events<V: Vector, const D: usize>(name: &str, setup: &Setup<V>, collisions: usize) {
    let mut reference = setup.reference::<D>();
    reference.run_collisions(collisions);
    for structure in STRUCTURES {
        let mut drive = setup.drive(structure);
        let mut worst = 0.0_f64;
        for (k, hit) in reference.pair_hits.iter().enumerate() {
            let before: Vec<V> = (0..setup.grains.len() as u32).map(|id| drive.velocity(id)).collect();
            let (was, hits) = (drive.gas.time(), drive.events.wall_hits);
            drive.collide(1);
            let flown = setup.laws.gravity * (drive.gas.time() - was);
            let changed: Vec<usize> = (0..before.len())
                .filter(|&id| {
                    (drive.velocity(id as u32) - before[id] - flown).length() > 1e-9 * (1.0 + flown.length())
                })
                .collect();
            for grain in hit.grains {
                assert!(changed.contains(&grain), "{name} {structure:?} {k}: {hit:?} {changed:?}");
            }
            // Beside the two only those who have hit a wall in between.
            let wall_hits = (drive.events.wall_hits - hits) as usize;
            assert!(changed.len() <= 2 + wall_hits, "{name} {structure:?} {k}: {hit:?} {changed:?}");
            let error = (drive.gas.time() - hit.time).abs();
            assert!(error < 1e-8, "{name} {structure:?} {k}: {error}");
            worst = worst.max(error);
        }
        assert_eq!(drive.events.wall_hits as usize, reference.wall_hits.len(), "{name}");
        println!("{name} {structure:?}: {collisions} collisions, times to {worst:.1e}");
    }
}

// 14² = 196 at ν = 0.3; 6³ = 216 at ν = 0.3. Five collisions per particle are 490 and 540.
const FLAT: (usize, f64) = (14, 1.618);
const DEEP: (usize, f64) = (6, 1.204);

#[test]
fn elastic_gases_go_event_by_event() {
    same_events::<DVec2, 2>("2D", &Setup::new(FLAT.0, FLAT.1), 490);
    same_events::<DVec3, 3>("3D", &Setup::new(DEEP.0, DEEP.1), 540);
}

#[test]
fn lossy_gases_go_event_by_event() {
    same_events::<DVec2, 2>("2D r = 0.8", &Setup::new(FLAT.0, FLAT.1).with_restitution(0.8), 490);
    same_events::<DVec3, 3>("3D r = 0.8", &Setup::new(DEEP.0, DEEP.1).with_restitution(0.8), 540);
}

#[test]
fn mixtures_go_event_by_event() {
    same_events::<DVec2, 2>("2D mixture", &Setup::new(FLAT.0, 1.3).mixed(), 490);
    same_events::<DVec3, 3>("3D mixture", &Setup::new(DEEP.0, 1.1).mixed().with_restitution(0.9), 540);
}

#[test]
fn falling_gases_go_event_by_event() {
    same_events::<DVec2, 2>("2D field", &Setup::new(FLAT.0, FLAT.1).in_a_field(0.3), 490);
    same_events::<DVec3, 3>("3D field", &Setup::new(DEEP.0, DEEP.1).in_a_field(0.3).mixed(), 540);
}

/// Beyond the horizon of predictability: collisions in a given time and the energy that is left, over 20 replicas.
#[test]
fn rates_and_energies_agree_beyond() {
    let end = 6.0;
    let mut found: [[Vec<f64>; 2]; 2] = Default::default();
    for number in 0..20 {
        let setup = Setup::<DVec2>::new(10, 1.618).with_restitution(0.8).replica(number);
        let mut drive = setup.drive(STRUCTURES[number % 2]);
        let mut reference = setup.reference::<2>();
        let start = reference.energy();
        drive.to(end);
        reference.run_to(end);
        found[0][0].push(drive.counts.collisions as f64);
        found[1][0].push(reference.pair_hits.len() as f64);
        found[0][1].push(drive.energy() / start);
        found[1][1].push(reference.energy() / start);
    }
    for (quantity, name) in ["collisions", "energy"].into_iter().enumerate() {
        let [ours, theirs] = [0, 1].map(|k| average(&found[k][quantity]).unwrap());
        let error = ours.standard_error.unwrap().hypot(theirs.standard_error.unwrap());
        println!("{name}: {:.4} and {:.4} ± {error:.4}", ours.value, theirs.value);
        assert!((ours.value - theirs.value).abs() < 3.0 * error);
        assert!(error < 0.05 * ours.value, "no power");
    }
}
