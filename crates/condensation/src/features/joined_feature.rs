use image::RgbImage;

use crate::{CondensationError, DescriptorTable, GlobalDescriptor, View, ViewGrid};

/// Several features side by side as one.
///
/// ```
/// use wayfix_condensation::{Fft6Descriptor, Hist6Descriptor, JoinedDescriptor, MeanVarDescriptor, GlobalDescriptor};
/// let all = JoinedDescriptor::new(vec![Box::new(MeanVarDescriptor), Box::new(Fft6Descriptor), Box::new(Hist6Descriptor::default())]);
/// assert_eq!(all.n_components(), 18);
/// ```
pub struct JoinedDescriptor {
    parts: Vec<Box<dyn GlobalDescriptor + Send>>,
}

impl JoinedDescriptor {
    /// In that order.
    pub fn new(parts: Vec<Box<dyn GlobalDescriptor + Send>>) -> Self {
        Self { parts }
    }
}

impl GlobalDescriptor for JoinedDescriptor {
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

    fn extract_all(&self, scene: &RgbImage, views: &ViewGrid) -> Result<DescriptorTable, CondensationError> {
        let mut joined = DescriptorTable::zeros(views.grid(), self.n_components());
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
