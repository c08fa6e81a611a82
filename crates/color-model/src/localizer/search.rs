use std::sync::Arc;

use nalgebra::Vector3;
use rand::Rng;
use wayfix_color_map::{Camera, ColorMap};
use wayfix_estimation_traits::Pose2;
use wayfix_particle::{RaoBlackwell, Weights};

use super::{
    AcquisitionParams, LocalizerParams, candidate::Candidate, estimate::dominant_cluster, hypothesis::Judged,
    light::Light, niche::Niche, particle::ColorParticle, seen::Seen, shots::Shot, start::Area,
    surroundings::Surroundings, trajectory::Trajectory, views::Views, weighed::Weighed,
};
use crate::{Background, ColorModelError, Frame, PixelSums};

/// A place that explains the frames well, its log-evidence that of all frames.
pub(crate) struct Found {
    pub(crate) judged: Judged,
    /// Whether it descends from a known one.
    pub(crate) is_known: bool,
}

/// Looks for the robot in several frames at once, under one light.
pub(crate) struct Search<'a> {
    pub(super) map: &'a Arc<ColorMap>,
    pub(super) camera: Camera,
    pub(super) area: &'a Area,
    pub(super) params: &'a LocalizerParams,
    pub(super) light: &'a Arc<Light>,
    pub(super) shots: Vec<Shot>,
    pub(super) frames: Vec<Frame>,
    /// Variance of a map colour's pixels.
    pub(super) noise: Vector3<f64>,
}

impl<'a> Search<'a> {
    pub(crate) fn new(
        map: &'a Arc<ColorMap>,
        camera: Camera,
        area: &'a Area,
        params: &'a LocalizerParams,
        light: &'a Arc<Light>,
        shots: Vec<Shot>,
        background: Option<&Background>,
    ) -> Result<Self, ColorModelError> {
        let brightness = shots.iter().map(|shot| shot.image.brightness()).sum::<f64>() / shots.len() as f64;
        let noise = light.bank.member(0).params().pixel_noise + params.pixels.unevenness(brightness);
        let AcquisitionParams { shrink, .. } = params.acquisition;
        let images = shots.iter().map(|shot| shot.image.shrunk(shrink)).collect::<Result<Vec<_>, _>>()?;
        let surroundings = Surroundings::of(images.iter(), &noise, params.pixels.uniform_share);
        let nats = |pixel| {
            background.map_or_else(|| surroundings.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let frames = images
            .iter()
            .map(|image| Frame::with_background(image, |pixel| Some(nats(pixel))))
            .collect::<Result<_, _>>()?;
        let camera = params.acquisition.camera(&camera)?;
        Ok(Self { map, camera, area, params, light, shots, frames, noise })
    }

    /// The places that explain the frames best, of those whose first poses are drawn from `first` and of those `known` at the newest frame, with
    /// the log-likelihood of all frames.
    pub(crate) fn run<R: Rng + ?Sized>(
        &self,
        first: impl FnMut(&mut R) -> Pose2<f64>,
        known: &[Pose2<f64>],
        rng: &mut R,
    ) -> Result<Vec<Found>, ColorModelError> {
        let AcquisitionParams { n_niches, n_passes, n_kept, .. } = self.params.acquisition;
        let mut niches = Niche::apart(self.candidates(first, known, rng)?, n_niches);
        for pass in 0..n_passes {
            niches = self.refined(&niches, pass, rng)?;
            let fewer = (2 * niches.len()).div_ceil(3).max(n_kept);
            let most = if pass + 1 < n_passes { fewer } else { niches.len() };
            Niche::retain_best(&mut niches, most);
        }
        let found = |niche: &Niche| {
            let is_known = niche.0.iter().any(|candidate| candidate.is_known);
            let seen = self.seen(&niche.0, rng)?;
            let estimate =
                dominant_cluster(&seen.weighed.poses(&seen.particles)).ok_or(ColorModelError::NoPose)?;
            Ok(Found { judged: Judged { seen, estimate, log_evidence: niche.best() }, is_known })
        };
        niches.iter().map(found).collect()
    }

    /// Candidates all over the start, weighed by a few frames, and those of known places, before them.
    fn candidates<R: Rng + ?Sized>(
        &self,
        mut first: impl FnMut(&mut R) -> Pose2<f64>,
        known: &[Pose2<f64>],
        rng: &mut R,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let AcquisitionParams { n_drawn, n_coarse, .. } = self.params.acquisition;
        let mut candidates: Vec<Candidate> = known.iter().map(|place| self.known_candidate(place)).collect();
        let drawn = (0..n_drawn).map(|_| self.candidate(&first(rng))).collect();
        candidates
            .extend(self.each(drawn, rng, |scratch, candidate, _| self.weigh(scratch, candidate, n_coarse))?);
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
        let scale = self.params.acquisition.scale(pass);
        let refined = self.each(candidates, rng, |scratch, candidate, rng| {
            if pass == 0 {
                self.weigh(scratch, candidate, self.shots.len());
            }
            self.refine(scratch, candidate, scale, rng);
        })?;
        Ok(refined.chunks(n_each).map(|candidates| Niche(candidates.to_vec())).collect())
    }

    /// A niche's candidates as particles at the newest frame.
    fn seen<R: Rng + ?Sized>(&self, candidates: &[Candidate], rng: &mut R) -> Result<Seen, ColorModelError> {
        let n_colors = self.map.colors().len();
        let mut views = Views::new(candidates.len(), &self.light.bank);
        for (view, candidate) in views.chunks_mut(1).flatten().zip(candidates) {
            candidate.total(n_colors, view.sums);
            view.log_likelihoods.copy_from_slice(&candidate.log_likelihoods);
        }
        let banks = candidates.iter().map(|_| &self.light.bank);
        let equal = Weights::from_linear(vec![1.0; candidates.len()])?;
        let weighed = Weighed::new(banks, &equal, &views, self.params.acquisition.least_effective, rng)?;
        let particle = |candidate: &Candidate| -> Option<ColorParticle> {
            let newest = candidate.trajectory.locations(&self.shots, &self.params.camera).pop()?;
            Some(RaoBlackwell::from_shared(newest, Arc::clone(self.light)))
        };
        let particles = candidates.iter().filter_map(particle).collect();
        let fit =
            weighed.mean_log_likelihood / (self.params.pixels.independent_pixels * self.shots.len() as f64);
        Ok(Seen { particles, views, weighed, fit })
    }

    fn known_candidate(&self, place: &Pose2<f64>) -> Candidate {
        let mut candidate = Candidate { is_known: true, score: f64::MAX, ..self.candidate(place) };
        candidate.trajectory.newest = *place;
        candidate
    }

    fn candidate(&self, first: &Pose2<f64>) -> Candidate {
        let mut trajectory = Trajectory::from(first, &self.shots);
        self.area.clamp(&mut trajectory.newest);
        Candidate {
            trajectory,
            sums: vec![PixelSums::default(); self.shots.len() * self.map.colors().len()],
            log_likelihoods: vec![0.0; self.light.bank.n_members()],
            score: f64::NEG_INFINITY,
            is_known: false,
        }
    }
}
