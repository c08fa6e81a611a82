/// Numbers below a limit, a bit each: they come out in order, which is the order in memory of what they stand for.
pub(super) struct SlotSet {
    words: Vec<u64>,
}

impl SlotSet {
    pub(super) fn new(limit: usize) -> Self {
        Self { words: vec![0; limit.div_ceil(64)] }
    }

    pub(super) fn insert(&mut self, slot: u32) {
        if let Some(word) = self.words.get_mut(slot as usize / 64) {
            *word |= 1 << (slot % 64);
        }
    }

    pub(super) fn into_slots(self) -> impl Iterator<Item = u32> {
        self.words.into_iter().zip((0..).step_by(64)).flat_map(|(word, first)| {
            let mut left = word;
            std::iter::from_fn(move || {
                let bit = (left != 0).then(|| left.trailing_zeros())?;
                left &= left - 1;
                Some(first + bit)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_iterate_in_order_up_to_the_limit() {
        let mut set = SlotSet::new(130);
        for slot in [129, 64, 0, 63, 64, 500] {
            set.insert(slot);
        }
        assert_eq!(set.into_slots().collect::<Vec<u32>>(), [0, 63, 64, 129]);
    }
}
