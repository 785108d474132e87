//! Cell–cell collisions of HSMC: momentum passes between crowded cells (Müller 2001, section 2.3.2).
//!
//! Cells are treated like grains with the mass and mean velocity of what they hold. The energy
//! that an inelastic cell collision takes returns as heat, so that momentum and energy are kept.

use super::number_set::NumberSet;
use super::parallel;
use crate::engine::report::Counts;
use crate::matter::gas::Gas;
use crate::matter::grid::Grid;
use crate::random::{Phase, PhaseStreams, Stream, Streams};
use crate::space::Vector;

/// Below this share of the returned heat, thermal motion is too weak to be scaled (Müller 2001, 2.33 is singular).
const WEAKEST_THERMAL_SHARE: f64 = 1e-3;

/// Mean velocity and thermal motion of the grains of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct CellField<V> {
    grains: u32,
    /// v_c [length/time].
    velocity: V,
    /// Σ |v_i − v_c|²: twice the thermal energy per mass [length²/time²].
    thermal: f64,
}

/// What a collision does to one of its two cells.
#[derive(Clone, Copy, Debug)]
struct Outcome<V> {
    /// Its place among the active cells.
    place: u32,
    cell: u32,
    /// Change of the mean velocity [length/time].
    kick: V,
    heat: Heat,
}

/// How the lost energy comes back.
#[derive(Clone, Copy, Debug)]
enum Heat {
    /// Velocities relative to the mean are scaled by k.
    Scale(f64),
    /// Thermal motion begins anew, with this Σ |v_i − v_c|² [length²/time²].
    Renew(f64),
}

/// The cell–cell collisions of an engine, with memory kept from step to step.
#[derive(Debug, Default)]
pub(crate) struct CellCollisions<V: Vector> {
    /// Cells that are full or beside a full one, and not empty, in rising order.
    active: Vec<Active>,
    /// `[active cell]`.
    fields: Vec<CellField<V>>,
    /// `[active cell]`: which other one a white cell wants to collide with.
    choices: Vec<u32>,
}

/// A cell that may take part in collisions. What stays the same from sweep to sweep is looked up once.
#[derive(Clone, Copy, Debug)]
struct Active {
    cell: u32,
    /// Of the two colours of a chessboard.
    colour: u32,
    /// `[2 axis + upwards]`: the neighbour that it may collide with, as its place among the active cells, or nobody.
    partners: [u32; 6],
}

/// A white cell that wants to collide with nobody.
const NOBODY: u32 = u32::MAX;

/// The laws of cell–cell collisions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellCollisionRules {
    /// Grains that make a cell full.
    pub(crate) capacity: u32,
    /// Restitution of cells.
    pub(crate) restitution: f64,
    /// Sweeps per step.
    pub(crate) sweeps: u32,
    /// Mass of a grain.
    pub(crate) mass: f64,
}

impl<V: Vector> CellCollisions<V> {
    /// All sweeps of one step.
    pub(crate) fn sweep(
        &mut self,
        rules: CellCollisionRules,
        gas: &mut Gas<V>,
        streams: Streams,
        step: u64,
        counts: &mut Counts<V>,
    ) {
        self.find_active(gas, rules.capacity);
        if self.active.is_empty() {
            return;
        }
        self.measure(gas);
        for sweep in 0..u64::from(rules.sweeps) {
            // Colours exchange their roles from sweep to sweep and from step to step.
            let parity = ((step + sweep) & 1) as u32;
            let serial = step.wrapping_mul(u64::from(rules.sweeps)).wrapping_add(sweep);
            let random = streams.at(serial, Phase::CellCollisions);
            self.choose(gas, parity);
            let outcomes = self.collide(rules, gas, parity, random, counts);
            self.apply(gas, outcomes, random);
        }
    }

    /// Lists the cells that could take part: not empty, and full or beside a full one.
    fn find_active(&mut self, gas: &Gas<V>, capacity: u32) {
        self.active.clear();
        let number_of_cells = gas.grid().number_of_cells();
        let full = |cell: u32| gas.occupancy(cell) >= capacity;
        let mut full_cells = occupied_spans(gas).flatten().filter(|&cell| full(cell)).peekable();
        if full_cells.peek().is_none() {
            return;
        }
        let mut cells = NumberSet::below(number_of_cells);
        for cell in full_cells {
            cells.insert(cell);
            let beside = neighbours(gas.grid(), cell).map(|(_, other)| other);
            beside.filter(|&other| gas.occupancy(other) > 0).for_each(|other| cells.insert(other));
        }
        cells.number();
        self.active.extend(cells.iter().map(|cell| Active::new(gas, cell, full, &cells)));
    }

    fn measure(&mut self, gas: &Gas<V>) {
        self.fields = parallel::map_slice(gas.len(), &self.active, |active| {
            CellField::of(&gas.velocities()[gas.rows(active.cell)])
        });
    }

