//! What a grain will do next (Miller 2004, section 2.5).

use super::body::{Body, Contact, Event, Face, NONE, Plan};
use super::contact::{leave_interval, pair_contact};
use super::walls::{Fall, Meeting};
use super::world::World;
use crate::matter::fetch::fetch;
use crate::space::Vector;

impl<V: Vector> World<V> {
    /// Finds the next event of the grain in `row`, which is up to date.
    pub(super) fn foresee(&mut self, row: u32) {
        let contact = self.next_contact(row, None, Contact::NONE);
        self.settle(row, contact);
    }

    /// The earliest collision of the grain in `row` with those around it; `only` with those on one side
    /// of its cell, and `so_far` with the others.
    pub(super) fn next_contact(&self, row: u32, only: Option<Face>, so_far: Contact) -> Contact {
        match (self.falls, &self.lists) {
            (false, None) => self.contact_in_cells::<false>(row, only, so_far),
            (true, None) => self.contact_in_cells::<true>(row, only, so_far),
            (false, Some(lists)) => self.contact_in_list::<false>(row, lists.of(row)),
            (true, Some(lists)) => self.contact_in_list::<true>(row, lists.of(row)),
        }
    }

    fn contact_in_cells<const FALLS: bool>(&self, row: u32, only: Option<Face>, so_far: Contact) -> Contact {
        let mut best = so_far;
        let body = &self.bodies[row as usize];
        let scale = self.scale_now();
        let cell = self.plans[row as usize].cell;
        if let Some((firsts, number)) = self.cells.firsts_around(cell, only) {
            // All grains are sent for before the first is looked at.
            firsts[..number].iter().for_each(|&first| fetch(&self.bodies[first as usize]));
            for &first in &firsts[..number] {
                let mut other = first;
                while other != NONE {
                    let partner = &self.bodies[other as usize];
                    let (place, dv) = self.relative::<FALLS>(body, partner);
                    self.consider(row, other, place - body.position, dv, scale, &mut best);
                    other = partner.next;
                }
            }
            return best;
        }
        self.cells.around(cell, only).for_each(|cell, shift: V| {
            let mut other = self.cells.first(cell);
            while other != NONE {
                let partner = &self.bodies[other as usize];
                let (place, dv) = self.relative::<FALLS>(body, partner);
                // In the order of `nearest_image`, so that the collision sees the same vector to the last bit.
                self.consider(row, other, (place - body.position) + shift, dv, scale, &mut best);
                other = partner.next;
            }
        });
        best
    }

    fn contact_in_list<const FALLS: bool>(&self, row: u32, list: &[u32]) -> Contact {
        let mut best = Contact::NONE;
        let body = &self.bodies[row as usize];
        let scale = self.scale_now();
        list.iter().for_each(|&other| fetch(&self.bodies[other as usize]));
        for &other in list {
            let (place, dv) = self.relative::<FALLS>(body, &self.bodies[other as usize]);
            self.consider(row, other, self.nearest_image(place - body.position), dv, scale, &mut best);
        }
        best
    }

    /// Sends for the memory of the events that come next, the nearer the more of it.
    #[inline]
    pub(super) fn send_ahead(&self) {
        if let Some(entry) = self.calendar.upcoming(5) {
            fetch(&self.bodies[entry.row as usize]);
            fetch(&self.plans[entry.row as usize]);
            if let Some(lists) = &self.lists {
                lists.send_for_span(entry.row);
            }
        }
        let Some(entry) = self.calendar.upcoming(2) else { return };
        let plan = &self.plans[entry.row as usize];
        if let Some(partner) = self.bodies.get(plan.contact.partner as usize) {
            fetch(partner);
        }
        match &self.lists {
            Some(lists) => lists.of(entry.row).first().into_iter().for_each(fetch),
            None => self.cells.send_for(plan.cell),
        }
        let Some(entry) = self.calendar.upcoming(0) else { return };
        let plan = &self.plans[entry.row as usize];
        match &self.lists {
            Some(lists) => lists.of(entry.row).iter().for_each(|&other| fetch(&self.bodies[other as usize])),
            None if plan.cell != NONE => {
                if let Some((firsts, number)) = self.cells.firsts_around(plan.cell, None) {
                    firsts[..number].iter().for_each(|&first| fetch(&self.bodies[first as usize]));
                }
            }
            None => {}
        }
    }

