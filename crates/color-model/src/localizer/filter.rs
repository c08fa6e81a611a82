use std::sync::Arc;

use rand::Rng;
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_estimation_traits::{Pose2, Pose3, SampleMotion};
use wayfix_particle::{NormalizedWeights, RaoBlackwellParticle};

use super::{
    Fix, FrameOutcome, LocalizerParams, OdometryStep, PoseEstimate, Start,
    hypothesis::{Hypothesis, Judged, lead, share_of_first, shortlist},
    light::Light,
    particle::CameraLocation,
    routine::Routine,
    shots::{Shot, Shots, Walked},
    start::Area,
    vigilance::Vigilance,
};
use crate::{AcquisitionParams, BackgroundColorModel, ColorModelError, LightingBank, YuvImage};

/// Probability of the best place from which on it is called tracked.
const SURE: f64 = 0.95;

/// Finds out where a robot stands on a colour-coded field and what the colours look like in today's light, at once.
///
/// The Rao-Blackwellised particle filter of [Schulz & Fox 2004, IV]: a particle is a camera location and, conditioned on it, a switching
/// Kalman filter of the light.
pub struct ColorLocalizer {
    pub(super) map: Arc<ColorMap>,
    pub(super) camera: PinholeCamera,
    pub(super) area: Area,
    pub(super) background: Option<BackgroundColorModel>,
    pub(super) params: LocalizerParams,
    /// Where the robot may be, the most probable first; never empty.
    pub(super) hypotheses: Vec<Hypothesis>,
    /// The light as it is known beforehand.
    pub(super) prior: Arc<Light>,
    /// The light as it was known before there was doubt about the place.
    pub(super) trusted: Arc<Light>,
    pub(super) start: Start,
    /// Odometry since the last frame.
    pub(super) walked: Walked,
    pub(super) shots: Shots,
    pub(super) vigilance: Vigilance,
    pub(super) n_updates: usize,
    pub(super) routine: Routine,
}

