//! The engine of the library, driven by hand.

use grainflow::engine::event_driven::EventDriven;
use grainflow::engine::event_driven::laws::{Growth, Laws};
use grainflow::engine::event_driven::rules::{Cure, Structure};
use grainflow::engine::report::{Counts, EventCounts};
use grainflow::engine::{Engine, EngineError, Horizon, NoLaps};
use grainflow::law::boundary::{AxisBoundary, Boundary, Face, Wall, WallKind};
use grainflow::law::restitution::{Constant, RestitutionLaw};
use grainflow::matter::clock::Clock;
use grainflow::matter::columns::Columns;
use grainflow::matter::gas::Gas;
use grainflow::matter::grain::Grain;
use grainflow::matter::grid::Grid;
use grainflow::random::Streams;
use grainflow::space::Vector;

pub(crate) const STRUCTURES: [Structure; 2] = [Structure::Cells, Structure::NeighbourLists];

/// Grains of diameter 1 and mass 1 that lose nothing, in a periodic box without gravity.
pub(crate) fn laws<V: Vector>(size: V) -> Laws<V> {
    Laws {
        grain: Grain { diameter: 1.0, mass: 1.0 },
        species: Vec::new(),
        restitution: RestitutionLaw::Constant(Constant(1.0)),
        roughness: None,
        gravity: V::ZERO,
        size,
        boundary: Boundary::periodic(),
        cure: Cure::default(),
        growth: Growth::NONE,
        streams: Streams::new(7),
        seed: 7,
    }
}

pub(crate) fn restitution(r: f64) -> RestitutionLaw {
    RestitutionLaw::Constant(Constant(r))
}

pub(crate) fn wall<V>(restitution: f64, kind: WallKind<V>) -> Face<V> {
    Face::Wall(Wall { restitution, kind })
}

pub(crate) fn faces<V>(lower: Face<V>, upper: Face<V>) -> AxisBoundary<V> {
    AxisBoundary::Faces { lower, upper }
}

/// A vector in any dimension, from as many of the numbers as it needs.
pub(crate) fn vector<V: Vector>(numbers: [f64; 3]) -> V {
    V::from_fn(|axis| numbers[axis])
}

/// An engine with its gas, and everything that it has counted.
#[derive(Debug)]
pub(crate) struct Drive<V: Vector> {
    pub(crate) laws: Laws<V>,
    pub(crate) structure: Structure,
    pub(crate) engine: EventDriven<V>,
    pub(crate) gas: Gas<V>,
    pub(crate) counts: Counts<V>,
    pub(crate) events: EventCounts,
    /// Steps of the engine that may be made without any progress of time.
    pub(crate) patience: u32,
}

impl<V: Vector> Drive<V> {
    /// Grains at positions with velocities, numbered in this order.
    pub(crate) fn new(laws: &Laws<V>, structure: Structure, grains: &[(V, V)]) -> Self {
        Self::mixed(laws, structure, grains, &[])
    }

    /// The same with a species for each grain.
    pub(crate) fn mixed(laws: &Laws<V>, structure: Structure, grains: &[(V, V)], species: &[u8]) -> Self {
        let periodic = [0, 1, 2].map(|axis| laws.boundary.is_periodic(axis));
        let grid = Grid::new(V::ZERO, laws.size, &[2; 3], &periodic);
        let next_id = grains.len() as u32;
        let columns = Columns {
            positions: grains.iter().map(|grain| grain.0).collect(),
            velocities: grains.iter().map(|grain| grain.1).collect(),
            ids: (0..next_id).collect(),
            spins: None,
            species: (!species.is_empty()).then(|| species.to_vec()),
        };
        let mut gas = Gas::restored(grid, laws.grain, columns, Clock::default(), next_id);
        gas.species.clone_from(&laws.species);
        let engine = EventDriven::new(laws.clone(), structure);
        let (counts, events) = Default::default();
        Drive { laws: laws.clone(), structure, engine, gas, counts, events, patience: 50 }
    }

