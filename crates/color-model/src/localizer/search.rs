use std::sync::Arc;

use rand::Rng;
use wayfix_color_map::MapRenderer;
use wayfix_estimation_traits::{LieGroup, LogWeight, Pose2, Pose3};
use wayfix_gaussian_core::log_sum_exp;
use wayfix_particle::{ParticleChunkRng, ParticleSet};

use super::{
    LocalizerParams, StartPosePrior,
    background::ImageHistogram,
    buffer::BufferedFrame,
    camera::CameraLocation,
    detections::Detections,
    estimate::is_same_place,
    filter::{ColorFilter, color_means},
    frame::Scene,
    start::Area,
    trajectory::Trajectory,
};
use crate::{
    ColorModelError, LightingTracker, LikelihoodModel, PixelClassifier, PixelLikelihoodFrame,
    PixelLikelihoodParams, PixelLikelihoodScratch, PixelSums, PredictedMapView, PrefixSumImage, gather,
};

/// Images are searched at half the resolution.
const SHRINK: u32 = 2;
/// Rounds of successive halving after the first.
const N_HALVINGS: u32 = 3;
/// Factors of a step after a success and after a failure: the step stays the same if one in five succeeds. [Rechenberg 1973]
const STEP_FACTORS: [f64; 2] = [1.5, 0.9036];
/// Smallest share of the frames that a place has to see of the map: nothing can contradict a place that sees less.
const MIN_MAP_SHARE: f64 = 0.1;

/// Global search in several frames at once.
///
/// Under an unknown light some false place explains a single frame better than the true one. The light is common to all frames, so whole trajectories
/// are weighed by all frames under one light. The likelihood is narrow: trajectories are drawn where detected landmarks fit, then moved by steps that adapt to
/// their success [Rechenberg 1973], while the worse half of the places is dropped again and again [Karnin et al. 2013].
pub(crate) struct Search<'a, T> {
    scene: Scene<'a, PixelLikelihoodParams>,
    area: &'a Area,
    start: &'a StartPosePrior,
    params: &'a LocalizerParams,
    /// The light before the first frame of all, and the one before the buffered frames: the latter is the better one if the place was right.
    lights: [&'a Arc<T>; 2],
    buffered: Vec<BufferedFrame>,
    frames: Vec<PrefixSumImage>,
    detections: Detections,
}

/// A place that explains the frames.
pub(crate) struct Found<T> {
    pub(crate) filter: ColorFilter<T>,
    pub(crate) place: Pose2<f64>,
    /// Log-likelihood of all frames with the prior of the trajectory, nats.
    pub(crate) log_evidence: LogWeight,
    /// Whether it is the place that was known before the search.
    pub(crate) is_known: bool,
}

/// A trajectory, and how well it explains the frames.
#[derive(Clone)]
struct Candidate {
    trajectory: Trajectory,
    /// Sums of every colour over the frames that are not hidden.
    sums: Vec<PixelSums>,
    /// The most probable light: of which tracker, and which of its lights.
    light: (usize, usize),
    log_evidence: LogWeight,
    /// Scale of the next step of the pose, and of the errors.
    steps: [f64; 2],
    /// The place that was known before the search, if the candidate started there; it stays there.
    known: Option<Pose2<f64>>,
}

/// Working memory of a thread.
struct Scratch {
    projector: MapRenderer,
    joint: PixelLikelihoodScratch,
    frames: Vec<Vec<PixelSums>>,
    values: Vec<f64>,
}

/// How many of the frames weigh a candidate.
#[derive(Clone, Copy, PartialEq)]
enum Effort {
    /// Two.
    Coarse,
    /// All, of which some may be hidden.
    Full,
}

