//! How partners are found, in cells or by lists, and in which order grains stand in memory.

use super::body::{Body, Contact, Event, NONE, Plan};
use super::cells::Cells;
use super::lists::Lists;
use super::order::place_on_curve;
use super::rules::Structure;
use super::world::World;
use crate::space::Vector;

/// Grains in a cell, where they are too far apart for cells of their own size: in 2D and in 3D. Measured: fewer
/// grains make more crossings, more grains longer searches.
const GRAINS_PER_CELL: [f64; 2] = [0.7, 0.4];

/// Most cells beside a number for each grain.
const MOST_CELLS: (f64, f64) = (4.0, 1_048_576.0);
/// Half-width of the surroundings of a list, as a share of the mean gap between grains.
const SHARE_OF_GAP: f64 = 2.0;
/// Smallest and largest half-width [diameters].
const HALF_WIDTHS: (f64, f64) = (0.02, 0.3);
/// Volume fraction from which on a run begins with lists: in 2D and in 3D.
const DENSE: [f64; 2] = [0.8, 0.55];
/// Collisions for each crossing above which lists take over from cells: grains are then caged.
const COLLISIONS_PER_CROSSING: f64 = 40.0;
/// Collisions for each renewal below which cells take over from lists.
const COLLISIONS_PER_RENEWAL: f64 = 4.0;

/// Cells of a side, and lists of a half-width if any [length].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrangement {
    pub(super) side: f64,
    pub(super) half_width: Option<f64>,
}

impl<V: Vector> World<V> {
    /// What suits the grains at the beginning.
    pub(super) fn first_arrangement(&self) -> Arrangement {
        let dense = self.volume_fraction() >= DENSE[V::DIMENSION - 2];
        match self.structure {
            Structure::NeighbourLists => self.with_lists(),
            Structure::Automatic if dense => self.with_lists(),
            Structure::Automatic | Structure::Cells => self.with_cells(),
        }
    }

    /// What suits the events of the last year better than what there is.
    pub(super) fn next_arrangement(&self) -> Option<Arrangement> {
        let grains = self.bodies.len() as u64;
        let (collisions, crossings) = (self.pace.collisions as f64, self.pace.crossings as f64);
        if grains > 2 * self.pace.arranged_for {
            return Some(if self.lists.is_some() { self.with_lists() } else { self.with_cells() });
        }
        if self.structure != Structure::Automatic {
            return None;
        }
        match &self.lists {
            None if collisions > COLLISIONS_PER_CROSSING * crossings + grains as f64 => {
                Some(self.with_lists())
            }
            Some(_) if collisions < COLLISIONS_PER_RENEWAL * crossings => Some(self.with_cells()),
            _ => None,
        }
        .filter(|arrangement| arrangement.half_width.is_some() != self.lists.is_some())
    }

    fn with_cells(&self) -> Arrangement {
        Arrangement { side: self.cell_side(), half_width: None }
    }

    /// Lists where the box is wide enough for them, cells where it is not.
    fn with_lists(&self) -> Arrangement {
        let diameter = self.laws.largest_diameter();
        let fraction = self.volume_fraction().max(1e-3);
        let gap = libm::pow(V::DENSEST_PACKING / fraction, 1.0 / V::DIMENSION as f64) - 1.0;
        let half_width = (SHARE_OF_GAP * gap).clamp(HALF_WIDTHS.0, HALF_WIDTHS.1) * diameter;
        let reach = diameter + 2.0 * half_width;
        if self.is_wide_for(reach) {
            Arrangement { side: reach, half_width: Some(half_width) }
        } else {
            self.with_cells()
        }
    }

    /// Whether lists that reach so far have room [length]: only one image of a neighbour may be near, and three cells must
    /// fit along each periodic axis.
    fn is_wide_for(&self, reach: f64) -> bool {
        (0..V::DIMENSION)
            .all(|axis| !self.laws.boundary.is_periodic(axis) || self.laws.size[axis] > 3.01 * reach)
    }

    /// Whether there can be so many cells along each axis, and lists of this half-width [length], when they were made for
    /// at most so many `grains`.
    pub(super) fn may_have(&self, counts: [u32; 3], half_width: Option<f64>, grains: u64) -> bool {
        let diameter = self.laws.largest_diameter();
        let Some(half_width) = half_width else {
            let wish = self.least_side(grains as f64).max(diameter);
            let most = Cells::counts_of(self.laws.size, diameter, wish);
            return counts.iter().zip(most).all(|(&count, most)| (1..=most).contains(&count));
        };
        let reach = diameter + 2.0 * half_width;
        self.structure != Structure::Cells
            && (HALF_WIDTHS.0 * diameter..=HALF_WIDTHS.1 * diameter).contains(&half_width)
            && self.is_wide_for(reach)
            && counts == Cells::counts_of(self.laws.size, reach, reach)
    }

    /// Share of the box that the grains fill at their full size.
    fn volume_fraction(&self) -> f64 {
        let volume: f64 = (0..self.bodies.len() as u32).map(|row| self.grain(row).volume::<V>()).sum();
        volume / self.laws.size.product()
    }

    /// The side of a cell that holds a grain or so; a grain that falls comes to lie near others [length].
    fn cell_side(&self) -> f64 {
        let (volume, grains) = (self.laws.size.product(), self.bodies.len() as f64);
        let least = self.least_side(grains);
        if self.falls {
            return least;
        }
        let share = GRAINS_PER_CELL[V::DIMENSION - 2] * volume / grains.max(1.0);
        libm::pow(share, 1.0 / V::DIMENSION as f64).max(least)
    }

