use image::RgbImage;

use crate::features::columns::ColumnSums;
use crate::features::picture::rgb_pixels;
use crate::{CondensationError, GlobalDescriptor, StateDescriptorTable, View, ViewGrid};

/// Mean and standard deviation of red, green and blue: $`[m_1, m_2, m_3, σ_1, σ_2, σ_3]`$. [Kasprzak & Szynkiewicz, Sec. 3.2]
///
/// ```
/// use wayfix_condensation::{ColorMeanStdDescriptor, RgbImage, View, GlobalDescriptor};
/// let picture = RgbImage::from_raw(2, 1, vec![10, 7, 0, 30, 7, 0]).expect("3 bytes a pixel");
/// let mut features = [0.0; 6];
/// ColorMeanStdDescriptor.extract(&View::whole(&picture)?, &mut features);
/// assert_eq!(features, [20.0, 7.0, 0.0, 10.0, 0.0, 0.0]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColorMeanStdDescriptor;

impl GlobalDescriptor for ColorMeanStdDescriptor {
    fn n_components(&self) -> usize {
        6
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        let mut sums = [0; 6];
        for &pixel in view.rows().flatten() {
            for (sum, term) in sums.iter_mut().zip(terms(pixel)) {
                *sum += term;
            }
        }
        write(&sums, view.n_pixels(), features);
    }

    fn extract_all(
        &self,
        scene: &RgbImage,
        views: &ViewGrid,
    ) -> Result<StateDescriptorTable, CondensationError> {
        views.check(scene)?;
        let mut table = StateDescriptorTable::zeros(views.grid(), 6);
        let (view_width, view_height) = views.view_size();
        let (pixels, (width, _)) = (rgb_pixels(scene), views.scene_size());
        let pixel = |x, y| terms(pixels[y * width + x]);
        let mut integral = vec![[0; 6]; width + 1];
        ColumnSums::for_each_band(views, pixel, |row, columns| {
            for (x, column) in columns.iter().enumerate() {
                integral[x + 1] = std::array::from_fn(|i| integral[x][i] + column[i]);
            }
            for (column, &left) in views.lefts().iter().enumerate() {
                let sums = std::array::from_fn(|i| integral[left + view_width][i] - integral[left][i]);
                let state = row * views.lefts().len() + column;
                write(&sums, view_width * view_height, table.row_mut(state));
            }
        });
        Ok(table)
    }
}

/// A pixel's three values and their squares.
fn terms(pixel: [u8; 3]) -> [u64; 6] {
    let [r, g, b] = pixel.map(u64::from);
    [r, g, b, r * r, g * g, b * b]
}

/// $`σ^2 = \frac{1}{n} \sum I^2 - m^2`$ with the difference taken between integers, where nothing cancels.
fn write(sums: &[u64; 6], n_pixels: usize, features: &mut [f64]) {
    let n = n_pixels as f64;
    for channel in 0..3 {
        let (sum, squares) = (u128::from(sums[channel]), u128::from(sums[channel + 3]));
        features[channel] = sum as f64 / n;
        features[channel + 3] = ((squares * n_pixels as u128 - sum * sum) as f64).sqrt() / n;
    }
}
