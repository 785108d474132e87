//! Pair collisions inside cells (Nanbu's form of DSMC; Müller 2001, section 2.4.1).
//!
//! The cells of a block draw their candidate pairs first; then all candidates are put to the test. So
//! the processor draws while it need not know the outcome of a test, which nobody can predict.

use std::ops::Range;

use super::Step;
use super::blocks::Block;
use super::displacement::Displacement;
use super::enskog::EnskogFactors;
use super::laws::Laws;
use super::onlooker::Onlooker;
use super::relative_speeds::RelativeSpeeds;
use super::tally::Tally;
use crate::law::impact::Impacts;
use crate::law::restitution::Restitution;
use crate::matter::fetch::fetch_all;
use crate::matter::grid::Grid;
use crate::random::{Phase, PhaseStreams, Stream};
use crate::space::Vector;

/// Pair collisions of one step, the same for all cells.
#[derive(Clone, Debug)]
pub(crate) struct PairCollisions<'a, V: Vector, R> {
    restitution: R,
    impacts: Impacts,
    mass: f64,
    enskog: EnskogFactors<'a, V>,
    /// σ τ / (2 V_c): candidates per ordered pair and unit of relative speed.
    candidates_per_speed: f64,
    /// σ/(2 V_c) times the mean relative speed at unit thermal speed.
    rate_per_speed: f64,
    displacement: Displacement,
    streams: PhaseStreams,
}

/// A grain pair that has just collided and the way its first partner should be displaced;
/// the second goes the opposite way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displaced<V> {
    /// Their cell.
    pub(crate) cell: u32,
    /// Rows of the partners, counted from the start of the block.
    pub(crate) pair: (usize, usize),
    /// Displacement of the first partner [length].
    pub(crate) shift: V,
    /// Momentum times the way that the displacement carries [mass·length²/time].
    pub(crate) carried: f64,
}

/// What the cells of a block have drawn.
#[derive(Debug)]
struct Draws {
    candidates: Vec<Candidate>,
    cells: Vec<Drawn>,
    /// What the block draws from here on.
    random: Stream,
}

/// A candidate pair.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Rows, counted from the start of the block.
    pair: (u32, u32),
    /// Its cell, as a place in [`Draws::cells`].
    cell: u32,
    /// The pair collides where its squared relative speed exceeds this [length²/time²].
    threshold: f64,
}

/// A cell that has drawn candidates.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    number: u32,
    /// Bound on the squared relative speeds, before any collision [length²/time²].
    bound: f64,
}

impl<'a, V: Vector, R: Restitution> PairCollisions<'a, V, R> {
    pub(crate) fn new(laws: &Laws<V, R>, grid: &'a Grid<V>, offsets: &'a [u32], step: Step) -> Self {
        let per_pair = V::cross_section(laws.grain.diameter) / (2.0 * grid.cell_volume());
        PairCollisions {
            restitution: laws.restitution,
            impacts: laws.impacts,
            mass: laws.grain.mass,
            enskog: EnskogFactors::new(laws.dense, grid, offsets, laws.grain.diameter),
            candidates_per_speed: per_pair * step.duration,
            rate_per_speed: per_pair * V::MEAN_RELATIVE_SPEED,
            displacement: Displacement::of(laws),
            streams: laws.streams.at(step.number, Phase::Collisions),
        }
    }

    /// Collides the grains of a block. `displace` is told of every collision that should displace its
    /// partners, with the positions of the block, and says whether it did.
    ///
    /// M = χ N(N − 1) σ v_max τ/(2V_c) candidates, rounded at random; a pair collides with
    /// probability |v_i − v_j|/v_max (Müller 2001, 2.34; the test of 2.38 is printed the wrong way round).
    #[inline]
    pub(crate) fn collide(
        &self,
        block: &mut Block<'_, V>,
        offsets: &[u32],
        tally: &mut Tally<V>,
        displace: impl FnMut(Displaced<V>, &mut [V]) -> bool,
    ) {
        match block.take_counter() {
            None => self.collide_before(&mut (), block, offsets, tally, displace),
            Some(mut counter) => self.collide_counted(&mut counter, block, offsets, tally, displace),
        }
    }

    /// Apart, so that counting changes nothing of the code without it.
    #[cold]
    #[inline(never)]
    fn collide_counted(
        &self,
        counter: &mut impl Onlooker,
        block: &mut Block<'_, V>,
        offsets: &[u32],
        tally: &mut Tally<V>,
        displace: impl FnMut(Displaced<V>, &mut [V]) -> bool,
    ) {
        self.collide_before(counter, block, offsets, tally, displace);
    }

