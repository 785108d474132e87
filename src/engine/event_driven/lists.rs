//! Lists of neighbours, for dense matter.
//!
//! Each grain has an anchor: where it stood when its list was last renewed. As long as it stays within a
//! box of half-width h around its anchor, it can only meet grains whose boxes come within a contact
//! distance of its own. Whether two grains are neighbours follows from their anchors alone.

use super::body::{Body, Plan};
use super::cells::Cells;
use crate::matter::fetch::fetch;
use crate::space::Vector;

/// Places that a new list gets beyond its first neighbours.
const SPARE_PLACES: u32 = 3;

/// The neighbours of every grain.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lists<V> {
    /// h [length].
    half_width: f64,
    /// `[row]`: where the grain stood when its list was renewed [length].
    anchors: Vec<V>,
    /// `[row]`: where its neighbours stand in the pool.
    spans: Vec<Span>,
    pool: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Span {
    first: u32,
    number: u32,
    room: u32,
}

impl<V: Vector> Lists<V> {
    /// Lists of no grains.
    pub(super) fn new(half_width: f64) -> Self {
        Lists { half_width, ..Lists::default() }
    }

    /// h [length].
    pub(super) fn half_width(&self) -> f64 {
        self.half_width
    }

    /// `[row]` [length].
    pub(super) fn anchors(&self) -> &[V] {
        &self.anchors
    }

    /// Lower and upper corner of the box of the grain in `row` [length].
    #[inline(always)]
    pub(super) fn bounds(&self, row: u32) -> (V, V) {
        let anchor = self.anchors[row as usize];
        let half = V::from_fn(|_| self.half_width);
        (anchor - half, anchor + half)
    }

    /// The neighbours of the grain in `row`.
    #[inline(always)]
    pub(super) fn of(&self, row: u32) -> &[u32] {
        let span = self.spans[row as usize];
        &self.pool[span.first as usize..span.first as usize + span.number as usize]
    }

    /// Sends for the memory that says where the list of the grain in `row` is.
    #[inline(always)]
    pub(super) fn send_for_span(&self, row: u32) {
        fetch(&self.spans[row as usize]);
        fetch(&self.anchors[row as usize]);
    }

    /// Forgets all lists and pools and sets the anchors `[row]`.
    pub(super) fn reset(&mut self, anchors: Vec<V>) {
        self.spans.clear();
        self.spans.resize(anchors.len(), Span::default());
        self.anchors = anchors;
        self.pool.clear();
    }

    /// Makes room for one more grain, which has no neighbours yet.
    pub(super) fn append(&mut self, anchor: V) {
        self.anchors.push(anchor);
        self.spans.push(Span::default());
    }

    /// Finds the neighbours of the grain in `row` among the chains of `cells`, which hold anchors, and
    /// enters it into their lists. `distance` gives the contact distance of a pair [length].
    pub(super) fn find(
        &mut self,
        row: u32,
        cells: &Cells<V>,
        bodies: &[Body<V>],
        plans: &[Plan],
        distance: impl Fn(u32, u32) -> f64,
    ) {
        let anchor = self.anchors[row as usize];
        let reach = 2.0 * self.half_width;
        cells.around(plans[row as usize].cell, None).for_each(|cell, shift: V| {
            let mut other = cells.first(cell);
            while other != super::body::NONE {
                let apart = self.anchors[other as usize] + shift - anchor;
                let gap = V::from_fn(|axis| (apart[axis].abs() - reach).max(0.0));
                let contact = distance(row, other);
                if other != row && gap.length_squared() <= contact * contact && !self.of(row).contains(&other)
                {
                    self.enter(row, other);
                    self.enter(other, row);
                }
                other = bodies[other as usize].next;
            }
        });
    }

    /// Takes the grain in `row` out of all lists.
    pub(super) fn withdraw(&mut self, row: u32) {
        let span = std::mem::take(&mut self.spans[row as usize].number);
        let first = self.spans[row as usize].first as usize;
        for place in first..first + span as usize {
            let other = self.pool[place];
            let theirs = &mut self.spans[other as usize];
            let begin = theirs.first as usize;
            let list = &mut self.pool[begin..begin + theirs.number as usize];
            let at = list.iter().position(|&entry| entry == row).expect("neighbours know each other");
            list[at] = list[list.len() - 1];
            theirs.number -= 1;
        }
    }

    /// Puts the anchor of the grain in `row`, which is in no list, at `anchor`.
    pub(super) fn anchor(&mut self, row: u32, anchor: V) {
        self.anchors[row as usize] = anchor;
    }

    fn enter(&mut self, row: u32, neighbour: u32) {
        let span = &mut self.spans[row as usize];
        if span.number == span.room {
            // The list moves to the end of the pool; what it leaves is won back when all lists are made anew.
            let room = (span.room + span.room / 2).max(span.number + SPARE_PLACES);
            let first = self.pool.len() as u32;
            let old = span.first as usize..span.first as usize + span.number as usize;
            self.pool.extend_from_within(old);
            self.pool.resize(first as usize + room as usize, 0);
            (span.first, span.room) = (first, room);
        }
        self.pool[span.first as usize + span.number as usize] = neighbour;
        span.number += 1;
    }

    /// Whether most of the pool is of no use to any list.
    pub(super) fn is_wasteful(&self) -> bool {
        let used: usize = self.spans.iter().map(|span| span.room as usize).sum();
        self.pool.len() > 2 * used
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::boundary::{AxisBoundary, Boundary, Face};
    use glam::DVec2;

    /// One giant among very many small grains, as in mixtures of extreme diameters.
    #[test]
    fn a_list_may_hold_more_neighbours_than_sixteen_bits_count() {
        let small: u32 = 70_000;
        let side = 100.0;
        let places = (0..small).map(|k| DVec2::new(f64::from(k % 300), f64::from(k / 300)) * 0.3);
        let anchors: Vec<DVec2> = std::iter::once(DVec2::splat(50.0)).chain(places).collect();
        let mut bodies = vec![Body::<DVec2>::default(); anchors.len()];
        let mut plans = vec![Plan::default(); anchors.len()];
        let boundary = Boundary { axes: [AxisBoundary::Faces { lower: Face::Open, upper: Face::Open }; 3] };
        let mut cells = Cells::new(DVec2::splat(side), &boundary, side, side);
        for row in 0..anchors.len() as u32 {
            cells.insert(0, row, &mut bodies, &mut plans);
        }
        let mut lists = Lists::new(0.1);
        lists.reset(anchors);
        lists.find(0, &cells, &bodies, &plans, |one, other| if one.min(other) == 0 { side } else { 0.1 });
        assert_eq!(lists.of(0).len(), small as usize);
        assert!((1..=small).all(|row| lists.of(row) == [0]));
        lists.withdraw(0);
        assert!((0..=small).all(|row| lists.of(row).is_empty()));
    }
}
