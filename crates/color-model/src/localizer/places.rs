use rand::Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_integrity::{RelocalizationCandidate, RelocalizationTest};

use super::{
    ColorLocalizer, OdometryModel, StartPosePrior,
    buffer::{FrameBuffer, view_change},
    color_localizer::TRACKING_PROBABILITY,
    estimate::is_same_place,
    filter::ColorFilter,
    frame::PreparedFrame,
    search::{Found, Search},
};
use crate::{ColorModelError, LightingTracker, LikelihoodModel, lighting::SunAndShade};

type Test<T> = RelocalizationTest<ColorFilter<SunAndShade<T>>>;

/// Whether a search found the present place again as the best one, and all other places together are improbable. Each has these log-odds before the search.
fn is_present_certain<F>(found: &[Found<F>], log_prior_odds: f64) -> bool {
    let Some(best) = found.first() else { return false };
    let is_best = |place: &Pose2<f64>| is_same_place(place, &best.place);
    let others = found.iter().filter(|one| !is_best(&one.place));
    let odds: f64 = others.map(|one| (log_prior_odds + one.evidence.log_odds(&best.evidence)).exp()).sum();
    let is_present_best = found.iter().any(|one| one.is_present && is_best(&one.place));
    is_present_best && 1.0 / (1.0 + odds) > TRACKING_PROBABILITY
}

/// The test between the present place and others.
impl<T, M, L> ColorLocalizer<T, M, L>
where
    T: LightingTracker + Clone + Send + Sync,
    M: OdometryModel,
    L: LikelihoodModel,
{
    /// Compares the alternatives with the present place by a frame, of whose evidence this share is independent of the frame before.
    pub(super) fn test_alternatives<R: Rng + ?Sized>(
        &self,
        test: &mut Test<T>,
        frame: &PreparedFrame<'_, L>,
        (share, log_evidence_here): (f64, f64),
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        Ok(test.observe(share * log_evidence_here, |alternative| {
            let is_new_camera = !alternative.knows_camera(frame.camera());
            match self.step(alternative, frame, rng) {
                // The present place has learned the light of this camera, and a new one has not.
                Ok(()) if is_new_camera => share * log_evidence_here,
                Ok(()) => share * alternative.weighing.log_evidence,
                Err(_) => f64::NEG_INFINITY,
            }
        })?)
    }

    /// Searches if it is time to: at the start where the start allows, later anywhere. Returns whether the present place is certain then.
    pub(super) fn search_places<R: Rng + ?Sized>(
        &self,
        buffer: &FrameBuffer,
        present: &mut ColorFilter<SunAndShade<T>>,
        test: &mut Test<T>,
        rng: &mut R,
    ) -> Result<Option<bool>, ColorModelError> {
        let params = &self.params.search;
        let n_frames = self.n_updates + 1;
        let is_start = n_frames <= params.n_buffered_frames;
        let is_late = self.since_search + self.cameras[0].delta.seconds >= params.search_interval;
        let is_due = if is_start { params.is_start_search(n_frames) } else { is_late };
        let is_on = !self.params.relocalization.is_off();
        if params.samples_per_place == 0.0 || !is_due || !(is_start || is_on) {
            return Ok(None);
        }
        let alternatives = test.alternatives().iter().map(|one| one.hypothesis.location());
        let known = std::iter::once(present.location()).chain(alternatives).skip(usize::from(n_frames == 1));
        let known = known.collect::<Result<Vec<_>, _>>()?;
        let found = self.search(buffer, is_start)?.run(&known, rng)?;
        let is_certain = is_present_certain(&found, self.log_prior_odds(is_start));
        if is_start {
            self.choose_start(found, present, test)?;
        } else {
            self.propose(found, test)?;
        }
        Ok(Some(is_certain))
    }

    /// Log-odds of another place before a search. A robot with a known start is elsewhere only after a kidnapping. A search counts as a metre of driving.
    fn log_prior_odds(&self, is_start: bool) -> f64 {
        match self.start {
            StartPosePrior::Near(_) if !is_start => {
                (self.params.relocalization.prior() / self.area.n_places() as f64).ln()
            }
            _ => 0.0,
        }
    }

    fn search<'a>(
        &'a self,
        buffer: &FrameBuffer,
        is_start: bool,
    ) -> Result<Search<'a, SunAndShade<T>>, ColorModelError> {
        let start = if is_start { &self.start } else { &StartPosePrior::Anywhere };
        let frames = buffer.frames();
        // Once the view has turned by a tile, its tiles show something else.
        let tile = f64::from(self.params.pixels.tile_pixels) / self.cameras[0].model.fx();
        let shares = frames
            .windows(2)
            .map(|pair| (view_change(&pair[0].mount, &pair[1].odometry, &pair[1].mount) / tile).min(1.0));
        let shares = std::iter::once(1.0).chain(shares).collect();
        let lights = [&self.prior, self.lights.front().unwrap_or(&self.prior)];
        Search::new(self.scene(0, &()), (&self.area, start), &self.params, lights, (frames, shares))
    }

    /// The best place by all frames becomes the present one, and the others its alternatives.
    fn choose_start(
        &self,
        mut found: Vec<Found<SunAndShade<T>>>,
        present: &mut ColorFilter<SunAndShade<T>>,
        test: &mut Test<T>,
    ) -> Result<(), ColorModelError> {
        let best = found.remove(0);
        found.retain(|one| !is_same_place(&one.place, &best.place));
        let odds: Vec<f64> = found.iter().map(|one| one.evidence.log - best.evidence.log).collect();
        // The particles of the present place have seen every frame: they know more than the search.
        if !best.is_present {
            *present = best.filter;
        }
        present.set_max_particles(self.params.max_particles);
        let even = found.into_iter().map(|one| one.filter).zip(odds);
        Ok(test.start(even.filter(|(_, odds)| odds.is_finite()))?)
    }

    /// Places that are better than the present one and not tracked yet become its alternatives.
    fn propose(
        &self,
        mut found: Vec<Found<SunAndShade<T>>>,
        test: &mut Test<T>,
    ) -> Result<(), ColorModelError> {
        let Some(at) = found.iter().position(|one| one.is_present) else { return Ok(()) };
        let present = found.remove(at);
        let tracked = test.alternatives().iter().filter_map(|one| one.hypothesis.estimate().ok());
        let mut tracked: Vec<Pose2<f64>> = tracked.map(|estimate| *estimate.pose.mean()).collect();
        tracked.push(present.place);
        let is_new = |one: &Found<_>| !tracked.iter().any(|place| is_same_place(place, &one.place));
        found.retain(|one| is_new(one) && one.evidence.log > present.evidence.log);
        let prior = 1.0 / self.area.n_places() as f64;
        test.propose(found.into_iter().map(|one| RelocalizationCandidate {
            prior,
            log_likelihood_ratio: one.evidence.log - present.evidence.log,
            hypothesis: one.filter,
        }))?;
        Ok(())
    }
}
