//! One number for a whole state: two runs agree when their hashes do.

use sha2::{Digest, Sha256};

use super::fetch::fetch;
use super::gas::Gas;
use crate::space::Vector;

/// Grains whose memory is sent for ahead: in rising identity they stand in no order.
const AHEAD: usize = 16;
/// Bytes that are hashed at a time.
const BUFFER: usize = 1 << 14;

/// SHA-256 over, little-endian: dimension u32, N u64, time f64, then for each grain in rising
/// identity its id u32, position, velocity and spin (if any), as the f64 bits that are held.
/// In hexadecimal digits.
pub fn state_hash<V: Vector>(gas: &Gas<V>) -> String {
    let columns = gas.columns();
    let mut hasher = Sha256::new();
    hasher.update((V::DIMENSION as u32).to_le_bytes());
    hasher.update((gas.len() as u64).to_le_bytes());
    hasher.update(gas.time().to_le_bytes());
    let mut bytes = Vec::with_capacity(BUFFER + 80);
    let rows = rows_by_identity(gas);
    for (place, &row) in rows.iter().enumerate() {
        if let Some(&ahead) = rows.get(place + AHEAD) {
            fetch(&columns.ids[ahead as usize]);
            fetch(&columns.positions[ahead as usize]);
            fetch(&columns.velocities[ahead as usize]);
        }
        let row = row as usize;
        bytes.extend_from_slice(&columns.ids[row].to_le_bytes());
        for vector in [columns.positions[row], columns.velocities[row]] {
            for axis in 0..V::DIMENSION {
                bytes.extend_from_slice(&vector[axis].to_le_bytes());
            }
        }
        if let Some(spins) = &columns.spins {
            for component in spins[row].as_ref() {
                bytes.extend_from_slice(&component.to_le_bytes());
            }
        }
        if bytes.len() >= BUFFER {
            hasher.update(&bytes);
            bytes.clear();
        }
    }
    hasher.update(&bytes);
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The rows of `gas` in rising identity.
pub fn rows_by_identity<V: Vector>(gas: &Gas<V>) -> Vec<u32> {
    let mut rows = vec![u32::MAX; gas.next_id() as usize];
    for (row, &id) in gas.ids().iter().enumerate() {
        rows[id as usize] = row as u32;
    }
    rows.retain(|&row| row != u32::MAX);
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::{grain::Grain, grid::Grid};
    use glam::DVec2;

    fn gas(x: f64) -> Gas<DVec2> {
        let grid = Grid::new(DVec2::ZERO, DVec2::splat(4.0), &[4, 4], &[true, true]);
        let positions = vec![DVec2::new(3.5, 3.5), DVec2::new(x, 0.5)];
        Gas::new(grid, Grain { diameter: 1.0, mass: 1.0 }, positions, vec![DVec2::ONE; 2])
    }

    #[test]
    fn one_bit_changes_the_hash() {
        let base = state_hash(&gas(0.5));
        assert_eq!(base.len(), 64);
        assert_eq!(base, state_hash(&gas(0.5)));
        assert_ne!(base, state_hash(&gas(f64::from_bits(0.5_f64.to_bits() + 1))));
    }
}
