use std::sync::Arc;

use nalgebra::Vector3;
use rand::Rng;
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_estimation_traits::Pose2;
use wayfix_particle::{NormalizedWeights, RaoBlackwellParticle};

use super::{
    AcquisitionParams, LocalizerParams, Start,
    acquisition::Effort,
    candidate::{Candidate, Known},
    estimate::dominant_cluster,
    hypothesis::Judged,
    light::Light,
    niche::Niche,
    particle::ColorParticle,
    seen::Seen,
    shots::Shot,
    sightings::Sightings,
    start::Area,
    surroundings::Surroundings,
    trajectory::Trajectory,
    views::Views,
    weighed::Weighed,
};
use crate::{BackgroundColorModel, ColorModelError, PixelSums, PrefixSumImage};

/// A place that explains the frames well, its log-evidence that of all frames.
pub(crate) struct Found {
    pub(crate) judged: Judged,
    /// Which of the known places it descends from, if any.
    pub(crate) known: Option<usize>,
}

/// What is known before the frames.
pub(crate) struct Premise<'a> {
    /// Where the robot may have been at the first of them.
    pub(crate) start: &'a Start,
    pub(crate) light: &'a Arc<Light>,
    /// Whether that light was learned here, or is only what light may be.
    pub(crate) is_light_known: bool,
}

/// Looks for the robot in several frames at once, under one light.
pub(crate) struct Search<'a> {
    pub(super) map: &'a Arc<ColorMap>,
    pub(super) camera: PinholeCamera,
    pub(super) area: &'a Area,
    pub(super) start: &'a Start,
    pub(super) params: &'a LocalizerParams,
    pub(super) light: &'a Arc<Light>,
    pub(super) shots: Vec<Shot>,
    pub(super) frames: Vec<PrefixSumImage>,
    /// Under a light that is not known, all frames are weighed at once.
    pub(super) is_light_known: bool,
    sightings: Sightings,
    /// Variance of a map colour's pixels.
    pub(super) noise: Vector3<f64>,
}

