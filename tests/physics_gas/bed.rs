//! A gas, an engine, and what has happened to them: what all tests here run.

use grainflow::engine::report::{StepReport, Totals};
use grainflow::engine::stochastic::Stochastic;
use grainflow::engine::stochastic::laws::{DenseGas, Laws};
use grainflow::engine::stochastic::rules::{
    Admission, DisplacementRule, EnskogFactor, HsmcRules, TimeStep, Transfer,
};
use grainflow::engine::{Engine, Horizon, NoLaps};
use grainflow::law::boundary::{AxisBoundary, Boundary, Face, Wall, WallKind};
use grainflow::law::impact::Impacts;
use grainflow::law::restitution::Constant;
use grainflow::matter::gas::Gas;
use grainflow::matter::grain::Grain;
use grainflow::matter::grid::Grid;
use grainflow::observe::moments;
use grainflow::random::{Phase, Stream, Streams};
use grainflow::scenario::initial::rescale;
use grainflow::space::Vector;

/// The grain of all tests: unit diameter and mass.
pub(crate) const GRAIN: Grain = Grain { diameter: 1.0, mass: 1.0 };

/// Which engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Dsmc,
    Cba,
    Hsmc,
}

/// All engines.
pub(crate) const KINDS: [Kind; 3] = [Kind::Dsmc, Kind::Cba, Kind::Hsmc];

/// What a bed is made of. The box is as large as the volume fraction asks for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) kind: Kind,
    pub(crate) restitution: f64,
    pub(crate) cell_restitution: f64,
    pub(crate) volume_fraction: f64,
    /// Cells along every axis.
    pub(crate) cells: u32,
    pub(crate) grains_per_cell: f64,
    pub(crate) transfer: Transfer,
    /// Collisions per particle and step.
    pub(crate) pace: f64,
    /// Smooth resting walls of this restitution at the ends of the last axis.
    pub(crate) walls: Option<f64>,
}

/// A gas at temperature 1 with its engine.
pub(crate) struct Bed<V: Vector> {
    pub(crate) plan: Plan,
    pub(crate) gas: Gas<V>,
    pub(crate) totals: Totals<V>,
    engine: Stochastic<V, Constant>,
}

impl Plan {
    /// An elastic periodic gas with the default rules.
    pub(crate) fn new(kind: Kind, volume_fraction: f64, cells: u32, grains_per_cell: f64) -> Self {
        Plan {
            kind,
            restitution: 1.0,
            cell_restitution: 1.0,
            volume_fraction,
            cells,
            grains_per_cell,
            transfer: Transfer::MomentumChange,
            pace: 0.1,
            walls: None,
        }
    }

    /// The same with another restitution of grains and cells.
    pub(crate) fn with_restitution(self, restitution: f64) -> Self {
        Plan { restitution, cell_restitution: restitution, ..self }
    }

    /// Number of grains.
    pub(crate) fn grains<V: Vector>(self) -> usize {
        let cells = f64::from(self.cells).powi(V::DIMENSION as i32);
        (self.grains_per_cell * cells).round() as usize
    }

    /// The box, and with it the cells.
    pub(crate) fn grid<V: Vector>(self) -> Grid<V> {
        let volume = self.grains::<V>() as f64 * GRAIN.volume::<V>() / self.volume_fraction;
        let side = volume.powf(1.0 / V::DIMENSION as f64);
        let periodic: [bool; 3] =
            std::array::from_fn(|axis| self.walls.is_none() || axis != V::DIMENSION - 1);
        Grid::new(V::ZERO, V::from_fn(|_| side), &[self.cells; 3], &periodic)
    }

    fn boundary<V: Vector>(self) -> Boundary<V> {
        let mut boundary = Boundary::periodic();
        if let Some(restitution) = self.walls {
            let wall = Face::Wall(Wall { restitution, kind: WallKind::Smooth });
            boundary.axes[V::DIMENSION - 1] = AxisBoundary::Faces { lower: wall, upper: wall };
        }
        boundary
    }

