//! What HSMC adds to CBA: an excluded volume on the level of cells.

use std::sync::atomic::AtomicU32;

use super::Step;
use super::admission::{Moves, Rejected};
use super::blocks::{Block, Part, parts, rows_of, with_counts};
use super::cell_collisions::{CellCollisionRules, CellCollisions};
use super::cell_pairs::PairCollisions;
use super::coloured_pass::{ColouredPass, Contested};
use super::entry::Entry;
use super::flight::Flights;
use super::laws::{Laws, Room};
use super::movers::Mover;
use super::parallel;
use super::rules::{Admission, HsmcRules};
use super::tally::{Speeds, Tally};
use super::wishes::{Places, Wish, Wishes};
use crate::engine::cell_counts::CellCount;
use crate::law::piecewise::PiecewiseLinear;
use crate::law::restitution::Restitution;
use crate::matter::gas::{Gas, SortSpace};
use crate::matter::grid::Grid;
use crate::matter::sort::{Counter, REMOVED};
use crate::random::Phase;
use crate::space::Vector;

/// The rules of HSMC and the memory they need.
#[derive(Debug)]
pub(crate) struct ExcludedVolume<V: Vector> {
    rules: HsmcRules,
    /// p(ν) of entering a cell, where it is more than a question of room.
    pub(crate) entry_probability: Option<PiecewiseLinear>,
    cell_collisions: CellCollisions<V>,
    /// `[block]`: displacements that the collisions of the step ask for.
    wishes: Vec<Vec<Wish<V>>>,
    /// `[cell]`: grains that would enter if every wish came true.
    visitors: Vec<AtomicU32>,
    /// `[cell]`: grains now; kept only where cells get crowded.
    occupancy: Vec<AtomicU32>,
    /// `[part]`: grains that want to change their cell.
    movers: Vec<Vec<Mover<V>>>,
}

/// The blocks that one thread takes, each with its wishes.
type WishingPart<'a, V> = Vec<(Block<'a, V>, &'a mut Vec<Wish<V>>)>;

impl<V: Vector> ExcludedVolume<V> {
    pub(crate) fn new(rules: HsmcRules) -> Self {
        ExcludedVolume {
            rules,
            entry_probability: None,
            cell_collisions: CellCollisions::default(),
            wishes: Vec::new(),
            visitors: Vec::new(),
            occupancy: Vec::new(),
            movers: Vec::new(),
        }
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

    /// Pairs collide inside cells and are displaced where there is room. Counts of cells are kept up where there are any.
    pub(crate) fn collide_pairs<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        space: &mut SortSpace<V>,
        step: Step,
        (tally, cell_counts): (&mut Tally<V>, &mut [CellCount]),
    ) {
        let capacity = self.capacity(gas);
        let (grid, offsets, columns) = gas.parts_mut();
        start_counts(&mut self.visitors, (1..offsets.len()).map(|_| 0));
        let wishes =
            Wishes { places: self.places(laws, grid, offsets, capacity, step), visitors: &self.visitors };
        let collisions = PairCollisions::new(laws, grid, offsets, step);
        let parts = with_counts(parts(offsets, columns, &mut space.cells), cell_counts);
        let parts = with_wishes(parts, &mut self.wishes, grid);
        let results = parallel::each(parts.into_iter(), |part| {
            let blocks = part.into_iter().map(|(mut block, list)| {
                let mut tally = Tally::default();
                list.clear();
                collisions.collide(&mut block, offsets, &mut tally, |displaced, _| {
                    list.push(Wish::new(displaced));
                    false
                });
                (tally, wishes.grant(list, &mut block))
            });
            blocks.collect::<Vec<_>>()
        });
        let (mut crowded, mut carried) = (false, 0.0);
        for (block, granted) in results.into_iter().flatten() {
            tally.add(&block);
            carried += granted.carried;
            crowded |= granted.crowded;
        }
        tally.counts.carried_momentum +=
            if crowded { self.find_room(laws, gas, space, step) } else { carried };
    }

