use image::RgbImage;

use crate::features::dominance::DominantGrayCriterion;
use crate::features::histogram::{self, Histogram};
use crate::{CondensationError, GlobalDescriptor, StateDescriptorTable, View, ViewGrid};

/// Three dominating grey values and their densities: $`[I_1, I_2, I_3, ρ(I_1), ρ(I_2), ρ(I_3)]`$. [Kasprzak & Szynkiewicz, Sec. 3.3]
///
/// What dominates is up to [`DominantGrayCriterion`]. Where there are fewer than three, the last repeats with density zero.
///
/// ```
/// use wayfix_condensation::{DominantGrayCriterion, DominantGraysDescriptor, RgbImage, View, GlobalDescriptor};
/// let bytes = [10, 10, 60, 200].into_iter().flat_map(|grey| [grey; 3]).collect();
/// let picture = RgbImage::from_raw(4, 1, bytes).expect("3 bytes a pixel");
/// let mut features = [0.0; 6];
/// DominantGraysDescriptor { dominance: DominantGrayCriterion::Classes }.extract(&View::whole(&picture)?, &mut features);
/// assert_eq!(features, [10.0, 60.0, 200.0, 0.5, 0.25, 0.25]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DominantGraysDescriptor {
    /// What makes a grey value dominate.
    pub dominance: DominantGrayCriterion,
}

const N: usize = 6;

impl GlobalDescriptor for DominantGraysDescriptor {
    fn n_components(&self) -> usize {
        N
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        self.describe(&histogram::of_view(view), features);
    }

    fn extract_all(
        &self,
        scene: &RgbImage,
        views: &ViewGrid,
    ) -> Result<StateDescriptorTable, CondensationError> {
        views.check(scene)?;
        let mut table = StateDescriptorTable::zeros(views.grid(), N);
        histogram::for_each_view(scene, views, |state, histogram| {
            self.describe(histogram, table.row_mut(state));
        });
        Ok(table)
    }
}

impl DominantGraysDescriptor {
    fn describe(&self, histogram: &Histogram, features: &mut [f64]) {
        let n_pixels = f64::from(histogram.iter().sum::<u32>());
        let density = histogram.map(|count| f64::from(count) / n_pixels);
        let dominating = self.dominance.of(&density);
        let mut last = 0.0;
        for k in 0..N / 2 {
            let (value, share) = dominating.get(k).copied().unwrap_or((last, 0.0));
            (features[k], features[k + N / 2]) = (value, share);
            last = value;
        }
    }
}
