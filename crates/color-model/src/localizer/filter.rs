use std::{collections::BTreeSet, sync::Arc};

use rand::{Rng, RngExt};
use wayfix_estimation_traits::Pose2;
use wayfix_particle::{
    KldParams, KldSampling, NormalizedWeights, ParticleChunkRng, ParticleSet, RaoBlackwellParticle,
    Resampler, SystematicResampler, grid_cell, map_conditionals,
};

use super::{
    LocalizerParams, PoseEstimate,
    camera::{CameraLocation, CameraPoseError},
    estimate::{PLACE_RADIUS, dominant_cluster},
    frame::PreparedFrame,
};
use crate::{
    ColorMeans, ColorModelError, LightingTracker, LikelihoodModel, PixelSums, ViewOcclusionModel,
    likelihood::or_hidden,
};

/// A camera location with its light, $`p(θ | x, z)`$, and what the last frame shows from there. [Schulz & Fox 2004, Eqs. 11–12]
#[derive(Clone)]
pub(crate) struct ColorParticle<T> {
    pub(crate) state: RaoBlackwellParticle<CameraLocation, T>,
    /// The error of the mount and the light of each camera beside the first.
    others: Vec<(CameraPoseError, Arc<T>)>,
    /// Of every colour in the first light, then in the next. Lights that the frame does not show have none.
    sums: Vec<PixelSums>,
    /// The light drawn.
    light: usize,
    /// Of the frame, whichever light was drawn, in nats.
    log_likelihood: f64,
}

/// The particle filter of one place: a camera location is sampled, the light is a Kalman filter conditioned on it. [Schulz & Fox 2004, IV]
#[derive(Clone)]
pub(crate) struct ColorFilter<T> {
    particles: Vec<ColorParticle<T>>,
    weights: NormalizedWeights,
    /// Probability that the view is hidden.
    hidden: f64,
    /// The same of each camera beside the first.
    others_hidden: Vec<f64>,
    max_particles: usize,
    /// Result of the last frame.
    pub(crate) weighing: Weighing,
}

/// Result of weighing particles by a frame.
#[derive(Clone, Debug)]
pub(crate) struct Weighing {
    /// Log-likelihood of the frame, $`\ln \sum_i w_i p(z | x_i)`$, relative to the background, nats.
    pub(crate) log_evidence: f64,
    /// Mean over the weighted particles, nats.
    pub(crate) mean_log_likelihood: f64,
    /// Exponent of the likelihoods, at most 1.
    pub(crate) tempering: f64,
    pub(crate) effective_particles: f64,
    /// Probability of each light.
    pub(crate) light_probabilities: Vec<f64>,
}

impl<T: LightingTracker + Clone + Send + Sync> ColorFilter<T> {
    /// Particles at these locations with equal weights, which share one light.
    pub(crate) fn new(
        locations: impl IntoIterator<Item = CameraLocation>,
        light: &Arc<T>,
    ) -> Result<Self, ColorModelError> {
        let particle = |location| ColorParticle {
            state: RaoBlackwellParticle::from_shared(location, Arc::clone(light)),
            others: Vec::new(),
            sums: Vec::new(),
            light: 0,
            log_likelihood: 0.0,
        };
        let particles: Vec<_> = locations.into_iter().map(particle).collect();
        let weights = NormalizedWeights::from_linear(vec![1.0; particles.len()])?;
        let weighing = Weighing {
            log_evidence: 0.0,
            mean_log_likelihood: 0.0,
            tempering: 1.0,
            effective_particles: particles.len() as f64,
            light_probabilities: (0..light.n_lights()).map(|at| light.light_probability(at)).collect(),
        };
        let (hidden, others_hidden) = (0.0, Vec::new());
        Ok(Self { max_particles: particles.len(), particles, weights, hidden, others_hidden, weighing })
    }

    /// Whether it has seen a frame of the camera of this number.
    pub(crate) fn knows_camera(&self, camera: usize) -> bool {
        self.others_hidden.len() >= camera
    }

