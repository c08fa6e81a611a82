use crate::RgbImage;

/// Source of the size of the head: [`DistanceScale`], or one of your own.
pub trait RelativeHeadSizeSource {
    /// The size of the head in `picture` beside that in the first one, or `None` where it is to be searched; `center` is where the head
    /// was, in pixels.
    fn scale(&mut self, picture: &RgbImage, center: [f64; 2]) -> Option<f64>;
}

/// Leaves the scale to the search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeadSizeFromSearch;

impl RelativeHeadSizeSource for HeadSizeFromSearch {
    fn scale(&mut self, _picture: &RgbImage, _center: [f64; 2]) -> Option<f64> {
        None
    }
}

/// The scale from the distance of the head, $`s = Z_0 / Z`$, as a stereo or depth camera measures it.
///
/// ```
/// use wayfix_visual_tracking::{DistanceScale, RgbImage, RelativeHeadSizeSource};
/// let picture = RgbImage::new(1, 1);
/// // Distances that a stereo camera measures, in metres; the first picture showed the head at 2 m.
/// let mut stereo = DistanceScale::new(2.0, |_: &RgbImage, _center: [f64; 2]| Some(4.0));
/// assert_eq!(stereo.scale(&picture, [0.0, 0.0]), Some(0.5));
/// // A head 0.15 m wide is 30 pixels wide at 2 m if the focal length is 400 pixels.
/// let mut known = DistanceScale::of_known_width(0.15, 400.0, 30.0, |_: &RgbImage, _center: [f64; 2]| Some(1.0));
/// assert_eq!(known.scale(&picture, [0.0, 0.0]), Some(2.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DistanceScale<F> {
    first_m: f64,
    distance: F,
}

impl<F: FnMut(&RgbImage, [f64; 2]) -> Option<f64>> DistanceScale<F> {
    /// From the distance in the first picture and the source of the later ones, all in metres. A distance that is not positive makes the tracker
    /// refuse the picture.
    pub fn new(first_m: f64, distance: F) -> Self {
        Self { first_m, distance }
    }

    /// From the width of the head in metres, the focal length in pixels and the head's width in the first picture in pixels,
    /// $`Z_0 = f W / w_0`$.
    pub fn of_known_width(width_m: f64, focal_length_px: f64, first_width_px: f64, distance: F) -> Self {
        Self::new(focal_length_px * width_m / first_width_px, distance)
    }
}

impl<F: FnMut(&RgbImage, [f64; 2]) -> Option<f64>> RelativeHeadSizeSource for DistanceScale<F> {
    fn scale(&mut self, picture: &RgbImage, center: [f64; 2]) -> Option<f64> {
        (self.distance)(picture, center).map(|distance| self.first_m / distance)
    }
}
