//! Places and states made by hand, for the tests of measures.

use super::measure::{Measure, Snapshot};
use super::setting::Setting;
use crate::engine::report::{IMPACT_BINS, Totals};
use crate::law::boundary::{AxisBoundary, Boundary, Face, Wall, WallKind};
use crate::matter::clock::Clock;
use crate::matter::gas::Gas;
use crate::matter::grain::Grain;
use crate::matter::grid::Grid;
use crate::random::{Phase, Streams};
use crate::space::Vector;

/// A setting to be changed at will.
pub(crate) struct Bed<V: Vector> {
    pub(crate) setting: Setting<V>,
}

/// A gas and what happened to it.
pub(crate) type State<V> = (Gas<V>, Totals<V>);

/// A periodic box without gravity; grains of unit diameter and mass.
pub(crate) fn setting_of<V: Vector>(size: V, cells: [u32; 3]) -> Bed<V> {
    Bed {
        setting: Setting {
            gravity: V::ZERO,
            size,
            grid: Grid::new(V::ZERO, size, &cells, &[true; 3]),
            boundary: Boundary::periodic(),
            grain: Grain { diameter: 1.0, mass: 1.0 },
            species: 0,
            is_poured: false,
            roughness: None,
            counts_impacts: false,
        },
    }
}

impl<V: Vector> Bed<V> {
    /// Puts faces at the ends of `axis`.
    pub(crate) fn walls(&mut self, axis: usize, lower: Face<V>, upper: Face<V>) {
        self.setting.boundary.axes[axis] = AxisBoundary::Faces { lower, upper };
    }

    /// Grains in the box at `time`.
    pub(crate) fn gas(&self, time: f64, positions: Vec<V>, velocities: Vec<V>) -> Gas<V> {
        let Setting { grid, boundary, grain, .. } = &self.setting;
        let periodic: Vec<bool> = (0..V::DIMENSION).map(|axis| boundary.is_periodic(axis)).collect();
        let grid = Grid::new(grid.origin(), grid.size(), &grid.cells(), &periodic);
        let mut gas = Gas::new(grid, *grain, positions, velocities);
        gas.clock = Clock::restored(time, 0.0);
        gas
    }

    /// Random grains at `states` times 0, 1, 2 …, with totals that grow at random.
    pub(crate) fn random_states(&self, states: usize, grains: usize) -> Vec<State<V>> {
        let mut random = Streams::new(77).at(0, Phase::Collisions).stream(0);
        let mut totals = Totals::default();
        (0..states as u64)
            .map(|k| {
                let positions = random_positions(k, grains, self.setting.size);
                let gas = self.gas(k as f64, positions, random_velocities(1000 + k, grains));
                if k > 0 {
                    totals.collisions_per_particle += random.uniform();
                    totals.events.all += 1;
                    let bin = (random.uniform() * IMPACT_BINS as f64) as usize;
                    totals.events.impacts[bin.min(IMPACT_BINS - 1)] += grains as u64;
                    totals.counts.carried_momentum += random.uniform() * grains as f64;
                    for sides in &mut totals.counts.wall_momentum {
                        sides[0] += V::from_fn(|_| random.gaussian());
                        sides[1] += V::from_fn(|_| random.gaussian());
                    }
                }
                (gas, totals.clone())
            })
            .collect()
    }
}

/// A smooth elastic wall.
pub(crate) fn smooth<V: Vector>() -> Face<V> {
    Face::Wall(Wall { restitution: 1.0, kind: WallKind::Smooth })
}

/// A rough elastic wall.
pub(crate) fn rough<V: Vector>(velocity: V) -> Face<V> {
    Face::Wall(Wall { restitution: 1.0, kind: WallKind::Rough { velocity } })
}

/// Independent places in a box of `size` at the origin.
pub(crate) fn random_positions<V: Vector>(seed: u64, grains: usize, size: V) -> Vec<V> {
    let mut random = Streams::new(seed).at(0, Phase::InitialPositions).stream(0);
    (0..grains).map(|_| V::from_fn(|axis| size[axis] * random.uniform())).collect()
}

/// Independent Gaussian velocities of variance 1 along every axis.
pub(crate) fn random_velocities<V: Vector>(seed: u64, grains: usize) -> Vec<V> {
    let mut random = Streams::new(seed).at(0, Phase::InitialVelocities).stream(0);
    (0..grains).map(|_| V::from_fn(|_| random.gaussian())).collect()
}

/// Shows a measure one state, as a sample and as a recording; returns what it said.
pub(crate) fn show<V: Vector>(measure: &mut dyn Measure<V>, (gas, totals): &State<V>) -> Vec<f64> {
    let snapshot = Snapshot::new(gas, totals);
    measure.sample(&snapshot);
    let values = measure.values(&snapshot);
    assert_eq!(values.len(), measure.columns().len(), "{}", measure.name());
    for profile in measure.profiles(&snapshot) {
        assert_eq!(profile.columns.len(), profile.values.len());
    }
    values
}

/// Shows a measure all states; returns value and standard error of `figure` from `from` on.
pub(crate) fn figure_of<V: Vector>(
    measure: &mut dyn Measure<V>,
    states: &[State<V>],
    from: f64,
    figure: &str,
) -> (Option<f64>, Option<f64>) {
    for state in states {
        show(measure, state);
    }
    let (gas, totals) = states.last().unwrap();
    let (_, figures) = measure.conclusion(&Snapshot::new(gas, totals), from);
    let found = figures.iter().find(|f| f.name == figure).unwrap_or_else(|| panic!("no {figure}"));
    (found.value, found.standard_error)
}

/// Asserts that a measure which is saved and recalled in the middle ends with the same bits.
pub(crate) fn assert_resumes<V: Vector>(make: impl Fn() -> Box<dyn Measure<V>>, states: &[State<V>]) {
    let (before, after) = states.split_at(states.len() / 2);
    let mut first = make();
    for state in before {
        show(&mut *first, state);
    }
    let saved = first.memory();
    let mut second = make();
    assert!(second.recall(&saved), "{}", first.name());
    if !saved.is_empty() {
        // A memory of another length is none.
        let misread = [&saved[..], &[7.0]].concat();
        assert!(!second.recall(&misread), "{}", first.name());
    }
    let bits = |memory: Vec<f64>| memory.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(second.memory()), bits(saved));
    for state in after {
        let said = (show(&mut *first, state), show(&mut *second, state));
        assert_eq!(bits(said.0), bits(said.1), "{}", first.name());
    }
    let (gas, totals) = states.last().unwrap();
    let snapshot = Snapshot::new(gas, totals);
    // The shortest decimal that reads back the same: equal text is equal bits.
    let text = |measure: &dyn Measure<V>| format!("{:?}", measure.conclusion(&snapshot, 1.0));
    assert_eq!(text(&*first), text(&*second));
    assert_eq!(bits(first.memory()), bits(second.memory()));
}
