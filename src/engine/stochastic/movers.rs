//! Grains that want to change their cell, and so may be sent back.

use crate::space::Vector;

/// Where a grain was before its flight. All grains fly at once; only those that change their cell may have to come back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover<V> {
    /// Its row.
    pub(crate) row: u32,
    /// The cell that it wants to leave.
    pub(crate) source: u32,
    /// Position before the flight [length].
    pub(crate) position: V,
    /// Velocity before the flight [length/time].
    pub(crate) velocity: V,
}

impl<V: Vector> Mover<V> {
    /// Takes the flight back: the grain keeps position and velocity, and gets nothing from gravity.
    pub(crate) fn stay(&self, positions: &mut [V], velocities: &mut [V]) {
        let row = self.row as usize;
        (positions[row], velocities[row]) = (self.position, self.velocity);
    }

    /// Takes the flight back but for the part along `axis`.
    pub(crate) fn slide(&self, axis: usize, positions: &mut [V], velocities: &mut [V]) {
        let there = positions[self.row as usize][axis];
        self.stay(positions, velocities);
        positions[self.row as usize][axis] = there;
    }
}
