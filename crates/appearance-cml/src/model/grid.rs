use std::collections::BTreeMap;

use nalgebra::Vector2;

use crate::ReferenceId;

/// The references with places near a point of the plane, in cells of 1 m².
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Grid {
    cells: BTreeMap<(i64, i64), Vec<ReferenceId>>,
}

impl Grid {
    pub(super) fn insert(&mut self, id: ReferenceId, at: &Vector2<f64>) {
        self.cells.entry(cell(at)).or_default().push(id);
    }

    /// Removes one entry of `id` at this point.
    pub(super) fn remove(&mut self, id: ReferenceId, at: &Vector2<f64>) {
        let key = cell(at);
        if let Some(ids) = self.cells.get_mut(&key) {
            if let Some(index) = ids.iter().position(|other| *other == id) {
                ids.swap_remove(index);
            }
            if ids.is_empty() {
                self.cells.remove(&key);
            }
        }
    }

    /// The area with places, m²; at least one cell.
    pub(super) fn area(&self) -> f64 {
        self.cells.len().max(1) as f64
    }

    /// All references with a place that may be within `radius` of the point, each once, in the order of their numbers.
    pub(super) fn near(&self, at: &Vector2<f64>, radius: f64) -> Vec<ReferenceId> {
        let reach = Vector2::repeat(radius);
        let (low, high) = (cell(&(at - reach)), cell(&(at + reach)));
        let mut found: Vec<ReferenceId> = Vec::new();
        // A range of more columns than occupied cells is cheaper to search cell by cell.
        if high.0.saturating_sub(low.0) as u64 > self.cells.len() as u64 {
            let is_inside =
                |key: &(i64, i64)| (low.0..=high.0).contains(&key.0) && (low.1..=high.1).contains(&key.1);
            found.extend(self.cells.iter().filter(|(key, _)| is_inside(key)).flat_map(|(_, ids)| ids));
        } else {
            for x in low.0..=high.0 {
                found.extend(self.cells.range((x, low.1)..=(x, high.1)).flat_map(|(_, ids)| ids));
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Saturates far outside of any world.
fn cell(at: &Vector2<f64>) -> (i64, i64) {
    (at.x.floor() as i64, at.y.floor() as i64)
}