    /// [`PairCollisions::collide`] before the eyes of `onlooker`.
    #[inline(always)]
    fn collide_before<O: Onlooker>(
        &self,
        onlooker: &mut O,
        block: &mut Block<'_, V>,
        offsets: &[u32],
        tally: &mut Tally<V>,
        mut displace: impl FnMut(Displaced<V>, &mut [V]) -> bool,
    ) {
        let Draws { candidates, cells, mut random } = self.draw(block, offsets, tally);
        tally.counts.candidates += candidates.len() as u64;
        if O::LOOKS {
            cells.iter().for_each(|drawn| onlooker.bounded(drawn.number, drawn.bound));
            candidates.iter().for_each(|candidate| onlooker.tried(cells[candidate.cell as usize].number));
        }
        for &Candidate { pair, cell, threshold } in &candidates {
            let pair = (pair.0 as usize, pair.1 as usize);
            let relative = block.velocities[pair.0] - block.velocities[pair.1];
            let square = relative.length_squared();
            if square <= threshold {
                continue;
            }
            let Drawn { number, bound } = cells[cell as usize];
            let mut times = 1;
            if square > bound {
                times += excess(square / bound, &mut random);
            }
            for _ in 0..times {
                onlooker.collided(number);
                self.collide_pair(number, pair, block, tally, &mut random, &mut displace);
            }
        }
    }

    /// Exchanges momentum along a random contact normal; the normal relative velocity becomes −r times itself.
    #[inline(always)]
    fn collide_pair(
        &self,
        cell: u32,
        pair: (usize, usize),
        block: &mut Block<'_, V>,
        tally: &mut Tally<V>,
        random: &mut Stream,
        displace: &mut impl FnMut(Displaced<V>, &mut [V]) -> bool,
    ) {
        let relative = block.velocities[pair.0] - block.velocities[pair.1];
        let elastic = self.impacts.exchange(relative, random);
        let change = elastic * (0.5 * (1.0 + self.restitution.at(elastic.length())));
        block.velocities[pair.0] += change;
        block.velocities[pair.1] -= change;
        tally.counts.collisions += 1;
        let after = relative + change * 2.0;
        if let Some(shift) = self.displacement.shift(change, after) {
            let carried = self.mass * after.dot(shift);
            if displace(Displaced { cell, pair, shift, carried }, block.positions) {
                tally.counts.carried_momentum += carried;
            }
        }
    }

    /// Draws the candidates of all cells of the block.
    fn draw(&self, block: &Block<'_, V>, offsets: &[u32], tally: &mut Tally<V>) -> Draws {
        let mut draws = Draws {
            candidates: Vec::with_capacity(block.ids.len()),
            cells: Vec::with_capacity(block.cells.len()),
            random: self.streams.stream(u64::from(block.cells.start)),
        };
        // Displacements will go to positions in no order.
        let fetches_positions = !matches!(self.displacement, Displacement::None);
        for cell in block.cells.clone() {
            let rows = block.rows_of(cell, offsets);
            let grains = rows.len() as u32;
            if grains < 2 {
                continue;
            }
            if fetches_positions {
                fetch_all(&block.positions[rows.clone()]);
            }
            let speeds = RelativeSpeeds::of(&block.velocities[rows.clone()]);
            if !speeds.sum_over_pairs.is_finite() {
                // Endless speeds would mean endless candidates; the end of the step says what is wrong.
                continue;
            }
            let pairs = self.enskog.of(cell, rows.len()) * f64::from(grains) * f64::from(grains - 1);
            tally.collision_rate += self.expected_rate(pairs, grains, speeds);
            let expected = pairs * self.candidates_per_speed * speeds.largest_square.sqrt();
            draws.add(rows, Drawn { number: cell, bound: speeds.largest_square }, expected);
        }
        draws
    }

    /// Expected collisions per time in `cell`, whose grains have these `velocities` [1/time].
    pub(crate) fn rate(&self, cell: u32, velocities: &[V]) -> f64 {
        let grains = velocities.len() as u32;
        if grains < 2 {
            return 0.0;
        }
        let pairs = self.enskog.of(cell, velocities.len()) * f64::from(grains) * f64::from(grains - 1);
        self.expected_rate(pairs, grains, RelativeSpeeds::of(velocities))
    }

    /// From the unbiased temperature of the cell, Σ|v − v_c|²/(D(N − 1)) per mass.
    #[inline(always)]
    fn expected_rate(&self, pairs: f64, grains: u32, speeds: RelativeSpeeds) -> f64 {
        let grains = f64::from(grains);
        let thermal_square = speeds.sum_over_pairs / (V::DIMENSION as f64 * grains * (grains - 1.0));
        pairs * self.rate_per_speed * thermal_square.sqrt()
    }
}

impl Draws {
    /// Draws the candidates of one more cell, `expected` of them on the average.
    #[inline(always)]
    fn add(&mut self, rows: Range<usize>, drawn: Drawn, expected: f64) {
        let cell = self.cells.len() as u32;
        let (first_row, grains) = (rows.start as u32, rows.len() as u32);
        for _ in 0..self.random.round(expected) {
            let ((first, second), z) = self.random.pair_and_uniform(grains);
            let pair = (first_row + first as u32, first_row + second as u32);
            self.candidates.push(Candidate { pair, cell, threshold: z * z * drawn.bound });
        }
        self.cells.push(drawn);
    }
}

/// How many times more a pair collides that earlier collisions of the step have made faster than the bound: on
/// the average by how much |v_i − v_j|/v_max exceeds one. `ratio` is the square of that.
#[cold]
#[inline(never)]
fn excess(ratio: f64, random: &mut Stream) -> u64 {
    random.round(ratio.sqrt() - 1.0)
}
