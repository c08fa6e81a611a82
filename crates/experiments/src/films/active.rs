use std::{f64::consts::PI, ops::Range};

use anyhow::{Context, Result};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rayon::prelude::*;
use wayfix_evaluation::{
    errors::MeanInterval,
    report::{ConfidenceInterval, Metric, ReportRun},
};
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_systems::track::LostStatusScore;
use wayfix_visual_tracking::{
    ActiveTracker, BoundingBox, HeadTracker, HeadTrackerParams, PanTiltAim, PanTiltHead, PanTiltLimits,
    RgbImage, SimulatedPanTilt, TrackStatus,
};

use super::score::{bounds, mean};

/// The view, a quarter of the film.
const VIEW_PX: [usize; 2] = [SyntheticFilm::SIZE_PX.0 / 2, SyntheticFilm::SIZE_PX.1 / 2];
/// A horizontal field of view of 53 degrees.
const FOCAL_LENGTH_PX: f64 = VIEW_PX[0] as f64;
/// Pictures that a command is late: exposure, transfer, motor.
const DELAY: usize = 2;

/// What became of the target in one film.
#[derive(Default)]
struct Score {
    in_middle: Vec<f64>,
    in_view: Vec<f64>,
    n_lost: usize,
    status: LostStatusScore,
}

/// The head tracker on a simulated pan/tilt head of that rate, in rad/s, which turns a view over a larger film.
///
/// # Errors
/// Returns an error if the film cannot be shown or the tracker cannot begin.
pub(crate) fn active(film: &SyntheticFilm, seeds: Range<u64>, rate: f64) -> Result<ReportRun> {
    let one = |seed: u64| follow(&SyntheticFilm { seed, ..*film }, rate);
    let scores = seeds.into_par_iter().map(one).collect::<Result<Vec<_>>>()?;
    let share = |name: &str, of: fn(&Score) -> &Vec<f64>| {
        let shares: Vec<f64> = scores.iter().map(|score| mean(of(score))).collect();
        let spread = MeanInterval::of(&shares)
            .map(|MeanInterval { half_width, n, .. }| ConfidenceInterval { half_width, n });
        Metric { spread, ..Metric::new(name, mean(&shares), "") }
    };
    let mut status = LostStatusScore::default();
    scores.iter().for_each(|score| status.merge(&score.status));
    let metrics = vec![
        share("middle_third_share", |score| &score.in_middle),
        share("in_view_share", |score| &score.in_view),
        Metric::new("n_frames_lost", scores.iter().map(|score| score.n_lost).sum::<usize>() as f64, ""),
        Metric::new("false_tracked_share", status.false_tracked_share(), ""),
    ];
    let notes = vec![format!("{} seeds; a command acts {DELAY} pictures later.", scores.len())];
    Ok(ReportRun { metrics, notes, ..ReportRun::default() })
}

fn follow(film: &SyntheticFilm, rate: f64) -> Result<Score> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    let limits = PanTiltLimits { rate, ..PanTiltLimits::default() };
    let mut head = SimulatedPanTilt::new(limits, DELAY, 1.0 / SyntheticFilm::RATE_HZ)?;
    // The target is in the middle at first, at any rate.
    let target = bounds(&first.target)?.center();
    head.turn_to([0, 1].map(|k| ((target[k] - VIEW_PX[k] as f64) / FOCAL_LENGTH_PX).atan()))?;
    let n_pictures = (DELAY + 1) + (PI / rate * SyntheticFilm::RATE_HZ) as usize;
    (0..n_pictures).for_each(|_| head.advance());
    let view = View::at(head.angles()?);
    let tracker = HeadTracker::new(
        &view.picture(&first.picture.rgb)?,
        view.shown(&bounds(&first.target)?)?,
        HeadTrackerParams::default(),
    )?;
    let aim = PanTiltAim::new(FOCAL_LENGTH_PX, VIEW_PX.map(|side| side as f64 / 2.0), (DELAY + 1) as f64)?;
    let mut active = ActiveTracker::new(tracker, aim, head);
    let mut rng = ChaCha8Rng::seed_from_u64(film.seed);
    let mut score = Score::default();
    for frame in frames {
        active.head.advance();
        let view = View::at(active.head.angles()?);
        let target = active.step(&view.picture(&frame.picture.rgb)?, &mut rng)?.target;
        let truth = view.shown(&bounds(&frame.target)?)?;
        let within = |share: f64| {
            let near = |k: usize| (truth.center()[k] / VIEW_PX[k] as f64 - 0.5).abs() <= share / 2.0;
            f64::from(u8::from(near(0) && near(1)))
        };
        score.in_middle.push(within(1.0 / 3.0));
        score.in_view.push(within(1.0));
        let lost = target.status == TrackStatus::Lost;
        score.n_lost += usize::from(lost);
        score.status.add(target.bounding_box.iou(&truth), lost);
    }
    Ok(score)
}

/// The left and top column and row of the film that a camera shows; beyond the film its last pixel repeats.
struct View([f64; 2]);

impl View {
    fn at(angles: [f64; 2]) -> Self {
        Self([0, 1].map(|k| (FOCAL_LENGTH_PX * angles[k].tan() + VIEW_PX[k] as f64 / 2.0).round()))
    }

    fn picture(&self, film: &[u8]) -> Result<RgbImage> {
        let (width, height) = SyntheticFilm::SIZE_PX;
        let film = RgbImage::from_raw(width as u32, height as u32, film.to_vec());
        let film = film.context("a frame of the film has not three bytes a pixel")?;
        let place =
            |k: usize, at: u32, side: usize| (self.0[k] + f64::from(at)).clamp(0.0, side as f64 - 1.0);
        Ok(RgbImage::from_fn(VIEW_PX[0] as u32, VIEW_PX[1] as u32, |u, v| {
            *film.get_pixel(place(0, u, width) as u32, place(1, v, height) as u32)
        }))
    }

    fn shown(&self, truth: &BoundingBox) -> Result<BoundingBox> {
        let [x, y] = truth.corner();
        Ok(BoundingBox::from_corner(x - self.0[0], y - self.0[1], truth.width(), truth.height())?)
    }
}
