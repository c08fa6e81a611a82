use crate::features::dominance::DominantGrayCriterion;
use crate::features::histogram;
use crate::{GlobalDescriptor, View};

/// Three dominating grey values, their densities, and where they are: mass centre and box of their regions, a matrix of measurements.
/// [Kasprzak & Szynkiewicz, Sec. 3.3]
///
/// $`[I_k, ρ_k, x_k, y_k, w_k, h_k]`$ for $`k = 1, 2, 3`$; positions and sizes are shares of the width and height of the view. The box has the
/// variances of the region: the outermost pixels alone would make it the whole view. An empty region lies in the middle.
///
/// ```
/// use wayfix_condensation::{DominantGrayCriterion, GlobalDescriptor, IntensityRegionsDescriptor, RgbImage, View};
/// let dark_on_the_left = (0..64).flat_map(|i| [if i % 8 < 4 { 20 } else { 220_u8 }; 3]).collect();
/// let picture = RgbImage::from_raw(8, 8, dark_on_the_left).expect("3 bytes a pixel");
/// let mut features = [0.0; 18];
/// IntensityRegionsDescriptor { dominance: DominantGrayCriterion::Counts }.extract(&View::whole(&picture)?, &mut features);
/// assert_eq!(features[..4], [20.0, 0.5, 0.25, 0.5]);
/// assert_eq!(features[6..10], [220.0, 0.5, 0.75, 0.5]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IntensityRegionsDescriptor {
    /// What makes a grey value dominate.
    pub dominance: DominantGrayCriterion,
}

/// Numbers of a region.
const A_REGION: usize = 6;
const N_REGIONS: usize = 3;

impl GlobalDescriptor for IntensityRegionsDescriptor {
    fn n_components(&self) -> usize {
        N_REGIONS * A_REGION
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        let n_pixels = view.n_pixels() as f64;
        let density = histogram::of_view(view).map(|count| f64::from(count) / n_pixels);
        let memberships = self.dominance.memberships(&density);
        let (columns, rows) = sums_by_grey(view);
        for (region, membership) in features.chunks_exact_mut(A_REGION).zip(memberships) {
            let sum = |value: &dyn Fn(usize) -> f64| -> f64 {
                membership.iter().enumerate().map(|(grey, share)| share * value(grey)).sum()
            };
            let share = sum(&|grey| density[grey]);
            let mean = |value: &dyn Fn(usize) -> f64| sum(value) / (share * n_pixels);
            let grey = if share > 0.0 { sum(&|grey| density[grey] * grey as f64) / share } else { 0.0 };
            let side = |sums: &Sums, length: usize| -> (f64, f64) {
                if share <= 0.0 {
                    return (0.5, 0.0);
                }
                let (first, second) = (mean(&|grey| sums[grey].0), mean(&|grey| sums[grey].1));
                let variance = (second - first * first).max(0.0);
                let length = length as f64;
                // A uniform region of width w has the variance w²/12.
                ((first + 0.5) / length, (12.0 * variance).sqrt() / length)
            };
            let ((x, width), (y, height)) = (side(&columns, view.width()), side(&rows, view.height()));
            region.copy_from_slice(&[grey, share, x, y, width, height]);
        }
    }
}

/// Sum and sum of squares of the coordinate of all pixels of a grey value.
type Sums = [(f64, f64); 256];

/// Of the columns and of the rows.
fn sums_by_grey(view: &View<'_>) -> (Sums, Sums) {
    let (mut columns, mut rows) = ([(0.0, 0.0); 256], [(0.0, 0.0); 256]);
    let width = view.width();
    for (i, &grey) in view.grey().as_raw().iter().enumerate() {
        let grey = usize::from(grey);
        for (sums, at) in [(&mut columns, i % width), (&mut rows, i / width)] {
            let at = at as f64;
            sums[grey].0 += at;
            sums[grey].1 += at * at;
        }
    }
    (columns, rows)
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use image::RgbImage;

    use super::*;

    fn features(dominance: DominantGrayCriterion, pixel: impl Fn(u32, u32) -> u8) -> Vec<f64> {
        let picture = RgbImage::from_fn(40, 30, |x, y| image::Rgb([pixel(x, y); 3]));
        let descriptor = IntensityRegionsDescriptor { dominance };
        let mut features = vec![f64::NAN; descriptor.n_components()];
        descriptor.extract(&View::whole(&picture).unwrap(), &mut features);
        features
    }

    #[test]
    fn a_rectangle_has_its_own_centre_and_sides() {
        let scene = |x: u32, y: u32| match (x, y) {
            (4..12, 15..27) => 10,
            (20..40, 0..10) => 120,
            _ => 220,
        };
        let features = features(DominantGrayCriterion::Classes, scene);
        let [grey, share, x, y, width, height] = features[..6] else { unreachable!() };
        assert_abs_diff_eq!(grey, 10.0, epsilon = 1e-9);
        assert_abs_diff_eq!(share, 0.08, epsilon = 1e-9);
        assert_abs_diff_eq!(x, 8.0 / 40.0, epsilon = 1e-9);
        assert_abs_diff_eq!(y, 21.0 / 30.0, epsilon = 1e-9);
        // The variance of n pixels side by side is (n² - 1) / 12.
        let sides = [(width * 40.0, 8.0_f64), (height * 30.0, 12.0)];
        assert!(sides.iter().all(|(got, n)| (got - (n * n - 1.0).sqrt()).abs() < 1e-9), "{sides:?}");
    }

    #[test]
    fn pictures_of_one_grey_give_finite_numbers() {
        for dominance in [
            DominantGrayCriterion::Counts,
            DominantGrayCriterion::Peaks { sigma: 3.0 },
            DominantGrayCriterion::Classes,
            DominantGrayCriterion::default(),
        ] {
            let features = features(dominance, |_, _| 77);
            assert!(features.iter().all(|value| value.is_finite()), "{dominance:?}: {features:?}");
        }
    }
}
