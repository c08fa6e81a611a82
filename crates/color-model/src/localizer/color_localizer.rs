use std::{collections::VecDeque, sync::Arc};

use rand::Rng;
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_estimation_traits::{Pose2, Pose3};
use wayfix_integrity::RelocalizationTest;

use super::{
    FrameOutcome, LocalizationStatus, LocalizerParams, OdometryModel, OdometryNoise, OdometryStep,
    PoseEstimate, StartPosePrior,
    buffer::{BufferedFrame, FrameBuffer},
    camera::CameraLocation,
    estimate::PLACE_RADIUS,
    filter::ColorFilter,
    frame::{PreparedFrame, Scene, check_frame},
    odometry::OdometryDelta,
    search::{Area, check_area},
};
use crate::{
    BackgroundColorModel, ColorModelError, LightingFilterBank, LightingTracker, LikelihoodModel,
    PixelLikelihoodParams, YuvImage, lighting::SunAndShade,
};

/// Probability of a place from which on it is tracked.
pub(super) const TRACKING_PROBABILITY: f64 = 0.95;

/// Localizes in a coloured map and learns the light at the same time: the Rao-Blackwellised particle filter of [Schulz & Fox 2004, IV].
///
/// A particle is a camera location and, conditioned on it, a tracker of the light `T`. The odometry model `M` and the likelihood `L` are parameters too.
/// Where the start is unknown, and every few seconds while the robot drives, a global search proposes places; [`RelocalizationTest`] decides between them and the
/// present one.
///
/// ```
/// use std::sync::Arc;
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use rand::SeedableRng;
/// use wayfix_color_map::{PinholeCamera, ColorId, ColorMap, ColoredShape};
/// use wayfix_color_model::{ColorLocalizer, LightingFilterBank, LightingFilter, LightingFilterParams, LocalizerParams, OdometryStep, StartPosePrior, YuvImage};
/// use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::MarkovChain;
/// let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
/// let map = ColorMap::new(vec!["green".into()], vec![ColoredShape::Polygon { color: ColorId(0), vertices }])?;
/// let prior = Gaussian::new(DVector::from_vec(vec![70.0, 120.0, 110.0]), DMatrix::identity(3, 3) * 400.0)?;
/// let bank = LightingFilterBank::new(vec![LightingFilter::new(prior, LightingFilterParams::default())?], MarkovChain::sticky(1, 1.0)?)?;
/// let start = StartPosePrior::Near(Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?);
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let camera = PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?;
/// let mut localizer = ColorLocalizer::new(Arc::new(map), camera, bank, &start, LocalizerParams::default(), &mut rng)?;
/// let forward = OdometryStep { increment: Some(Pose2::new(0.01, 0.0, 0.0)), seconds: 0.1 };
/// localizer.predict(&forward, &mut rng)?;
/// // The lower half of the image is carpet.
/// let pixels = (0..32 * 24).map(|at| if at < 32 * 12 { [20, 128, 128] } else { [90, 120, 110] }).collect();
/// let mount = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
/// let outcome = localizer.update(&YuvImage::new(32, 24, pixels)?, &mount, &mut rng)?;
/// assert!(outcome.estimate.pose.mean().translation.norm() < 0.5);
/// assert!(localizer.light().member(0).mean()[0] > 75.0); // the carpet is brighter than the prior's 70
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ColorLocalizer<T = LightingFilterBank, M = OdometryNoise, L = PixelLikelihoodParams> {
    map: Arc<ColorMap>,
    pub(super) camera: PinholeCamera,
    pub(super) area: Area,
    background: Option<BackgroundColorModel>,
    pub(super) params: LocalizerParams,
    odometry: M,
    likelihood: L,
    /// Where the robot may have been at the start; anywhere once it was moved.
    pub(super) start: StartPosePrior,
    /// The light before the first frame.
    pub(super) prior: Arc<SunAndShade<T>>,
    /// The most probable place.
    present: ColorFilter<SunAndShade<T>>,
    relocalization: RelocalizationTest<ColorFilter<SunAndShade<T>>>,
    /// Since the last frame.
    pub(super) delta: OdometryDelta,
    buffer: FrameBuffer,
    /// The light of the most probable place before each frame of the buffer.
    pub(super) lights: VecDeque<Arc<SunAndShade<T>>>,
    pub(super) n_updates: usize,
    /// Since the last search, s.
    pub(super) since_search: f64,
    /// Whether a search was certain of the present place: the last one of the start, or one later.
    is_confirmed: bool,
    /// Log-likelihood ratios of the last frames to the background at the estimate, nats, and what each frame adds to the one before.
    log_ratios: VecDeque<(f64, f64)>,
}

/// The models of a [`ColorLocalizer`].
#[derive(Clone, Copy, Debug)]
pub struct ColorLocalizerModels<T, M, L> {
    /// The light before the first frame.
    pub light: T,
    /// The odometry.
    pub odometry: M,
    /// The likelihood of an image.
    pub likelihood: L,
}

