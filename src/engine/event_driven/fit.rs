//! Whether a world that was saved is one: what comes from a log may be wrong although all its checksums hold.
//!
//! Nothing is checked here that the next events could not stumble over, and only once, when a run goes on.

use super::body::{Contact, Event, NONE, Plan};
use super::world::World;
use crate::engine::EngineMisfit;
use crate::matter::gas::Gas;
use crate::space::Vector;

/// How far a grain may be from where others see it [diameters], and its velocity from theirs, as a share of it.
const APART: f64 = 1e-6;
/// How far it may be outside its cell or the surroundings of its list, as a share of them.
const OUTSIDE: f64 = 1e-3;
/// Rounding of a time after the origin, as a share of the time since the start.
const ROUNDING: f64 = 1e-12;

impl<V: Vector> World<V> {
    /// Checks what holds for all grains together, before there are any: `counts` of cells along each axis, the half-width of
    /// lists [length], the time, the pace.
    pub(super) fn check_frame(
        &self,
        counts: [u32; 3],
        half_width: Option<f64>,
        gas: &Gas<V>,
    ) -> Result<(), EngineMisfit> {
        let grains = u64::from(self.next_id);
        let latest = self.latest(gas);
        let near = |time: f64| (-self.pace.year()..=latest).contains(&time) && time.is_finite();
        let faults = [
            (self.next_id != gas.next_id(), "it has had another number of grains"),
            (!self.pace.is_of(grains), "it has no proper pace"),
            (!self.may_have(counts, half_width, grains), "its cells or lists do not suit the box"),
            (!(near(self.now) && near(self.since_origin(gas.time()))), "it is at another time"),
            (!(self.scale > 0.0 && self.scale <= 1.0 + APART), "its grains have no proper size"),
        ];
        first(&faults)
    }

    /// The latest time after its origin that a world can be at which is to go on with `gas`: within the year or soon after,
    /// but where nothing happens, no year ends [time].
    fn latest(&self, gas: &Gas<V>) -> f64 {
        self.since_origin(gas.time()).max(2.0 * self.pace.year())
    }

    /// Checks all grains and their plans: that they can be gone on with, and that they are those of `gas`.
    pub(super) fn check_grains(&self, gas: &Gas<V>) -> Result<(), EngineMisfit> {
        let gone = self.plans.iter().filter(|plan| plan.event == Event::Gone).count() as u64;
        let is_late = self.latest(gas) > 2.0 * self.pace.year();
        first(&[
            (is_late && !self.is_at_rest(), "it is at another time"),
            (gone != self.pace.gone, "another number of grains has left than it says"),
            (!self.watch.is_over(self.bodies.len()), "its watch for collapse knows other grains"),
        ])?;
        for row in 0..self.bodies.len() as u32 {
            self.check_grain(row, gas)?;
        }
        let mut mine: Vec<(u32, u32)> = self.ids.iter().copied().zip(0..).collect();
        mine.retain(|&(_, row)| self.plans[row as usize].event != Event::Gone);
        let mut theirs: Vec<(u32, u32)> = gas.ids().iter().copied().zip(0..).collect();
        mine.sort_unstable();
        theirs.sort_unstable();
        let same = |(mine, theirs): (&(u32, u32), &(u32, u32))| {
            mine.0 == theirs.0 && self.is_seen_as(mine.1 as usize, theirs.1 as usize, gas)
        };
        let all = mine.len() == theirs.len() && mine.iter().zip(&theirs).all(same);
        first(&[(!all, "its grains are not those of the state")])
    }