impl<'a> Search<'a> {
    pub(crate) fn new(
        map: &'a Arc<ColorMap>,
        camera: PinholeCamera,
        area: &'a Area,
        params: &'a LocalizerParams,
        Premise { start, light, is_light_known }: Premise<'a>,
        shots: Vec<Shot>,
        background: Option<&BackgroundColorModel>,
    ) -> Result<Self, ColorModelError> {
        let brightness = shots.iter().map(|shot| shot.image.brightness()).sum::<f64>() / shots.len() as f64;
        let noise = light.bank.member(0).params().pixel_color_variance + params.pixels.unevenness(brightness);
        let AcquisitionParams { shrink, .. } = params.acquisition;
        let images = shots.iter().map(|shot| shot.image.shrunk(shrink)).collect::<Result<Vec<_>, _>>()?;
        let surroundings = Surroundings::of(images.iter(), &noise, params.pixels.uniform_background_share);
        let nats = |pixel| {
            background.map_or_else(|| surroundings.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let frames = images
            .iter()
            .map(|image| PrefixSumImage::with_background(image, |pixel| Some(nats(pixel))))
            .collect::<Result<_, _>>()?;
        let camera = params.acquisition.camera(&camera)?;
        let stride = stride(shots.len(), params.acquisition.n_coarse);
        let coarse = images.iter().enumerate().rev().step_by(stride);
        let sightings = Sightings::of(coarse, &shots, &camera, map, light, nats)?;
        Ok(Self { map, camera, area, start, params, light, shots, frames, is_light_known, sightings, noise })
    }

    /// The places that explain the frames best, of those that the start allows or a sighting suggests and of those `known` at the newest frame, with
    /// the log-likelihood of all frames.
    pub(crate) fn run<R: Rng + ?Sized>(
        &self,
        known: &[Known],
        rng: &mut R,
    ) -> Result<Vec<Found>, ColorModelError> {
        let AcquisitionParams { n_niches, n_passes, n_kept, .. } = self.params.acquisition;
        let mut niches = Niche::apart(self.candidates(known, rng)?, n_niches);
        for pass in 0..n_passes {
            if *self.start == Start::Anywhere && self.params.acquisition.is_first_full(pass) {
                self.add_opposites(&mut niches);
            }
            niches = self.refined(&niches, pass, rng)?;
            let fewer = (2 * niches.len()).div_ceil(3).max(n_kept);
            let most = if pass + 1 < n_passes { fewer } else { niches.len() };
            Niche::retain_best(&mut niches, most);
        }
        let found = |niche: &Niche| {
            let seen = self.seen(&niche.0, rng)?;
            let estimate =
                dominant_cluster(&seen.weighed.poses(&seen.particles)).ok_or(ColorModelError::NoPose)?;
            let judged = Judged { seen, estimate, log_evidence: niche.best(), hidden: 0.0 };
            Ok(Found { judged, known: niche.known() })
        };
        niches.iter().map(found).collect()
    }

    /// Adds to every niche the one that is opposite: the two halves of a field are alike but for a few colours, which a light that is not known explains,
    /// so that a place that was found says where else to look.
    fn add_opposites(&self, niches: &mut Vec<Niche>) {
        for at in 0..niches.len() {
            let Some(best) = niches[at].best_candidate() else { continue };
            let mut opposite = Candidate { known: None, ..best.clone() };
            opposite.trajectory.newest = self.area.opposite(&best.trajectory.newest);
            if !niches.iter().any(|niche| niche.is_at(&opposite.trajectory.newest)) {
                niches.push(Niche(vec![opposite]));
            }
        }
    }

    /// Candidates all over the start, weighed by a few frames, and those of known places, before them.
    fn candidates<R: Rng + ?Sized>(
        &self,
        known: &[Known],
        rng: &mut R,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let AcquisitionParams { n_drawn, .. } = self.params.acquisition;
        let mut candidates: Vec<Candidate> = known.iter().map(|known| self.known_candidate(*known)).collect();
        let drawn = (0..n_drawn).map(|n| self.drawn(n, rng)).collect();
        candidates.extend(
            self.each(drawn, rng, |scratch, candidate, _| self.weigh(scratch, candidate, Effort::Coarse))?,
        );
        Ok(candidates)
    }

    /// Every niche with a new generation of candidates, each moved to where it explains the frames better.
    fn refined<R: Rng + ?Sized>(
        &self,
        niches: &[Niche],
        pass: u32,
        rng: &mut R,
    ) -> Result<Vec<Niche>, ColorModelError> {
        let AcquisitionParams { n_particles, least_effective, .. } = self.params.acquisition;
        let n_each = (n_particles / niches.len().max(1)).max(1);
        let mut candidates: Vec<Candidate> = Vec::new();
        for niche in niches {
            candidates.extend(niche.resampled(n_each, least_effective, rng)?);
        }
        let refined = self.each(candidates, rng, |scratch, candidate, rng| {
            self.refine(scratch, candidate, pass, rng);
        })?;
        Ok(refined.chunks(n_each).map(|candidates| Niche(candidates.to_vec())).collect())
    }

    /// A niche's candidates as particles at the newest frame.
    fn seen<R: Rng + ?Sized>(&self, candidates: &[Candidate], rng: &mut R) -> Result<Seen, ColorModelError> {
        let mut views = Views::new(candidates.len(), &self.light.bank);
        for (view, candidate) in views.chunks_mut(1).flatten().zip(candidates) {
            candidate.total(&candidate.is_hidden, view.sums);
            view.log_likelihoods.copy_from_slice(&candidate.log_likelihoods);
        }
        let banks = candidates.iter().map(|_| &self.light.bank);
        let equal = NormalizedWeights::from_linear(vec![1.0; candidates.len()])?;
        let weighed = Weighed::new(banks, &equal, &views, 0.0, self.params.acquisition.least_effective, rng)?;
        let particle = |candidate: &Candidate| -> Option<ColorParticle> {
            let newest = candidate.trajectory.locations(&self.shots, &self.params.camera).pop()?;
            Some(RaoBlackwellParticle::from_shared(newest, Arc::clone(self.light)))
        };
        let particles = candidates.iter().filter_map(particle).collect();
        let fit =
            weighed.mean_log_likelihood / (self.params.pixels.independent_pixels * self.shots.len() as f64);
        Ok(Seen { particles, views, weighed, fit })
    }

    /// A candidate that the start allows; if that is anywhere, every other one shows a landmark where a frame does.
    fn drawn<R: Rng + ?Sized>(&self, n: usize, rng: &mut R) -> Candidate {
        let sighted = match self.start {
            Start::Anywhere if n.is_multiple_of(2) => self.sightings.draw(self.area, rng),
            _ => None,
        };
        let (at, pose) = sighted.unwrap_or_else(|| (0, self.start.draw(self.area, rng)));
        self.candidate(&pose, at)
    }

    fn known_candidate(&self, known: Known) -> Candidate {
        let mut candidate = Candidate {
            known: Some(known),
            score: f64::MAX,
            ..self.candidate(&known.place, self.shots.len())
        };
        candidate.trajectory.newest = known.place;
        candidate
    }

    pub(super) fn candidate(&self, pose: &Pose2<f64>, at: usize) -> Candidate {
        let mut trajectory = Trajectory::through(pose, at, &self.shots);
        self.area.clamp(&mut trajectory.newest);
        Candidate {
            trajectory,
            sums: vec![PixelSums::default(); self.shots.len() * self.map.colors().len()],
            by_frame: vec![0.0; self.shots.len() * self.light.bank.n_members()],
            is_hidden: vec![false; self.shots.len()],
            log_likelihoods: vec![0.0; self.light.bank.n_members()],
            log_prior: 0.0,
            score: f64::NEG_INFINITY,
            step: 1.0,
            known: None,
        }
    }
}

/// Steps between frames of `len` that leave at most `most`.
pub(super) fn stride(len: usize, most: usize) -> usize {
    len.div_ceil(most.max(1)).max(1)
}
