use std::ops::Range;

use anyhow::{Context, Result};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rayon::prelude::*;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_visual_tracking::{
    ColorContourTracker, ColorContourTrackerParams, ColorDistributionState, ColorDynamics, ColorStateVector,
    PrincipalColors, TrackStatus, Tracker,
};

use super::{
    FilmTrackingScore,
    follow::pixels,
    score::mask,
    table::{over_seeds, prefixed},
};

/// Frames of the training film: forty for each of the 16 unknowns of a row of $`A`$.
const N_TRAINING: usize = 640;

/// The contour tracker on a film with $`A`$ and $`B`$ learned from another film of the same story, by the least squares of Blake & Isard, beside
/// the same with its default dynamics.
///
/// # Errors
/// Returns an error if a tracker cannot begin or the training film leaves the dynamics open.
pub fn learned(
    film: &SyntheticFilm,
    seeds: Range<u64>,
    params: &ColorContourTrackerParams,
) -> Result<ReportRun> {
    let training = SyntheticFilm { seed: seeds.end, n_frames: N_TRAINING, ..*film };
    let mut series = Series::default();
    follow(&training, params, None, |colors| series.add(colors))?;
    let dynamics = ColorDynamics::learn(&series.states, 0.0)?.dynamics;
    let mut metrics = Vec::new();
    for (name, dynamics) in [("learned", Some(dynamics)), ("default", None)] {
        let one = |seed: u64| follow(&SyntheticFilm { seed, ..*film }, params, dynamics, |_| {});
        let scores = seeds.clone().into_par_iter().map(one).collect::<Result<Vec<_>>>()?;
        let scores: Vec<&FilmTrackingScore> = scores.iter().collect();
        metrics.extend(over_seeds(&scores, film.occlusion).into_iter().map(|metric| prefixed(name, metric)));
    }
    metrics.push(Metric::new("n_training_states", series.states.len() as f64, ""));
    let notes = vec![format!("A and B from the film of seed {}, which is not judged.", training.seed)];
    Ok(ReportRun { metrics, notes, ..ReportRun::default() })
}

fn follow(
    film: &SyntheticFilm,
    params: &ColorContourTrackerParams,
    dynamics: Option<ColorDynamics>,
    mut observe: impl FnMut(&PrincipalColors),
) -> Result<FilmTrackingScore> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    let mut tracker = ColorContourTracker::from_mask(&pixels(&first)?, &mask(&first.target)?, *params)?;
    if let Some(dynamics) = dynamics {
        tracker = tracker.with_dynamics(dynamics);
    }
    let (mut rng, mut score) = (ChaCha8Rng::seed_from_u64(film.seed), FilmTrackingScore::default());
    observe(tracker.colors());
    for frame in frames {
        let target = tracker.track(&pixels(&frame)?, &mut rng)?;
        if target.status == TrackStatus::Tracked {
            observe(tracker.colors());
        }
        score.add(&target, &frame)?;
    }
    Ok(score)
}

/// The states of a training film; angles are summed from frame to frame.
#[derive(Default)]
struct Series {
    states: Vec<ColorStateVector>,
    last: Option<(PrincipalColors, [f64; 2])>,
}

impl Series {
    fn add(&mut self, colors: &PrincipalColors) {
        let angles = self.last.as_ref().map_or([0.0; 2], |(last, sum)| {
            let turned = colors.angles_since(last);
            [sum[0] + turned[0], sum[1] + turned[1]]
        });
        let mut state = ColorDistributionState::at_rest(colors).value;
        (state[6], state[7]) = (angles[0], angles[1]);
        self.states.push(state);
        self.last = Some((*colors, angles));
    }
}
