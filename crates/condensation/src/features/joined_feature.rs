use image::RgbImage;

use crate::{CondensationError, GlobalDescriptor, StateDescriptorTable, View, ViewGrid};

/// Several features side by side as one.
///
/// ```
/// use wayfix_condensation::{Fft6Descriptor, DominantGraysDescriptor, ConcatenatedDescriptor, ColorMeanStdDescriptor, GlobalDescriptor};
/// let all = ConcatenatedDescriptor::new(vec![Box::new(ColorMeanStdDescriptor), Box::new(Fft6Descriptor), Box::new(DominantGraysDescriptor::default())]);
/// assert_eq!(all.n_components(), 18);
/// ```
pub struct ConcatenatedDescriptor {
    parts: Vec<Box<dyn GlobalDescriptor + Send>>,
}

impl ConcatenatedDescriptor {
    /// In that order.
    pub fn new(parts: Vec<Box<dyn GlobalDescriptor + Send>>) -> Self {
        Self { parts }
    }
}

impl GlobalDescriptor for ConcatenatedDescriptor {
    fn n_components(&self) -> usize {
        self.parts.iter().map(|part| part.n_components()).sum()
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        let mut rest = features;
        for part in &self.parts {
            let (own, others) = rest.split_at_mut(part.n_components());
            part.extract(view, own);
            rest = others;
        }
    }

    fn extract_all(
        &self,
        scene: &RgbImage,
        views: &ViewGrid,
    ) -> Result<StateDescriptorTable, CondensationError> {
        let mut joined = StateDescriptorTable::zeros(views.grid(), self.n_components());
        let mut begin = 0;
        for part in &self.parts {
            let table = part.extract_all(scene, views)?;
            for (state, row) in table.rows().enumerate() {
                joined.row_mut(state)[begin..begin + row.len()].copy_from_slice(row);
            }
            begin += part.n_components();
        }
        Ok(joined)
    }
}