    fn places<'a, R: Restitution>(
        &self,
        laws: &Laws<V, R>,
        grid: &'a Grid<V>,
        offsets: &'a [u32],
        capacity: u32,
        step: Step,
    ) -> Places<'a, V> {
        let room = Room::at(grid, &laws.boundary, step.start);
        Places { grid, offsets, room, capacity, rule: self.rules.displacement }
    }

    /// Where cells get crowded: calm cells keep what they were granted, the others are served again, colour by colour.
    /// Returns what the displacements carry.
    fn find_room<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        space: &mut SortSpace<V>,
        step: Step,
    ) -> f64 {
        let capacity = self.capacity(gas);
        let (grid, offsets, columns) = gas.parts_mut();
        start_counts(&mut self.occupancy, offsets.windows(2).map(|ends| ends[1] - ends[0]));
        let places = self.places(laws, grid, offsets, capacity, step);
        let wishes = Wishes { places, visitors: &self.visitors };
        let parts = with_wishes(parts(offsets, columns, &mut space.cells), &mut self.wishes, grid);
        let occupancy = &self.occupancy;
        let results = parallel::each(parts.into_iter(), |part| {
            let mut contested = Vec::new();
            let carried = part
                .into_iter()
                .map(|(mut block, list)| wishes.keep_calm(list, &mut block, occupancy, &mut contested));
            (carried.collect::<Vec<_>>(), contested)
        });
        let (mut contested, mut carried) = (Vec::new(), 0.0);
        for (blocks, cells) in results {
            blocks.into_iter().for_each(|block| carried += block);
            contested.extend(cells.into_iter().map(|cell| contest(cell, &self.wishes, offsets)));
        }
        let order = laws.streams.at(step.number, Phase::Colours);
        carried + ColouredPass { places, occupancy }.run(&contested, columns, &mut space.cells, order)
    }

    /// All grains fly; those who change their cell remember where they were.
    pub(crate) fn advect<R: Restitution>(
        &mut self,
        laws: &Laws<V, R>,
        gas: &mut Gas<V>,
        space: &mut SortSpace<V>,
        step: Step,
        tally: &mut Tally<V>,
    ) {
        let (grid, offsets, columns) = gas.parts_mut();
        let flights = Flights::new(laws, grid, step);
        let parts = parts(offsets, columns, &mut space.cells);
        let counters = space.sort.begin(rows_of(&parts), grid.number_of_cells());
        self.movers.resize_with(counters.len(), Vec::new);
        let work = parts.into_iter().zip(counters).zip(&mut self.movers);
        let tallies = parallel::each(work, |((part, mut counter), movers)| {
            movers.clear();
            let blocks = part.blocks.into_iter().map(|mut block| {
                let mut tally = Tally::default();
                fly(&flights, &mut block, &mut counter, movers, &mut tally);
                tally
            });
            blocks.collect::<Vec<_>>()
        });
        tallies.iter().flatten().for_each(|block| tally.add(block));
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
        let (grid, _, columns) = gas.parts_mut();
        let flights = Flights::new(laws, grid, step);
        let (first, others) = self.movers.split_first_mut().expect("there is a part at least");
        others.iter_mut().for_each(|others| first.append(others));
        if let Some(probability) = &self.entry_probability {
            let grain_share = laws.grain.volume::<V>() / grid.cell_volume();
            let random = laws.streams.at(step.number, Phase::Admission);
            let entry = Entry { probability, grain_share, number_of_cells: grid.number_of_cells(), random };
            entry.refuse(&flights, first, columns, space, tally);
        }
        let movers = &*first;
        let mut moves = Moves {
            grid,
            capacity,
            movers,
            ids: &columns.ids,
            targets: &mut space.cells,
            counts: &mut space.sort,
            ranks: laws.streams.at(step.number, Phase::Admission),
        };
        let mut rejected = match self.rules.admission {
            Admission::Strict => moves.reject_surplus(),
            Admission::Thesis => moves.reject_at_full_cells(),
        };
        tally.counts.rejected_moves += rejected.len() as u64;
        for &Rejected { mover, .. } in &rejected {
            take_back_wall_momentum(&flights, movers[mover as usize], moves.ids, tally);
        }
        let mut slid = Vec::new();
        if self.rules.admission == Admission::Strict {
            for axis in axes_with_gravity_last(laws.gravity) {
                slid.extend(moves.slide(axis, &mut rejected).into_iter().map(|mover| (mover, axis)));
            }
        }
        let mut held = Vec::with_capacity(slid.len() + rejected.len());
        for (mover, axis) in slid {
            movers[mover as usize].slide(axis, &mut columns.positions, &mut columns.velocities);
            held.push(mover);
        }
        for Rejected { mover, .. } in rejected {
            movers[mover as usize].stay(&mut columns.positions, &mut columns.velocities);
            held.push(mover);
        }
        for mover in held {
            let row = movers[mover as usize].row;
            if flights.is_out(columns.positions[row as usize]) {
                moves.send(row, REMOVED);
                tally.counts.removed += 1;
            }
        }
    }
}

