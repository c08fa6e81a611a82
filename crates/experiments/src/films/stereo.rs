use std::{cell::Cell, ops::Range};

use anyhow::{Context, Result};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use rayon::prelude::*;
use wayfix_evaluation::report::ReportRun;
use wayfix_scene_sim::film::{FilmFrame, SyntheticFilm};
use wayfix_visual_tracking::{
    DistanceScale, HeadTracker, HeadTrackerParams, RelativeHeadSizeSource, RgbImage, Tracker,
};

use super::{
    FilmTrackingScore,
    follow::pixels,
    score::bounds,
    table::{over_seeds, prefixed},
};

/// Relative error of a stereo camera whose disparity of 50 pixels has an error of one.
const DISTANCE_SIGMA_SHARE: f64 = 0.02;
/// The head in the first picture; only ratios of distances count.
const FIRST_DISTANCE_M: f64 = 1.0;

/// The head tracker whose scale comes from the measured distance of the head, beside the same with its scale from the search.
///
/// # Errors
/// Returns an error if a tracker cannot begin or refuses a frame.
pub(crate) fn stereo(
    film: &SyntheticFilm,
    seeds: Range<u64>,
    params: &HeadTrackerParams,
) -> Result<ReportRun> {
    let mut metrics = Vec::new();
    for (name, has_distance) in [("stereo", true), ("search", false)] {
        let one = |seed: u64| {
            let film = SyntheticFilm { seed, ..*film };
            if has_distance { with_distance(&film, params) } else { with_search(&film, params) }
        };
        let scores = seeds.clone().into_par_iter().map(one).collect::<Result<Vec<_>>>()?;
        let scores: Vec<&FilmTrackingScore> = scores.iter().collect();
        metrics.extend(over_seeds(&scores, film.occlusion).into_iter().map(|metric| prefixed(name, metric)));
    }
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

fn with_search(film: &SyntheticFilm, params: &HeadTrackerParams) -> Result<FilmTrackingScore> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    follow(frames, begin(&first, params)?, film.seed, |_| Ok(()))
}

fn with_distance(film: &SyntheticFilm, params: &HeadTrackerParams) -> Result<FilmTrackingScore> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    let (first_side, distance) = (side(&first)?, Cell::new(FIRST_DISTANCE_M));
    let camera = DistanceScale::new(FIRST_DISTANCE_M, |_: &RgbImage, _center: [f64; 2]| Some(distance.get()));
    let mut noise = ChaCha8Rng::seed_from_u64(film.seed);
    follow(frames, begin(&first, params)?.with_scale_source(camera), film.seed, |frame| {
        let error = 1.0 + DISTANCE_SIGMA_SHARE * noise.sample::<f64, _>(StandardNormal);
        distance.set(error * FIRST_DISTANCE_M * first_side / side(frame)?);
        Ok(())
    })
}

fn begin(first: &FilmFrame, params: &HeadTrackerParams) -> Result<HeadTracker> {
    Ok(HeadTracker::new(&pixels(first)?, bounds(&first.target)?, params.clone())?)
}

/// The side of a square as large as the head, which is inverse to its distance.
fn side(frame: &FilmFrame) -> Result<f64> {
    let truth = bounds(&frame.target)?;
    Ok((truth.width() * truth.height()).sqrt())
}

fn follow<S: RelativeHeadSizeSource>(
    frames: impl Iterator<Item = FilmFrame>,
    mut tracker: HeadTracker<S>,
    seed: u64,
    mut measure: impl FnMut(&FilmFrame) -> Result<()>,
) -> Result<FilmTrackingScore> {
    let (mut rng, mut score) = (ChaCha8Rng::seed_from_u64(seed), FilmTrackingScore::default());
    for frame in frames {
        measure(&frame)?;
        score.add(&tracker.track(&pixels(&frame)?, &mut rng)?, &frame)?;
    }
    Ok(score)
}
