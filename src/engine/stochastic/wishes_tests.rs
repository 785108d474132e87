use super::*;
use crate::engine::stochastic::Step;
use crate::engine::stochastic::blocks::parts;
use crate::engine::stochastic::cell_pairs::PairCollisions;
use crate::engine::stochastic::coloured_pass::{ColouredPass, Contested, in_turn};
use crate::engine::stochastic::tally::Tally;
use crate::engine::stochastic::trial::{DENSE, gas, laws};
use crate::law::boundary::{AxisBoundary, Face, Wall, WallKind};
use crate::matter::gas::Gas;
use crate::random::{Phase, PhaseStreams, Stream, Streams};
use glam::DVec2;

const CAPACITY: u32 = 4;
/// Two blocks of 256 cells.
const CELLS: [u32; 2] = [20, 16];

/// What came of the displacements of one step, and what they were.
struct Served {
    /// `[block]`: wishes as they were asked for.
    asked: Vec<Vec<Displaced<DVec2>>>,
    /// Cells that were found calm, and those that had to wait for their turn.
    calm: Vec<u32>,
    contested: Vec<u32>,
    positions: Vec<DVec2>,
    carried: f64,
}

fn crowd(seed: u64) -> Gas<DVec2> {
    let mut random = Streams::new(seed).at(1, Phase::InitialPositions).stream(0);
    // Few cells are full, so that there is something to be displaced.
    let few = 2.0 + 2.4 * random.uniform();
    let grains: Vec<u32> = (0..CELLS[0] * CELLS[1]).map(|_| (few * random.uniform()) as u32).collect();
    gas(CELLS, [true, false], &grains, 1.0, seed)
}

/// Room between two walls above and below, elsewhere none ends.
fn room(grid: &Grid<DVec2>) -> Room<DVec2> {
    let face = Face::Wall(Wall { restitution: 1.0, kind: WallKind::Smooth });
    let mut boundary = laws(None).boundary;
    boundary.axes[1] = AxisBoundary::Faces { lower: face, upper: face };
    Room::at(grid, &boundary, 0.0)
}

fn colours(seed: u64) -> PhaseStreams {
    Streams::new(seed).at(0, Phase::Colours)
}

/// Collides the pairs of `gas` and serves what they wish: calm cells at once, the others colour by colour.
fn served(gas: &mut Gas<DVec2>, rule: DisplacementRule, seed: u64) -> Served {
    let laws = laws(Some(DENSE));
    let (grid, offsets, columns) = gas.parts_mut();
    let places = Places { grid, offsets, room: room(grid), capacity: CAPACITY, rule };
    let counts = |count: fn(&[u32]) -> u32| offsets.windows(2).map(|w| AtomicU32::new(count(w))).collect();
    let visitors: Vec<AtomicU32> = counts(|_| 0);
    let occupancy: Vec<AtomicU32> = counts(|ends| ends[1] - ends[0]);
    let wishes = Wishes { places, visitors: &visitors };
    let collisions =
        PairCollisions::new(&laws, grid, offsets, Step { number: seed, start: 0.0, duration: 0.5 });
    let mut targets = vec![0; columns.len()];
    let mut blocks: Vec<_> =
        parts(offsets, columns, &mut targets).into_iter().flat_map(|p| p.blocks).collect();
    let mut lists: Vec<Vec<Wish<DVec2>>> = Vec::new();
    for block in &mut blocks {
        let mut list = Vec::new();
        collisions.collide(block, offsets, &mut Tally::default(), |displaced, _| {
            list.push(Wish::new(displaced));
            false
        });
        wishes.grant(&mut list, block);
        lists.push(list);
    }
    let (mut calm, mut contested, mut carried) = (Vec::new(), Vec::new(), 0.0);
    for (block, list) in blocks.iter_mut().zip(&lists) {
        let cells = list.chunk_by(|a, b| a.asked.cell == b.asked.cell);
        let open = cells.filter(|cell| places.occupancy(cell[0].asked.cell) < CAPACITY);
        calm.extend(open.filter(|cell| wishes.is_calm(cell)).map(|cell| cell[0].asked.cell));
        carried += wishes.keep_calm(list, block, &occupancy, &mut contested);
    }
    let turns: Vec<Contested<'_, DVec2>> =
        contested.iter().map(|&cell| contest(cell, &lists, offsets)).collect();
    let pass = ColouredPass { places, occupancy: &occupancy };
    carried += pass.run(&turns, columns, &mut targets, colours(seed));
    let asked = lists.iter().map(|list| list.iter().map(|wish| wish.asked).collect()).collect();
    Served { asked, calm, contested, positions: columns.positions.clone(), carried }
}

fn contest<'a>(cell: u32, lists: &'a [Vec<Wish<DVec2>>], offsets: &[u32]) -> Contested<'a, DVec2> {
    let number = Block::<DVec2>::number_of(cell);
    let first = Block::<DVec2>::first_cell(number) as usize;
    let all = lists[number].chunk_by(|a, b| a.asked.cell == b.asked.cell);
    let wishes = all.into_iter().find(|wishes| wishes[0].asked.cell == cell).unwrap();
    Contested { cell, first_row: offsets[first] as usize, wishes }
}

