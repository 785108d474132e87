//! What a part of a step adds up, block by block.

use crate::engine::report::Counts;
use crate::space::Vector;

/// Sums over some grains or cells. Blocks are added in their order, so that
/// the total does not depend on the number of threads.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally<V> {
    /// Events.
    pub counts: Counts<V>,
    /// Expected collisions per time, from the temperatures of the cells [1/time].
    pub collision_rate: f64,
    /// Speeds after the move.
    pub speeds: Speeds<V>,
}

/// What a step knows of the speeds of grains.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Speeds<V> {
    /// Largest squared speed [length²/time²].
    pub largest_square: f64,
    /// Σ v² [length²/time²].
    pub sum_of_squares: f64,
    /// Σ v [length/time].
    pub sum_of_velocities: V,
}

impl<V: Vector> Speeds<V> {
    /// Takes note of one more grain.
    #[inline(always)]
    pub(crate) fn note(&mut self, velocity: V) {
        let square = velocity.length_squared();
        self.sum_of_squares += square;
        self.sum_of_velocities += velocity;
        self.largest_square = if square > self.largest_square { square } else { self.largest_square };
    }

    /// Adds those of other grains.
    pub(crate) fn add(&mut self, others: &Self) {
        self.largest_square = self.largest_square.max(others.largest_square);
        self.sum_of_squares += others.sum_of_squares;
        self.sum_of_velocities += others.sum_of_velocities;
    }
}

impl<V: Vector> Tally<V> {
    /// Adds the next block.
    pub(crate) fn add(&mut self, block: &Self) {
        self.counts.add(&block.counts);
        self.collision_rate += block.collision_rate;
        self.speeds.add(&block.speeds);
    }

    /// The sum of `blocks` in their order.
    pub(crate) fn total(blocks: impl IntoIterator<Item = Self>) -> Self {
        let mut total = Self::default();
        for block in blocks {
            total.add(&block);
        }
        total
    }
}
