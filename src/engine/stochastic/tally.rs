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
    /// Largest squared speed after the move [length²/time²].
    pub largest_square: f64,
    /// Σ v² after the move [length²/time²].
    pub sum_of_squares: f64,
    /// Σ v after the move [length/time].
    pub sum_of_velocities: V,
}

impl<V: Vector> Tally<V> {
    /// Adds the next block.
    pub(crate) fn add(&mut self, block: &Self) {
        self.counts.add(&block.counts);
        self.collision_rate += block.collision_rate;
        self.largest_square = self.largest_square.max(block.largest_square);
        self.sum_of_squares += block.sum_of_squares;
        self.sum_of_velocities += block.sum_of_velocities;
    }

    /// Takes note of a velocity after the move.
    #[inline(always)]
    pub(crate) fn note_velocity(&mut self, velocity: V) {
        let square = velocity.length_squared();
        self.sum_of_squares += square;
        self.sum_of_velocities += velocity;
        if square > self.largest_square {
            self.largest_square = square;
        }
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