    /// Each white cell chooses the neighbour it approaches fastest; ties go to the lower cell number.
    fn choose(&mut self, gas: &Gas<V>, parity: u32) {
        let fields = &self.fields;
        let choice = |(place, active): (usize, &Active)| {
            let mut best = (NOBODY, 0.0);
            for (axis, upwards, other) in active.partners() {
                let approach = approach_speed(fields, place as u32, other, axis, upwards);
                if approach > best.1 || (approach == best.1 && approach > 0.0 && other < best.0) {
                    best = (other, approach);
                }
            }
            best.0
        };
        self.choices = parallel::map_numbered(gas.len(), &self.active, |(place, active)| {
            if active.is_white(parity) { choice((place, active)) } else { NOBODY }
        });
    }

    /// Each black cell collides with the fastest of its suitors: one collision per cell at most.
    fn collide(
        &self,
        rules: CellCollisionRules,
        gas: &Gas<V>,
        parity: u32,
        random: PhaseStreams,
        counts: &mut Counts<V>,
    ) -> Vec<Outcome<V>> {
        let grid = gas.grid();
        let pairs = parallel::map_numbered(gas.len(), &self.active, |(place, active)| {
            let pair =
                if active.is_white(parity) { None } else { self.accepted_suitor(place as u32, active) };
            pair.map(|pair| self.outcome(rules, grid, pair, random))
        });
        let mut outcomes = Vec::with_capacity(self.active.len());
        for (black, white, carried) in pairs.into_iter().flatten() {
            counts.cell_collisions += 1;
            outcomes.extend([black, white]);
            counts.carried_momentum += carried;
        }
        outcomes.sort_unstable_by_key(|outcome| outcome.cell);
        outcomes
    }

    /// The pair (black, white), as places, with the axis and direction from black to white.
    fn accepted_suitor(&self, black: u32, active: &Active) -> Option<(u32, u32, usize, bool)> {
        let mut best: Option<(u32, u32, usize, bool)> = None;
        let mut fastest = 0.0;
        for (axis, upwards, white) in active.partners() {
            if self.choices[white as usize] != black {
                continue;
            }
            let approach = approach_speed(&self.fields, black, white, axis, upwards);
            let wins = approach > fastest
                || (approach == fastest && best.is_some_and(|(_, other, ..)| white < other));
            if wins {
                fastest = approach;
                best = Some((black, white, axis, upwards));
            }
        }
        best
    }

    /// The collision follows the rules of two grains: a random impact parameter about the
    /// direction of approach, restitution along the normal (Müller 2001, B.1.3).
    fn outcome(
        &self,
        rules: CellCollisionRules,
        grid: &Grid<V>,
        (black, white, axis, upwards): (u32, u32, usize, bool),
        random: PhaseStreams,
    ) -> (Outcome<V>, Outcome<V>, f64) {
        let (a, b) = (self.fields[black as usize], self.fields[white as usize]);
        let relative = a.velocity - b.velocity;
        let [black_cell, white_cell] = [black, white].map(|place| self.active[place as usize].cell);
        let elastic = V::exchange(relative, &mut random.stream(u64::from(black_cell)));
        let (n_a, n_b) = (f64::from(a.grains), f64::from(b.grains));
        let reduced = n_a * n_b / (n_a + n_b);
        let impulse = elastic * ((1.0 + rules.restitution) * reduced);
        // In units of the grain mass: Σ |v − v_c|² that the two cells gain together.
        let lost = (1.0 - rules.restitution * rules.restitution) * reduced * elastic.length_squared();
        let (heat_a, heat_b) = heats(&a, &b, lost);
        let separation = if upwards { -grid.side()[axis] } else { grid.side()[axis] };
        let carried = rules.mass * impulse[axis] * separation;
        (
            Outcome { place: black, cell: black_cell, kick: impulse * (1.0 / n_a), heat: heat_a },
            Outcome { place: white, cell: white_cell, kick: impulse * (-1.0 / n_b), heat: heat_b },
            carried,
        )
    }

    /// Gives the grains their new velocities. `outcomes` are in rising cell number, one per cell.
    fn apply(&mut self, gas: &mut Gas<V>, outcomes: Vec<Outcome<V>>, random: PhaseStreams) {
        let grains = gas.len();
        let (_, offsets, columns) = gas.parts_mut();
        let mut velocities = columns.velocities.as_mut_slice();
        let mut cut = 0;
        let mut work = Vec::with_capacity(outcomes.len());
        for outcome in outcomes {
            let (first, last) = (offsets[outcome.cell as usize], offsets[outcome.cell as usize + 1]);
            let (first, last) = (first as usize, last as usize);
            velocities.split_off_mut(..first - cut).expect("cells come in rising order");
            let rows = velocities.split_off_mut(..last - first).expect("a cell has its rows");
            cut = last;
            work.push((outcome, rows));
        }
        let fields = &self.fields;
        let changed = parallel::map(grains, work, |(outcome, rows)| {
            let field = fields[outcome.place as usize];
            outcome.apply(field.velocity, rows, random);
            (outcome.place, CellField::of(rows))
        });
        for (place, field) in changed {
            self.fields[place as usize] = field;
        }
    }
}