    /// Swaps what belongs to the first camera with what belongs to the one of this number; a second call swaps back. A new camera has this light and an error of its
    /// mount by `sample`.
    pub(crate) fn swap_camera(
        &mut self,
        camera: usize,
        light: &Arc<T>,
        mut sample: impl FnMut() -> CameraPoseError,
    ) {
        let Some(at) = camera.checked_sub(1) else { return };
        self.others_hidden.resize(camera.max(self.others_hidden.len()), 0.0);
        std::mem::swap(&mut self.hidden, &mut self.others_hidden[at]);
        for ColorParticle { state, others, .. } in &mut self.particles {
            others.resize_with(camera.max(others.len()), || (sample(), Arc::clone(light)));
            let (error, light) = &mut others[at];
            std::mem::swap(&mut state.sampled.error, error);
            let first = Arc::clone(state.shared_conditional());
            state.set_conditional(std::mem::replace(light, first));
        }
    }

    /// Moves each particle. [Schulz & Fox 2004, Eqs. 13, 15]
    pub(crate) fn predict(&mut self, mut moved: impl FnMut(&Pose2<f64>) -> Pose2<f64>) {
        for particle in &mut self.particles {
            particle.state.sampled.body = moved(&particle.state.sampled.body);
        }
    }

    /// Lets the light drift. [Schulz & Fox 2004, Eq. 6]
    pub(crate) fn predict_lighting(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        let mut states: Vec<_> = self.particles.iter().map(|particle| particle.state.clone()).collect();
        map_conditionals(&mut states, |light| {
            let mut light = light.clone();
            light.predict(seconds)?;
            Ok::<_, ColorModelError>(light)
        })?;
        self.particles.iter_mut().zip(states).for_each(|(particle, state)| particle.state = state);
        Ok(())
    }

    /// Draws a camera error and a light for each particle and weighs them by the frame. [Schulz & Fox 2004, Eqs. 14–16]
    ///
    /// The light is drawn from the optimal proposal $`p(j | z) ∝ π_j\, p(z | x, θ_j)`$ by enumeration; the weight is the sum, whichever was drawn.
    /// [Andrieu et al. 2002]
    pub(crate) fn weigh<L: LikelihoodModel, R: Rng + ?Sized>(
        &mut self,
        frame: &PreparedFrame<'_, L>,
        seconds: f64,
        params: &LocalizerParams,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        self.view(frame, seconds, params, rng)?;
        let hidden = params.occlusion.predict(self.hidden, seconds);
        let evidence = |particle: &ColorParticle<T>| or_hidden(particle.log_likelihood, hidden);
        let evidences: Vec<f64> = self.particles.iter().map(evidence).collect();
        let min_effective = params.tempering_min_ess_share * self.weights.effective_sample_size();
        let (weights, tempering) = tempered(&evidences, &self.weights, min_effective)?;
        let joint = evidences.iter().zip(self.weights.as_slice()).map(|(l, w)| l + w.ln());
        let log_evidence = wayfix_gaussian_core::log_sum_exp(&joint.collect::<Vec<_>>());
        self.hidden = ViewOcclusionModel::posterior(hidden, log_evidence);
        let (light_probabilities, mean_log_likelihood) =
            self.summarized(&weights, params.pixels.outlier_share.ln() * frame.n_tiles() as f64);
        self.weighing = Weighing {
            log_evidence,
            mean_log_likelihood,
            tempering,
            effective_particles: weights.effective_sample_size(),
            light_probabilities,
        };
        self.weights = weights;
        Ok(())
    }

    /// Draws a camera error for each particle, sums the pixels that it sees, and draws its light.
    fn view<L: LikelihoodModel, R: Rng + ?Sized>(
        &mut self,
        frame: &PreparedFrame<'_, L>,
        seconds: f64,
        params: &LocalizerParams,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        let mut set = ParticleSet::new(std::mem::take(&mut self.particles))?;
        let view = |(scratch, values): &mut (_, Vec<f64>),
                    particle: &mut ColorParticle<T>,
                    rng: &mut ParticleChunkRng| {
            let location = &mut particle.state.sampled;
            location.error = params.camera_pose_noise.after(&location.error, seconds, rng);
            let light = particle.state.conditional();
            values.resize(light.n_lights(), 0.0);
            particle.sums.resize(light.n_lights() * frame.n_colors(), PixelSums::default());
            frame.view(scratch, &particle.state.sampled, light, &mut particle.sums, values);
            (particle.light, particle.log_likelihood) = draw_light(light, values, rng.random());
            let shade = light.shade_of(particle.light);
            let others = particle.sums.chunks_exact_mut(frame.n_colors()).enumerate();
            others
                .filter(|(at, _)| *at != particle.light && Some(*at) != shade)
                .for_each(|(_, sums)| sums.fill(PixelSums::default()));
        };
        set.propagate_with(|| (frame.scratch(), Vec::new()), view, rng);
        self.particles = set.states().to_vec();
        Ok(())
    }

