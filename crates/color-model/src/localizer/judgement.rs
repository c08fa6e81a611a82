use std::sync::Arc;

use rand::Rng;
use wayfix_color_map::ColorId;
use wayfix_estimation_traits::Pose3;

use super::{
    ColorLocalizer, Start,
    candidate::Known,
    estimate::dominant_cluster,
    hypothesis::{Hypothesis, Judged},
    light::Light,
    palette::Palette,
    relight::{Relight, predict_light},
    renewal::renew,
    search::{Found, Premise, Search},
    seen::Seen,
    shots::Shots,
    surroundings::Surroundings,
    weigh::Weighing,
    weighed::Weighed,
};
use crate::{ColorModelError, YuvImage};

/// Searches in vain, one after the other, with which the light is doubted as well.
const SEARCHES_TO_DOUBT_LIGHT: usize = 4;
/// How many times the lead a place needs that is found under another light than the one that was learned.
const OTHER_LIGHT: f64 = 3.0;

/// What frames say of where the robot may be.
impl ColorLocalizer {
    /// The particles of one of `n` hypotheses after the frame.
    pub(super) fn renewed<R: Rng + ?Sized>(
        &self,
        judged: &Judged,
        n: usize,
        rng: &mut R,
    ) -> Result<Hypothesis, ColorModelError> {
        let Seen { particles, views, weighed, .. } = &judged.seen;
        let params = &self.params;
        let relight = Relight {
            views,
            members: &weighed.members,
            min_pixels: params.min_pixels,
            withheld: params.withheld.map(|color| ColorId(color as u8)),
            pixels: &params.pixels,
        };
        let most = (params.max_particles_lost / n.max(1)).clamp(1, params.max_particles);
        let (particles, weights) = renew(particles, &weighed.weights, &relight, params, most, rng)?;
        Ok(Hypothesis { particles, weights, log_evidence: judged.log_evidence, hidden: judged.hidden })
    }

