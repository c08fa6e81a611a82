use wayfix_visual_tracking::BoundingBox;

/// Overlap thresholds of the success curve: 0, 0.05, …, 1. [Wu, Lim & Yang 2013]
const N_THRESHOLDS: usize = 21;
/// Distance of the centres within which a frame counts as precise, pixels. [Wu, Lim & Yang 2013]
const NEAR_PX: f64 = 20.0;

/// Tracking accuracy of boxes, accumulated frame by frame.
///
/// A frame without an estimate has overlap 0 and is not precise.
///
/// ```
/// use wayfix_systems::track::BoxScore;
/// use wayfix_visual_tracking::BoundingBox;
/// let truth = BoundingBox::from_corner(0.0, 0.0, 30.0, 30.0)?;
/// let mut score = BoxScore::default();
/// score.add(Some(&BoundingBox::from_corner(10.0, 0.0, 30.0, 30.0)?), &truth); // overlap 1/2, off by 10 px
/// score.add(Some(&BoundingBox::from_corner(25.0, 0.0, 30.0, 30.0)?), &truth); // 1/11, off by 25 px
/// assert!((score.iou_mean().unwrap() - (0.5 + 1.0 / 11.0) / 2.0).abs() < 1e-12);
/// assert_eq!((score.precision(), score.center_error_mean()), (Some(0.5), Some(17.5)));
/// assert!((score.success_auc().unwrap() - (10.0 + 2.0) / 42.0).abs() < 1e-12); // above 0 … 0.45, above 0 and 0.05
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoxScore {
    n_frames: u64,
    iou_sum: f64,
    n_above: [u64; N_THRESHOLDS],
    n_near: u64,
    n_estimated: u64,
    center_error_sum: f64,
}

impl BoxScore {
    /// Counts a frame with a visible target; `None` is a frame without an estimate.
    pub fn add(&mut self, estimate: Option<&BoundingBox>, truth: &BoundingBox) {
        self.n_frames += 1;
        let Some(estimate) = estimate else { return };
        let iou = estimate.iou(truth);
        self.iou_sum += iou;
        for (k, n_above) in self.n_above.iter_mut().enumerate() {
            *n_above += u64::from(iou > k as f64 / (N_THRESHOLDS - 1) as f64);
        }
        let ([u, v], [true_u, true_v]) = (estimate.center(), truth.center());
        let distance = (u - true_u).hypot(v - true_v);
        self.n_near += u64::from(distance <= NEAR_PX);
        self.n_estimated += 1;
        self.center_error_sum += distance;
    }

    /// Number of counted frames.
    pub fn n_frames(&self) -> u64 {
        self.n_frames
    }

    /// Mean intersection over union; `None` without frames.
    pub fn iou_mean(&self) -> Option<f64> {
        self.per_frame(self.iou_sum)
    }

    /// Share of the frames with more overlap than each of the thresholds 0, 0.05, …, 1, averaged over these.
    pub fn success_auc(&self) -> Option<f64> {
        self.per_frame(self.n_above.iter().sum::<u64>() as f64 / N_THRESHOLDS as f64)
    }

    /// Share of the frames with a centre error of at most 20 pixels.
    pub fn precision(&self) -> Option<f64> {
        self.per_frame(self.n_near as f64)
    }

    /// Mean centre error in pixels, over the frames with an estimate.
    pub fn center_error_mean(&self) -> Option<f64> {
        (self.n_estimated > 0).then(|| self.center_error_sum / self.n_estimated as f64)
    }

    fn per_frame(&self, sum: f64) -> Option<f64> {
        (self.n_frames > 0).then(|| sum / self.n_frames as f64)
    }
}
