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
pub(crate) fn learned(
    film: &SyntheticFilm,
    seeds: Range<u64>,
    params: &ColorContourTrackerParams,
) -> Result<ReportRun> {
    let training = SyntheticFilm { seed: seeds.end, n_frames: N_TRAINING, ..*film };
    let mut series = Series::default();
    follow(&training, params, None, |colors| series.add(colors))?;
    let learned = ColorDynamics::learn(&series.sequences, 0.0)?;
    let dynamics = learned.dynamics;
    let mut metrics = Vec::new();
    for (name, dynamics) in [("learned", Some(dynamics)), ("default", None)] {
        let one = |seed: u64| follow(&SyntheticFilm { seed, ..*film }, params, dynamics, |_| {});
        let scores = seeds.clone().into_par_iter().map(one).collect::<Result<Vec<_>>>()?;
        let scores: Vec<&FilmTrackingScore> = scores.iter().collect();
        metrics.extend(over_seeds(&scores, film.occlusion).into_iter().map(|metric| prefixed(name, metric)));
    }
    metrics.push(Metric::new("n_training_steps", learned.n_steps as f64, ""));
    let notes = vec![format!("A and B from the film of seed {}, which is not judged.", training.seed)];
    Ok(ReportRun { metrics, notes, ..ReportRun::default() })
}

fn follow(
    film: &SyntheticFilm,
    params: &ColorContourTrackerParams,
    dynamics: Option<ColorDynamics>,
    mut observe: impl FnMut(Option<&PrincipalColors>),
) -> Result<FilmTrackingScore> {
    let mut frames = film.frames()?;
    let first = frames.next().context("a film without frames")?;
    let mut tracker = ColorContourTracker::from_mask(&pixels(&first)?, &mask(&first.target)?, *params)?;
    if let Some(dynamics) = dynamics {
        tracker = tracker.with_dynamics(dynamics);
    }
    let (mut rng, mut score) = (ChaCha8Rng::seed_from_u64(film.seed), FilmTrackingScore::default());
    observe(Some(tracker.colors()));
    for frame in frames {
        let target = tracker.track(&pixels(&frame)?, &mut rng)?;
        observe((target.status == TrackStatus::Tracked).then(|| tracker.colors()));
        score.add(&target, &frame)?;
    }
    Ok(score)
}

/// The states of a training film in sequences without a gap; angles are summed from frame to frame.
#[derive(Default)]
struct Series {
    sequences: Vec<Vec<ColorStateVector>>,
    last: Option<(PrincipalColors, [f64; 2])>,
}

impl Series {
    /// Adds the next frame; a lost target ends the sequence.
    fn add(&mut self, colors: Option<&PrincipalColors>) {
        let Some(colors) = colors else {
            self.last = None;
            return;
        };
        let angles = self.last.as_ref().map_or([0.0; 2], |(last, sum)| {
            let turned = colors.angles_since(last);
            [sum[0] + turned[0], sum[1] + turned[1]]
        });
        let mut state = ColorDistributionState::at_rest(colors).value;
        (state[6], state[7]) = (angles[0], angles[1]);
        if self.last.is_none() {
            self.sequences.push(Vec::new());
        }
        if let Some(sequence) = self.sequences.last_mut() {
            sequence.push(state);
        }
        self.last = Some((*colors, angles));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_lost_target_ends_the_sequence() {
        let cloud = [Vector3::new(0.2, 0.5, 0.5), Vector3::new(0.4, 0.6, 0.5), Vector3::new(0.3, 0.5, 0.8)];
        let colors = PrincipalColors::of(&cloud, &[1.0; 3], None).unwrap();
        let mut series = Series::default();
        for is_tracked in [true, true, false, false, true] {
            series.add(is_tracked.then_some(&colors));
        }
        let lengths: Vec<usize> = series.sequences.iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 1]);
    }
}
