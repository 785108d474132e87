//! Sets of small numbers, as bits: cells, or rows.

/// Numbers in a word.
const WORD: u32 = u64::BITS;

/// A set of numbers below a bound, which also counts them off in rising order.
#[derive(Debug, Default)]
pub(crate) struct NumberSet {
    words: Vec<u64>,
    /// `[word]`: members in all words before it, once they are counted.
    before: Vec<u32>,
}

impl NumberSet {
    /// The empty set, of numbers below `bound`.
    pub(crate) fn below(bound: usize) -> Self {
        NumberSet { words: vec![0; bound.div_ceil(WORD as usize)], before: Vec::new() }
    }

    /// Puts `number` in.
    #[inline(always)]
    pub(crate) fn insert(&mut self, number: u32) {
        self.words[(number / WORD) as usize] |= 1 << (number % WORD);
    }

    /// Counts the members off, so that each has its place. Returns how many there are.
    pub(crate) fn number(&mut self) -> usize {
        let mut count = 0;
        self.before.clear();
        for word in &self.words {
            self.before.push(count);
            count += word.count_ones();
        }
        count as usize
    }

    /// The place of `number` among the members in rising order; `None` of one that is not in the set.
    #[inline(always)]
    pub(crate) fn place(&self, number: u32) -> Option<u32> {
        let (word, bit) = ((number / WORD) as usize, number % WORD);
        let bits = self.words[word] >> bit;
        let lower = self.words[word] & !(u64::MAX << bit);
        (bits & 1 == 1).then(|| self.before[word] + lower.count_ones())
    }

    /// The members in rising order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = u32> {
        self.words.iter().enumerate().flat_map(|(place, &word)| {
            let mut left = word;
            std::iter::from_fn(move || {
                let bit = (left != 0).then(|| left.trailing_zeros())?;
                left &= left - 1;
                Some(place as u32 * WORD + bit)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_come_in_rising_order_and_know_their_places() {
        let mut set = NumberSet::below(256);
        let members = [0, 5, 63, 64, 130, 255];
        members.iter().rev().for_each(|&member| set.insert(member));
        assert_eq!(set.number(), 6);
        assert_eq!(set.iter().collect::<Vec<u32>>(), members);
        for number in 0..256 {
            let place = members.iter().position(|&member| member == number);
            assert_eq!(set.place(number), place.map(|place| place as u32));
        }
    }
}