    /// The probability of each light, and the mean log-likelihood, of which a particle counts at least `least`, the worst that a frame can.
    fn summarized(&self, weights: &NormalizedWeights, least: f64) -> (Vec<f64>, f64) {
        let n_lights = self.particles.first().map_or(0, |particle| particle.state.conditional().n_lights());
        let mut light_probabilities = vec![0.0; n_lights];
        let mut mean_log_likelihood = 0.0;
        for (particle, weight) in
            self.particles.iter().zip(weights.as_slice()).filter(|(_, weight)| **weight > 0.0)
        {
            light_probabilities[particle.light] += weight;
            mean_log_likelihood += weight * particle.log_likelihood.max(least);
        }
        (light_probabilities, mean_log_likelihood)
    }

    /// Draws the ancestors of the next generation, as many as their spread needs. [Fox 2003]
    pub(crate) fn resample<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<usize>, ColorModelError> {
        let n = n_particles(&self.particles, &self.weights, self.max_particles, rng)?;
        Ok(SystematicResampler.ancestors(&self.weights, n, rng)?)
    }

    /// The next generation: the light of each ancestor is updated with the colour means that it shows, once for all its children.
    /// [Schulz & Fox 2004, Eqs. 3–5]
    pub(crate) fn update_lighting(
        &mut self,
        ancestors: &[usize],
        params: &LocalizerParams,
    ) -> Result<(), ColorModelError> {
        let survivors: Vec<usize> = ancestors.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
        let mut updated: Vec<_> = survivors.iter().map(|at| self.particles[*at].clone()).collect();
        for_each(&mut updated, |particle| particle.update_lighting(params));
        let child = |ancestor: &usize| {
            let at = survivors.binary_search(ancestor).unwrap_or(0); // every ancestor survives
            updated[at].clone()
        };
        self.particles = ancestors.iter().map(child).collect();
        self.weights = NormalizedWeights::from_linear(vec![1.0; ancestors.len()])?;
        Ok(())
    }

    /// The dominant cluster.
    pub(crate) fn estimate(&self) -> Result<PoseEstimate, ColorModelError> {
        dominant_cluster(&self.poses().collect::<Vec<_>>()).ok_or(ColorModelError::NoPose)
    }

    /// The estimate with the mean error of the camera.
    pub(crate) fn location(&self) -> Result<CameraLocation, ColorModelError> {
        let weighted = self.particles.iter().zip(self.weights.as_slice());
        let error = weighted.fold(CameraPoseError::default(), |mean, (particle, weight)| {
            let error = &particle.state.sampled.error;
            CameraPoseError {
                rotation: mean.rotation + error.rotation * *weight,
                height: mean.height + error.height * weight,
            }
        });
        Ok(CameraLocation { body: *self.estimate()?.pose.mean(), error })
    }

    /// Body poses with weights.
    pub(crate) fn poses(&self) -> impl Iterator<Item = (Pose2<f64>, f64)> {
        let bodies = self.particles.iter().map(|particle| particle.state.sampled.body);
        bodies.zip(self.weights.as_slice().iter().copied())
    }

    /// Light of the heaviest particle in the camera of this number.
    pub(crate) fn light(&self, camera: usize) -> Option<&Arc<T>> {
        let weighted = self.particles.iter().zip(self.weights.as_slice());
        let (heaviest, _) = weighted.max_by(|a, b| a.1.total_cmp(b.1))?;
        match camera.checked_sub(1) {
            None => Some(heaviest.state.shared_conditional()),
            Some(other) => heaviest.others.get(other).map(|(_, light)| light),
        }
    }

    pub(crate) fn set_max_particles(&mut self, max_particles: usize) {
        self.max_particles = max_particles;
    }

    pub(crate) fn n_particles(&self) -> usize {
        self.particles.len()
    }
}

impl<T: LightingTracker + Clone> ColorParticle<T> {
    /// A tracker that refuses the means stays as it is.
    fn update_lighting(&mut self, params: &LocalizerParams) {
        let mut light = self.state.conditional().clone();
        update_lights(&mut light, self.light, &self.sums, params);
        self.state.set_conditional(Arc::new(light));
    }
}

