use std::sync::Arc;

use rand::Rng;
use wayfix_color_map::ColorId;
use wayfix_estimation_traits::{Pose2, Pose3};

use super::{
    ColorLocalizer, Start,
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
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<Vec<Judged>, ColorModelError> {
        let seconds = self.walked.seconds;
        let mut hypotheses = self.hypotheses.clone();
        for hypothesis in &mut hypotheses {
            predict_light(&mut hypothesis.particles, seconds, &self.params.pixels)?;
        }
        let pixels = &self.params.pixels;
        let noise = self.prior.bank.member(0).params().pixel_noise + pixels.unevenness(image.brightness());
        let surroundings = Surroundings::of(std::iter::once(image), &noise, pixels.uniform_share);
        let nats = |pixel| {
            let background = self.background.as_ref();
            background.map_or_else(|| surroundings.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let frames = &Palette::of(&hypotheses)?.look(image, nats, -pixels.floor)?;
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
    pub(super) fn search<R: Rng + ?Sized>(
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
        let known: Vec<Pose2<f64>> = if self.n_updates == 0 {
            Vec::new()
        } else {
            self.hypotheses.iter().filter_map(|hypothesis| hypothesis.place()).collect()
        };
        search.run(&known, rng)
    }

    /// The places that are believed in, and those that explain the last frames better.
    pub(super) fn reconsider<R: Rng + ?Sized>(
        &self,
        believed: Vec<Judged>,
        shots: &Shots,
        rng: &mut R,
    ) -> Result<Vec<Judged>, ColorModelError> {
        // The light stays as it was when somebody lifts the robot; but it may have been wrong as well.
        let is_light_doubted = self.n_in_vain % 2 == 1;
        let light = if is_light_doubted { &self.prior } else { &self.trusted };
        let found = self.search(shots, &Start::Anywhere, light, rng)?;
        let best = |scores: &mut dyn Iterator<Item = f64>| scores.fold(f64::NEG_INFINITY, f64::max);
        let of_found = |one: &Found| one.judged.log_evidence;
        let as_known = best(&mut found.iter().filter(|one| one.is_known).map(of_found));
        let best_found = best(&mut found.iter().map(of_found));
        let odds = self.params.acquisition.elsewhere * if is_light_doubted { 3.0 } else { 1.0 };
        let start = best(&mut believed.iter().map(|one| one.log_evidence)) - odds;
        // The frames that a place was chosen by among thousands flatter it: only those to come count for it. Meanwhile their order decides.
        let newcomer = |Found { judged, .. }: Found| {
            let order = judged.log_evidence - best_found;
            Judged { log_evidence: start + order, ..judged }
        };
        let better = found
            .into_iter()
            .filter(|one| {
                !one.is_known && of_found(one) > (as_known - self.params.acquisition.margin).max(0.0)
            })
            .map(newcomer);
        Ok(believed.into_iter().chain(better).collect())
    }
}
