//! The grains, each at its own time, and what is known of their future.

use super::body::{Body, NONE, Plan};
use super::calendar::{Calendar, Entry};
use super::cell_tally::CellTally;
use super::cells::{Cells, SLACK};
use super::collapse::CollapseWatch;
use super::laws::Laws;
use super::lists::Lists;
use super::rules::Structure;
use super::walls::Walls;
use super::year::Pace;
use crate::engine::report::{Counts, EventCounts, StepReport};
use crate::matter::clock::Clock;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// All grains of a run with their plans.
#[derive(Debug)]
pub(super) struct World<V: Vector> {
    pub(super) laws: Laws<V>,
    /// Whether there is gravity.
    pub(super) falls: bool,
    pub(super) walls: Walls<V>,
    /// The origin of time: when the year began.
    pub(super) origin: Clock,
    /// Time after the origin [time].
    pub(super) now: f64,
    /// All diameters, as a share of those in the laws, at the origin of time.
    pub(super) scale: f64,
    /// `[row]`.
    pub(super) bodies: Vec<Body<V>>,
    /// `[row]`.
    pub(super) plans: Vec<Plan>,
    /// `[row]`: identities.
    pub(super) ids: Vec<u32>,
    /// `[row]`: angular velocities, where grains are rough [1/time].
    pub(super) spins: Option<Vec<V::Spin>>,
    /// `[row]`: species, where there are several.
    pub(super) species: Option<Vec<u8>>,
    /// `[row]`: when the grain last collided, where a cure asks for it [time].
    pub(super) last_collisions: Option<Vec<f64>>,
    /// The identity that the next new grain will get.
    pub(super) next_id: u32,
    /// How the structure is chosen.
    pub(super) structure: Structure,
    pub(super) cells: Cells<V>,
    /// Neighbour lists, where matter is dense; the cells then hold anchors.
    pub(super) lists: Option<Lists<V>>,
    pub(super) calendar: Calendar,
    pub(super) pace: Pace,
    pub(super) watch: CollapseWatch,
    /// What happened since the last report.
    pub(super) counts: Counts<V>,
    /// Collisions since the last report up to the departure of each grain that has left.
    pub(super) removals: Vec<u64>,
    /// What events there were since the last report.
    pub(super) events: EventCounts,
    /// What happens in each cell of the gas, where somebody counts it.
    pub(super) cell_tally: Option<CellTally<V>>,
}

impl<V: Vector> World<V> {
    /// The grains of `gas`, all at its time.
    pub(super) fn new(laws: &Laws<V>, structure: Structure, gas: &Gas<V>) -> Self {
        let columns = gas.columns();
        let body =
            |(&position, &velocity): (&V, &V)| Body { position, velocity, next: NONE, ..Body::default() };
        let grains = columns.len();
        let spins = || columns.spins.clone().unwrap_or_else(|| vec![V::Spin::default(); grains]);
        let mut world = World {
            origin: gas.clock,
            bodies: columns.positions.iter().zip(&columns.velocities).map(body).collect(),
            plans: vec![Plan::default(); grains],
            ids: columns.ids.clone(),
            spins: laws.roughness.map(|_| spins()),
            species: columns.species.clone(),
            last_collisions: laws.cure.contact_time.map(|_| vec![f64::NEG_INFINITY; grains]),
            next_id: gas.next_id(),
            ..World::empty(laws, structure)
        };
        world.walls.set_origin(world.origin);
        world.begin();
        world
    }

    /// A world without grains.
    pub(super) fn empty(laws: &Laws<V>, structure: Structure) -> Self {
        World {
            falls: laws.gravity != V::ZERO,
            walls: Walls::new(laws),
            laws: laws.clone(),
            origin: Clock::default(),
            now: 0.0,
            scale: laws.growth.start,
            bodies: Vec::new(),
            plans: Vec::new(),
            ids: Vec::new(),
            spins: None,
            species: None,
            last_collisions: None,
            next_id: 0,
            structure,
            cells: Cells::default(),
            lists: None,
            calendar: Calendar::default(),
            pace: Pace::default(),
            watch: CollapseWatch::default(),
            counts: Counts::default(),
            removals: Vec::new(),
            events: EventCounts::default(),
            cell_tally: None,
        }
    }

    /// `time` [time] as seen from the origin of time.
    pub(super) fn since_origin(&self, time: f64) -> f64 {
        // What rounding took from the clock is part of the origin.
        (time - self.origin.time()) + self.origin.compensation()
    }

