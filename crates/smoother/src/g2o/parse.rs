use nalgebra::DMatrix;

use super::LineProblem;

/// The words of a line after the first, to be taken one after the other.
pub(super) struct Words<'a> {
    tag: &'a str,
    words: Vec<&'a str>,
    taken: usize,
}

impl<'a> Words<'a> {
    /// `None` for blank lines and comments.
    pub(super) fn of(line: &'a str) -> Option<Self> {
        let mut words = line.split_whitespace();
        let tag = words.next().filter(|word| !word.starts_with('#'))?;
        Some(Self { tag, words: words.collect(), taken: 0 })
    }

    pub(super) fn tag(&self) -> &'a str {
        self.tag
    }

    /// Fails unless the line has this many numbers.
    pub(super) fn expect(&self, expected: usize) -> Result<(), LineProblem> {
        let got = self.words.len();
        if got == expected {
            Ok(())
        } else {
            Err(LineProblem::Count { tag: self.tag.to_owned(), expected, got })
        }
    }

    pub(super) fn n_left(&self) -> usize {
        self.words.len() - self.taken
    }

    pub(super) fn id(&mut self) -> Result<u64, LineProblem> {
        let word = self.next()?;
        word.parse().map_err(|_| LineProblem::NotANumber(word.to_owned()))
    }

    pub(super) fn numbers(&mut self, n: usize) -> Result<Vec<f64>, LineProblem> {
        (0..n).map(|_| self.number()).collect()
    }

    /// A symmetric matrix from its upper triangle by rows.
    pub(super) fn symmetric(&mut self, n: usize) -> Result<DMatrix<f64>, LineProblem> {
        let mut matrix = DMatrix::zeros(n, n);
        for i in 0..n {
            for k in i..n {
                matrix[(i, k)] = self.number()?;
                matrix[(k, i)] = matrix[(i, k)];
            }
        }
        Ok(matrix)
    }

    fn number(&mut self) -> Result<f64, LineProblem> {
        let word = self.next()?;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| LineProblem::NotANumber(word.to_owned()))
    }

    fn next(&mut self) -> Result<&'a str, LineProblem> {
        let word = self.words.get(self.taken).copied();
        self.taken += 1;
        let missing =
            || LineProblem::Count { tag: self.tag.to_owned(), expected: self.taken, got: self.words.len() };
        word.ok_or_else(missing)
    }
}
