//! What HSMC adds to CBA: an excluded volume on the level of cells.

use super::Step;
use super::admission::Moves;
use super::blocks::Block;
use super::cell_collisions::{CellCollisionRules, CellCollisions};
use super::cell_pairs::PairCollisions;
use super::coloured_pass::ColouredPass;
use super::enskog::EnskogFactors;
use super::flight::Flights;
use super::laws::{Laws, Room};
use super::parallel;
use super::rules::{Admission, HsmcRules};
use super::tally::Tally;
use crate::law::restitution::Restitution;
use crate::matter::columns::Columns;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::sort::REMOVED;
use crate::random::Phase;
use crate::space::Vector;

/// The rules of HSMC and the memory they need.
#[derive(Debug)]
pub(crate) struct ExcludedVolume<V: Vector> {
    rules: HsmcRules,
    cell_collisions: CellCollisions<V>,
    moves: Moves,
}

impl<V: Vector> ExcludedVolume<V> {
    pub(crate) fn new(rules: HsmcRules) -> Self {
        ExcludedVolume { rules, cell_collisions: CellCollisions::default(), moves: Moves::default() }
    }

    /// Grains that make a cell of `gas` full.
    pub(crate) fn capacity(&self, gas: &Gas<V>) -> u32 {
        gas.grid().capacity(gas.grain.diameter, self.rules.maximum_volume_fraction)
    }

    /// Full cells and their neighbours collide like grains.
    pub(crate) fn collide_cells<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        step: Step,
        tally: &mut Tally<V>,
    ) {
        let rules = CellCollisionRules {
            capacity: self.capacity(gas),
            restitution: self.rules.cell_restitution,
            sweeps: self.rules.sweeps,
            mass: laws.grain.mass,
        };
        self.cell_collisions.sweep(rules, gas, laws.streams, step.number, &mut tally.counts);
    }

    /// Pairs collide inside cells and are displaced where there is room.
    pub(crate) fn collide_pairs<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        step: Step,
        tally: &mut Tally<V>,
    ) {
        let capacity = self.capacity(gas);
        let (grid, offsets, columns) = gas.parts_mut();
        self.moves.begin(offsets, columns.len());
        let pass = ColouredPass {
            grid,
            offsets,
            collisions: PairCollisions::new(laws, grid, offsets, step),
            room: Room::at(grid, &laws.boundary, step.start),
            capacity,
            rule: self.rules.displacement,
            occupancy: &self.moves.occupancy,
        };
        let order = laws.streams.at(step.number, Phase::Colours);
        tally.add(&pass.run(columns, &mut self.moves.sources, order));
    }

    /// Every grain announces where it would go: into the spare columns, nothing is decided yet.
    pub(crate) fn advect<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        space: &mut SortSpace<V>,
        step: Step,
        tally: &mut Tally<V>,
    ) {
        let capacity = self.capacity(gas);
        let mut crowds = std::mem::take(&mut self.moves.crowded);
        crowds.clear();
        let (grid, offsets, columns) = gas.parts_mut();
        space.spare.take_labels(columns);
        let flights = Flights::new(laws, grid, step);
        let (moves, columns) = (&self.moves, &*columns);
let _=flights; let _= moves; let _ = columns;
        self.moves.crowded = crowds;
    }

    /// Rejects moves into cells without room. A rejected grain keeps position and velocity, and
    /// gets nothing from gravity; a diagonal mover may go along one axis, gravity's last. One
    /// whose displacement has carried it out through an open side has no place to keep: it leaves.
    pub(crate) fn admit<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        space: &mut SortSpace<V>,
        step: Step,
        tally: &mut Tally<V>,
    ) {
        let capacity = self.capacity(gas);
        let ranks = laws.streams.at(step.number, Phase::Admission);
        let (grid, _, columns) = gas.parts_mut();
        let SortSpace { spare, cells, .. } = space;
        let flights = Flights::new(laws, grid, step);
        let rejected = self.moves.reject(self.rules.admission, capacity, cells, &spare.ids, ranks);
        tally.counts.rejected_moves += rejected.len() as u64;
        for &row in rejected {
            take_back_wall_momentum(&flights, columns, spare.ids[row as usize], row as usize, tally);
        }
        if self.rules.admission == Admission::Strict {
            for axis in axes_with_gravity_last(laws.gravity) {
                for row in self.moves.slide(axis, capacity, grid, cells, &spare.ids, ranks) {
                    let row = row as usize;
                    let along = spare.positions[row][axis];
                    spare.positions[row] = columns.positions[row];
                    spare.positions[row][axis] = along;
                    spare.velocities[row] = columns.velocities[row];
                    if flights.is_out(spare.positions[row]) {
                        cells[row] = REMOVED;
                        tally.counts.removed += 1;
                    }
                }
            }
        }
        for &row in self.moves.rejected() {
            let row = row as usize;
            cells[row] = self.moves.sources[row];
            spare.positions[row] = columns.positions[row];
            spare.velocities[row] = columns.velocities[row];
            if flights.is_out(spare.positions[row]) {
                cells[row] = REMOVED;
                tally.counts.removed += 1;
            }
        }
    }
}

/// Flies the grains of a block from the columns to the spare ones and announces who changes cells.
/// Also returns the cells that were found crowded.
fn fly_block<V: Vector, R: Restitution>(
    flights: &Flights<'_, V, R>,
    moves: &Moves,
    columns: &Columns<V>,
    capacity: u32,
    block: Block<'_, V>,
) -> (Tally<V>, Vec<u32>) {
    let mut tally = Tally::default();
    let mut crowded = Vec::new();
    for k in 0..block.ids.len() {
        let row = block.first_row + k;
        let (position, velocity) = (columns.positions[row], columns.velocities[row]);
        let flight = flights.fly(position, velocity, block.ids[k], &mut tally.counts.wall_momentum);
        tally.speeds.note(flight.velocity);
        block.positions[k] = flight.position;
        block.velocities[k] = flight.velocity;
        let target = if flight.left { REMOVED } else { flights.cell_of(flight.position) };
        tally.counts.removed += u64::from(flight.left);
        block.targets[k] = target;
        let source = moves.sources[row];
        if target != source && moves.announce(source, target) > capacity {
            crowded.push(target);
        }
    }
    (tally, crowded)
}

/// A rejected move has not met the walls it would have met.
fn take_back_wall_momentum<V: Vector, R: Restitution>(
    flights: &Flights<'_, V, R>,
    columns: &Columns<V>,
    id: u32,
    row: usize,
    tally: &mut Tally<V>,
) {
    let mut momentum = Default::default();
    flights.fly(columns.positions[row], columns.velocities[row], id, &mut momentum);
    for (axis, sides) in momentum.iter().enumerate() {
        for (side, &given) in sides.iter().enumerate() {
            tally.counts.wall_momentum[axis][side] -= given;
        }
    }
}

/// Horizontal axes first, the axis along which gravity is strongest last.
fn axes_with_gravity_last<V: Vector>(gravity: V) -> Vec<usize> {
    let mut axes: Vec<usize> = (0..V::DIMENSION).collect();
    axes.sort_by(|&a, &b| gravity[a].abs().total_cmp(&gravity[b].abs()));
    axes
}
