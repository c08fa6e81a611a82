use nalgebra::{Matrix3, Vector3};
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    ColorContourTracker, ColorSpace, CorrelationTracker, HeadTracker, RgbImage, TargetEstimate, Tracker,
    TrackingError,
};

/// The target in a frame.
type Estimated = Result<TargetEstimate, TrackingError>;

/// A tracker of any method.
pub trait FrameTracker {
    /// Processes the next image.
    ///
    /// # Errors
    /// Returns the errors of [`Tracker::track`].
    fn track_frame(&mut self, picture: &RgbImage, rng: &mut ChaCha8Rng) -> Estimated;

    /// Colour distribution of the target, for trackers that model it.
    fn colors(&self) -> Option<TargetColorDistribution> {
        None
    }
}

/// Distribution of the target's colours in a colour space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetColorDistribution {
    /// The space.
    pub space: ColorSpace,
    /// Their mean, each axis scaled to [0, 1].
    pub mean: Vector3<f64>,
    /// Their covariance.
    pub covariance: Matrix3<f64>,
}

impl FrameTracker for CorrelationTracker {
    fn track_frame(&mut self, picture: &RgbImage, rng: &mut ChaCha8Rng) -> Estimated {
        self.track(picture, rng)
    }
}

impl FrameTracker for HeadTracker {
    fn track_frame(&mut self, picture: &RgbImage, rng: &mut ChaCha8Rng) -> Estimated {
        self.track(picture, rng)
    }
}

/// A contour tracker and its colour space.
pub(super) struct ContourFrameTracker {
    pub(super) tracker: ColorContourTracker,
    pub(super) space: ColorSpace,
}

impl FrameTracker for ContourFrameTracker {
    fn track_frame(&mut self, picture: &RgbImage, rng: &mut ChaCha8Rng) -> Estimated {
        self.tracker.track(picture, rng)
    }

    fn colors(&self) -> Option<TargetColorDistribution> {
        let colors = self.tracker.colors();
        let variances = Matrix3::from_diagonal(&colors.axis_sigmas.map(|sigma| sigma * sigma));
        let covariance = colors.axes * variances * colors.axes.transpose();
        Some(TargetColorDistribution { space: self.space, mean: colors.mean, covariance })
    }
}