    /// Where `partner` is now, and its velocity relative to `body`.
    #[inline(always)]
    fn relative<const FALLS: bool>(&self, body: &Body<V>, partner: &Body<V>) -> (V, V) {
        if FALLS {
            let place = partner.position_at(self.now, self.laws.gravity);
            return (place, partner.velocity_at(self.now, self.laws.gravity) - body.velocity);
        }
        let elapsed = self.now - partner.time;
        (partner.position + partner.velocity * elapsed, partner.velocity - body.velocity)
    }

    /// Takes the collision with `other`, `dx` away and moving with `dv`, if it is the earliest.
    #[inline(always)]
    fn consider(&self, row: u32, other: u32, dx: V, dv: V, scale: f64, best: &mut Contact) {
        let distance = self.contact_distance(row, other);
        let Some(after) = pair_contact(dx, dv, distance * scale, distance * self.laws.growth.rate) else {
            return;
        };
        let time = self.now + after;
        let ids = &self.ids;
        // Between equal times the smaller identity decides, not the order of memory.
        let earlier = time < best.time
            || time == best.time && best.partner != NONE && ids[other as usize] < ids[best.partner as usize];
        if earlier && other != row {
            *best = Contact { time, partner: other, collisions: self.bodies[other as usize].collisions };
        }
    }

    /// Sets the next event of the grain in `row`: its `contact`, or what comes before.
    pub(super) fn settle(&mut self, row: u32, contact: Contact) {
        let body = self.bodies[row as usize];
        let cell = self.plans[row as usize].cell;
        let (low, high) = match &self.lists {
            None => self.cells.bounds(cell),
            Some(lists) => lists.bounds(row),
        };
        let event = if contact.partner == NONE { Event::Rest } else { Event::Collision };
        let mut plan = Plan { time: contact.time, contact, cell, event };
        let gravity = self.laws.gravity;
        for axis in 0..V::DIMENSION {
            let (after, upper) = leave_interval(
                body.position[axis],
                low[axis],
                high[axis],
                body.velocity[axis],
                gravity[axis],
            );
            let time = self.now + after;
            if time < plan.time {
                (plan.time, plan.event) = (time, Event::Crossing(Face::new(axis, upper)));
            }
        }
        if self.walls.any {
            self.settle_walls(row, &body, low, high, &mut plan);
        }
        self.set_plan(row, plan);
    }

    /// What comes before `plan` at the sides of the box, for a grain between `low` and `high`.
    fn settle_walls(&self, row: u32, body: &Body<V>, low: V, high: V, plan: &mut Plan) {
        let grain = self.grain(row);
        for axis in 0..V::DIMENSION {
            let zone = self.walls.zones[axis];
            let fall = Fall {
                place: body.position[axis],
                velocity: body.velocity[axis],
                acceleration: self.laws.gravity[axis],
                radius: 0.5 * grain.diameter * self.scale_now(),
                growth: 0.5 * grain.diameter * self.laws.growth.rate,
            };
            for (upper, near) in [(false, low[axis] <= zone[0]), (true, high[axis] >= zone[1])] {
                if !near {
                    continue;
                }
                let face = Face::new(axis, upper);
                let (after, event) = match self.walls.meeting(face, fall, self.now, plan.time - self.now) {
                    Meeting::Hit(after) => (after, Event::Wall(face)),
                    Meeting::Passage(after) => (after, Event::Exit),
                    Meeting::Unknown(after) => (after, Event::Outlook),
                    Meeting::Never => continue,
                };
                if self.now + after < plan.time {
                    (plan.time, plan.event) = (self.now + after, event);
                }
            }
        }
    }
}
