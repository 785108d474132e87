//! The order of grains in memory: along a curve that fills space.

use super::cells::Cells;
use crate::space::Vector;

/// The place of `position` on the curve of Morton (1966) through the cells: neighbours in space stand
/// near each other on it.
pub(super) fn place_on_curve<V: Vector>(cells: &Cells<V>, position: V) -> u64 {
    let mut place = 0;
    for axis in 0..V::DIMENSION {
        place |= spread(cells.coordinate(position, axis), V::DIMENSION) << axis;
    }
    place
}

/// The lower bits of `number`, `gap` places apart: 32 of them in 2D, 21 in 3D.
fn spread(number: u32, gap: usize) -> u64 {
    let mut bits = u64::from(number);
    // Halves, quarters, … of the number move apart (Warren 2012, section 7-2).
    let steps: &[(u32, u64)] = if gap == 2 {
        &[
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ]
    } else {
        bits &= 0x1f_ffff;
        &[
            (32, 0x001f_0000_0000_ffff),
            (16, 0x001f_0000_ff00_00ff),
            (8, 0x100f_00f0_0f00_f00f),
            (4, 0x10c3_0c30_c30c_30c3),
            (2, 0x1249_2492_4924_9249),
        ]
    };
    for &(shift, mask) in steps {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_stand_apart() {
        for number in [0, 1, 2, 3, 77, 0xffff, 0x1f_ffff] {
            for gap in [2, 3] {
                let expected =
                    (0..21).filter(|k| number >> k & 1 == 1).fold(0, |sum, k| sum | 1_u64 << (gap * k));
                assert_eq!(spread(number, gap as usize), expected, "{number} {gap}");
            }
        }
    }
}