    /// All diameters at this moment, as a share of those in the laws.
    #[inline(always)]
    pub(super) fn scale_now(&self) -> f64 {
        self.scale + self.laws.growth.rate * self.now
    }

    /// The distance at which two grains touch, as long as all diameters are those of the laws [length].
    #[inline(always)]
    pub(super) fn contact_distance(&self, one: u32, other: u32) -> f64 {
        match &self.species {
            None => self.laws.grain.diameter,
            Some(species) => {
                let diameter = |row: u32| self.laws.kind(species[row as usize]).diameter;
                0.5 * (diameter(one) + diameter(other))
            }
        }
    }

    /// Diameter and mass of the grain in `row`, as the laws have them.
    #[inline(always)]
    pub(super) fn grain(&self, row: u32) -> crate::matter::grain::Grain {
        match &self.species {
            None => self.laws.grain,
            Some(species) => self.laws.kind(species[row as usize]),
        }
    }

    /// The shortest vector between periodic images of the two ends of `apart` [length].
    #[inline(always)]
    pub(super) fn nearest_image(&self, mut apart: V) -> V {
        for axis in 0..V::DIMENSION {
            let (half, whole) = (self.walls.half_period[axis], self.laws.size[axis]);
            if apart[axis] > half {
                apart[axis] -= whole;
            } else if apart[axis] < -half {
                apart[axis] += whole;
            }
        }
        apart
    }

    /// Sets what the grain in `row` does next.
    #[inline]
    pub(super) fn set_plan(&mut self, row: u32, plan: Plan) {
        self.plans[row as usize] = plan;
        self.calendar.write(Entry { time: plan.time, id: self.ids[row as usize], row });
    }

    /// Brings the grain in `row` up to date.
    #[inline(always)]
    pub(super) fn advance(&mut self, row: u32) {
        self.bodies[row as usize].advance(self.now, self.laws.gravity);
    }

    /// Takes over grains that were added to `gas` since the last look at it.
    pub(super) fn adopt(&mut self, gas: &Gas<V>) {
        if gas.next_id() == self.next_id {
            return;
        }
        self.now = self.since_origin(gas.time());
        let columns = gas.columns();
        let new = (0..gas.len()).filter(|&row| columns.ids[row] >= self.next_id);
        let mut new: Vec<usize> = new.collect();
        new.sort_unstable_by_key(|&row| columns.ids[row]);
        for row in new {
            let (position, velocity) = (columns.positions[row], columns.velocities[row]);
            let species = columns.species.as_ref().map_or(0, |species| species[row]);
            self.add(
                Body { position, velocity, time: self.now, collisions: 0, next: NONE },
                columns.ids[row],
                species,
            );
        }
        self.next_id = gas.next_id();
    }

    fn add(&mut self, body: Body<V>, id: u32, species: u8) {
        let row = self.bodies.len() as u32;
        self.bodies.push(body);
        self.plans.push(Plan::default());
        self.ids.push(id);
        self.spins.as_mut().into_iter().for_each(|spins| spins.push(V::Spin::default()));
        self.species.as_mut().into_iter().for_each(|all| all.push(species));
        self.last_collisions.as_mut().into_iter().for_each(|last| last.push(f64::NEG_INFINITY));
        let cell = self.cells.cell_of(body.position);
        self.cells.insert(cell, row, &mut self.bodies, &mut self.plans);
        if let Some(lists) = &mut self.lists {
            lists.append(body.position);
            self.find_neighbours(row);
        }
        self.foresee(row);
    }

    /// Enters the grain in `row`, which is in no list, into the lists around its anchor.
    pub(super) fn find_neighbours(&mut self, row: u32) {
        let Some(mut lists) = self.lists.take() else { return };
        // Growing grains are smaller than the laws have them; rounding must not hide a contact.
        let distance = |one, other| self.contact_distance(one, other) * SLACK;
        lists.find(row, &self.cells, &self.bodies, &self.plans, distance);
        self.lists = Some(lists);
    }

    /// What happened since the last report, during which `duration` passed [time].
    pub(super) fn report(&mut self, duration: f64) -> StepReport<V> {
        StepReport {
            steps: 0,
            duration,
            capped: false,
            counts: std::mem::take(&mut self.counts),
            removals: std::mem::take(&mut self.removals),
            events: std::mem::take(&mut self.events),
        }
    }
}
