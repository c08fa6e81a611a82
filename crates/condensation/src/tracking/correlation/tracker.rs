use rand::Rng;
use std::f64::consts::TAU;

use super::color_ratio::ColorRatio;
use super::features::{CELL, Shares, features};
use super::filter::{CorrelationFilter, Learning};
use super::params::CorrelationTrackerParams;
use super::patch::Patch;
use super::response::Peak;
use super::scale_filter::ScaleFilter;
use crate::tracking::{BoundingBox, Target, TrackStatus, Tracker};
use crate::{CondensationError, Picture};

const SIDE: usize = 48;
const PIXELS: usize = SIDE * CELL;

#[derive(Clone, Debug)]
pub struct CorrelationTracker {
    params: CorrelationTrackerParams,
    picture_size: (usize, usize),
    center: [f64; 2],
    /// Size of the target at scale 1.
    base: [f64; 2],
    window: f64,
    scale: f64,
    taper: Vec<f32>,
    shares: Shares,
    filter: CorrelationFilter,
    colors: ColorRatio,
    scales: ScaleFilter,
    pub debug: [f64; 6],
}

impl CorrelationTracker {
    pub fn new(
        picture: &Picture,
        target: BoundingBox,
        params: CorrelationTrackerParams,
    ) -> Result<Self, CondensationError> {
        let base = [target.width(), target.height()];
        let area = (base[0] * base[1]).sqrt();
        let window = (params.padding * area).max(1.6 * base[0].max(base[1]));
        let per_cell = window / SIDE as f64;
        let cells = base.map(|side| side / per_cell);
        let sigma = params.response_width * (cells[0] * cells[1]).sqrt();
        let support = support(cells.map(|c| c * params.support_margin));
        let hann = |i: usize| 0.5 - 0.5 * libm::cos(TAU * (i as f64 + 0.5) / SIDE as f64);
        let taper = (0..SIDE * SIDE).map(|i| (hann(i % SIDE) * hann(i / SIDE)) as f32).collect();
        let grey = picture.pixels().iter().all(|&[r, g, b]| r == g && g == b);
        let color = if grey { 0.0 } else { params.color_share as f32 };
        let grey_share = params.grey_share as f32;
        let shares = Shares { gradient: 1.0 - color - grey_share, grey: grey_share, color };
        let scales = ScaleFilter::new(params.n_scales, params.scale_step, base, params.scale_regularization);
        let mut tracker = Self {
            picture_size: (picture.width(), picture.height()),
            center: target.center(),
            base,
            window,
            scale: 1.0,
            taper,
            shares,
            filter: CorrelationFilter::new(SIDE, sigma, support),
            colors: ColorRatio::new(),
            scales,
            params,
            debug: [0.0; 6],
        };
        tracker.learn(picture);
        Ok(tracker)
    }

    fn size(&self) -> [f64; 2] {
        self.base.map(|side| side * self.scale)
    }

    fn patch(&self, picture: &Picture) -> Patch {
        let extent = [self.window * self.scale; 2];
        Patch::sampled(picture, self.center, extent, (PIXELS, PIXELS))
    }

    /// Pixels of a patch for one of the picture at scale 1.
    fn zoom(&self) -> f64 {
        PIXELS as f64 / self.window
    }

    fn learn(&mut self, picture: &Picture) {
        let patch = self.patch(picture);
        let spectrum = self.filter.fourier().forward(&features(&patch, &self.taper, self.shares));
        let learning =
            Learning { inertia: self.params.inertia as f32, penalties: [self.params.penalty as f32; 2] };
        self.filter.learn(&spectrum, learning);
        self.colors.learn(&patch, self.base.map(|side| side * self.zoom()), self.params.color_rate as f32);
        self.scales.learn(picture, self.center, self.size(), self.params.scale_rate as f32);
    }

    fn find(&mut self, picture: &Picture) -> Peak {
        let patch = self.patch(picture);
        let spectrum = self.filter.fourier().forward(&features(&patch, &self.taper, self.shares));
        let mut response = self.filter.response(&spectrum);
        let own = Peak::of(&response, SIDE);
        let ratio = self.colors.of(&patch);
        let score = box_means(&ratio, self.base.map(|side| side * self.zoom()));
        let weight = self.params.color_weight as f32;
        for (value, score) in response.iter_mut().zip(&score) {
            *value = (1.0 - weight) * *value + weight * score;
        }
        let peak = Peak::of(&response, SIDE);
        self.debug =
            [own.value, own.sidelobe_ratio, peak.value, peak.sidelobe_ratio, f64::from(score[0]), 0.0];
        Peak { value: own.value, ..peak }
    }
}

impl Tracker for CorrelationTracker {
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &Picture,
        _rng: &mut R,
    ) -> Result<Target, CondensationError> {
        let peak = self.find(picture);
        let per_cell = self.window * self.scale / SIDE as f64;
        self.center[0] = (self.center[0] + peak.shift[0] * per_cell).clamp(0.0, self.picture_size.0 as f64);
        self.center[1] = (self.center[1] + peak.shift[1] * per_cell).clamp(0.0, self.picture_size.1 as f64);
        let factor = self.scales.factor(picture, self.center, self.size());
        self.scale = (self.scale * factor).clamp(0.1, 10.0);
        if peak.value > self.params.learn_above {
            self.learn(picture);
        }
        let size = self.size();
        Ok(Target {
            bounding_box: BoundingBox::from_center(self.center, size[0], size[1])?,
            outline: Vec::new(),
            status: TrackStatus::Tracked,
            quality: peak.value.clamp(0.0, 1.0),
        })
    }
}

fn support(cells: [f64; 2]) -> Vec<f32> {
    let covered = |i: usize, len: f64| {
        let off = (i as f64 + 0.5 - SIDE as f64 / 2.0).abs();
        (0.5 * len + 0.5 - off).clamp(0.0, 1.0)
    };
    (0..SIDE * SIDE).map(|i| (covered(i % SIDE, cells[0]) * covered(i / SIDE, cells[1])) as f32).collect()
}

/// Mean over a box of `size` pixels around the middle shifted by whole cells, in the order of a response.
fn box_means(ratio: &[f32], size: [f64; 2]) -> Vec<f32> {
    let mut sums = vec![0.0_f64; (PIXELS + 1) * (PIXELS + 1)];
    for y in 0..PIXELS {
        let mut row = 0.0;
        for x in 0..PIXELS {
            row += f64::from(ratio[y * PIXELS + x]);
            sums[(y + 1) * (PIXELS + 1) + x + 1] = sums[y * (PIXELS + 1) + x + 1] + row;
        }
    }
    let range = |shift: usize, len: f64| {
        let signed = if shift > SIDE / 2 { shift as f64 - SIDE as f64 } else { shift as f64 };
        let middle = PIXELS as f64 / 2.0 + signed * CELL as f64;
        let clamp = |v: f64| v.round().clamp(0.0, PIXELS as f64) as usize;
        (clamp(middle - len / 2.0), clamp(middle + len / 2.0))
    };
    let mut means = Vec::with_capacity(SIDE * SIDE);
    for y in 0..SIDE {
        let (top, bottom) = range(y, size[1]);
        for x in 0..SIDE {
            let (left, right) = range(x, size[0]);
            let at = |x: usize, y: usize| sums[y * (PIXELS + 1) + x];
            let sum = at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
            means.push((sum / (size[0] * size[1])) as f32);
        }
    }
    means
}