/// Serves one cell after another and counts the grains of cells anew for each displacement.
struct OneAfterAnother<'a> {
    grid: &'a Grid<DVec2>,
    rule: DisplacementRule,
    positions: Vec<DVec2>,
    carried: f64,
    /// Displacements for which there was no room.
    refused: u32,
}

impl OneAfterAnother<'_> {
    fn held(&self, cell: u32) -> u32 {
        self.positions.iter().filter(|&&position| self.grid.cell_of(position) == cell).count() as u32
    }

    fn is_beside(&self, a: u32, b: u32) -> bool {
        let ([i, j, _], [k, l, _]) = (self.grid.coordinates(a), self.grid.coordinates(b));
        i.abs_diff(k).min(CELLS[0] - i.abs_diff(k)) <= 1 && j.abs_diff(l) <= 1
    }

    fn displace(&mut self, wish: &Displaced<DVec2>, first_row: usize) {
        let rows = [wish.pair.0 + first_row, wish.pair.1 + first_row];
        let places = [self.positions[rows[0]] + wish.shift, self.positions[rows[1]] - wish.shift];
        let inside = |place: &DVec2| place.y >= self.grid.origin().y && place.y <= self.grid.end().y;
        let wrapped = places.map(|place| self.grid.wrapped(place));
        let targets = wrapped.map(|place| self.grid.cell_of(place));
        let is_near = targets.iter().all(|&target| self.is_beside(wish.cell, target));
        if !places.iter().all(inside) || !is_near || self.held(wish.cell) >= CAPACITY {
            return;
        }
        let entered = [0, 1].map(|k| targets[k] != self.grid.cell_of(self.positions[rows[k]]));
        let fits = |target: u32| {
            let newcomers = (0..2).filter(|&k| entered[k] && targets[k] == target).count() as u32;
            newcomers == 0 || self.held(target) + newcomers <= CAPACITY
        };
        if self.rule == DisplacementRule::Paired && !targets.into_iter().all(fits) {
            self.refused += 1;
            return;
        }
        (self.positions[rows[0]], self.positions[rows[1]]) = (wrapped[0], wrapped[1]);
        self.carried += wish.carried;
    }
}

/// Where grains of `gas` are after the wishes of `cells`, served in this order.
fn one_after_another<'a>(
    gas: &'a Gas<DVec2>,
    cells: &[u32],
    asked: &[Vec<Displaced<DVec2>>],
    rule: DisplacementRule,
) -> OneAfterAnother<'a> {
    let (grid, positions) = (gas.grid(), gas.positions().to_vec());
    let mut order = OneAfterAnother { grid, rule, positions, carried: 0.0, refused: 0 };
    for &cell in cells {
        let number = Block::<DVec2>::number_of(cell);
        let first_row = gas.rows(Block::<DVec2>::first_cell(number)).start;
        asked[number]
            .iter()
            .filter(|wish| wish.cell == cell)
            .for_each(|wish| order.displace(wish, first_row));
    }
    order
}

fn shuffled(mut cells: Vec<u32>, random: &mut Stream) -> Vec<u32> {
    for last in (1..cells.len()).rev() {
        cells.swap(last, random.below(last as u64 + 1) as usize);
    }
    cells
}

#[test]
fn calm_cells_and_colours_are_one_order_of_all_cells() {
    let (mut calm, mut contested, mut refused) = (0, 0, 0);
    for seed in 0..12 {
        for rule in [DisplacementRule::Paired, DisplacementRule::Thesis] {
            let before = crowd(seed);
            let after = served(&mut before.clone(), rule, seed);
            let mut random = Streams::new(seed).at(2, Phase::InitialPositions).stream(0);
            let turns = in_turn(before.grid(), &after.contested, colours(seed));
            let cells = [shuffled(after.calm.clone(), &mut random), turns].concat();
            let order = one_after_another(&before, &cells, &after.asked, rule);
            assert!(order.positions == after.positions, "seed {seed}, {rule:?}");
            assert!((order.carried - after.carried).abs() < 1e-12 * (1.0 + order.carried.abs()));
            (calm, contested) = (calm + after.calm.len(), contested + after.contested.len());
            refused += order.refused;
        }
    }
    assert!(calm > 100 && contested > 100 && refused > 30, "{calm}, {contested}, {refused}");
}

#[test]
fn a_calm_cell_is_granted_the_same_in_every_order() {
    let mut entered = 0;
    for seed in 0..12 {
        for rule in [DisplacementRule::Paired, DisplacementRule::Thesis] {
            let before = crowd(seed);
            let after = served(&mut before.clone(), rule, seed);
            let mut random = Streams::new(seed).at(3, Phase::InitialPositions).stream(0);
            let cells = shuffled([after.calm.clone(), after.contested.clone()].concat(), &mut random);
            let order = one_after_another(&before, &cells, &after.asked, rule);
            for row in after.calm.iter().flat_map(|&cell| before.rows(cell)) {
                let (there, here) = (after.positions[row], before.positions()[row]);
                assert_eq!(order.positions[row], there, "seed {seed}, {rule:?}");
                entered += u32::from(before.grid().cell_of(there) != before.grid().cell_of(here));
            }
        }
    }
    assert!(entered > 100, "{entered} grains of calm cells have entered another");
}
