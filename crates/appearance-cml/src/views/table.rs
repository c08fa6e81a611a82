use super::low_harmonics::LowHarmonics;
use super::{PanoramaDescriptor, PanoramaQuery};
use crate::LowerBoundTable;

/// The slow changes of many panoramas from top to bottom, side by side: 156 bytes each.
#[derive(Clone, Debug, Default)]
pub struct PanoramaLowerBoundTable {
    rows: Vec<LowHarmonics>,
}

impl LowerBoundTable<PanoramaDescriptor> for PanoramaLowerBoundTable {
    fn put(&mut self, slot: usize, reference: &PanoramaDescriptor) {
        let row = LowHarmonics::new(reference);
        match self.rows.get_mut(slot) {
            Some(old) => *old = row,
            None => self.rows.push(row),
        }
    }

    #[inline]
    fn may_be_within(&self, slot: usize, view: &PanoramaQuery, enough: f64) -> Option<f64> {
        let squared = f64::from(view.slow().squared_bound(&self.rows[slot]));
        // What is no number bounds nothing.
        if squared.is_nan() {
            return Some(0.0);
        }
        (squared <= enough * enough).then(|| squared.max(0.0).sqrt())
    }
}
