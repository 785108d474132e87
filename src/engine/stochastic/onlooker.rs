//! Who looks on while the cells of a block collide their pairs.

use crate::engine::cell_counts::CellCount;

/// Somebody who hears what happens in which cell; `()` is nobody, and costs nothing.
pub(crate) trait Onlooker {
    /// Whether there is somebody.
    const LOOKS: bool;
    /// `cell` draws its candidates with this bound on squared relative speeds [length²/time²].
    fn bounded(&mut self, cell: u32, bound: f64);
    /// A candidate pair of `cell` is looked at.
    fn tried(&mut self, cell: u32);
    /// A pair of `cell` collides.
    fn collided(&mut self, cell: u32);
}

impl Onlooker for () {
    const LOOKS: bool = false;
    #[inline(always)]
    fn bounded(&mut self, _cell: u32, _bound: f64) {}
    #[inline(always)]
    fn tried(&mut self, _cell: u32) {}
    #[inline(always)]
    fn collided(&mut self, _cell: u32) {}
}

/// Counts for the cells of one block.
#[derive(Debug)]
pub(crate) struct Counter<'a> {
    /// The first cell of the block.
    pub(crate) first: u32,
    /// `[cell of the block]`.
    pub(crate) counts: &'a mut [CellCount],
}

impl Counter<'_> {
    fn of(&mut self, cell: u32) -> &mut CellCount {
        &mut self.counts[(cell - self.first) as usize]
    }
}

impl Onlooker for Counter<'_> {
    const LOOKS: bool = true;

    fn bounded(&mut self, cell: u32, bound: f64) {
        self.of(cell).bound = bound.sqrt();
    }

    fn tried(&mut self, cell: u32) {
        self.of(cell).attempts += 1;
    }

    fn collided(&mut self, cell: u32) {
        self.of(cell).collisions += 1;
    }
}
