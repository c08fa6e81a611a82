use std::sync::Arc;

use rand::{Rng, distr::Distribution};
use wayfix_color_map::{Camera, ColorId, ColorMap};
use wayfix_estimation_traits::{Pose2, Pose3, SampleMotion};
use wayfix_particle::{RaoBlackwell, Weights};

use super::{
    Fix, FrameOutcome, LocalizerParams, OdometryStep, PoseEstimate, Start,
    estimate::dominant_cluster,
    fitness::Fitness,
    light::Light,
    palette::Palette,
    particle::{CameraLocation, ColorParticle},
    relight::{Relight, predict_light},
    renewal::Renewal,
    start::Area,
    weigh::Weighing,
    weighed::Weighed,
};
use crate::{Background, ColorModelError, LightingBank, YuvImage};

/// Finds out where a robot stands on a colour-coded field and what the colours look like in today's light, at once.
///
/// The Rao-Blackwellised particle filter of [Schulz & Fox 2004, IV]: a particle is a camera location and, conditioned on it, a switching
/// Kalman filter of the light.
pub struct ColorLocalizer {
    map: Arc<ColorMap>,
    camera: Camera,
    area: Area,
    background: Option<Background>,
    params: LocalizerParams,
    particles: Vec<ColorParticle>,
    weights: Weights,
    seconds: f64,
    fitness: Fitness,
}

impl ColorLocalizer {
    /// A localizer that starts where `start` says, in light of which `light` says what is known.
    ///
    /// # Errors
    /// When a parameter is out of range, the map is empty, or its colours and the light's differ in number.
    pub fn new<R: Rng + ?Sized>(
        map: Arc<ColorMap>,
        camera: Camera,
        light: LightingBank,
        start: &Start,
        params: LocalizerParams,
        rng: &mut R,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        let (expected, got) = (map.colors().len(), light.n_colors());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "colours of the lighting bank", expected, got });
        }
        let area = Area::of(&map)?;
        let light = Arc::new(Light::new(light, &params.pixels)?);
        let particle = |body: Pose2<f64>, rng: &mut R| {
            RaoBlackwell::from_shared(
                CameraLocation { body, error: params.camera.sample(rng) },
                Arc::clone(&light),
            )
        };
        let particles: Vec<ColorParticle> = match start {
            Start::Near(about) => {
                let about = about.sampler();
                (0..params.max_particles).map(|_| particle(about.sample(rng), rng)).collect()
            }
            Start::Anywhere => {
                (0..params.max_particles_lost).map(|_| particle(area.sample(rng), rng)).collect()
            }
        };
        let weights = Weights::from_linear(vec![1.0; particles.len()])?;
        let fitness = Fitness::default();
        Ok(Self { map, camera, area, background: None, params, particles, weights, seconds: 0.0, fitness })
    }

    /// The same with a background learned from images; without, it is made of a uniform one and of the colours of each frame.
    pub fn with_background(self, background: Background) -> Self {
        Self { background: Some(background), ..self }
    }

    /// The particles' weighted body poses.
    pub fn poses(&self) -> impl Iterator<Item = (Pose2<f64>, f64)> {
        let weights = self.weights.as_slice().iter().copied();
        self.particles.iter().map(|particle| particle.sampled.body).zip(weights)
    }

    /// What the colours look like to the heaviest particle.
    pub fn light(&self) -> &LightingBank {
        let weights = self.weights.as_slice();
        let heaviest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
        &self.particles[heaviest].conditional().bank
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
        let moved = self.params.odometry.given(step);
        for particle in &mut self.particles {
            particle.sampled.body = moved(&particle.sampled.body, rng);
            self.area.clamp(&mut particle.sampled.body);
        }
        self.seconds += step.seconds;
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
        let mut particles = self.particles.clone();
        predict_light(&mut particles, self.seconds, &self.params.pixels)?;
        let look = Palette::of(&particles, self.weights.as_slice())?.look(image, self.background.as_ref())?;
        for particle in &mut particles {
            particle.sampled.error = self.params.camera.after(&particle.sampled.error, self.seconds, rng);
        }
        let frame = &look.frame;
        let weighing =
            Weighing { map: &self.map, camera: self.camera, frame, mount, pixels: &self.params.pixels };
        let views = weighing.views(&particles);
        let weighed = Weighed::new(&particles, &self.weights, &views, self.params.least_effective, rng)?;

        let estimate = dominant_cluster(&weighed.poses(&particles)).ok_or(ColorModelError::NoPose)?;
        let temper = self.params.pixels.independent_pixels / frame.n_pixels() as f64;
        let fit = weighed.mean_log_likelihood / temper / look.explainable.max(1.0);
        let mut fitness = self.fitness;
        fitness.observe(fit, &self.params);

        let renewal = Renewal {
            params: &self.params,
            area: &self.area,
            suspicion: fitness.suspicion(),
            estimate: estimate.pose.mean(),
        };
        let relight = Relight {
            views: &views,
            members: &weighed.members,
            min_pixels: self.params.min_pixels,
            withheld: self.params.withheld.map(|color| ColorId(color as u8)),
            pixels: &self.params.pixels,
        };
        let renewed = renewal.renew(&particles, &weighed.weights, &relight, rng)?;

        let outcome = FrameOutcome {
            fix: self.fix(&estimate),
            estimate,
            tempering: weighed.tempering,
            effective_particles: weighed.weights.effective_sample_size(),
            n_particles: renewed.particles.len(),
            log_evidence_per_pixel: weighed.log_evidence / temper / frame.n_pixels() as f64,
            fit,
            kidnap_suspicion: fitness.suspicion(),
            n_injected: renewed.n_injected,
            light_probabilities: weighed.light_probabilities(),
        };
        (self.particles, self.weights) = (renewed.particles, renewed.weights);
        (self.fitness, self.seconds) = (fitness, 0.0);
        Ok(outcome)
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

    fn fix(&self, estimate: &PoseEstimate) -> Fix {
        let narrow = estimate.position_sigma() < 0.3 && estimate.heading_sigma() < 0.3;
        if estimate.share > 0.5 && narrow { Fix::Tracking } else { Fix::Ambiguous }
    }
}
