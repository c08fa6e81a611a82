use anyhow::{Context, Result};
use wayfix_scene_sim::film::{FilmFrame, Silhouette};
use wayfix_visual_tracking::{BoundingBox, PixelMask, TargetEstimate, TrackStatus};

use wayfix_systems::track::LostStatusScore;

/// Overlap of an outline from which on it is right. [Everingham et al. 2010, for detections]
const RIGHT: f64 = 0.5;
/// Distance of the centre of a box in pixels up to which it is right. [Wu, Lim & Yang 2013, "precision"]
const NEAR: f64 = 20.0;
/// Minimum number of pixels of a neck in a frame that determine its position.
const MIN_DISTRACTOR_PX: usize = 100;

/// Score of one tracker on one film, without the first frame.
///
/// An outline is scored by its pixels and the whole target, hidden parts included; a target without an outline by its box and the true one.
#[derive(Clone, Debug, Default)]
pub struct FilmTrackingScore {
    /// Overlap of each frame with a visible target; 0 if the tracker reports it lost.
    pub iou: Vec<f64>,
    /// Distance of the centres in pixels, in frames not reported lost.
    pub center_error: Vec<f64>,
    /// Whether each frame with a visible target is correct: the outline covers it, or the centre of the box is near. Box overlap is unsuitable for
    /// a target that rotates.
    pub right: Vec<bool>,
    /// Share of the neck that is inside the outline, of the frames with enough of a neck.
    pub distractor_share: Vec<f64>,
    /// Error rates of the lost status.
    pub status: LostStatusScore,
    /// Number of frames with a visible target reported lost.
    pub n_lost: usize,
    /// Number of frames without a visible target.
    pub n_hidden: usize,
    /// Number of these that are reported lost.
    pub n_hidden_and_lost: usize,
}

impl FilmTrackingScore {
    /// Takes the next frame in.
    ///
    /// # Errors
    /// Returns an error if an outline cannot be compared with the truth.
    pub fn add(&mut self, target: &TargetEstimate, frame: &FilmFrame) -> Result<()> {
        let lost = target.status == TrackStatus::Lost;
        if frame.visible.area() == 0 {
            self.status.add(0.0, lost);
            self.n_hidden += 1;
            self.n_hidden_and_lost += usize::from(lost);
            return Ok(());
        }
        if lost {
            self.status.add(target.bounding_box.iou(&bounds(&frame.target)?), lost);
            self.n_lost += 1;
            self.iou.push(0.0);
            self.right.push(false);
            return Ok(());
        }
        let (iou, [du, dv]) = if target.outline.is_empty() {
            let truth = bounds(&frame.target)?;
            (target.bounding_box.iou(&truth), apart(target.bounding_box.center(), truth.center()))
        } else {
            let estimate = inside(target, &frame.target)?;
            let truth = mask(&frame.target)?;
            if frame.distractor.area() >= MIN_DISTRACTOR_PX {
                let share =
                    estimate.overlap(&mask(&frame.distractor)?)? as f64 / frame.distractor.area() as f64;
                self.distractor_share.push(share);
            }
            let centers = estimate.centroid().zip(truth.centroid());
            (estimate.iou(&truth)?, centers.map_or([f64::NAN; 2], |(one, other)| apart(one, other)))
        };
        self.status.add(iou, lost);
        let off = du.hypot(dv);
        self.right.push(if target.outline.is_empty() { off <= NEAR } else { iou > RIGHT });
        self.iou.push(iou);
        self.center_error.push(off);
        Ok(())
    }

    /// Whether most of the last frames are right.
    pub fn is_correct_at_end(&self, n_frames: usize) -> bool {
        let last = &self.right[self.right.len().saturating_sub(n_frames)..];
        2 * last.iter().filter(|right| **right).count() > last.len()
    }
}

/// The mean; NaN if empty.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A silhouette as the library's mask.
pub(super) fn mask(silhouette: &Silhouette) -> Result<PixelMask> {
    let (width, pixels) = (silhouette.width(), silhouette.pixels());
    Ok(PixelMask::from_fn(width, silhouette.height(), |u, v| pixels[v * width + u])?)
}

/// The true box.
pub(super) fn bounds(silhouette: &Silhouette) -> Result<BoundingBox> {
    let [x, y, width, height] = silhouette.bounding_box().context("the target is out of the picture")?;
    Ok(BoundingBox::from_corner(x, y, width, height)?)
}

fn inside(target: &TargetEstimate, like: &Silhouette) -> Result<PixelMask> {
    Ok(PixelMask::from_polygon(like.width(), like.height(), &target.outline)?)
}

fn apart(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0] - other[0], one[1] - other[1]]
}