/// Moves the grains of a block.
fn fly<V: Vector, R: Restitution>(
    flights: &Flights<'_, V, R>,
    block: &mut Block<'_, V>,
    counter: &mut Counter<'_>,
    movers: &mut Vec<Mover<V>>,
    tally: &mut Tally<V>,
) {
    let rows = block.ids.len();
    let (positions, velocities) = (&mut block.positions[..rows], &mut block.velocities[..rows]);
    let cells = &mut block.targets[..rows];
    let mut speeds = Speeds::default();
    for row in 0..rows {
        let (position, velocity) = (positions[row], velocities[row]);
        let (mut there, mut gained) = flights.free(position, velocity);
        let target = if flights.is_free(there) {
            flights.cell_inside(there)
        } else {
            // Variables of its own: those whose address is handed out live in memory, for all grains.
            let (mut end, mut last) = (position, velocity);
            let target = flights.meet_the_edge((&mut end, &mut last, block.ids[row]), &mut tally.counts);
            (there, gained) = (end, last);
            target
        };
        speeds.note(gained);
        counter.add(target);
        let source = std::mem::replace(&mut cells[row], target);
        if target != source {
            movers.push(Mover { row: (block.first_row + row) as u32, source, position, velocity });
        }
        (positions[row], velocities[row]) = (there, gained);
    }
    tally.speeds.add(&speeds);
}

/// Gives every block the wishes of its place.
fn with_wishes<'a, V: Vector>(
    parts: Vec<Part<'a, V>>,
    wishes: &'a mut Vec<Vec<Wish<V>>>,
    grid: &Grid<V>,
) -> Vec<WishingPart<'a, V>> {
    wishes.resize_with(Block::<V>::number_of(grid.number_of_cells() as u32 - 1) + 1, Vec::new);
    let mut lists = wishes.iter_mut().enumerate();
    let mut list = |block: &Block<'_, V>| {
        let number = Block::<V>::number_of(block.cells.start);
        lists.find(|(place, _)| *place == number).expect("every block has a list, in order").1
    };
    let parts = parts.into_iter().map(|part| {
        part.blocks
            .into_iter()
            .map(|block| (list(&block), block))
            .map(|(list, block)| (block, list))
            .collect()
    });
    parts.collect()
}

/// The wishes of a cell.
fn contest<'a, V: Vector>(cell: u32, wishes: &'a [Vec<Wish<V>>], offsets: &[u32]) -> Contested<'a, V> {
    let number = Block::<V>::number_of(cell);
    let first_cell = Block::<V>::first_cell(number);
    let list = &wishes[number];
    let first = list.partition_point(|wish| wish.asked.cell < cell);
    let last = list.partition_point(|wish| wish.asked.cell <= cell);
    Contested { cell, first_row: offsets[first_cell as usize] as usize, wishes: &list[first..last] }
}

/// Sets the counts of all cells.
fn start_counts(counts: &mut Vec<AtomicU32>, values: impl Iterator<Item = u32>) {
    counts.clear();
    counts.extend(values.map(AtomicU32::new));
}

/// A rejected move has not met the walls it would have met.
pub(crate) fn take_back_wall_momentum<V: Vector, R: Restitution>(
    flights: &Flights<'_, V, R>,
    mover: Mover<V>,
    ids: &[u32],
    tally: &mut Tally<V>,
) {
    let mut momentum = Default::default();
    flights.fly(mover.position, mover.velocity, ids[mover.row as usize], &mut momentum);
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
