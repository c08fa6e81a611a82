use anyhow::{Context, Result};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::film::{FilmFrame, SyntheticFilm};
use wayfix_sensor_log::Stamp;
use wayfix_system_core::Stopwatch;
use wayfix_systems::track::{
    InitialTargetRegion, TargetTruth, TrackFrameResult, TrackParams, TrackingMethod,
};
use wayfix_visual_tracking::RgbImage;

use super::{
    FilmTrackingScore,
    score::{bounds, mask},
};

/// Runs trackers of several methods on a film, each started with the true mask of the first frame, and scores the later frames.
///
/// `observe` sees every frame of the first method.
/// # Errors
/// Returns an error if a tracker cannot begin, or refuses a frame.
pub(crate) fn follow(
    film: &SyntheticFilm,
    methods: &[TrackingMethod],
    params: &TrackParams,
    mut observe: impl FnMut(&TrackFrameResult) -> Result<()>,
) -> Result<Vec<FilmTrackingScore>> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    let (picture, start) = (pixels(&first)?, InitialTargetRegion::Mask(mask(&first.target)?));
    let begin = |method: &TrackingMethod| method.begin(params, &picture, &start);
    let mut trackers = methods.iter().map(begin).collect::<Result<Vec<_>, _>>()?;
    let mut rngs = vec![ChaCha8Rng::seed_from_u64(film.seed); methods.len()];
    let mut scores = vec![FilmTrackingScore::default(); methods.len()];
    for (index, frame) in (1..).zip(frames) {
        let picture = pixels(&frame)?;
        for (k, tracker) in trackers.iter_mut().enumerate() {
            let stopwatch = Stopwatch::start();
            let target = tracker.track_frame(&picture, &mut rngs[k])?;
            let step = stopwatch.elapsed();
            let n_frames_with_truth = scores[k].iou.len();
            scores[k].add(&target, &frame)?;
            if k == 0 {
                observe(&TrackFrameResult {
                    index,
                    stamp: Stamp::from_nanoseconds((1e9 * index as f64 / SyntheticFilm::RATE_HZ) as u64),
                    picture: picture.clone(),
                    target,
                    truth: bounds(&frame.target).map_or(TargetTruth::Absent, TargetTruth::At),
                    iou: scores[0].iou.get(n_frames_with_truth).copied(),
                    colors: tracker.colors(),
                    step,
                })?;
            }
        }
    }
    Ok(scores)
}

pub(super) fn pixels(frame: &FilmFrame) -> Result<RgbImage> {
    let picture = &frame.picture;
    RgbImage::from_raw(picture.width as u32, picture.height as u32, picture.rgb.clone())
        .context("a frame of the film has not three bytes a pixel")
}
