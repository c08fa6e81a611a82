use super::bits;

/// Emitted pixels: one bit per pixel, each row in separate words.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    words_per_row: usize,
    words: Vec<u64>,
}

impl Coverage {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let words_per_row = (width as usize).div_ceil(bits::BITS);
        Self { words_per_row, words: vec![0; words_per_row * height as usize] }
    }

    pub(super) fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Covers the columns `start..end` of a row and reports the runs of those that were free.
    pub(super) fn claim(&mut self, row: usize, start: usize, end: usize, free: impl FnMut(usize, usize)) {
        let words = &mut self.words[row * self.words_per_row..][..self.words_per_row];
        bits::claim(words, start, end, free);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a row of booleans, for spans that begin and end everywhere around the words' borders.
    #[test]
    fn each_pixel_is_free_once() {
        const WIDTH: usize = 200;
        let pairs =
            [((60, 70), (0, 200)), ((64, 128), (63, 129)), ((0, 1), (0, 64)), ((199, 200), (127, 200))];
        for (first, second) in pairs {
            let mut coverage = Coverage::new(WIDTH as u32, 2);
            let mut taken = [false; WIDTH];
            for (start, end) in [first, second, (130, 131), (0, WIDTH)] {
                let mut got = [false; WIDTH];
                coverage.claim(1, start, end, |from, to| {
                    assert!(from < to && (from == start || taken[from - 1]) && (to == end || taken[to]));
                    got[from..to].fill(true);
                });
                for column in 0..WIDTH {
                    let expected = (start..end).contains(&column) && !taken[column];
                    assert_eq!(got[column], expected, "column {column} of {start}..{end}");
                    taken[column] |= expected;
                }
            }
        }
    }
}
