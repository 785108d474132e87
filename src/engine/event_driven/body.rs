//! A grain at its own time, and what it will do next.

use crate::space::Vector;

/// No grain, no cell.
pub(super) const NONE: u32 = u32::MAX;

/// A grain as it was after its last event: one line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub(super) struct Body<V> {
    /// Position at `time` [length].
    pub(super) position: V,
    /// Velocity at `time` [length/time].
    pub(super) velocity: V,
    /// When that was, after the origin of time [time].
    pub(super) time: f64,
    /// Collisions so far, with grains and walls: an event foreseen at another count is void.
    pub(super) collisions: u32,
    /// The next grain of its cell, or [`NONE`].
    pub(super) next: u32,
}

/// A collision that is foreseen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    /// When, after the origin of time; infinite for none [time].
    pub(super) time: f64,
    /// The row of the partner.
    pub(super) partner: u32,
    /// The partner's collisions when this was foreseen.
    pub(super) collisions: u32,
}

impl Contact {
    pub(super) const NONE: Contact = Contact { time: f64::INFINITY, partner: NONE, collisions: 0 };
}

/// One side of a box or a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Face {
    /// The axis it is normal to.
    pub(super) axis: u8,
    /// Whether it is the upper one.
    pub(super) upper: bool,
}

impl Face {
    pub(super) fn new(axis: usize, upper: bool) -> Self {
        Face { axis: axis as u8, upper }
    }
    pub(super) fn axis(self) -> usize {
        self.axis as usize
    }
    /// 0 lower, 1 upper.
    pub(super) fn side(self) -> usize {
        usize::from(self.upper)
    }
}

/// What a grain does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// Nothing, ever.
    Rest,
    /// It has left the box.
    Gone,
    /// It meets the partner of its contact.
    Collision,
    /// It leaves its cell, or the surroundings for which its list of neighbours holds.
    Crossing(Face),
    /// It hits a wall.
    Wall(Face),
    /// It passes an open side.
    Exit,
    /// Nothing, but this is how far its future was looked into.
    Outlook,
}

/// The next event of a grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// When, after the origin of time; infinite for none [time].
    pub(super) time: f64,
    /// The next collision with a grain, which may lie behind the next event.
    pub(super) contact: Contact,
    /// Its cell; [`NONE`] for a grain that has left the box.
    pub(super) cell: u32,
    /// What happens.
    pub(super) event: Event,
}

impl Default for Plan {
    fn default() -> Self {
        Plan { time: f64::INFINITY, contact: Contact::NONE, cell: NONE, event: Event::Rest }
    }
}

impl<V: Vector> Body<V> {
    /// Its position at `now` under `gravity` [length].
    #[inline(always)]
    pub(super) fn position_at(&self, now: f64, gravity: V) -> V {
        let elapsed = now - self.time;
        self.position + (self.velocity + gravity * (0.5 * elapsed)) * elapsed
    }

    /// Its velocity at `now` under `gravity` [length/time].
    #[inline(always)]
    pub(super) fn velocity_at(&self, now: f64, gravity: V) -> V {
        self.velocity + gravity * (now - self.time)
    }

    /// Moves it on to `now` (Miller 2004, equations 2.2 and 2.3).
    #[inline(always)]
    pub(super) fn advance(&mut self, now: f64, gravity: V) {
        (self.position, self.velocity) = (self.position_at(now, gravity), self.velocity_at(now, gravity));
        self.time = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn what_is_read_most_is_small() {
        assert_eq!(size_of::<Body<DVec3>>(), 64);
        assert_eq!(size_of::<Body<DVec2>>(), 64);
        assert_eq!(size_of::<Plan>(), 32);
    }

    #[test]
    fn a_thrown_grain_follows_its_parabola() {
        let mut body = Body { velocity: DVec2::new(1.0, 2.0), time: 1.0, ..Body::default() };
        body.advance(3.0, DVec2::new(0.0, -1.0));
        assert_eq!((body.position, body.velocity), (DVec2::new(2.0, 2.0), DVec2::new(1.0, 0.0)));
    }
}