    fn check_grain(&self, row: u32, gas: &Gas<V>) -> Result<(), EngineMisfit> {
        let (body, plan) = (&self.bodies[row as usize], &self.plans[row as usize]);
        let times = -self.pace.year()..=self.latest(gas);
        let position = body.position_at(self.since_origin(gas.time()), self.laws.gravity);
        let is_number = |time: f64| time < f64::INFINITY;
        let last = self.last_collisions.as_ref().map_or(0.0, |last| last[row as usize]);
        let has_spin = self
            .spins
            .as_ref()
            .is_none_or(|spins| spins[row as usize].as_ref().iter().all(|x| x.is_finite()));
        first(&[
            (!(body.position.is_finite() && body.velocity.is_finite() && has_spin), "a grain is not finite"),
            (!(times.contains(&body.time) && is_number(last)), "a grain is at another time"),
            (!self.has_place(row, position, plan), "a grain is not in its cell"),
            (!self.may_meet(row, plan.contact), "a grain meets one that does not exist"),
            (!self.may_plan(plan), "a grain has an event that cannot be"),
        ])
    }

    /// Whether `position`, that of the grain in `row` at the time of the gas, is where its cell or its list has it; nowhere if it
    /// has left. At the beginning of the year, to which the turn of a year takes all grains, one that was poured since then may
    /// have been anywhere on its way.
    fn has_place(&self, row: u32, position: V, plan: &Plan) -> bool {
        if plan.event == Event::Gone || plan.cell as usize >= self.cells.number() {
            return plan.event == Event::Gone && plan.cell == NONE;
        }
        let ((low, high), width) = match &self.lists {
            None => (self.cells.bounds(plan.cell), self.cells.side()),
            Some(lists) => (lists.bounds(row), V::from_fn(|_| lists.half_width())),
        };
        let is_between = |axis: usize| {
            let slack = OUTSIDE * width[axis];
            (low[axis] - slack..=high[axis] + slack).contains(&position[axis])
        };
        let has_anchor = self
            .lists
            .as_ref()
            .is_none_or(|lists| self.cells.cell_of(lists.anchors()[row as usize]) == plan.cell);
        has_anchor && (0..V::DIMENSION).all(is_between)
    }

    /// Whether the grain in `row` can have foreseen `contact`. One whose partner has left stands in for it, with another count.
    fn may_meet(&self, row: u32, contact: Contact) -> bool {
        let Contact { time, partner, collisions } = contact;
        match self.bodies.get(partner as usize) {
            None => partner == NONE && time == f64::INFINITY,
            Some(other) => time.is_finite() && (partner != row || collisions != other.collisions),
        }
    }

    /// Whether a grain can have this plan.
    fn may_plan(&self, plan: &Plan) -> bool {
        let time = (-self.pace.year()..f64::INFINITY).contains(&plan.time);
        match plan.event {
            Event::Rest | Event::Gone => plan.time == f64::INFINITY,
            Event::Collision => time && plan.contact.partner != NONE,
            Event::Crossing(face) => time && (self.lists.is_some() || self.cells.has_beyond(plan.cell, face)),
            Event::Wall(face) => time && self.walls.is_wall(face),
            Event::Exit => time && self.walls.has_open_side(),
            Event::Outlook => time,
        }
    }

    /// Whether the grain in `row` is that in row `other` of `gas`, but for rounding.
    fn is_seen_as(&self, row: usize, other: usize, gas: &Gas<V>) -> bool {
        let (body, gravity, now) = (&self.bodies[row], self.laws.gravity, self.since_origin(gas.time()));
        let (elapsed, rounding) = (now - body.time, ROUNDING * gas.time().abs());
        let speed = body.velocity.length() + gravity.length() * elapsed.abs();
        let apart = gas.grid().separation(body.position_at(now, gravity), gas.positions()[other]);
        let change = body.velocity_at(now, gravity) - gas.velocities()[other];
        let columns = gas.columns();
        apart.length() <= APART * self.laws.largest_diameter() + speed * rounding
            && change.length() <= APART * speed + gravity.length() * rounding
            && (self.species.as_ref())
                .is_none_or(|mine| Some(mine[row]) == columns.species.as_ref().map(|all| all[other]))
    }
}

/// The first fault that there is.
fn first(faults: &[(bool, &'static str)]) -> Result<(), EngineMisfit> {
    match faults.iter().find(|(is_there, _)| *is_there) {
        Some((_, fault)) => Err(EngineMisfit(fault)),
        None => Ok(()),
    }
}
