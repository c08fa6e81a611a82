const WORD: usize = u64::BITS as usize;

/// A set of small numbers, a bit each.
#[derive(Clone, Debug)]
pub(super) struct BitSet(Vec<u64>);

impl BitSet {
    /// The empty set of numbers below `n`.
    pub(super) fn below(n: usize) -> Self {
        Self(vec![0; n.div_ceil(WORD)])
    }

    #[inline]
    pub(super) fn insert(&mut self, number: usize) {
        self.0[number / WORD] |= 1 << (number % WORD);
    }

    pub(super) fn clear(&mut self) {
        self.0.fill(0);
    }

    /// The numbers in order.
    pub(super) fn iter(&self) -> Numbers<'_> {
        Numbers { words: &self.0, end: 0, left: 0 }
    }
}

#[derive(Clone)]
pub(super) struct Numbers<'a> {
    /// Words that were not begun.
    words: &'a [u64],
    /// End of the numbers of the present word, and which of them are left.
    end: usize,
    left: u64,
}

impl Iterator for Numbers<'_> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        while self.left == 0 {
            let (first, rest) = self.words.split_first()?;
            (self.left, self.words, self.end) = (*first, rest, self.end + WORD);
        }
        let bit = self.left.trailing_zeros() as usize;
        self.left &= self.left - 1;
        Some(self.end - WORD + bit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_once_and_in_order() {
        let mut set = BitSet::below(200);
        [199, 0, 63, 64, 64, 130].into_iter().for_each(|number| set.insert(number));
        assert_eq!(set.iter().collect::<Vec<_>>(), [0, 63, 64, 130, 199]);
        set.clear();
        assert_eq!(set.iter().count(), 0);
    }
}