/// Updates every light with the means of the colours in it, the `dominant` one last, which makes it the active one. A tracker that refuses the means stays as it is.
pub(crate) fn update_lights<T: LightingTracker>(
    light: &mut T,
    dominant: usize,
    sums: &[PixelSums],
    params: &LocalizerParams,
) {
    let n_colors = sums.len() / light.n_lights().max(1);
    let means = |at: usize| color_means(&sums[at * n_colors..(at + 1) * n_colors], params);
    for at in (0..light.n_lights()).filter(|at| *at != dominant) {
        let means = means(at);
        if means.seen().next().is_some() {
            let _ = light.update_in(at, &means);
        }
    }
    let _ = light.update_in(dominant, &means(dominant));
}

/// The mean colour of each region of at least `min_pixels`, $`\bar v`$ of [Schulz & Fox 2004, Eq. 3].
fn color_means(sums: &[PixelSums], params: &LocalizerParams) -> ColorMeans {
    let mean = |(color, sums): (usize, &PixelSums)| {
        let is_used = sums.count() >= params.min_pixels.max(1) && params.withheld_color != Some(color);
        (if is_used { sums.mean() } else { None }, sums.count())
    };
    ColorMeans::new(sums.iter().enumerate().map(mean))
}

/// The light drawn by `uniform`, and the log-likelihood that all lights sum to.
pub(crate) fn draw_light(
    light: &impl LightingTracker,
    log_likelihoods: &[f64],
    uniform: f64,
) -> (usize, f64) {
    let joint = |at: usize| light.light_probability(at).ln() + log_likelihoods[at];
    let joint: Vec<f64> = (0..log_likelihoods.len()).map(joint).collect();
    let sum = wayfix_gaussian_core::log_sum_exp(&joint);
    let mut left = uniform;
    let drawn = joint.iter().position(|log| {
        left -= (log - sum).exp();
        left < 0.0
    });
    let best = || joint.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(at, _)| at);
    (drawn.unwrap_or_else(best), sum)
}

/// Weights under the largest power of the likelihood, up to 1, that leaves `least` effective particles, and that power.
///
/// A likelihood narrower than the distance between particles would leave one of them. Tempered, they contract over some frames; once they are as close as the
/// likelihood is wide, the power is 1.
pub(crate) fn tempered(
    log_likelihoods: &[f64],
    prior: &NormalizedWeights,
    least: f64,
) -> Result<(NormalizedWeights, f64), ColorModelError> {
    let weights = |power: f64| {
        let log_weight = |(l, w): (&f64, &f64)| if *l == f64::NEG_INFINITY { *l } else { power * l + w.ln() };
        NormalizedWeights::from_log(
            &log_likelihoods.iter().zip(prior.as_slice()).map(log_weight).collect::<Vec<_>>(),
        )
    };
    let full = weights(1.0)?;
    if full.effective_sample_size() >= least {
        return Ok((full, 1.0));
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..f32::MANTISSA_DIGITS {
        let middle = f64::midpoint(low, high);
        let is_enough = weights(middle)?.effective_sample_size() >= least;
        *(if is_enough { &mut low } else { &mut high }) = middle;
    }
    Ok((weights(low)?, low))
}

/// KLD-sampling on cells of half the radius of a place.
fn n_particles<T, R: Rng + ?Sized>(
    particles: &[ColorParticle<T>],
    weights: &NormalizedWeights,
    max: usize,
    rng: &mut R,
) -> Result<usize, ColorModelError> {
    let kld = KldSampling::new(KldParams {
        min_particles: max.div_ceil(2),
        max_particles: max,
        ..KldParams::default()
    })?;
    let cell = |at: &usize| {
        let body = particles[*at].state.sampled.body;
        grid_cell([body.x(), body.y(), body.heading()], [PLACE_RADIUS / 2.0; 3])
    };
    let cells: BTreeSet<_> = SystematicResampler.ancestors(weights, max, rng)?.iter().map(cell).collect();
    Ok(kld.required(cells.len()))
}

#[cfg(feature = "parallel")]
fn for_each<X: Send>(items: &mut [X], job: impl Fn(&mut X) + Sync + Send) {
    use rayon::prelude::*;
    items.par_iter_mut().for_each(job);
}

#[cfg(not(feature = "parallel"))]
fn for_each<X>(items: &mut [X], job: impl Fn(&mut X)) {
    items.iter_mut().for_each(job);
}
