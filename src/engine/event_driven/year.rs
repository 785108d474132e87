//! The turn of a year: what is done now and then for all grains.
//!
//! Times are counted from the beginning of the year, so that long runs lose no precision. When it is over,
//! all grains are brought up to date, the origin of time moves, and the next year gets the length and
//! the pages that suit the events of the last one. Also the order in memory and the choice between cells
//! and lists are looked at. All this follows from the state and from counts alone.

use super::body::NONE;
use super::calendar::{Calendar, Entry};
use super::lists::Lists;
use super::world::World;
use crate::space::Vector;

/// Events of each grain in a year, and of all grains at least.
const EVENTS_PER_YEAR: (f64, f64) = (4.0, 64.0);
/// A year with this many times the events that it was planned for is ended at once.
const OVERFULL: f64 = 4.0;
/// A year without events makes the next one this much longer.
const LARGEST_SLOWDOWN: f64 = 4.0;
/// A span of time in which no grain can collide often but in a collapse, as a share of a year: 2⁻⁴⁰.
const SHORTEST_SPAN: f64 = 1.0 / (1_u64 << 40) as f64;
/// Crossings of each grain after which the order in memory has decayed.
const CROSSINGS_PER_ORDER: f64 = 4.0;

/// How fast things happen, and what was counted of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pace {
    /// Events per time that the year was planned for [1/time].
    pub(super) rate: f64,
    /// Events that it was planned for.
    pub(super) planned: f64,
    /// Events since the year began.
    pub(super) events: u64,
    /// Collisions of pairs since the year began.
    pub(super) collisions: u64,
    /// Crossings or renewals since the year began.
    pub(super) crossings: u64,
    /// Crossings or renewals since the grains were put into order.
    pub(super) crossings_since_order: u64,
    /// Grains when the cells were made.
    pub(super) arranged_for: u64,
    /// Grains that have left the box but still have a row.
    pub(super) gone: u64,
    /// See [`SHORTEST_SPAN`] [time].
    pub(super) shortest_span: f64,
}

/// Events that a year of so many grains is planned for.
fn planned_for(grains: u64) -> f64 {
    let (per_grain, least) = EVENTS_PER_YEAR;
    per_grain * grains as f64 + least
}

impl Pace {
    /// Length of the year [time].
    pub(super) fn year(&self) -> f64 {
        let year = self.planned / self.rate;
        // Where nothing moves any length will do.
        if year.is_finite() && year > 0.0 { year } else { 1.0 }
    }

    /// Whether this is the pace of a world that has had at most so many `grains`.
    pub(super) fn is_of(&self, grains: u64) -> bool {
        let counts = [self.events, self.collisions, self.crossings, self.crossings_since_order];
        (0.0..=f64::MAX).contains(&self.rate)
            && (planned_for(0)..=planned_for(grains)).contains(&self.planned)
            && self.shortest_span == SHORTEST_SPAN * self.year()
            && counts.iter().all(|&count| count < 1 << 60)
            && self.arranged_for <= grains
            && self.gone <= grains
    }

    /// Mean time between events of one of `grains` grains [time].
    pub(super) fn time_between_events(&self, grains: usize) -> f64 {
        grains as f64 / self.rate
    }
}

impl<V: Vector> World<V> {
    /// Arranges the grains of a new world and foresees what they do.
    pub(super) fn begin(&mut self) {
        self.pace.rate = self.expected_rate();
        self.open_year();
        self.arrange(self.first_arrangement());
        self.foresee_all();
    }

    /// A first guess of events per time: crossings of a diameter, and what gravity adds [1/time].
    fn expected_rate(&self) -> f64 {
        let diameter = self.laws.largest_diameter();
        let speeds: f64 = self.bodies.iter().map(|body| body.velocity.length()).sum();
        2.0 * speeds / diameter + (self.laws.gravity.length() / diameter).sqrt() * self.bodies.len() as f64
    }

    fn open_year(&mut self) {
        self.pace.planned = planned_for(self.bodies.len() as u64);
        let year = self.pace.year();
        self.pace.shortest_span = SHORTEST_SPAN * year;
        (self.pace.events, self.pace.collisions, self.pace.crossings) = (0, 0, 0);
        self.calendar.begin(year, self.pace.planned);
    }

    /// Whether so much happens that the year should end.
    #[inline]
    pub(super) fn year_is_overfull(&self) -> bool {
        self.pace.events as f64 > OVERFULL * self.pace.planned
    }

    /// Whether nothing will ever happen.
    pub(super) fn is_at_rest(&self) -> bool {
        self.plans.iter().all(|plan| plan.time == f64::INFINITY)
    }

    /// Ends the year at `end` after its beginning [time].
    pub(super) fn turn_year(&mut self, end: f64) {
        self.move_origin(end);
        let measured = self.pace.events as f64 / end;
        self.pace.rate = measured.min(1e300).max(self.pace.rate / LARGEST_SLOWDOWN);
        let arrangement = self.next_arrangement();
        let decayed = self.pace.crossings_since_order as f64 > CROSSINGS_PER_ORDER * self.bodies.len() as f64;
        let disorderly = decayed || self.pace.gone > 0;
        if disorderly || arrangement.is_some() {
            // Grains are put into order in the memory that this gives back.
            self.calendar = Calendar::default();
        }
        self.open_year();
        if let Some(arrangement) = arrangement {
            self.arrange(arrangement);
            self.foresee_all();
            return;
        }
        let wasteful = self.lists.as_ref().is_some_and(Lists::is_wasteful);
        if disorderly {
            self.order();
        } else if wasteful && let Some(lists) = &mut self.lists {
            // How full the pool is does not belong to a saved state: it must not decide on the order of rows.
            lists.reset(lists.anchors().to_vec());
            self.link();
        }
        for (row, plan) in self.plans.iter().enumerate() {
            self.calendar.write(Entry { time: plan.time, id: self.ids[row], row: row as u32 });
        }
    }

    /// Brings all grains up to `end` and counts time from there.
    fn move_origin(&mut self, end: f64) {
        self.now = 0.0;
        for (body, plan) in self.bodies.iter_mut().zip(&mut self.plans) {
            body.advance(end, self.laws.gravity);
            body.time = 0.0;
            plan.time -= end;
            plan.contact.time -= end;
        }
        for last in self.last_collisions.iter_mut().flatten() {
            *last -= end;
        }
        self.scale += self.laws.growth.rate * end;
        self.origin.advance(end);
        self.walls.set_origin(self.origin);
        self.watch.forget();
    }

    /// Foresees the next event of every grain anew.
    pub(super) fn foresee_all(&mut self) {
        for row in 0..self.bodies.len() as u32 {
            if self.plans[row as usize].cell != NONE {
                self.foresee(row);
            }
        }
    }
}

#[cfg(test)]
#[path = "year_tests.rs"]
mod tests;