impl ColorLocalizer {
    /// A localizer that starts where `start` says, in light of which `light` says what is known.
    ///
    /// # Errors
    /// When a parameter is out of range or too large for the camera's images, the map is empty, or its colours and the light's differ in number.
    pub fn new<R: Rng + ?Sized>(
        map: Arc<ColorMap>,
        camera: PinholeCamera,
        light: LightingBank,
        start: &Start,
        params: LocalizerParams,
        rng: &mut R,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        params.acquisition.camera(&camera)?;
        let (expected, got) = (map.colors().len(), light.n_colors());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "colours of the lighting bank", expected, got });
        }
        let area = Area::of(&map)?;
        let prior = Arc::new(Light::new(light, &params.pixels)?);
        let particles = (0..params.max_particles)
            .map(|_| {
                let location =
                    CameraLocation { body: start.draw(&area, rng), error: params.camera.sample(rng) };
                RaoBlackwellParticle::from_shared(location, Arc::clone(&prior))
            })
            .collect();
        Ok(Self {
            map,
            camera,
            area,
            background: None,
            params,
            hypotheses: vec![Hypothesis {
                particles,
                weights: NormalizedWeights::from_linear(vec![1.0; params.max_particles])?,
                log_evidence: 0.0,
                hidden: 0.0,
            }],
            trusted: Arc::clone(&prior),
            prior,
            start: start.clone(),
            walked: Walked::default(),
            shots: Shots::default(),
            vigilance: Vigilance::default(),
            n_updates: 0,
            routine: Routine::default(),
        })
    }

    /// The same with a background learned from images; without, it is made of a uniform one and of the colours of each frame.
    pub fn with_background(self, background: BackgroundColorModel) -> Self {
        Self { background: Some(background), ..self }
    }

    /// The weighted body poses of the particles about the most probable place.
    pub fn poses(&self) -> impl Iterator<Item = (Pose2<f64>, f64)> {
        self.hypotheses.iter().take(1).flat_map(|hypothesis| {
            let bodies = hypothesis.particles.iter().map(|particle| particle.sampled.body);
            bodies.zip(hypothesis.weights.as_slice().iter().copied())
        })
    }

    /// What the colours look like to the heaviest particle.
    pub fn light(&self) -> &LightingBank {
        self.hypotheses.first().and_then(Hypothesis::light).map_or(&self.prior.bank, |light| &light.bank)
    }

    /// Moves every particle by the odometry and by noise of its own. Call as often as there is odometry; the time adds up to the next frame.
    ///
    /// # Errors
    /// When the increment is not finite, or the time negative or not finite. Nothing has changed then.
    pub fn predict<R: Rng + ?Sized>(
        &mut self,
        step: &OdometryStep,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        if !step.increment.is_none_or(|increment| increment.is_finite()) {
            return Err(ColorModelError::NotFinite { what: "odometry increment" });
        }
        if !(step.seconds >= 0.0 && step.seconds.is_finite()) {
            return Err(ColorModelError::OutOfRange { what: "seconds of a step", value: step.seconds });
        }
        let moved = self.params.odometry.sampler(step);
        for particle in self.hypotheses.iter_mut().flat_map(|hypothesis| &mut hypothesis.particles) {
            particle.sampled.body = moved(&particle.sampled.body, rng);
            self.area.clamp(&mut particle.sampled.body);
        }
        self.walked.add(step, &self.params.odometry);
        Ok(())
    }

    /// Learns from a frame taken while the joints reported the camera at `mount` in the robot's frame.
    ///
    /// # Errors
    /// When the image is not of the camera's size or the mount is not finite. Nothing has changed then.
    pub fn update<R: Rng + ?Sized>(
        &mut self,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<FrameOutcome, ColorModelError> {
        self.check(image, mount)?;
        let mut shots = self.shots.clone();
        let shot = Shot { image: image.clone(), mount: *mount, walked: self.walked };
        shots.push(shot, self.params.acquisition.n_frames);
        let n_frames = self.params.acquisition.n_frames;
        let is_start = self.n_updates < n_frames && (self.n_updates + 1).is_power_of_two();
        let is_search = self.vigilance.is_search_due(&self.params) || self.is_routine();
        let judged = if is_start {
            self.acquire(image, mount, &shots, rng)?
        } else if is_search {
            self.reconsider(image, mount, &shots, rng)?
        } else {
            self.look(self.hypotheses.clone(), image, mount, rng)?
        };
        let routine = self.routine.next(is_start || is_search);
        let acquisition = &self.params.acquisition;
        let most = acquisition.n_kept.saturating_sub(routine.n_since()).max(acquisition.n_undecided);
        let judged = shortlist(judged, most, acquisition.hopeless);
        let best = judged.first().ok_or(ColorModelError::NoPose)?;
        let mut vigilance = self.vigilance;
        if !is_start {
            vigilance.observe(best.seen.fit, &self.params);
        }

        let share = share_of_first(&judged) * best.estimate.share;
        let mut outcome = FrameOutcome {
            fix: self.fix(&best.estimate, share, &vigilance),
            estimate: PoseEstimate { share, ..best.estimate.clone() },
            tempering: best.seen.weighed.tempering,
            effective_particles: best.seen.weighed.weights.effective_sample_size(),
            n_particles: 0,
            n_hypotheses: judged.len(),
            log_evidence_per_pixel: best.seen.weighed.log_evidence / self.params.pixels.independent_pixels,
            fit: best.seen.fit,
            kidnap_suspicion: vigilance.suspicion(&self.params),
            light_probabilities: best.seen.weighed.light_probabilities(),
        };
        let hypotheses =
            judged.iter().map(|one| self.renewed(one, judged.len(), rng)).collect::<Result<Vec<_>, _>>()?;
        outcome.n_particles = hypotheses.iter().map(|hypothesis| hypothesis.particles.len()).sum();
        let is_sure = vigilance.is_sound(&self.params) && self.is_decided(&judged);
        if let Some(light) = hypotheses.first().and_then(Hypothesis::light)
            && is_sure
            && (is_search || routine.n_in_vain() > 0)
        {
            self.trusted = Arc::clone(light);
        }
        self.routine = routine.after(is_search, is_sure, vigilance.is_as_usual(&self.params));
        (self.hypotheses, self.shots, self.vigilance) = (hypotheses, shots, vigilance);
        (self.walked, self.n_updates) = (Walked::default(), self.n_updates + 1);
        Ok(outcome)
    }

    /// Whether it is time to look for the robot again although nothing is doubted.
    fn is_routine(&self) -> bool {
        let AcquisitionParams { n_frames, every, .. } = self.params.acquisition;
        self.routine.is_due(every, self.vigilance.is_sound(&self.params))
            && self.n_updates > n_frames
            && !self.vigilance.is_undecided(&self.params)
    }

    /// Whether one place is left, or those beside it are as far behind as a place has to be that nothing speaks for.
    fn is_decided(&self, judged: &[Judged]) -> bool {
        let AcquisitionParams { elsewhere, n_frames, .. } = self.params.acquisition;
        judged.len() == 1 || (lead(judged) >= elsewhere && self.n_updates >= n_frames)
    }

    fn check(&self, image: &YuvImage, mount: &Pose3<f64>) -> Result<(), ColorModelError> {
        let expected = (self.camera.width() as usize, self.camera.height() as usize);
        let got = (image.width() as usize, image.height() as usize);
        if expected != got {
            return Err(ColorModelError::FrameSize { expected, got });
        }
        let unit = (mount.rotation.norm() - 1.0).abs() < 1e-6;
        if !(unit && mount.translation.iter().all(|v| v.abs() < 1e3)) {
            return Err(ColorModelError::NotFinite { what: "camera mount" });
        }
        Ok(())
    }

    fn fix(&self, estimate: &PoseEstimate, share: f64, vigilance: &Vigilance) -> Fix {
        let is_narrow = estimate.position_sigma() < 0.3 && estimate.heading_sigma() < 0.3;
        if vigilance.recent() < self.params.lost_fit {
            Fix::Lost
        } else if share > SURE
            && is_narrow
            && vigilance.suspicion(&self.params) < 1.0
            && self.n_updates >= self.params.acquisition.n_frames
        {
            Fix::Tracking
        } else {
            Fix::Ambiguous
        }
    }
}
