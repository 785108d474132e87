//! Matter: grains, the box and its cells, and the container that keeps grains in cell order.

pub mod bins;
pub mod clock;
pub mod columns;
pub mod fetch;
pub mod gas;
pub mod grain;
pub mod grid;
pub mod overlaps;
pub mod scatter;
pub mod sort;
pub mod state_hash;
