//! Grains that may not go where they want to.

use super::flight::Flights;
use super::number_set::{NumberSet, WORD};
use crate::law::restitution::Restitution;
use crate::matter::columns::Rows;
use crate::matter::scatter::Slot;
use crate::space::Vector;

/// The grains that stay, and those that go along one axis only.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Their rows; without memory where all grains go.
    held: NumberSet,
    /// Rows that go along one axis, and that axis; in rising order once all are known.
    slides: Vec<(u32, usize)>,
    rows: usize,
}

impl Held {
    /// All of `rows` may go.
    pub(crate) fn clear(&mut self, rows: usize) {
        self.held = NumberSet::default();
        self.slides.clear();
        self.rows = rows;
    }

    /// The grain in `row` stays where it is.
    pub(crate) fn hold(&mut self, row: u32) {
        if self.held.has_no_room() {
            self.held = NumberSet::of(vec![0; self.rows.div_ceil(WORD as usize)]);
        }
        self.held.insert(row);
    }

    /// The grain in `row` makes only the part of its move along `axis`.
    pub(crate) fn slide(&mut self, row: u32, axis: usize) {
        self.hold(row);
        self.slides.push((row, axis));
    }

    /// All have been told: from now on they can be asked for.
    pub(crate) fn order(&mut self) {
        self.slides.sort_unstable();
    }

    /// The rows that do not go where they want to.
    pub(crate) fn rows(&self) -> impl Iterator<Item = u32> {
        self.held.iter()
    }

    /// Brings the grain of `row` to where it gets.
    #[inline(always)]
    pub(crate) fn put<V: Vector, R: Restitution>(
        &self,
        flights: &Flights<'_, V, R>,
        columns: Rows<'_, V>,
        row: usize,
        slot: Slot<'_, V>,
    ) {
        let (there, gained) = flights.free(columns.positions[row], columns.velocities[row]);
        if flights.is_free(there) && !self.holds(row) {
            slot.put(there, gained, columns.ids[row]);
        } else {
            self.put_with_care(flights, columns, row, slot);
        }
    }

    #[inline(always)]
    fn holds(&self, row: usize) -> bool {
        !self.held.has_no_room() && self.held.contains(row as u32)
    }

    /// The rare cases. They write for themselves: a result handed back would go through memory, for all grains.
    #[cold]
    #[inline(never)]
    fn put_with_care<V: Vector, R: Restitution>(
        &self,
        flights: &Flights<'_, V, R>,
        columns: Rows<'_, V>,
        row: usize,
        slot: Slot<'_, V>,
    ) {
        let (position, velocity, id) = (columns.positions[row], columns.velocities[row], columns.ids[row]);
        if self.holds(row) {
            slot.put(self.held_position(flights, columns, row), velocity, id);
        } else {
            let flight = flights.fly_to_the_edge(position, velocity, id, &mut Default::default());
            slot.put(flight.position, flight.velocity, id);
        }
    }

    /// A held grain keeps its position apart from what it slides.
    pub(crate) fn held_position<V: Vector, R: Restitution>(
        &self,
        flights: &Flights<'_, V, R>,
        columns: Rows<'_, V>,
        row: usize,
    ) -> V {
        let mut position = columns.positions[row];
        if let Ok(slide) = self.slides.binary_search_by_key(&(row as u32), |&(row, _)| row) {
            let axis = self.slides[slide].1;
            let (velocity, id) = (columns.velocities[row], columns.ids[row]);
            position[axis] = flights.fly(position, velocity, id, &mut Default::default()).position[axis];
        }
        position
    }
}
