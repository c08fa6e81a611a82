use std::f64::consts::TAU;

use super::channels::patch::Patch;
use super::filter::Learning;
use super::recognizer::WindowSample;
use super::response::Peak;
use super::tracker::CorrelationTracker;
use super::window::{SIDE, Window, WindowPlace};
use crate::RgbImage;

/// Angles searched for a lost target; a filter recognizes rotations of up to half the step.
const N_ANGLES: usize = 12;
/// Angles searched per image.
const N_AT_ONCE: usize = 6;
/// Pixels along a target in the small image used for the colour search.
const COARSE: f64 = 12.0;
/// Factor on the required peak of a rotated target: the search has many more places for a chance match.
const STRICTER: f64 = 1.25;

impl CorrelationTracker {
    /// Searches for a lost, rotated target at the position with most of its colours; returns the quality.
    ///
    /// The filter is relearned at the result, because it covers one orientation only.
    pub(super) fn search_turned(&mut self, picture: &RgbImage) -> f64 {
        let from = WindowPlace { center: self.most_alike(picture), ..self.pose };
        let surroundings = self.recognizer.window.surroundings(picture, from);
        let first = 1 + self.n_lost % 2 * N_AT_ONCE;
        let angles = (first..(first + N_AT_ONCE).min(N_ANGLES)).map(|k| TAU * k as f64 / N_ANGLES as f64);
        let seen: Vec<(f64, Peak)> = angles
            .map(|angle| {
                let sample = self.recognizer.sample(Window::turned(&surroundings, angle));
                (angle, Peak::of(&self.recognizer.response(&self.trusted, &sample), SIDE))
            })
            .collect();
        let best = seen.into_iter().max_by(|a, b| a.1.peak_to_sidelobe.total_cmp(&b.1.peak_to_sidelobe));
        let Some((angle, peak)) = best else { return 0.0 };
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let [x, y] = peak.shift;
        let pose = self.recognizer.window.moved(from, [cos * x - sin * y, sin * x + cos * y]);
        let sample = self.recognizer.sample_at(picture, pose);
        let is_clear = peak.peak_to_sidelobe > STRICTER * self.params.recognize_above_psr
            && peak.value > self.params.min_recognition_response_share * self.typical_response;
        if !is_clear || !self.has_target_colors(&sample) {
            return 0.0;
        }
        self.relearn(picture, pose, &sample);
        self.found();
        peak.value / self.typical_response
    }

    /// Relearns the target at a pose.
    pub(super) fn relearn(&mut self, picture: &RgbImage, pose: WindowPlace, sample: &WindowSample) {
        let learning =
            Learning { inertia: 0.0, penalty: self.params.spatial_spectral_agreement_weight as f32 };
        self.current = self.recognizer.filter.learned(None, &sample.spectrum, learning);
        self.trusted.clone_from(&self.current);
        self.scales.learn(picture, pose.center, self.recognizer.window.size(pose.scale), 1.0);
        self.learned.clone_from(&sample.patch);
        (self.pose, self.n_untrusted) = (pose, 0);
    }

    /// The place where a square of the target's area has the most of its colours.
    fn most_alike(&self, picture: &RgbImage) -> [f64; 2] {
        let [width, height] = self.recognizer.window.size(self.pose.scale);
        let shrink = (COARSE / (width * height).sqrt()).min(1.0);
        let size = [picture.width() as usize, picture.height() as usize]
            .map(|n| ((n as f64 * shrink).ceil() as usize).max(1));
        let extent = [picture.width() as usize as f64, picture.height() as usize as f64];
        let small = Patch::sampled(picture, extent.map(|n| n / 2.0), extent, (size[0], size[1]));
        let side = (shrink * (width * height).sqrt()).round().max(1.0) as usize;
        let (u, v) = densest(&self.colors.of(&small), size, side);
        [0, 1].map(|axis| [u, v][axis] * extent[axis] / size[axis] as f64)
    }
}

/// The middle of the square of `side` pixels with the largest sum of `values`; squares reach beyond the rim.
fn densest(values: &[f32], [width, height]: [usize; 2], side: usize) -> (f64, f64) {
    let half = side / 2;
    let along_rows: Vec<f32> = (0..width * height)
        .map(|i| {
            let (u, v) = (i % width, i / width);
            values[v * width..][u.saturating_sub(half)..(u + half + 1).min(width)].iter().sum()
        })
        .collect();
    let sum = |i: usize| {
        let (u, v) = (i % width, i / width);
        (v.saturating_sub(half)..(v + half + 1).min(height)).map(|v| along_rows[v * width + u]).sum::<f32>()
    };
    let best = (0..width * height)
        .map(|i| (i, sum(i)))
        .fold((0, f32::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    ((best.0 % width) as f64 + 0.5, (best.0 / width) as f64 + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_densest_square_is_where_the_values_are() {
        let value =
            |i: usize| f32::from(u8::from((10..15).contains(&(i % 40)) && (20..25).contains(&(i / 40))));
        let values: Vec<f32> = (0..40 * 30).map(value).collect();
        assert_eq!(densest(&values, [40, 30], 5), (12.5, 22.5));
        assert_eq!(densest(&[0.0; 6], [3, 2], 9), (0.5, 0.5), "nothing anywhere: the first");
    }
}
