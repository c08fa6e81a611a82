use std::sync::Arc;

use super::pattern::Pattern;

/// $`H δ = -g`$ with $`H = \sum w J^T Ω J`$ and $`g = \sum w J^T Ω r`$, in the order of elimination.
pub struct NormalEquations {
    pattern: Arc<Pattern>,
    entries: Vec<f64>,
    gradient: Vec<f64>,
}

impl NormalEquations {
    pub(crate) fn zeros(pattern: Arc<Pattern>) -> Self {
        let (n_entries, n) = (pattern.n_entries(), pattern.n_rows());
        Self { pattern, entries: vec![0.0; n_entries], gradient: vec![0.0; n] }
    }

    pub(crate) fn clear(&mut self) {
        self.entries.fill(0.0);
        self.gradient.fill(0.0);
    }

    pub(crate) fn pattern(&self) -> &Pattern {
        &self.pattern
    }
    pub(crate) fn entries(&self) -> &[f64] {
        &self.entries
    }
    pub(crate) fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }
    pub(crate) fn gradient(&self) -> &[f64] {
        &self.gradient
    }
    pub(crate) fn gradient_mut(&mut self) -> &mut [f64] {
        &mut self.gradient
    }

    /// Whether every entry is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        self.entries.iter().chain(&self.gradient).all(|entry| entry.is_finite())
    }

    pub(crate) fn diagonal(&self) -> Vec<f64> {
        (0..self.pattern.n_rows()).map(|column| self.entries[self.pattern.diagonal_entry(column)]).collect()
    }

    /// $`H v`$
    pub(crate) fn multiply(&self, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; v.len()];
        for column in 0..v.len() {
            let range = self.pattern.column(column);
            for (row, entry) in self.pattern.rows()[range.clone()].iter().zip(&self.entries[range]) {
                product[*row] += entry * v[column];
                if *row != column {
                    product[column] += entry * v[*row];
                }
            }
        }
        product
    }
}