    /// Gives grains spins `[id]`.
    pub(crate) fn spin(&mut self, spins: &[V::Spin]) {
        let ids = self.gas.ids().to_vec();
        self.gas.parts_mut().2.spins = Some(ids.iter().map(|&id| spins[id as usize]).collect());
    }

    /// One step of the engine.
    pub(crate) fn step(&mut self, horizon: Horizon) -> Result<u64, EngineError> {
        let report = self.engine.step(&mut self.gas, horizon, &mut NoLaps)?;
        self.counts.add(&report.counts);
        self.events.add(&report.events);
        Ok(report.counts.collisions)
    }

    /// Runs to `time`; fails where the engine goes on and on without getting anywhere.
    pub(crate) fn try_to(&mut self, time: f64) -> Result<(), EngineError> {
        let mut idle = 0;
        while self.gas.time() < time {
            let before = self.gas.time();
            self.step(Horizon { time, collisions: u64::MAX })?;
            idle = if self.gas.time() > before { 0 } else { idle + 1 };
            assert!(idle < self.patience, "the engine hangs at t = {before}");
        }
        Ok(())
    }

    pub(crate) fn to(&mut self, time: f64) {
        self.try_to(time).unwrap();
    }

    /// Runs for so many collisions of pairs.
    pub(crate) fn collide(&mut self, collisions: u64) {
        let end = self.counts.collisions + collisions;
        while self.counts.collisions < end {
            let collisions = end - self.counts.collisions;
            self.step(Horizon { time: f64::INFINITY, collisions }).unwrap();
        }
    }

    /// Takes the state out and puts it into a new engine.
    pub(crate) fn restart(&mut self) {
        let state = self.engine.state();
        self.engine = EventDriven::new(self.laws.clone(), self.structure);
        self.engine.restore(&state, &self.gas).unwrap();
    }

    fn row(&self, id: u32) -> usize {
        self.gas.ids().iter().position(|&other| other == id).unwrap()
    }
    pub(crate) fn position(&self, id: u32) -> V {
        self.gas.positions()[self.row(id)]
    }
    pub(crate) fn velocity(&self, id: u32) -> V {
        self.gas.velocities()[self.row(id)]
    }
    pub(crate) fn spin_of(&self, id: u32) -> V::Spin {
        self.gas.columns().spins.as_ref().unwrap()[self.row(id)]
    }

    /// Kinetic energy of the translation.
    pub(crate) fn energy(&self) -> f64 {
        let of_row =
            |(row, velocity): (usize, &V)| 0.5 * self.gas.grain_at(row).mass * velocity.length_squared();
        self.gas.velocities().iter().enumerate().map(of_row).sum()
    }
}

/// Asserts that two vectors agree to 10⁻¹².
#[track_caller]
pub(crate) fn near<V: Vector>(found: V, expected: V) {
    assert!((found - expected).length() < 1e-12, "{found:?} {expected:?}");
}

/// Asserts that two numbers agree to 10⁻¹².
#[track_caller]
pub(crate) fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

/// Grains on a lattice of `per_axis` sites of spacing `spacing`, jostled by a tenth of it, with scattered velocities.
pub(crate) fn scattered<V: Vector>(per_axis: usize, spacing: f64, jostle: f64) -> Vec<(V, V)> {
    let number = per_axis.pow(V::DIMENSION as u32);
    let grain = |k: usize| {
        let place = V::from_fn(|axis| {
            let site = (k / per_axis.pow(axis as u32) % per_axis) as f64 + 0.5;
            spacing * site + jostle * scatter(3 * k + axis + 70_000)
        });
        (place, V::from_fn(|axis| scatter(3 * k + axis)))
    };
    (0..number).map(grain).collect()
}

/// Numbers in [−1, 1) without a pattern.
pub(crate) fn scatter(k: usize) -> f64 {
    let x = ((k as f64 + 1.0) * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}
