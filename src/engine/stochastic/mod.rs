//! The stochastic engines: DSMC, CBA and HSMC on cell-sorted grains.
//!
//! A step begins and ends in cell order and has one sort, at its end. It is the thesis' cycle of
//! advection and collisions, cut between the two: collide, then move.

mod admission;
mod blocks;
mod cell_collisions;
mod cell_pairs;
mod coloured_pass;
mod contests;
mod displacement;
mod enskog;
mod entry;
mod excluded_volume;
mod flight;
mod gas_pass;
pub mod laws;
mod movers;
mod number_set;
mod onlooker;
mod parallel;
mod relative_speeds;
pub mod rules;
mod tally;
mod time_step;
#[cfg(test)]
mod trial;
mod wishes;

use crate::engine::cell_counts::CellCount;
use crate::engine::report::StepReport;
use crate::engine::{Engine, EngineError, EngineMisfit, EngineState, Horizon, Laps};
use crate::law::impact::ImpactLaw;
use crate::law::piecewise::PiecewiseLinear;
use crate::law::restitution::Restitution;
use crate::matter::gas::{Gas, SortSpace, copy};
use crate::space::Vector;
use excluded_volume::ExcludedVolume;
use laws::Laws;
use rules::{HsmcRules, TimeStep};
use tally::Tally;
use time_step::{pace, time_step};

/// A stochastic engine: DSMC or CBA, by its laws, and HSMC when it has an excluded volume.
#[derive(Debug)]
pub struct Stochastic<V: Vector, R: Restitution> {
    laws: Laws<V, R>,
    /// What `laws.impacts` follow in the course of the run.
    impact_law: ImpactLaw,
    time_step: TimeStep,
    excluded_volume: Option<ExcludedVolume<V>>,
    space: SortSpace<V>,
    state: EngineState,
    /// `[cell]`: what happened there; empty where nothing is counted.
    cell_counts: Vec<CellCount>,
}

/// One step: its number, beginning and length.
#[derive(Clone, Copy, Debug)]
struct Step {
    number: u64,
    start: f64,
    duration: f64,
}

impl<V: Vector, R: Restitution> Stochastic<V, R> {
    /// DSMC where `laws.dense` is `None`, CBA where it is not, HSMC with `excluded_volume`.
    pub fn new(laws: Laws<V, R>, time_step: TimeStep, excluded_volume: Option<HsmcRules>) -> Self {
        Stochastic {
            laws,
            impact_law: ImpactLaw::UNIFORM,
            time_step,
            excluded_volume: excluded_volume.map(ExcludedVolume::new),
            space: SortSpace::default(),
            state: EngineState { largest_speed: -1.0, collision_rate: -1.0, ..EngineState::default() },
            cell_counts: Vec::new(),
        }
    }

    /// With impact parameters of pairs that follow `law` in the course of the run.
    #[must_use]
    pub fn with_impact_law(mut self, law: ImpactLaw) -> Self {
        self.laws.impacts = law.at(0.0);
        self.impact_law = law;
        self
    }

    /// HSMC with this probability of entering a cell, of its volume fraction; other engines have no use for it.
    #[must_use]
    pub fn with_entry_probability(mut self, probability: Option<PiecewiseLinear>) -> Self {
        if let Some(volume) = &mut self.excluded_volume {
            volume.entry_probability = probability;
        }
        self
    }

    /// DSMC and CBA: pair collisions with displacement and the move, fused over each cell; one sort.
    fn gas_step(&mut self, gas: &mut Gas<V>, step: Step, laps: &mut dyn Laps) -> Tally<V> {
        laps.start("pair collisions and move");
        let tally = gas_pass::collide_and_move(&self.laws, gas, &mut self.space, step, &mut self.cell_counts);
        laps.start("sort");
        gas.sort_counted(&mut self.space, copy);
        tally
    }

