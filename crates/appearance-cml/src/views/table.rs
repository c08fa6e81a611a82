use super::low_harmonics::LowHarmonics;
use super::{PanoramaDescriptor, PanoramaQuery};
use crate::LowerBoundTable;

/// The slow changes of many panoramas from top to bottom, side by side: 156 bytes each.
///
/// ```
/// use wayfix_appearance_cml::{LowerBoundTable, LowerBoundedDistance, PanoramaDescriptor, PanoramaLowerBoundTable};
/// let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let mut table = PanoramaLowerBoundTable::default();
/// table.put(0, &view(20)?);
/// let probe = view(50)?.probe(); // at a distance of 0.3, which the bound nearly reaches for one ring and one harmonic
/// assert!(table.may_be_within(0, &probe, 0.4).is_some_and(|bound| bound > 0.299 && bound <= 0.3));
/// assert_eq!(table.may_be_within(0, &probe, 0.2), None);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
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