    fn dense<V: Vector>(self) -> Option<DenseGas> {
        let largest_volume_fraction = match self.kind {
            Kind::Dsmc => return None,
            Kind::Cba => V::LARGEST_LOCAL_FRACTION,
            Kind::Hsmc => V::LARGEST_LOCAL_FRACTION_HSMC,
        };
        Some(DenseGas {
            enskog_factor: EnskogFactor::Local,
            transfer: self.transfer,
            displacement_ratio: V::displacement_ratio(self.restitution),
            largest_volume_fraction,
        })
    }

    fn engine<V: Vector>(self, seed: u64) -> Stochastic<V, Constant> {
        let laws = Laws {
            grain: GRAIN,
            restitution: Constant(self.restitution),
            impacts: Impacts::UNIFORM,
            gravity: V::ZERO,
            boundary: self.boundary(),
            dense: self.dense::<V>(),
            streams: Streams::new(seed),
            seed,
        };
        let rules = (self.kind == Kind::Hsmc).then_some(HsmcRules {
            maximum_volume_fraction: V::RANDOM_CLOSE_PACKING,
            cell_restitution: self.cell_restitution,
            sweeps: 1,
            admission: Admission::Strict,
            displacement: DisplacementRule::Paired,
        });
        Stochastic::new(laws, TimeStep::CollisionsPerParticle(self.pace), rules)
    }
}

impl<V: Vector> Bed<V> {
    /// Grains at random places with Maxwellian velocities at temperature 1, momentum zero.
    pub(crate) fn new(plan: Plan, seed: u64) -> Self {
        let size = plan.grid::<V>().size();
        let mut random = Streams::new(seed).at(0, Phase::InitialPositions).stream(0);
        let place = |_| V::from_fn(|axis| size[axis] * random.uniform());
        Self::with_positions(plan, seed, (0..plan.grains::<V>()).map(place).collect())
    }

    /// Grains at `positions` `[id]` with Maxwellian velocities at temperature 1, momentum zero.
    pub(crate) fn with_positions(plan: Plan, seed: u64, positions: Vec<V>) -> Self {
        let velocities = vec![V::ZERO; positions.len()];
        let gas = Gas::new(plan.grid(), GRAIN, positions, velocities);
        let mut bed = Bed { plan, gas, totals: Totals::default(), engine: plan.engine(seed) };
        bed.draw_velocities(&mut Streams::new(seed).at(0, Phase::InitialVelocities).stream(0));
        bed
    }

    /// Makes all velocities Maxwellian at temperature 1 with momentum zero.
    pub(crate) fn draw_velocities(&mut self, random: &mut Stream) {
        for velocity in self.gas.velocities_mut() {
            *velocity = V::from_fn(|_| random.gaussian());
        }
        rescale(&mut self.gas, 1.0);
        self.engine.forget_pace();
    }

    /// The bed after so many elastic collisions per particle, again at temperature 1 and time 0.
    pub(crate) fn equilibrated(plan: Plan, seed: u64, collisions_per_particle: f64) -> Self {
        let elastic = Plan { walls: plan.walls.map(|_| 1.0), ..plan.with_restitution(1.0) };
        let mut bed = Bed::new(elastic, seed);
        bed.advance_to(collisions_per_particle);
        rescale(&mut bed.gas, 1.0);
        bed.gas.clock = Default::default();
        let other_seed = Streams::new(seed).derived_seed(Phase::Equilibration);
        Bed { plan, engine: plan.engine(other_seed), totals: Totals::default(), ..bed }
    }

    /// One step.
    pub(crate) fn step(&mut self) -> StepReport<V> {
        let grains = self.gas.len();
        let report =
            self.engine.step(&mut self.gas, Horizon::NONE, &mut NoLaps).expect("a gas can always step");
        self.totals.add(&report, grains);
        report
    }

    /// Steps until so many collisions per particle are counted.
    pub(crate) fn advance_to(&mut self, collisions_per_particle: f64) {
        while self.totals.collisions_per_particle < collisions_per_particle {
            self.step();
        }
    }

    /// Granular temperature.
    pub(crate) fn temperature(&self) -> f64 {
        moments::temperature(&self.gas)
    }

    /// Grains that make a cell full, in HSMC.
    pub(crate) fn capacity(&self) -> Option<u32> {
        self.engine.capacity(&self.gas)
    }
}