    /// What a frame says of the hypotheses.
    pub(super) fn look<R: Rng + ?Sized>(
        &self,
        mut hypotheses: Vec<Hypothesis>,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<Vec<Judged>, ColorModelError> {
        let seconds = self.walked.seconds;
        for hypothesis in &mut hypotheses {
            predict_light(&mut hypothesis.particles, seconds, &self.params.pixels)?;
        }
        let pixels = &self.params.pixels;
        let noise =
            self.prior.bank.member(0).params().pixel_color_variance + pixels.unevenness(image.brightness());
        let surroundings = Surroundings::of(std::iter::once(image), &noise, pixels.uniform_background_share);
        let nats = |pixel| {
            let background = self.background.as_ref();
            background.map_or_else(|| surroundings.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let frames = &Palette::of(&hypotheses)?.look(image, nats, -pixels.log_likelihood_floor)?;
        let weighing = Weighing { map: &self.map, camera: self.camera, frames, mount, pixels, noise };
        let mut judged = Vec::new();
        for Hypothesis { mut particles, weights, log_evidence, hidden } in hypotheses {
            for particle in &mut particles {
                particle.sampled.error = self.params.camera.after(&particle.sampled.error, seconds, rng);
            }
            let hidden = self.params.hidden_views.predict(hidden, seconds);
            let views = weighing.views(&particles).ok_or(ColorModelError::NoPose)?;
            let banks = particles.iter().map(|particle| &particle.conditional().bank);
            let weighed = Weighed::new(banks, &weights, &views, hidden, self.params.least_effective, rng)?;
            let estimate = dominant_cluster(&weighed.poses(&particles)).ok_or(ColorModelError::NoPose)?;
            let fit = weighed.mean_log_likelihood / pixels.independent_pixels;
            let log_evidence = log_evidence + weighed.mean_log_evidence;
            let hidden = weighed.hidden;
            judged.push(Judged {
                seen: Seen { particles, views, weighed, fit },
                estimate,
                log_evidence,
                hidden,
            });
        }
        Ok(judged)
    }

    /// Where the robot may be, by the last frames, if it was where `start` says when the first of them was taken.
    fn search<R: Rng + ?Sized>(
        &self,
        shots: &Shots,
        start: &Start,
        light: &Arc<Light>,
        rng: &mut R,
    ) -> Result<Vec<Found>, ColorModelError> {
        let shots = shots.spread(self.params.acquisition.n_weighed);
        let background = self.background.as_ref();
        let premise = Premise { start, light, is_light_known: !Arc::ptr_eq(light, &self.prior) };
        let search =
            Search::new(&self.map, self.camera, &self.area, &self.params, premise, shots, background)?;
        let places = self.hypotheses.iter().enumerate();
        let known: Vec<Known> = if self.n_updates == 0 {
            Vec::new()
        } else {
            places.filter_map(|(index, one)| Some(Known { index, place: one.place()? })).collect()
        };
        search.run(&known, rng)
    }

    /// The places that explain the first frames. Of those that are pursued there are two opinions: that of their particles, which may be off the peak, and
    /// that of the search, which looks at some of the frames; their mean counts. Nothing is believed yet: a place that is new begins level with the best.
    pub(super) fn acquire<R: Rng + ?Sized>(
        &self,
        image: &YuvImage,
        mount: &Pose3<f64>,
        shots: &Shots,
        rng: &mut R,
    ) -> Result<Vec<Judged>, ColorModelError> {
        let found = self.search(shots, &self.start, &self.prior, rng)?;
        if self.n_updates == 0 {
            return Ok(found.into_iter().map(|one| one.judged).collect());
        }
        let mut judged = self.look(self.joined(&found, rng)?, image, mount, rng)?;
        let by_particles = best(judged.iter());
        let by_search = best(found.iter().filter(|one| one.known.is_some()).map(|one| &one.judged));
        for Found { judged: refined, known } in &found {
            if let Some(one) = known.and_then(|known| judged.get_mut(known))
                && refined.log_evidence.is_finite()
            {
                let behind = (one.log_evidence - by_particles) + (refined.log_evidence - by_search);
                one.log_evidence = by_particles + 0.5 * behind;
            }
        }
        let lead = best(judged.iter());
        judged.extend(self.newcomers(found, lead, 0.0));
        Ok(judged)
    }

    /// The places that are believed in, and those that explain the last frames better.
    pub(super) fn reconsider<R: Rng + ?Sized>(
        &self,
        image: &YuvImage,
        mount: &Pose3<f64>,
        shots: &Shots,
        rng: &mut R,
    ) -> Result<Vec<Judged>, ColorModelError> {
        let shots = shots.last(self.vigilance.n_telling());
        let found = self.search(&shots, &Start::Anywhere, &self.trusted, rng)?;
        let mut judged = self.look(self.joined(&found, rng)?, image, mount, rng)?;
        let lead = best(judged.iter());
        let elsewhere = self.params.acquisition.elsewhere;
        judged.extend(self.newcomers(found, lead, elsewhere));
        // The light stays as it was when somebody lifts the robot; but it may have been wrong as well.
        let is_light_doubted =
            self.routine.n_in_vain() % SEARCHES_TO_DOUBT_LIGHT == SEARCHES_TO_DOUBT_LIGHT - 1;
        if is_light_doubted && !Arc::ptr_eq(&self.trusted, &self.prior) {
            let found = self.search(&shots, &Start::Anywhere, &self.prior, rng)?;
            judged.extend(self.newcomers(found, lead, OTHER_LIGHT * elsewhere));
        }
        Ok(judged)
    }

    /// The places that are believed in, each with what a search refined it to.
    fn joined<R: Rng + ?Sized>(
        &self,
        found: &[Found],
        rng: &mut R,
    ) -> Result<Vec<Hypothesis>, ColorModelError> {
        let mut hypotheses = self.hypotheses.clone();
        for Found { judged, known } in found {
            if let Some(hypothesis) = known.and_then(|known| hypotheses.get_mut(known)) {
                hypothesis.join(&judged.seen, rng)?;
            }
        }
        Ok(hypotheses)
    }

    /// The places found that are worth to be pursued beside those that are believed in, of which the best has the log-evidence `lead`.
    ///
    /// A robot that is elsewhere is so with odds of $`e^{-o}`$ only, and the frames that a place was chosen by among thousands flatter it, by as much
    /// again at most: what they say for it beyond that counts, up to a draw. The frames to come decide.
    fn newcomers(&self, found: Vec<Found>, lead: f64, odds: f64) -> impl Iterator<Item = Judged> {
        let best_found = best(found.iter().map(|one| &one.judged));
        let as_known = best(found.iter().filter(|one| one.known.is_some()).map(|one| &one.judged));
        let shown = best_found - as_known - odds;
        let start = lead - odds + if shown.is_finite() { shown.clamp(0.0, odds) } else { 0.0 };
        let least = (as_known - self.params.acquisition.margin).max(0.0);
        found.into_iter().filter(move |one| one.known.is_none() && one.judged.log_evidence > least).map(
            move |Found { judged, .. }| {
                let order = judged.log_evidence - best_found;
                Judged { log_evidence: start + order, ..judged }
            },
        )
    }
}

/// The log-evidence of the best.
fn best<'a>(judged: impl Iterator<Item = &'a Judged>) -> f64 {
    judged.map(|one| one.log_evidence).fold(f64::NEG_INFINITY, f64::max)
}
