use crate::error::check_size;
use crate::{BinImage, BoundingBox, ColorHistogram, CondensationError, PixelRect};

/// How likely each pixel belongs to the target by its colour alone, in 255ths.
///
/// ```
/// use wayfix_condensation::{BackProjection, BinImage, BoundingBox, ColorHistogram, ColorQuantizer, ColorSpace, Picture};
/// let bytes = (0..40 * 30).flat_map(|i| if i % 40 > 30 { [200, 30, 10] } else { [90; 3] }).collect();
/// let picture = Picture::from_rgb(40, 30, bytes)?;
/// let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [16; 3])?;
/// let image = BinImage::new(&quantizer, &picture.whole())?;
/// let red = ColorHistogram::of_image(&BinImage::new(&quantizer, &picture.view((31, 0), (9, 30))?)?);
/// let projection = BackProjection::new(&image, &BackProjection::ratio(&red, &ColorHistogram::of_image(&image))?)?;
/// let window = BoundingBox::from_corner(24.0, 5.0, 9.0, 9.0)?;
/// let moments = projection.moments(&window).expect("some red is in it");
/// assert_eq!(moments.mean, [32.0, 9.5]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackProjection {
    width: usize,
    weights: Vec<u8>,
}

/// What a window of a back-projection holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The sum of the weights, 1 for a pixel that belongs to the target for certain.
    pub mass: f64,
    /// The mean `[u, v]` in pixels, by weight.
    pub mean: [f64; 2],
    /// The standard deviations along rows and columns in pixels, by weight.
    pub sigma: [f64; 2],
}

impl BackProjection {
    /// Looks the weight of every pixel up.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when there is not one weight for every bin.
    pub fn new(image: &BinImage, weights: &[u8]) -> Result<Self, CondensationError> {
        check_size("weights of bins", image.n_bins(), weights.len())?;
        let weights = image.bins().iter().map(|&bin| weights[usize::from(bin)]).collect();
        Ok(Self { width: image.width(), weights })
    }

    /// The weight of each bin in 255ths: the share of the surroundings' pixels that are the model's, $`\min(M_i / I_i, 1)`$.
    /// [Swain & Ballard 1991, Sec. 4]
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the histograms differ in the number of bins.
    pub fn ratio(
        model: &ColorHistogram,
        surroundings: &ColorHistogram,
    ) -> Result<Vec<u8>, CondensationError> {
        check_size("histogram", model.counts().len(), surroundings.counts().len())?;
        let pairs = model.counts().iter().zip(surroundings.counts());
        // A bin that the surroundings do not have is a colour of nothing else; one without the model's is none of it.
        let weight =
            |(&own, &all): (&f64, &f64)| if own > 0.0 { (255.0 * own / all).round() as u8 } else { 0 };
        Ok(pairs.map(weight).collect())
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.weights.len() / self.width
    }

    /// The weights of all pixels, row by row.
    pub fn weights(&self) -> &[u8] {
        &self.weights
    }

    /// How much denser the weights are in a window than in the rest of the picture, from -1 to 1: with 0 colour tells nothing of the target.
    /// What of the window is beyond the edges weighs nothing; where it leaves no rest, there is no contrast.
    pub fn contrast(&self, window: &BoundingBox) -> f64 {
        let inside = self.moments(window).map_or(0.0, |moments| moments.mass);
        let covered = PixelRect::covering(window, (self.width, self.height()))
            .map_or(0, |rect| rect.width * rect.height);
        let rest = self.weights.len() - covered;
        if rest == 0 {
            0.0
        } else {
            inside / window.area().max(covered as f64) - (self.mass() - inside) / rest as f64
        }
    }

    /// The moments of the pixels that a window touches; none where there is no mass.
    pub fn moments(&self, window: &BoundingBox) -> Option<Moments> {
        let rect = PixelRect::covering(window, (self.width, self.height()))?;
        let mut sums = [0.0; 5]; // 1, u, u², v, v²
        let rows = self.weights.chunks_exact(self.width).skip(rect.top).take(rect.height);
        for (v, row) in rows.enumerate() {
            let (v, row) = (v as f64, row_sums(&row[rect.left..][..rect.width]));
            let terms = [row[0], row[1], row[2], v * row[0], v * v * row[0]];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        let mass = sums[0];
        let axis = |first: f64, second: f64| {
            let mean = first / mass;
            // Every pixel is as wide as one, which alone is a variance of a twelfth.
            (mean, ((second / mass - mean * mean).max(0.0) + 1.0 / 12.0).sqrt())
        };
        let ((u, sigma_u), (v, sigma_v)) = (axis(sums[1], sums[2]), axis(sums[3], sums[4]));
        (mass > 0.0).then(|| Moments {
            mass: mass / 255.0,
            mean: [rect.left as f64 + u + 0.5, rect.top as f64 + v + 0.5],
            sigma: [sigma_u, sigma_v],
        })
    }

    /// Moves a window to the mean of what is in it until it rests: a mode of the density. [Comaniciu & Meer 2002; Bradski 1998]
    ///
    /// A window that holds nothing stays where it is.
    pub fn climb(&self, window: BoundingBox, max_iterations: usize, tolerance: f64) -> BoundingBox {
        let mut window = window;
        for _ in 0..max_iterations {
            let Some(Moments { mean, .. }) = self.moments(&window) else { break };
            let Ok(moved) = BoundingBox::from_center(mean, window.width(), window.height()) else { break };
            let [du, dv] = [0, 1].map(|axis| moved.center()[axis] - window.center()[axis]);
            window = moved;
            if du.hypot(dv) < tolerance {
                break;
            }
        }
        window
    }

    /// The window of that width and height which holds the most, of those that overlap their neighbours by half; none where there is nothing.
    pub fn densest(&self, width: f64, height: f64) -> Option<BoundingBox> {
        let places = |side: f64, len: usize| {
            let step = (side / 2.0).max(1.0); // less than a pixel finds nothing new
            (0..).map(move |k| f64::from(k) * step).take_while(move |&x| x < len as f64)
        };
        let mut best: Option<(f64, BoundingBox)> = None;
        for y in places(height, self.height()) {
            for x in places(width, self.width) {
                let window = BoundingBox::from_corner(x, y, width, height).ok()?;
                let mass = self.moments(&window).map_or(0.0, |moments| moments.mass);
                if mass > best.map_or(0.0, |(most, _)| most) {
                    best = Some((mass, window));
                }
            }
        }
        best.map(|(_, window)| window)
    }

    /// The sum of all weights; parts that fit into 32 bits vectorize.
    fn mass(&self) -> f64 {
        let part = |weights: &[u8]| f64::from(weights.iter().map(|&weight| u32::from(weight)).sum::<u32>());
        self.weights.chunks(1 << 16).map(part).sum::<f64>() / 255.0
    }
}

/// Sums of weights times 1, columns and their squares. Blocks of 64 columns fit into 32 bits, which vectorizes; what they add up to is exact up
/// to 2^53, and beyond that, in pictures larger than any, rounded instead of overflowing.
fn row_sums(row: &[u8]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (i, block) in row.chunks(64).enumerate() {
        let (mut mass, mut first, mut second) = (0_u32, 0_u32, 0_u32);
        for (u, &weight) in (0..).zip(block) {
            let weight = u32::from(weight);
            mass += weight;
            first += u * weight;
            second += u * u * weight;
        }
        let start = 64.0 * i as f64;
        let [mass, first, second] = [mass, first, second].map(f64::from);
        sums[0] += mass;
        sums[1] += start * mass + first;
        sums[2] += start * start * mass + 2.0 * start * first + second;
    }
    sums
}
