use std::f64::consts::TAU;

use image::RgbImage;

use crate::features::columns::ColumnSums;
use crate::features::picture::grey;
use crate::{CondensationError, GlobalDescriptor, StateDescriptorTable, View, ViewGrid};

/// The moduli of the first six Fourier components of the grey values, $`[|F_{0,0}|, …, |F_{0,5}|]`$. [Kasprzak & Szynkiewicz, Eq. 7]
///
/// ```math
/// F_{0,l} = \frac{1}{W H} \sum_{x=0}^{W-1} e^{-i 2π l x / W} \sum_{y=0}^{H-1} I(x, y)
/// ```
///
/// The inner sums are those of the columns, which neighbouring views share.
///
/// ```
/// use wayfix_condensation::{Fft6Descriptor, RgbImage, View, GlobalDescriptor};
/// let stripes = RgbImage::from_raw(2, 1, vec![90, 90, 90, 10, 10, 10]).expect("3 bytes a pixel");
/// let mut features = [0.0; 6];
/// Fft6Descriptor.extract(&View::whole(&stripes)?, &mut features);
/// assert!((features[0] - 50.0).abs() < 1e-12 && (features[1] - 40.0).abs() < 1e-12);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fft6Descriptor;

const N: usize = 6;

impl GlobalDescriptor for Fft6Descriptor {
    fn n_components(&self) -> usize {
        N
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        let mut columns = vec![[0_u64]; view.width()];
        for row in view.grey().as_raw().chunks_exact(view.width()) {
            for (column, &grey) in columns.iter_mut().zip(row) {
                column[0] += u64::from(grey);
            }
        }
        moduli(&columns, &waves(view.width()), view.n_pixels(), features);
    }

    fn extract_all(
        &self,
        scene: &RgbImage,
        views: &ViewGrid,
    ) -> Result<StateDescriptorTable, CondensationError> {
        views.check(scene)?;
        let mut table = StateDescriptorTable::zeros(views.grid(), N);
        let (view_width, view_height) = views.view_size();
        let waves = waves(view_width);
        let (grey, (width, _)) = (grey(scene).into_raw(), views.scene_size());
        let pixel = |x, y| [u64::from(grey[y * width + x])];
        ColumnSums::for_each_band(views, pixel, |row, columns| {
            for (column, &left) in views.lefts().iter().enumerate() {
                let state = row * views.lefts().len() + column;
                let seen = &columns[left..left + view_width];
                moduli(seen, &waves, view_width * view_height, table.row_mut(state));
            }
        });
        Ok(table)
    }
}

/// $`\cos`$ and $`\sin`$ of $`2π l x / W`$ for every column $`x`$ and $`l < 6`$.
fn waves(width: usize) -> Vec<[(f64, f64); N]> {
    let angle = |x: usize, l: usize| TAU * ((l * x) % width) as f64 / width as f64;
    (0..width).map(|x| std::array::from_fn(|l| (angle(x, l).cos(), angle(x, l).sin()))).collect()
}

fn moduli(columns: &[[u64; 1]], waves: &[[(f64, f64); N]], n_pixels: usize, features: &mut [f64]) {
    let (mut real, mut imaginary) = ([0.0; N], [0.0; N]);
    for (&[sum], wave) in columns.iter().zip(waves) {
        for l in 0..N {
            real[l] += sum as f64 * wave[l].0;
            imaginary[l] += sum as f64 * wave[l].1;
        }
    }
    for (l, feature) in features.iter_mut().enumerate() {
        *feature = real[l].hypot(imaginary[l]) / n_pixels as f64;
    }
}
