use super::channels::features::{Shares, features};
use super::channels::patch::Patch;
use super::channels::planes::Spectrum;
use super::filter::CorrelationFilter;
use super::params::CorrelationTrackerParams;
use super::response::Peak;
use super::window::{SIDE, Window, WindowPlace};
use crate::RgbImage;
use crate::picture::rgb_pixels;

/// Samples the window around a pose and applies filters to it.
#[derive(Clone, Debug)]
pub(super) struct Recognizer {
    pub(super) window: Window,
    pub(super) filter: CorrelationFilter,
    shares: Shares,
}

/// Sample of the window around a pose.
#[derive(Clone, Debug)]
pub(super) struct WindowSample {
    pub(super) patch: Patch,
    pub(super) spectrum: Spectrum,
}

/// Response of a filter in the middle of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FilterResponse {
    pub(super) value: f64,
    /// Peak-to-sidelobe ratio of the value, in standard deviations; 0 if there is a higher value elsewhere.
    pub(super) peak_to_sidelobe: f64,
}

/// Shift in cells up to which a peak is in the middle.
const MIDDLE: f64 = 2.0;

impl Recognizer {
    /// For a target of `size` pixels in pictures like `picture`.
    pub(super) fn new(picture: &RgbImage, size: [f64; 2], params: &CorrelationTrackerParams) -> Self {
        let window = Window::around(size, params.search_window_scale);
        let is_grey = rgb_pixels(picture).iter().all(|&[r, g, b]| r == g && g == b);
        let color = if is_grey { 0.0 } else { params.color_channel_share as f32 };
        let grey = params.gray_channel_share as f32;
        let sigma = params.target_response_width * window.target_cells();
        let filter = CorrelationFilter::new(SIDE, sigma, window.support());
        Self { window, filter, shares: Shares { gradient: 1.0 - color - grey, grey, color } }
    }

    pub(super) fn sample_at(&self, picture: &RgbImage, pose: WindowPlace) -> WindowSample {
        self.sample(self.window.patch(picture, pose))
    }

    /// Computes the sample of a patch.
    pub(super) fn sample(&self, patch: Patch) -> WindowSample {
        let features = features(&patch, self.window.taper(), self.shares);
        WindowSample { spectrum: self.filter.fourier().forward(&features), patch }
    }

    pub(super) fn response(&self, filter: &Spectrum, sample: &WindowSample) -> Vec<f32> {
        self.filter.response(filter, &sample.spectrum)
    }

    pub(super) fn evidence(&self, filter: &Spectrum, sample: &WindowSample) -> FilterResponse {
        let response = self.response(filter, sample);
        let peak = Peak::of(&response, SIDE);
        if peak.shift.iter().all(|shift| shift.abs() < MIDDLE) {
            FilterResponse { value: peak.value, peak_to_sidelobe: peak.peak_to_sidelobe }
        } else {
            FilterResponse { value: f64::from(response[0]).max(0.0), peak_to_sidelobe: 0.0 }
        }
    }
}