impl<'a, T: LightingTracker + Clone + Send + Sync> Search<'a, T> {
    pub(crate) fn new(
        scene: Scene<'a, PixelLikelihoodParams>,
        (area, start): (&'a Area, &'a StartPosePrior),
        params: &'a LocalizerParams,
        lights: [&'a Arc<T>; 2],
        buffered: Vec<BufferedFrame>,
    ) -> Result<Self, ColorModelError> {
        let camera = scene.camera.shrunk(SHRINK).map_err(|_| ColorModelError::EmptyMap)?;
        let scene = Scene { camera, ..scene };
        let images =
            buffered.iter().map(|frame| frame.image.shrunk(SHRINK)).collect::<Result<Vec<_>, _>>()?;
        let histogram = ImageHistogram::new(images.iter(), &scene.noise.pixel_color_variance, scene.pixels);
        let nats = |pixel| {
            scene.background.map_or_else(|| histogram.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let frames = images
            .iter()
            .map(|image| PrefixSumImage::with_background(image, |pixel| Some(nats(pixel))))
            .collect::<Result<_, _>>()?;
        let mut detections = Detections::new(scene.map);
        let every = lights.iter().flat_map(|light| (0..light.n_lights()).map(|at| light.colors_in(at)));
        for colors in every {
            let classifier = PixelClassifier::new(scene.pixels.shaded(colors?))?;
            for (frame, image) in images.iter().enumerate() {
                let label = |pixel: &[u8; 3]| classifier.classify_above(*pixel, -nats(*pixel));
                let labels: Vec<u8> = image.pixels().iter().map(label).collect();
                detections.add(&labels, frame, &buffered[frame], &scene.camera)?;
            }
        }
        Ok(Self { scene, area, start, params, lights, buffered, frames, detections })
    }

    /// The places that explain the frames best, the best first, among those that the start allows, and the `known` one.
    pub(crate) fn run<R: Rng + ?Sized>(
        &self,
        known: Option<Pose2<f64>>,
        rng: &mut R,
    ) -> Result<Vec<Found<T>>, ColorModelError> {
        let params = &self.params.search;
        let drawn = (0..params.n_sampled_trajectories).map(|n| self.drawn(n, rng)).collect();
        let mut candidates =
            self.each(drawn, rng, |scratch, candidate, _| self.weigh(scratch, candidate, Effort::Coarse))?;
        candidates.extend(known.map(|place| self.candidate(&place, self.buffered.len(), Some(place))));
        retain_places(&mut candidates, params.n_refined_places);
        for round in 0..=N_HALVINGS {
            candidates = self.each(candidates, rng, |scratch, candidate, rng| {
                self.weigh(scratch, candidate, Effort::Full);
                for _ in 0..params.n_first_round_moves << round {
                    self.refine(scratch, candidate, rng);
                }
            })?;
            retain_places(&mut candidates, params.n_refined_places >> (round + 1).min(N_HALVINGS));
        }
        let n_particles = self.params.max_particles.div_ceil(candidates.len().max(1));
        candidates.iter().map(|candidate| self.found(candidate, n_particles, rng)).collect()
    }

    /// A candidate that the start allows. If that is anywhere, every other one shows a landmark where a frame does.
    fn drawn<R: Rng + ?Sized>(&self, n: usize, rng: &mut R) -> Candidate {
        let detected = match self.start {
            StartPosePrior::Anywhere if n.is_multiple_of(2) => self.detections.draw(self.area, rng),
            _ => None,
        };
        let (at, pose) = detected.unwrap_or_else(|| (0, self.start.draw(self.area, rng)));
        self.candidate(&pose, at, None)
    }

    fn candidate(&self, pose: &Pose2<f64>, at: usize, known: Option<Pose2<f64>>) -> Candidate {
        let mut trajectory = Trajectory::through(pose, at, &self.buffered);
        self.area.clamp(&mut trajectory.newest);
        let sums = vec![PixelSums::default(); self.scene.map.colors().len()];
        Candidate {
            trajectory,
            sums,
            light: (0, 0),
            log_evidence: f64::NEG_INFINITY,
            steps: [0.5, 1.0],
            known,
        }
    }

    /// Tries a step of the whole trajectory, and a step of the errors at one frame.
    fn refine(&self, scratch: &mut Scratch, candidate: &mut Candidate, rng: &mut ParticleChunkRng) {
        let [pose, errors] = candidate.steps;
        let is_better = self.consider(scratch, candidate, candidate.trajectory.moved(pose, rng));
        candidate.steps[0] *= STEP_FACTORS[usize::from(!is_better)];
        let is_better = self.consider(scratch, candidate, candidate.trajectory.perturbed(errors, rng));
        candidate.steps[1] *= STEP_FACTORS[usize::from(!is_better)];
    }

    /// Takes a trajectory if it explains the frames better; returns whether it does.
    fn consider(&self, scratch: &mut Scratch, candidate: &mut Candidate, mut trajectory: Trajectory) -> bool {
        self.area.clamp(&mut trajectory.newest);
        if candidate.known.is_some_and(|known| !is_same_place(&known, &trajectory.newest)) {
            return false;
        }
        let mut moved = Candidate { trajectory, ..candidate.clone() };
        self.weigh(scratch, &mut moved, Effort::Full);
        let is_better = moved.log_evidence > candidate.log_evidence;
        if is_better {
            *candidate = moved;
        }
        is_better
    }

    /// The evidence of the frames, $`\ln \sum_j π_j \int \prod_{k ∉ H} p(z_k | x_k, θ)\, p_j(θ)\, dθ + |H| \ln h + (n - |H|) \ln (1 - h)`$, and of the prior. Frames are
    /// added to the hidden ones $`H`$ as long as that raises it.
    fn weigh(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort) {
        let locations = candidate.trajectory.locations(&self.buffered, &self.params.camera_pose_noise);
        let n = self.frames.len();
        let stride = if effort == Effort::Coarse { n.div_ceil(2).max(1) } else { 1 };
        let used: Vec<usize> = (0..n).rev().step_by(stride).collect();
        candidate.sums.fill(PixelSums::default());
        for &at in &used {
            let camera_pose = locations[at].camera_pose(&self.buffered[at].mount);
            let sums = &mut scratch.frames[at];
            let frame = |_| Some(&self.frames[at]);
            if gather(&mut scratch.projector, frame, &camera_pose, self.scene.pixels.edge_margin_pixels, sums)
                .is_err()
            {
                sums.fill(PixelSums::default());
            }
            candidate.sums.iter_mut().zip(&*sums).for_each(|(total, sums)| total.add(sums));
        }
        let n_seen: u64 = candidate.sums.iter().map(|sums| sums.count() + sums.n_outliers()).sum();
        let n_pixels = used.len() * self.frames.first().map_or(0, PrefixSumImage::n_pixels);
        if effort == Effort::Coarse
            && candidate.known.is_none()
            && (n_seen as f64) < MIN_MAP_SHARE * n_pixels as f64
        {
            candidate.log_evidence = f64::NEG_INFINITY;
            return;
        }
        let share = self.params.occlusion.share();
        let (hidden, free) = (share.ln(), (-share).ln_1p());
        let constant = self.start.log_prior(&locations[0].body)
            + candidate.trajectory.log_prior()
            + free * used.len() as f64;
        (candidate.light, candidate.log_evidence) = self.evidence(scratch, &candidate.sums);
        let (mut left, mut cost) = (used, 0.0);
        loop {
            if effort == Effort::Coarse {
                break;
            }
            let mut best = None;
            for (index, &at) in left.iter().enumerate() {
                let mut rest = candidate.sums.clone();
                rest.iter_mut().zip(&scratch.frames[at]).for_each(|(total, sums)| total.remove(sums));
                let (light, value) = self.evidence(scratch, &rest);
                if value + cost + hidden - free > candidate.log_evidence {
                    candidate.log_evidence = value + cost + hidden - free;
                    best = Some((index, light, rest));
                }
            }
            let Some((index, light, rest)) = best else { break };
            (candidate.light, candidate.sums) = (light, rest);
            left.swap_remove(index);
            cost += hidden - free;
        }
        candidate.log_evidence += constant;
    }

    /// The most probable light, and the log-likelihood that all lights sum to. Both trackers are equally probable.
    fn evidence(&self, scratch: &mut Scratch, sums: &[PixelSums]) -> ((usize, usize), LogWeight) {
        let frame = PixelLikelihoodFrame {
            n_pixels: self.frames.first().map_or(1, PrefixSumImage::n_pixels),
            pixel_color_variance: self.scene.noise.pixel_color_variance,
            mean_color_variance: self.scene.noise.mean_color_variance,
        };
        let Scratch { values, joint, .. } = scratch;
        let view = PredictedMapView { camera_pose: &Pose3::identity(), sums };
        let n_lights = self.lights[0].n_lights();
        values.resize(2 * n_lights, 0.0);
        for (light, values) in self.lights.iter().zip(values.chunks_mut(n_lights)) {
            self.scene.pixels.log_likelihoods(&frame, joint, &view, &***light, values);
            for (at, value) in values.iter_mut().enumerate() {
                *value += (light.light_probability(at) / 2.0).ln();
                if value.is_nan() {
                    *value = f64::NEG_INFINITY;
                }
            }
        }
        let best = values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(at, _)| at);
        ((best / n_lights, best % n_lights), log_sum_exp(values))
    }

    /// Particles about a candidate, spread by its last step, with the light that all frames show from there.
    fn found<R: Rng + ?Sized>(
        &self,
        candidate: &Candidate,
        n_particles: usize,
        rng: &mut R,
    ) -> Result<Found<T>, ColorModelError> {
        let (tracker, at) = candidate.light;
        let mut light = T::clone(self.lights[tracker]);
        // A tracker that refuses the means keeps its prior.
        let _ = light.update_in(at, &color_means(&candidate.sums, self.params));
        let newest = candidate
            .trajectory
            .locations(&self.buffered, &self.params.camera_pose_noise)
            .pop()
            .ok_or(ColorModelError::NoPose)?;
        let location = |_| {
            let mut body = candidate.trajectory.moved(candidate.steps[0], rng).newest;
            self.area.clamp(&mut body);
            CameraLocation { body, ..newest }
        };
        let filter = ColorFilter::new((0..n_particles).map(location), &Arc::new(light))?;
        Ok(Found {
            filter,
            place: candidate.trajectory.newest,
            log_evidence: candidate.log_evidence,
            is_known: candidate.known.is_some(),
        })
    }

    /// Does `job` to every candidate, each with the random stream of its chunk.
    fn each<R: Rng + ?Sized>(
        &self,
        candidates: Vec<Candidate>,
        rng: &mut R,
        job: impl Fn(&mut Scratch, &mut Candidate, &mut ParticleChunkRng) + Sync,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let scratch = || Scratch {
            projector: MapRenderer::new(Arc::clone(self.scene.map), self.scene.camera),
            joint: PixelLikelihoodScratch::new(),
            frames: vec![vec![PixelSums::default(); self.scene.map.colors().len()]; self.frames.len()],
            values: Vec::new(),
        };
        let mut set = ParticleSet::new(candidates)?;
        set.propagate_with(scratch, job, rng);
        Ok(set.states().to_vec())
    }
}

/// Keeps the `n` best that are in different places, the best first, and the known one.
fn retain_places(candidates: &mut Vec<Candidate>, n: usize) {
    candidates.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in candidates.drain(..) {
        let is_near =
            |other: &Candidate| is_same_place(&other.trajectory.newest, &candidate.trajectory.newest);
        if candidate.known.is_some() || (kept.len() < n.max(1) && !kept.iter().any(is_near)) {
            kept.push(candidate);
        }
    }
    *candidates = kept;
}
