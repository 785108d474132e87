//! Small whole numbers, several in each number of a saved memory.

/// Bits of a whole number that an `f64` holds exactly.
const EXACT: u32 = 53;

/// `counts` in few numbers: how many there are, the bits of each, then as many to a number as fit exactly.
pub(crate) fn pack(counts: &[u32]) -> Vec<f64> {
    let largest = counts.iter().copied().max().unwrap_or(0);
    let bits = (u32::BITS - largest.leading_zeros()).max(1);
    let mut packed = vec![counts.len() as f64, f64::from(bits)];
    packed.extend(counts.chunks((EXACT / bits) as usize).map(|group| {
        let digits = group.iter().rev();
        digits.fold(0_u64, |word, &count| word << bits | u64::from(count)) as f64
    }));
    packed
}

/// What [`pack`] packed; nothing from numbers that it cannot have made.
pub(crate) fn unpack(packed: &[f64]) -> Vec<u32> {
    let [count, bits, words @ ..] = packed else { return Vec::new() };
    let (count, bits) = (*count as usize, *bits as u32);
    if !(1..=u32::BITS).contains(&bits) {
        return Vec::new();
    }
    let mask = (1_u64 << bits) - 1;
    words
        .iter()
        .flat_map(|&word| (0..EXACT / bits).map(move |k| ((word as u64 >> (k * bits)) & mask) as u32))
        .take(count)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn small_counts_take_little_room() {
        // Four bits each, thirteen to a number.
        assert_eq!(pack(&[9; 1300]).len(), 2 + 100);
    }

    #[test]
    fn nonsense_gives_nothing() {
        assert!(
            unpack(&[]).is_empty() && unpack(&[3.0, 0.0, 1.0]).is_empty() && unpack(&[3.0, 99.0]).is_empty()
        );
    }

    proptest! {
        #[test]
        fn it_is_exact(counts in (0_u32..32).prop_flat_map(|s| proptest::collection::vec(0..=u32::MAX >> s, 0..60))) {
            prop_assert_eq!(unpack(&pack(&counts)), counts);
        }
    }
}
