//! The event-driven engine: exact dynamics of hard grains, one event after another.
//!
//! Every grain lives at the time of its own last event and has one next event, the earliest of its
//! collisions, its crossing into another cell and its hits on walls (Lubachevsky 1991; Miller 2004,
//! chapter 2). Nothing is done for a grain to which nothing happens. A collision that was foreseen with
//! a partner whose path has changed since is recognised by the partner's count of collisions, and annulled.

mod arrangement;
mod body;
mod calendar;
mod cell_tally;
mod cells;
mod collapse;
pub mod contact;
mod events;
mod fit;
pub mod growth;
pub mod laws;
mod lists;
mod order;
mod prediction;
pub mod rules;
mod saved;
mod synchronise;
mod walls;
mod world;
mod year;

use crate::engine::cell_counts::CellCount;
use crate::engine::report::StepReport;
use crate::engine::{Engine, EngineError, EngineMisfit, EngineState, Horizon, Laps};
use crate::matter::gas::{Gas, SortSpace};
use crate::space::Vector;
use body::Event;
pub use calendar::Usage;
use cell_tally::CellTally;
use laws::Laws;
use rules::Structure;
use world::World;

/// Events between two looks at the outside world, for each grain and at least.
const EVENTS_PER_CALL: (u64, u64) = (2, 1 << 16);

/// The event-driven engine.
#[derive(Debug)]
pub struct EventDriven<V: Vector> {
    laws: Laws<V>,
    structure: Structure,
    /// The grains; nothing before the first step.
    world: Option<World<V>>,
    space: SortSpace<V>,
    /// `[cell of the gas]`: what happened there; empty where nothing is counted.
    cell_counts: Vec<CellCount>,
}

impl<V: Vector> EventDriven<V> {
    /// An engine under `laws` that finds partners by `structure`.
    pub fn new(laws: Laws<V>, structure: Structure) -> Self {
        EventDriven { laws, structure, world: None, space: SortSpace::default(), cell_counts: Vec::new() }
    }

    /// How the calendar was used since its year began; nothing before the first step.
    pub fn calendar_usage(&self) -> Usage {
        self.world.as_ref().map_or_else(Usage::default, |world| world.calendar.usage())
    }
}

impl<V: Vector> World<V> {
    /// THE loop (Miller 2004, figure 2.1): take the next event, bring its grains up to date, let it happen,
    /// foresee what they do next. Goes on to `horizon`, in time and in collisions, or for `most` events;
    /// tells whether its time was reached.
    fn run(&mut self, horizon: Horizon, most: u64) -> Result<bool, EngineError> {
        let mut end = self.since_origin(horizon.time);
        // Who waits for a number of collisions per particle has to know when the number of grains changes: once all that
        // leave at one moment have left.
        let is_counted = horizon.collisions != u64::MAX;
        while self.counts.collisions < horizon.collisions && self.events.all < most {
            let has_lost = is_counted && self.counts.removed > 0;
            let Some(next) = self.calendar.next(&self.plans) else {
                if has_lost {
                    return Ok(false);
                }
                if end < self.calendar.year() || self.is_at_rest() {
                    return if end.is_finite() { Ok(true) } else { Err(self.nothing_moves()) };
                }
                self.turn_year(self.calendar.year());
                end = self.since_origin(horizon.time);
                continue;
            };
            if has_lost && next.time > self.now {
                self.calendar.write(next);
                return Ok(false);
            }
            if next.time > end {
                self.calendar.write(next);
                return Ok(true);
            }
            self.send_ahead();
            self.now = next.time;
            self.happen(next.row)?;
            if self.year_is_overfull() {
                self.turn_year(self.now);
                end = self.since_origin(horizon.time);
            }
        }
        Ok(false)
    }

    /// Lets the next event of the grain in `row` happen.
    fn happen(&mut self, row: u32) -> Result<(), EngineError> {
        self.events.all += 1;
        self.pace.events += 1;
        match self.plans[row as usize].event {
            Event::Collision => self.collide(row)?,
            Event::Crossing(face) => self.cross(row, face),
            Event::Wall(face) => self.hit_wall(row, face)?,
            Event::Exit => self.leave(row),
            Event::Outlook => self.look_again(row),
            Event::Rest | Event::Gone => unreachable!("nothing happens at an infinite time"),
        }
        Ok(())
    }

    fn nothing_moves(&self) -> EngineError {
        EngineError::NothingMoves { time: self.origin.time() + self.now }
    }
}

impl<V: Vector> Engine<V> for EventDriven<V> {
    fn step(
        &mut self,
        gas: &mut Gas<V>,
        horizon: Horizon,
        laps: &mut dyn Laps,
    ) -> Result<StepReport<V>, EngineError> {
        laps.start("maintenance");
        let world = self.world.get_or_insert_with(|| World::new(&self.laws, self.structure, gas));
        world.adopt(gas);
        if !self.cell_counts.is_empty() {
            let counts = std::mem::take(&mut self.cell_counts);
            world.cell_tally = Some(CellTally { grid: gas.grid().clone(), counts });
        }
        laps.start("events");
        let start = gas.time();
        let (per_grain, least) = EVENTS_PER_CALL;
        let reached = world.run(horizon, per_grain * gas.len() as u64 + least)?;
        self.cell_counts = world.cell_tally.take().map(|tally| tally.counts).unwrap_or_default();
        laps.start("synchronise");
        world.synchronise(gas, reached.then_some(horizon.time), &mut self.space)?;
        Ok(world.report(gas.time() - start))
    }

    fn state(&self) -> EngineState {
        self.world.as_ref().map_or_else(EngineState::default, World::state)
    }

    fn restore(&mut self, state: &EngineState, gas: &Gas<V>) -> Result<(), EngineMisfit> {
        let begins = state.numbers.is_empty() && state.words.is_empty();
        self.world = match begins {
            true => None,
            false => Some(World::restored(&self.laws, self.structure, state, gas)?),
        };
        Ok(())
    }

    fn forget_pace(&mut self) {
        self.world = None;
    }

    fn count_in_cells(&mut self, counts: Vec<CellCount>) {
        self.cell_counts = counts;
    }

    fn cell_counts(&self) -> &[CellCount] {
        &self.cell_counts
    }

    fn capacity(&self, _gas: &Gas<V>) -> Option<u32> {
        None
    }

    fn excludes_overlap(&self) -> bool {
        true
    }
}