    /// The side of the smallest cells that so many `grains` are given [length].
    fn least_side(&self, grains: f64) -> f64 {
        let volume = self.laws.size.product() / (MOST_CELLS.0 * grains + MOST_CELLS.1);
        libm::pow(volume, 1.0 / V::DIMENSION as f64)
    }

    /// Puts all grains, which are up to date, into new cells and into order, and makes their lists.
    pub(super) fn arrange(&mut self, arrangement: Arrangement) {
        let Arrangement { side, half_width } = arrangement;
        let reach = self.laws.largest_diameter() + 2.0 * half_width.unwrap_or(0.0);
        self.cells = Cells::new(self.laws.size, &self.laws.boundary, reach, side.max(reach));
        self.lists = half_width.map(Lists::new);
        self.pace.arranged_for = self.bodies.len() as u64;
        for (body, plan) in self.bodies.iter_mut().zip(&mut self.plans) {
            if plan.event == Event::Gone {
                continue;
            }
            for axis in (0..V::DIMENSION).filter(|&axis| self.laws.boundary.is_periodic(axis)) {
                let period = self.laws.size[axis];
                body.position[axis] -= (body.position[axis] / period).floor() * period;
            }
            *plan = Plan { cell: self.cells.cell_of(body.position), ..Plan::default() };
        }
        if let Some(lists) = &mut self.lists {
            lists.reset(self.bodies.iter().map(|body| body.position).collect());
        }
        self.order();
    }

    /// Brings the grains into the order of a curve that fills space, and forgets those that have left.
    pub(super) fn order(&mut self) {
        let order = self.rows_on_curve();
        let mut new_rows = vec![NONE; self.bodies.len()];
        for (new, &old) in order.iter().enumerate() {
            new_rows[old as usize] = new as u32;
        }
        gather_bodies(&mut self.bodies, &order);
        gather(&mut self.plans, &order);
        gather(&mut self.ids, &order);
        self.spins.as_mut().into_iter().for_each(|spins| gather(spins, &order));
        self.species.as_mut().into_iter().for_each(|species| gather(species, &order));
        self.last_collisions.as_mut().into_iter().for_each(|last| gather(last, &order));
        for (row, plan) in self.plans.iter_mut().enumerate() {
            let contact = &mut plan.contact;
            match new_rows.get(contact.partner as usize) {
                None => {}
                // A partner that has left will be met by nobody: the grain itself stands in for it, with a count
                // that it does not have.
                Some(&NONE) => {
                    let collisions = !self.bodies[row].collisions;
                    *contact = Contact { partner: row as u32, collisions, ..*contact };
                }
                Some(&partner) => contact.partner = partner,
            }
        }
        if let Some(lists) = &mut self.lists {
            let mut anchors = lists.anchors().to_vec();
            gather(&mut anchors, &order);
            lists.reset(anchors);
        }
        self.link();
        (self.pace.crossings_since_order, self.pace.gone) = (0, 0);
    }

    /// The rows of all grains that have not left, in the order of their places on the curve.
    fn rows_on_curve(&self) -> Vec<u32> {
        let places = self.bodies.iter().map(|body| place_on_curve(&self.cells, body.position));
        let mut order: Vec<(u64, u32)> = places.zip(0..).collect();
        order.retain(|&(_, row)| self.plans[row as usize].event != Event::Gone);
        order.sort_unstable_by_key(|&(place, row)| (place, self.ids[row as usize]));
        order.iter().map(|&(_, row)| row).collect()
    }

    /// Makes the chains of all cells, and all lists, of grains that know their cells and anchors.
    pub(super) fn link(&mut self) {
        self.cells.clear();
        for row in (0..self.bodies.len() as u32).rev() {
            let cell = self.plans[row as usize].cell;
            if cell != NONE {
                self.cells.insert(cell, row, &mut self.bodies, &mut self.plans);
            }
        }
        if self.lists.is_some() {
            for row in 0..self.bodies.len() as u32 {
                if self.plans[row as usize].cell != NONE {
                    self.find_neighbours(row);
                }
            }
        }
    }
}

/// Puts row `order[k]` at row k, for all k.
fn gather<T: Copy>(column: &mut Vec<T>, order: &[u32]) {
    *column = order.iter().map(|&row| column[row as usize]).collect();
}

/// The same one field after another, so that the copy is small.
fn gather_bodies<V: Vector>(bodies: &mut Vec<Body<V>>, order: &[u32]) {
    gather_field(bodies, order, |body| &mut body.position);
    gather_field(bodies, order, |body| &mut body.velocity);
    gather_field(bodies, order, |body| &mut body.time);
    gather_field(bodies, order, |body| &mut body.collisions);
    bodies.truncate(order.len());
}

fn gather_field<V: Vector, T: Copy>(
    bodies: &mut [Body<V>],
    order: &[u32],
    field: impl Fn(&mut Body<V>) -> &mut T,
) {
    let copy: Vec<T> = order.iter().map(|&row| *field(&mut bodies[row as usize])).collect();
    for (body, value) in bodies.iter_mut().zip(copy) {
        *field(body) = value;
    }
}
