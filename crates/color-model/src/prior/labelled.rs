use nalgebra::Vector3;

use super::{LightingPriorError, PooledPixelVariance, TrainingVenue};
use crate::{ColorMeans, YuvImage};

/// A pixel is an outlier beyond this number of robust standard deviations. [Hampel 1974]
const OUTLIER_SIGMAS: f64 = 3.0;
/// Standard deviations of a Gaussian in one median absolute deviation.
const SIGMAS_PER_MAD: f64 = 1.4826;

/// The labelled pixels of a training image as number, sum and sum of squares of each colour.
///
/// A label is the index of a map colour plus 1; 0 is what the map does not show.
/// ```
/// use wayfix_color_model::{LabelledPixels, TrainingVenue, YuvImage};
/// let mut pixels = vec![[80, 110, 100]; 25];
/// pixels[12] = [200, 60, 190]; // a ball on the carpet
/// let image = LabelledPixels::from_image(&YuvImage::new(5, 5, pixels)?, (5, 5), &[1; 25], 2)?;
/// assert_eq!((image.n_pixels(0), image.n_outliers()), (24, 1));
/// let venue = TrainingVenue::from_labelled_pixels("lab", &[image], 3);
/// assert_eq!(venue.images[0].seen().count(), 1); // no pixel of the second colour
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledPixels {
    colors: Vec<Moments>,
    n_edge_pixels: u64,
    n_outliers: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moments {
    count: u64,
    sum: Vector3<f64>,
    squares: Vector3<f64>,
}

impl LabelledPixels {
    /// No pixels yet of this number of colours.
    pub fn new(n_colors: usize) -> Self {
        Self { colors: vec![Moments::default(); n_colors], n_edge_pixels: 0, n_outliers: 0 }
    }

    /// Adds a pixel (Y, U, V) of a label; 0 and labels of no colour add nothing.
    pub fn add(&mut self, label: u8, yuv: &Vector3<f64>) {
        if let Some(color) = usize::from(label).checked_sub(1).and_then(|color| self.colors.get_mut(color)) {
            color.count += 1;
            color.sum += yuv;
            color.squares += yuv.component_mul(yuv);
        }
    }

    /// The pixels of an image whose labels are a camera's view of the map or drawn by hand.
    ///
    /// Two kinds of pixels are left out and counted: those next to another label, which mix two colours, and outliers, as a ball on the carpet: they differ from
    /// the median of their colour by more than three robust standard deviations (1.4826 MAD) in Y, U or V.
    ///
    /// # Errors
    /// Returns an error if labels and image differ in size, or a label is of no colour.
    pub fn from_image(
        image: &YuvImage,
        (width, height): (u32, u32),
        labels: &[u8],
        n_colors: usize,
    ) -> Result<Self, LightingPriorError> {
        let (size, n_pixels) = ((image.width(), image.height()), image.pixels().len());
        if size != (width, height) || labels.len() != n_pixels {
            return Err(LightingPriorError::LabelSize { image: size, labels: (width, height) });
        }
        let unknown = |label: &u8| usize::from(*label) > n_colors;
        if let Some(&label) = labels.iter().find(|label| unknown(label)) {
            let n_pixels = labels.iter().filter(|other| **other == label).count();
            return Err(LightingPriorError::UnknownLabel { label, n_pixels, n_colors });
        }
        let mut kept = Self::new(n_colors);
        let mut inside: Vec<Vec<[u8; 3]>> = vec![Vec::new(); n_colors];
        for (pixel, label) in image.pixels().iter().zip(inner_labels(labels, size)) {
            if let Some(color) = usize::from(label).checked_sub(1) {
                inside[color].push(*pixel);
            }
        }
        let n_inside: usize = inside.iter().map(Vec::len).sum();
        kept.n_edge_pixels = (labels.iter().filter(|label| **label > 0).count() - n_inside) as u64;
        for (pixels, label) in inside.iter().zip(1..) {
            let ranges = [0, 1, 2].map(|channel| InlierRange::of(pixels, channel));
            for pixel in pixels {
                if ranges.iter().zip(pixel).all(|(range, value)| range.contains(*value)) {
                    kept.add(label, &Vector3::from(pixel.map(f64::from)));
                } else {
                    kept.n_outliers += 1;
                }
            }
        }
        Ok(kept)
    }

    /// Number of pixels of a colour.
    pub fn n_pixels(&self, color: usize) -> u64 {
        self.colors.get(color).map_or(0, |color| color.count)
    }

    /// Number of labelled pixels next to another label.
    pub fn n_edge_pixels(&self) -> u64 {
        self.n_edge_pixels
    }

    /// Number of labelled pixels that differ from the rest of their colour.
    pub fn n_outliers(&self) -> u64 {
        self.n_outliers
    }

    /// The mean of each colour with at least this number of pixels.
    pub fn means(&self, min_pixels: u64) -> ColorMeans {
        ColorMeans::new(
            self.colors.iter().map(|color| (color.is_seen(min_pixels).then(|| color.mean()), color.count)),
        )
    }
}

impl Moments {
    fn is_seen(&self, min_pixels: u64) -> bool {
        self.count >= min_pixels.max(2) // one pixel has no variance
    }

    fn mean(&self) -> Vector3<f64> {
        self.sum / self.count as f64
    }
}

impl TrainingVenue {
    /// A venue of labelled images; a colour with fewer than `min_pixels` pixels in an image is not seen there.
    pub fn from_labelled_pixels(name: impl Into<String>, images: &[LabelledPixels], min_pixels: u64) -> Self {
        let mut pixels = PooledPixelVariance { variances: Vector3::zeros(), degrees_of_freedom: 0.0 };
        for color in images.iter().flat_map(|image| &image.colors).filter(|color| color.is_seen(min_pixels)) {
            pixels.variances += color.squares - color.mean().component_mul(&color.sum);
            pixels.degrees_of_freedom += (color.count - 1) as f64;
        }
        pixels.variances /= pixels.degrees_of_freedom.max(1.0);
        Self {
            name: name.into(),
            images: images.iter().map(|image| image.means(min_pixels)).collect(),
            pixels: Some(pixels),
        }
    }
}

/// The labels of an image, row by row, with 0 for each pixel next to another label: it may show two colours.
/// ```
/// use wayfix_color_model::inner_labels;
/// let labels = [1, 1, 1, 1, 2, 2];
/// assert_eq!(inner_labels(&labels, (6, 1)), [1, 1, 1, 0, 0, 2]);
/// ```
pub fn inner_labels(labels: &[u8], (width, height): (u32, u32)) -> Vec<u8> {
    let (width, height) = (width as usize, height as usize);
    let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let is_inside = |at: usize, label: u8| {
        let columns = around(at % width, width);
        around(at / width, height).all(|row| {
            let row = labels.get(row * width..).and_then(|row| row.get(columns.clone()));
            row.is_some_and(|row| row.iter().all(|other| *other == label))
        })
    };
    let labels = labels.iter().enumerate();
    labels.map(|(at, &label)| if label > 0 && is_inside(at, label) { label } else { 0 }).collect()
}

/// Values of a channel that are no outliers.
struct InlierRange {
    median: f64,
    reach: f64,
}

impl InlierRange {
    fn of(pixels: &[[u8; 3]], channel: usize) -> Self {
        let median = median(pixels.iter().map(|pixel| pixel[channel]));
        let mad = self::median(pixels.iter().map(|pixel| pixel[channel].abs_diff(median)));
        // Rounding hides half a level.
        let reach = OUTLIER_SIGMAS * SIGMAS_PER_MAD * (f64::from(mad) + 0.5);
        Self { median: f64::from(median), reach }
    }

    fn contains(&self, value: u8) -> bool {
        (f64::from(value) - self.median).abs() <= self.reach
    }
}

/// The lower median; 0 of no values.
fn median(values: impl Iterator<Item = u8>) -> u8 {
    let mut counts = [0_usize; 256];
    values.for_each(|value| counts[usize::from(value)] += 1);
    let n: usize = counts.iter().sum();
    let mut below = 0;
    let reaches_half = |count: &usize| {
        below += count;
        2 * below >= n
    };
    counts.iter().position(reaches_half).map_or(0, |value| value as u8)
}
