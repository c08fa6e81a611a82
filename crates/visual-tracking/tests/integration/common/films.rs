//! Films of the simulator, and how well a tracker follows them.

#![allow(dead_code, reason = "each test uses a part")]

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use wayfix_scene_sim::film::{FilmFrame, Silhouette, SyntheticFilm};
use wayfix_visual_tracking::{
    ColorContourTracker, ColorContourTrackerParams, PixelMask, RgbImage, TargetEstimate, TrackStatus,
    Tracker as _,
};

/// What became of every frame after the first.
pub(crate) struct Record(Vec<Step>);

struct Step {
    /// Pixels of the target that are in sight.
    n_visible: usize,
    tracked: bool,
    /// Intersection over union of the contour and the whole target.
    overlap: f64,
    decoy_inside: usize,
    distractor: usize,
}

impl Record {
    /// Frames in which the tracker says that it does not see the target.
    pub(crate) fn n_lost(&self) -> usize {
        self.0.iter().filter(|step| !step.tracked).count()
    }

    pub(crate) fn mean_overlap(&self) -> f64 {
        mean(self.0.iter())
    }

    /// The mean over the last ten frames.
    pub(crate) fn overlaps_at_the_end(&self) -> f64 {
        mean(self.0[self.0.len() - 10..].iter())
    }

    /// Frames without the target.
    pub(crate) fn n_gone(&self) -> usize {
        self.0.iter().filter(|step| step.n_visible == 0).count()
    }

    pub(crate) fn n_confident_while_gone(&self) -> usize {
        self.0.iter().filter(|step| step.n_visible == 0 && step.tracked).count()
    }

    /// Share of the distractor that is inside the contour.
    pub(crate) fn decoy_inside(&self) -> f64 {
        let total = |count: fn(&Step) -> usize| self.0.iter().map(count).sum::<usize>();
        total(|step| step.decoy_inside) as f64 / total(|step| step.distractor).max(1) as f64
    }
}

/// Tracks a film from the true mask of its first frame.
pub(crate) fn follow(film: &SyntheticFilm, params: ColorContourTrackerParams) -> Record {
    let mut frames = film.frames().expect("a known film");
    let first = frames.next().expect("frames");
    let start = ColorContourTracker::from_mask(&picture_of(&first), &mask_of(&first.target), params);
    let mut tracker = start.expect("a target in sight");
    let mut rng = ChaCha8Rng::seed_from_u64(film.seed);
    Record(
        frames
            .map(|frame| {
                let target = tracker.track(&picture_of(&frame), &mut rng).expect("frames of one size");
                step(&frame, &target)
            })
            .collect(),
    )
}

fn step(frame: &FilmFrame, target: &TargetEstimate) -> Step {
    let found = contour_mask(target, SyntheticFilm::SIZE_PX);
    let tracked = target.status == TrackStatus::Tracked;
    let overlap = found.iou(&mask_of(&frame.target)).expect("one size");
    Step {
        n_visible: frame.visible.area(),
        tracked,
        overlap: if tracked { overlap } else { 0.0 },
        decoy_inside: found.overlap(&mask_of(&frame.distractor)).expect("one size"),
        distractor: frame.distractor.area(),
    }
}

fn mean<'a>(steps: impl ExactSizeIterator<Item = &'a Step>) -> f64 {
    let n = steps.len() as f64;
    steps.map(|step| step.overlap).sum::<f64>() / n
}

pub(crate) fn picture_of(frame: &FilmFrame) -> RgbImage {
    let rgb = &frame.picture;
    RgbImage::from_raw(rgb.width as u32, rgb.height as u32, rgb.rgb.clone()).expect("3 bytes a pixel")
}

pub(crate) fn mask_of(silhouette: &Silhouette) -> PixelMask {
    let width = silhouette.width();
    let inside = |u: usize, v: usize| silhouette.pixels()[v * width + u];
    PixelMask::from_fn(width, silhouette.height(), inside).expect("pixels")
}

pub(crate) fn contour_mask(target: &TargetEstimate, size: (usize, usize)) -> PixelMask {
    PixelMask::from_polygon(size.0, size.1, &target.outline).expect("finite points")
}