    /// HSMC: cell–cell collisions, pair collisions with displacement, moves and admission; one sort.
    fn hybrid_step(&mut self, gas: &mut Gas<V>, step: Step, laps: &mut dyn Laps) -> Tally<V> {
        let Some(volume) = &mut self.excluded_volume else { return Tally::default() };
        let mut tally = Tally::default();
        laps.start("cell collisions");
        volume.collide_cells(&self.laws, gas, step, &mut tally);
        laps.start("pair collisions");
        volume.collide_pairs(&self.laws, gas, &mut self.space, step, (&mut tally, &mut self.cell_counts));
        laps.start("move");
        volume.advect(&self.laws, gas, &mut self.space, step, &mut tally);
        laps.start("admission");
        volume.admit(&self.laws, gas, &mut self.space, step, &mut tally);
        laps.start("sort");
        gas.sort_counted(&mut self.space, copy);
        tally
    }
}

impl<V: Vector, R: Restitution> Engine<V> for Stochastic<V, R> {
    fn step(
        &mut self,
        gas: &mut Gas<V>,
        _horizon: Horizon,
        laps: &mut dyn Laps,
    ) -> Result<StepReport<V>, EngineError> {
        laps.start("time step");
        if self.state.largest_speed < 0.0 {
            let tally = time_step::measure(&self.laws, gas);
            self.set_pace(gas, &tally);
        }
        let jumps_matter = self.excluded_volume.is_some() || self.laws.has_faces() || self.laws.has_gravity();
        let (duration, capped) = time_step(self.time_step, &self.laws, jumps_matter, gas, &self.state)?;
        let step = Step { number: self.state.step, start: gas.time(), duration };
        self.space.prepare(gas);
        let tally = match self.excluded_volume {
            None => self.gas_step(gas, step, laps),
            Some(_) => self.hybrid_step(gas, step, laps),
        };
        gas.clock.advance(duration);
        self.state.step += 1;
        self.set_pace(gas, &tally);
        if !tally.speeds.sum_of_squares.is_finite() {
            return Err(self.not_finite(gas));
        }
        Ok(StepReport { steps: 1, duration, capped, counts: tally.counts, ..StepReport::default() })
    }

    fn collided(&mut self, per_particle: f64) {
        self.laws.impacts = self.impact_law.at(per_particle);
    }

    fn state(&self) -> EngineState {
        self.state.clone()
    }

    fn restore(&mut self, state: &EngineState, _gas: &Gas<V>) -> Result<(), EngineMisfit> {
        if !(state.numbers.is_empty() && state.words.is_empty()) {
            return Err(EngineMisfit("it has the grains of an engine without steps"));
        }
        if !(state.largest_speed.is_finite() && state.collision_rate.is_finite()) {
            return Err(EngineMisfit("its largest speed or its collision rate is not finite"));
        }
        self.state = state.clone();
        Ok(())
    }

    fn forget_pace(&mut self) {
        (self.state.largest_speed, self.state.collision_rate) = (-1.0, -1.0);
    }

    fn count_in_cells(&mut self, counts: Vec<CellCount>) {
        self.cell_counts = counts;
    }

    fn cell_counts(&self) -> &[CellCount] {
        &self.cell_counts
    }

    fn capacity(&self, gas: &Gas<V>) -> Option<u32> {
        self.excluded_volume.as_ref().map(|volume| volume.capacity(gas))
    }
}

impl<V: Vector, R: Restitution> Stochastic<V, R> {
    fn set_pace(&mut self, gas: &Gas<V>, tally: &Tally<V>) {
        (self.state.largest_speed, self.state.collision_rate) = pace(&self.laws, gas, tally);
    }

    /// Names the first grain that is not where a number can say.
    fn not_finite(&self, gas: &Gas<V>) -> EngineError {
        let lost = |row: &usize| !(gas.positions()[*row].is_finite() && gas.velocities()[*row].is_finite());
        let row = (0..gas.len()).find(lost).unwrap_or(0);
        EngineError::NotFinite {
            id: gas.ids().get(row).copied().unwrap_or(0),
            cell: gas.positions().get(row).map_or(0, |&position| gas.grid().cell_of(position)),
            step: self.state.step,
            seed: self.laws.seed,
            time: gas.time(),
        }
    }
}
