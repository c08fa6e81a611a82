use crate::RgbImage;

/// Source of the size of the head, for example a stereo camera that measures its distance.
///
/// ```
/// use wayfix_visual_tracking::{RgbImage, RelativeHeadSizeSource};
/// /// Distances that a stereo camera measured, picture after picture, in metres.
/// struct Stereo(Vec<f64>);
/// impl RelativeHeadSizeSource for Stereo {
///     fn scale(&mut self, _picture: &RgbImage, _center: [f64; 2]) -> Option<f64> {
///         let first = 2.0;
///         self.0.pop().map(|distance| first / distance)
///     }
/// }
/// let picture = RgbImage::from_raw(1, 1, vec![0; 3]).expect("3 bytes a pixel");
/// assert_eq!(Stereo(vec![4.0]).scale(&picture, [0.0, 0.0]), Some(0.5));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
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