impl<T: LightingTracker + Clone + Send + Sync> ColorLocalizer<T> {
    /// A localizer with this prior of the pose and this tracker of the light, with the odometry noise and the pixel likelihood of the parameters.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range, the map is empty or too large to be searched, or the map and the light differ in their number of
    /// colours.
    pub fn new<R: Rng + ?Sized>(
        map: Arc<ColorMap>,
        camera: PinholeCamera,
        light: T,
        start: &StartPosePrior,
        params: LocalizerParams,
        rng: &mut R,
    ) -> Result<Self, ColorModelError> {
        let models = ColorLocalizerModels { light, odometry: params.odometry, likelihood: params.pixels };
        Self::with_models(map, camera, models, start, params, rng)
    }
}

impl<T, M, L> ColorLocalizer<T, M, L>
where
    T: LightingTracker + Clone + Send + Sync,
    M: OdometryModel,
    L: LikelihoodModel,
{
    /// [`new`](ColorLocalizer::new) with a model of the odometry and of the likelihood. The global search uses the pixel likelihood.
    ///
    /// # Errors
    /// As for [`new`](ColorLocalizer::new).
    pub fn with_models<R: Rng + ?Sized>(
        map: Arc<ColorMap>,
        camera: PinholeCamera,
        models: ColorLocalizerModels<T, M, L>,
        start: &StartPosePrior,
        params: LocalizerParams,
        rng: &mut R,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        let ColorLocalizerModels { light, odometry, likelihood } = models;
        let (expected, got) = (map.colors().len(), light.colors()?.len());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "colours of the light", expected, got });
        }
        let area = Area::of(&map)?;
        check_area(&area, &camera, &params)?;
        let prior = Arc::new(SunAndShade::new(light, likelihood.mixes_lights()));
        let location =
            |_| CameraLocation { body: start.draw(&area, rng), error: params.camera_pose_noise.sample(rng) };
        Ok(Self {
            present: ColorFilter::new((0..params.max_particles).map(location), &prior)?,
            relocalization: RelocalizationTest::new(params.relocalization)?,
            map,
            camera,
            area,
            background: None,
            params,
            odometry,
            likelihood,
            start: start.clone(),
            prior,
            delta: OdometryDelta::default(),
            buffer: FrameBuffer::default(),
            lights: VecDeque::new(),
            n_updates: 0,
            since_search: 0.0,
            is_confirmed: false,
            log_ratios: VecDeque::new(),
        })
    }

    /// Uses a background learned from images instead of the colours of each frame.
    #[must_use]
    pub fn with_background(self, background: BackgroundColorModel) -> Self {
        Self { background: Some(background), ..self }
    }

    /// The weighted body poses of the particles at the most probable place.
    pub fn poses(&self) -> impl Iterator<Item = (Pose2<f64>, f64)> {
        self.present.poses()
    }

    /// The light of the heaviest particle.
    pub fn light(&self) -> &T {
        &self.present.light().unwrap_or(&self.prior).sun
    }

    /// Moves every particle by the odometry and its noise. The motions since the last frame add up.
    ///
    /// # Errors
    /// Returns an error if the increment is not finite, or the time negative or not finite. The state is unchanged then.
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
        let distance = step.increment.map_or(0.0, |increment| increment.translation.norm());
        self.relocalization.drive(distance)?;
        let alternatives = self.relocalization.alternatives_mut().iter_mut().map(|one| &mut one.hypothesis);
        let sample = self.odometry.sampler(step);
        for filter in std::iter::once(&mut self.present).chain(alternatives) {
            filter.predict(|body| {
                let mut body = sample(body, rng);
                self.area.clamp(&mut body);
                body
            });
        }
        self.delta.add(step, &self.odometry);
        Ok(())
    }

    /// Learns from a frame; the joints report the camera at `mount` in the body frame. [Schulz & Fox 2004, IV]
    ///
    /// # Errors
    /// Returns an error if the image is not of the camera's size, the mount is not finite, or no particle explains the frame. The state is unchanged then.
    pub fn update<R: Rng + ?Sized>(
        &mut self,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<FrameOutcome, ColorModelError> {
        check_frame(&self.camera, image, mount)?;
        let scene = self.scene(&self.likelihood);
        let frame = PreparedFrame::new(&scene, image, mount, &self.light().colors()?)?;
        let light_before = self.present.light().unwrap_or(&self.prior).clone();
        let mut present = self.present.clone();
        self.step(&mut present, &frame, rng)?;

        let newest = BufferedFrame { image: image.clone(), mount: *mount, odometry: self.delta };
        let share =
            self.buffer.newest().map_or(1.0, |last| self.independent_share(last.view_change(&newest)));
        let mut relocalization = self.relocalization.clone();
        let log_evidence = present.weighing.log_evidence;
        self.test_alternatives(&mut relocalization, &frame, (share, log_evidence), rng)?;
        let mut buffer = self.buffer.clone();
        buffer.push(newest, self.params.search.n_buffered_frames);
        let is_certain = self.search_places(&buffer, &mut present, &mut relocalization, rng)?;
        let has_moved = relocalization.decide(&mut present);
        if has_moved {
            present.set_max_particles(self.params.max_particles);
        }
        self.since_search = if is_certain.is_some() { 0.0 } else { self.since_search + self.delta.seconds };
        let is_start = self.n_updates < self.params.search.n_buffered_frames;
        let confirmed = is_certain.filter(|is_certain| *is_certain || is_start);
        self.is_confirmed = !has_moved && confirmed.unwrap_or(self.is_confirmed);
        if has_moved && !is_start {
            self.start = StartPosePrior::Anywhere;
        }
        (self.present, self.relocalization, self.buffer) = (present, relocalization, buffer);
        self.remember_frame(light_before, share);
        self.outcome()
    }

    /// Counts the frame; keeps its light and its evidence for the map as long as the buffer keeps the frame.
    fn remember_frame(&mut self, light_before: Arc<SunAndShade<T>>, share: f64) {
        self.n_updates += 1;
        self.delta = OdometryDelta::default();
        self.log_ratios.push_back((self.present.weighing.mean_log_likelihood, share));
        self.lights.push_back(light_before);
        let n_old = self.log_ratios.len().saturating_sub(self.params.search.n_buffered_frames);
        self.log_ratios.drain(..n_old);
        self.lights.drain(..n_old);
    }

    /// One step of the particle filter of a place. [Schulz & Fox 2004, IV]
    pub(super) fn step<R: Rng + ?Sized>(
        &self,
        filter: &mut ColorFilter<SunAndShade<T>>,
        frame: &PreparedFrame<'_, L>,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        let seconds = self.delta.seconds;
        filter.predict_lighting(seconds)?; // Eq. 6
        filter.weigh(frame, seconds, &self.params, rng)?; // Eqs. 14–16
        let ancestors = filter.resample(rng)?;
        filter.update_lighting(&ancestors, &self.params) // Eqs. 3–5
    }

    /// Share of the evidence of a frame that is independent of the frame before, from which the view has turned by `angle`: what is not on the map, as another robot,
    /// stays in view until the camera has turned by its field of view, and is one error until then.
    fn independent_share(&self, angle: f64) -> f64 {
        let half = f64::from(self.camera.height()) / 2.0;
        let field_of_view = 2.0 * (half / self.camera.fy()).atan();
        (angle / field_of_view).min(1.0)
    }

    pub(super) fn scene<'a, K>(&'a self, likelihood: &'a K) -> Scene<'a, K> {
        Scene {
            map: &self.map,
            camera: self.camera,
            pixels: &self.params.pixels,
            likelihood,
            background: self.background.as_ref(),
            noise: self.prior.noise(),
        }
    }

    fn outcome(&self) -> Result<FrameOutcome, ColorModelError> {
        let weighing = &self.present.weighing;
        let alternative_probability = self.relocalization.probability();
        let estimate = self.present.estimate()?;
        let share = estimate.share * (1.0 - alternative_probability);
        let is_narrow = estimate.position_sigma() < PLACE_RADIUS && estimate.heading_sigma() < PLACE_RADIUS;
        let params = &self.params.search;
        // At even odds, the frames support the map at the estimate, one of all places, as much as the background.
        let odds = self.area.n_places() as f64 * TRACKING_PROBABILITY / (1.0 - TRACKING_PROBABILITY);
        let mean =
            self.log_ratios.iter().map(|(log, _)| log).sum::<f64>() / self.log_ratios.len().max(1) as f64;
        let n_independent = self.log_ratios.iter().map(|(_, share)| share).sum::<f64>().max(1.0);
        let is_explained = n_independent * mean > odds.ln();
        let is_confirmed =
            self.is_confirmed || params.samples_per_place == 0.0 || self.params.relocalization.is_off();
        let status = match (self.n_updates >= params.n_buffered_frames, is_explained) {
            (true, false) => LocalizationStatus::Lost,
            (true, true) if share > TRACKING_PROBABILITY && is_narrow && is_confirmed => {
                LocalizationStatus::Tracking
            }
            _ => LocalizationStatus::Ambiguous,
        };
        Ok(FrameOutcome {
            status,
            estimate: PoseEstimate { share, ..estimate },
            tempering: weighing.tempering,
            effective_particles: weighing.effective_particles,
            n_particles: self.present.n_particles(),
            n_hypotheses: 1 + self.relocalization.alternatives().len(),
            alternative_probability,
            light_probabilities: weighing.light_probabilities[..self.prior.sun.n_lights()].to_vec(),
        })
    }
}