impl Active {
    fn new<V: Vector>(gas: &Gas<V>, cell: u32, full: impl Fn(u32) -> bool, active: &NumberSet) -> Self {
        let [i, j, k] = gas.grid().coordinates(cell);
        let mut partners = [NOBODY; 6];
        for (place, other) in neighbours(gas.grid(), cell) {
            if gas.occupancy(other) > 0 && (full(cell) || full(other)) {
                partners[place] = active.place(other).expect("a full cell and those beside it are active");
            }
        }
        Active { cell, colour: (i + j + k) & 1, partners }
    }

    fn is_white(&self, parity: u32) -> bool {
        (self.colour + parity) & 1 == 0
    }

    /// Axis, whether upwards, and the other's place.
    fn partners(&self) -> impl Iterator<Item = (usize, bool, u32)> + '_ {
        let places = self.partners.iter().enumerate().filter(|(_, other)| **other != NOBODY);
        places.map(|(place, &other)| (place / 2, place % 2 == 1, other))
    }
}

impl<V: Vector> CellField<V> {
    fn of(velocities: &[V]) -> Self {
        let mut sum = V::ZERO;
        for &velocity in velocities {
            sum += velocity;
        }
        let velocity = sum * (1.0 / velocities.len() as f64);
        let thermal = velocities.iter().map(|&v| (v - velocity).length_squared()).sum();
        CellField { grains: velocities.len() as u32, velocity, thermal }
    }
}

impl<V: Vector> Outcome<V> {
    /// v′ = v + Δv_c, and relative to the mean either scaled by k or drawn anew.
    fn apply(&self, mean: V, velocities: &mut [V], random: PhaseStreams) {
        match self.heat {
            Heat::Scale(k) => {
                for velocity in velocities {
                    *velocity += self.kick + (*velocity - mean) * (k - 1.0);
                }
            }
            Heat::Renew(thermal) => {
                let mut random = random.stream(u64::from(self.cell) | 1 << 32);
                let noise = zero_mean_noise(velocities.len(), thermal, &mut random);
                for (velocity, noise) in velocities.iter_mut().zip(noise) {
                    *velocity = mean + self.kick + noise;
                }
            }
        }
    }
}

/// One common factor k = √((E_a + E_b + ΔE)/(E_a + E_b)) for both cells (Müller 2001, 2.33); where there
/// is next to no thermal motion, shares by inner degrees of freedom. Two single grains have
/// none: their heat is lost.
fn heats<V: Vector>(a: &CellField<V>, b: &CellField<V>, lost: f64) -> (Heat, Heat) {
    let thermal = a.thermal + b.thermal;
    if thermal >= WEAKEST_THERMAL_SHARE * lost {
        let k = if thermal > 0.0 { ((thermal + lost) / thermal).sqrt() } else { 1.0 };
        return (Heat::Scale(k), Heat::Scale(k));
    }
    let (inner_a, inner_b) = (f64::from(a.grains - 1), f64::from(b.grains - 1));
    let share = |inner: f64| match inner > 0.0 {
        true => Heat::Renew((thermal + lost) * inner / (inner_a + inner_b)),
        false => Heat::Scale(1.0),
    };
    (share(inner_a), share(inner_b))
}

/// Gaussian vectors of zero mean whose squares add up to `thermal`.
fn zero_mean_noise<V: Vector>(grains: usize, thermal: f64, random: &mut Stream) -> Vec<V> {
    let mut noise: Vec<V> = (0..grains).map(|_| V::from_fn(|_| random.gaussian())).collect();
    let field = CellField::of(&noise);
    let scale = (thermal / field.thermal).sqrt();
    for vector in &mut noise {
        *vector = (*vector - field.velocity) * scale;
    }
    noise
}

/// Speed at which `cell` and its neighbour `other` approach each other along their axis [length/time].
fn approach_speed<V: Vector>(
    fields: &[CellField<V>],
    cell: u32,
    other: u32,
    axis: usize,
    upwards: bool,
) -> f64 {
    let difference = fields[cell as usize].velocity[axis] - fields[other as usize].velocity[axis];
    if upwards { difference } else { -difference }
}

/// Spans of cells that are not all empty, in rising order.
fn occupied_spans<V: Vector>(gas: &Gas<V>) -> impl Iterator<Item = std::ops::Range<u32>> + '_ {
    const SPAN: usize = 64;
    let cells = gas.grid().number_of_cells();
    (0..cells).step_by(SPAN).filter_map(move |first| {
        let last = (first + SPAN).min(cells);
        (gas.offsets()[first] < gas.offsets()[last]).then_some(first as u32..last as u32)
    })
}

/// The face neighbours of `cell`, each with its place 2 axis + upwards.
fn neighbours<V: Vector>(grid: &Grid<V>, cell: u32) -> impl Iterator<Item = (usize, u32)> + '_ {
    let coordinates = grid.coordinates(cell);
    (0..2 * V::DIMENSION).filter_map(move |place| {
        grid.neighbour(coordinates, place / 2, place % 2 == 1).map(|other| (place, other))
    })
}

#[cfg(test)]
#[path = "cell_collisions_tests.rs"]
mod tests;
