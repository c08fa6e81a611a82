use rand::Rng;

use super::hypotheses::candidate::Candidate;
use super::hypotheses::each::map_each;
use super::hypotheses::samples::Samples;
use super::scene::Scene;
use super::search::in_other_light;
use super::{ColorContourTracker, TrackingCues};
use crate::{
    ColorBinSet, ColorCloud, ColorDistributionState, Outline, PixelMask, RgbImage, TrackStatus, TrackingError,
};

/// Result of a search for the target, and the data to learn from it.
pub(super) struct Found {
    pub(super) candidate: Candidate,
    pub(super) quality: f64,
    /// Whether the contour jumped to the whole of a target of which it had a part.
    pub(super) regrown: bool,
    /// The outline, if it is not the snake's.
    pub(super) outline: Option<Outline>,
    pub(super) cloud: Option<ColorCloud>,
    pub(super) samples: Samples,
}

impl ColorContourTracker {
    /// Round the place where the target is expected.
    pub(super) fn follow<R: Rng + ?Sized>(
        &self,
        picture: &RgbImage,
        rng: &mut R,
    ) -> Result<Option<Found>, TrackingError> {
        let scene = Scene::around_target(&self.params, &self.quantizer, picture, &self.reference)?;
        let Some(scene) = scene else { return Ok(None) };
        if self.params.cues == TrackingCues::Shape {
            let (candidate, samples) = (Candidate::of_edges(&scene), self.samples.clone());
            // Area and quality are meaningless without an edge.
            let quality = candidate.agreement.score(&self.params).min(candidate.agreement.affine);
            return Ok(Some(Found {
                candidate,
                quality,
                regrown: false,
                outline: None,
                cloud: None,
                samples,
            }));
        }
        let states = self.hypotheses(rng)?;
        let candidates = map_each(&states, |state| Candidate::of_colors(&scene, state));
        let log_weights: Vec<f64> =
            candidates.iter().map(|candidate| candidate.agreement.log_weight(&self.params)).collect();
        let best = first_max(&log_weights);
        let state = states[best];
        let set = scene.bin_set(&state);
        let samples = self.samples.weighed(states, log_weights)?;
        let Some(mask) = scene.target_mask(&set) else { return Ok(None) };
        self.finish(&scene, candidates[best], &state, &set, &mask, samples).map(Some)
    }

    /// In the whole picture.
    pub(super) fn search<R: Rng + ?Sized>(
        &self,
        picture: &RgbImage,
        rng: &mut R,
    ) -> Result<Option<Found>, TrackingError> {
        if self.params.cues == TrackingCues::Shape {
            return Ok(None);
        }
        let scene = Scene::whole(&self.params, &self.quantizer, picture, &self.reference)?;
        let states = self.hypotheses(rng)?;
        let stride = states.len().div_ceil(self.params.n_search_color_hypotheses);
        let mut states: Vec<ColorDistributionState> = states.into_iter().step_by(stride).collect();
        if self.params.adapts_colors {
            states.extend(in_other_light(self.params.color_space, &self.reference.colors));
        }
        let found = map_each(&states, |state| scene.find(state));
        let better = |best: usize, i: usize| {
            let score = |i: usize| found[i].as_ref().map_or(0.0, |found| found.score);
            if score(i) > score(best) { i } else { best }
        };
        let best = (0..found.len()).fold(0, better);
        let Some(Some(seen)) = found.get(best) else { return Ok(None) };
        let set = scene.bin_set(&states[best]);
        self.finish(&scene, seen.candidate, &states[best], &set, &seen.mask, self.samples.clone()).map(Some)
    }

    /// Stores the reference for the next image.
    fn finish(
        &self,
        scene: &Scene<'_>,
        candidate: Candidate,
        state: &ColorDistributionState,
        set: &ColorBinSet,
        mask: &PixelMask,
        samples: Samples,
    ) -> Result<Found, TrackingError> {
        let larger = candidate.regrown(scene, mask)?;
        let (candidate, regrown) = (larger.unwrap_or(candidate), larger.is_some());
        let mut quality = scene.confidence(&candidate, mask)?;
        if self.status == TrackStatus::Lost {
            // Out of the place that spoke for it, the segmentation alone proves little.
            quality *= scene.color_similarity(state, &candidate, mask)?;
        }
        let candidate = candidate.refined(scene, mask);
        let cloud = if self.params.adapts_colors { scene.colors_of(&candidate, set, mask)? } else { None };
        let blob_outline = || Outline::of_mask(mask, scene.region.rect.corner());
        let outline = if self.params.cues == TrackingCues::Color { blob_outline() } else { None };
        Ok(Found { candidate, quality, regrown, outline, cloud, samples })
    }

    fn hypotheses<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<ColorDistributionState>, TrackingError> {
        if self.params.adapts_colors {
            return self.samples.predicted(&self.dynamics, &self.params, rng);
        }
        Ok(vec![ColorDistributionState::at_rest(&self.reference.colors)])
    }
}

fn first_max(values: &[f64]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}
