use std::{collections::VecDeque, sync::Arc};

use rand::Rng;
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_estimation_traits::{Pose2, Pose3};
use wayfix_integrity::RelocalizationTest;

use super::{
    FrameOutcome, LocalizationStatus, LocalizerParams, OdometryModel, OdometryNoise, OdometryStep,
    PoseEstimate, StartPosePrior,
    buffer::{BufferedFrame, FrameBuffer},
    camera::{CameraLocation, CameraPoseError},
    estimate::PLACE_RADIUS,
    filter::ColorFilter,
    frame::{PreparedFrame, Scene, check_frame},
    robot_camera::RobotCamera,
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
/// After 1, 4 and 16 frames, and then every few seconds, a global search proposes places; [`RelocalizationTest`] decides between them and the present one.
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
    /// The first camera, and others.
    pub(super) cameras: Vec<RobotCamera>,
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
    buffer: FrameBuffer,
    /// The light of the most probable place before each frame of the buffer, the oldest first.
    pub(super) lights: VecDeque<Arc<SunAndShade<T>>>,
    pub(super) n_updates: usize,
    /// Since the last search, s.
    pub(super) since_search: f64,
    /// Whether a search was certain of the present place: the last one of the start, or one later.
    is_confirmed: bool,
}

/// The tracked places after a frame.
struct PlacesAfterFrame<T> {
    present: ColorFilter<SunAndShade<T>>,
    relocalization: RelocalizationTest<ColorFilter<SunAndShade<T>>>,
    /// Share of the evidence of the frame that is independent of the frame before.
    share: f64,
}

/// The models of a [`ColorLocalizer`].
/// ```
/// # use {nalgebra::*, rand::SeedableRng, wayfix_color_map::*, wayfix_color_model::*, wayfix_gaussian_core::Gaussian};
/// # let (start, params, mut rng) = (StartPosePrior::Anywhere, LocalizerParams::default(), rand_chacha::ChaCha8Rng::seed_from_u64(1));
/// let light = LightingFilter::new(Gaussian::new(DVector::repeat(3, 128.0), DMatrix::identity(3, 3))?, Default::default())?; // of one colour
/// let models = ColorLocalizerModels { light, odometry: OdometryNoise::default(), likelihood: FeatureLikelihoodParams::default() };
/// let (map, camera) = (ColorMap::new(vec!["green".into(), "white".into()], vec![])?, PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?);
/// assert!(matches!(ColorLocalizer::with_models(map.into(), camera, models, &start, params, &mut rng), Err(ColorModelError::Dimension { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
        if let Some(withheld) = params.withheld_color.filter(|withheld| *withheld >= expected) {
            return Err(ColorModelError::OutOfRange { what: "withheld color", value: withheld as f64 });
        }
        if light.n_lights() == 0 {
            return Err(ColorModelError::OutOfRange { what: "number of lights", value: 0.0 });
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
            cameras: vec![RobotCamera::new(camera)],
            area,
            background: None,
            params,
            odometry,
            likelihood,
            start: start.clone(),
            prior,
            buffer: FrameBuffer::default(),
            lights: VecDeque::new(),
            n_updates: 0,
            since_search: 0.0,
            is_confirmed: false,
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

    /// Adds a camera that [`update_from`](Self::update_from) takes the frames of, and returns its number. It has a light of its own, since cameras differ in exposure
    /// and white balance. The errors of cameras are taken as independent: they should look in different directions. The search for places uses the first camera alone.
    pub fn add_camera(&mut self, camera: PinholeCamera) -> usize {
        self.cameras.push(RobotCamera::new(camera));
        self.cameras.len() - 1
    }

    /// The light of the heaviest particle, in the first camera.
    pub fn light(&self) -> &T {
        &self.light_in(0).sun
    }

    fn light_in(&self, camera: usize) -> &Arc<SunAndShade<T>> {
        self.present.light(camera).unwrap_or(&self.prior)
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
        self.cameras.iter_mut().for_each(|camera| camera.delta.add(step, &self.odometry));
        Ok(())
    }

    /// Learns from a frame of the first camera; the joints report the camera at `mount` in the body frame. [Schulz & Fox 2004, IV]
    ///
    /// # Errors
    /// Returns an error if the image is not of the camera's size, the mount is not finite, or no particle explains the frame. The state is unchanged then.
    pub fn update<R: Rng + ?Sized>(
        &mut self,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<FrameOutcome, ColorModelError> {
        let light_before = self.light_in(0).clone();
        let PlacesAfterFrame { mut present, mut relocalization, share } =
            self.weigh_places(0, image, mount, rng)?;
        let odometry = self.cameras[0].delta;
        let newest = BufferedFrame { image: image.clone(), mount: *mount, odometry };
        let mut buffer = self.buffer.clone();
        buffer.push(newest, self.params.search.n_buffered_frames);
        let is_certain = self.search_places(&buffer, &mut present, &mut relocalization, rng)?;
        self.since_search = if is_certain.is_some() { 0.0 } else { self.since_search + odometry.seconds };
        let is_start = self.n_updates < self.params.search.n_buffered_frames;
        if let Some(is_certain) = is_certain.filter(|is_certain| *is_certain || is_start) {
            self.is_confirmed = is_certain;
        }
        self.choose_place(0, mount, PlacesAfterFrame { present, relocalization, share });
        self.buffer = buffer;
        self.n_updates += 1;
        self.lights.push_back(light_before);
        self.lights.drain(..self.lights.len().saturating_sub(self.params.search.n_buffered_frames));
        self.outcome()
    }

    /// [`update`](Self::update) from a frame of the camera of this number. A frame of an added camera weighs the places that are tracked; it starts no search.
    /// Once the first camera is silent for longer than the interval of searches, no place is [`Tracking`](LocalizationStatus::Tracking) until a search confirms it. The light in
    /// the outcome is that of this camera.
    ///
    /// # Errors
    /// As for [`update`](Self::update), or an error if there is no such camera.
    pub fn update_from<R: Rng + ?Sized>(
        &mut self,
        camera: usize,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<FrameOutcome, ColorModelError> {
        if camera >= self.cameras.len() {
            return Err(ColorModelError::OutOfRange { what: "number of a camera", value: camera as f64 });
        }
        if camera == 0 {
            return self.update(image, mount, rng);
        }
        let places = self.weigh_places(camera, image, mount, rng)?;
        // A search was due, and the first camera has shown nothing for it.
        self.is_confirmed &= self.cameras[0].delta.seconds <= self.params.search.search_interval;
        self.choose_place(camera, mount, places);
        self.outcome()
    }

    /// Weighs the particles of all places by a frame.
    fn weigh_places<R: Rng + ?Sized>(
        &self,
        camera: usize,
        image: &YuvImage,
        mount: &Pose3<f64>,
        rng: &mut R,
    ) -> Result<PlacesAfterFrame<T>, ColorModelError> {
        check_frame(&self.cameras[camera].model, image, mount)?;
        let scene = self.scene(camera, &self.likelihood);
        let frame = PreparedFrame::new(&scene, image, mount, &self.light_in(camera).sun.colors()?)?;
        let (mut present, mut relocalization) = (self.present.clone(), self.relocalization.clone());
        self.step(&mut present, &frame, rng)?;
        let share = self.cameras[camera].independent_share(mount);
        let log_evidence = present.weighing.log_evidence;
        self.test_alternatives(&mut relocalization, &frame, (share, log_evidence), rng)?;
        Ok(PlacesAfterFrame { present, relocalization, share })
    }

    /// The most probable place after a frame becomes the present one.
    fn choose_place(&mut self, camera: usize, mount: &Pose3<f64>, places: PlacesAfterFrame<T>) {
        let PlacesAfterFrame { mut present, mut relocalization, share } = places;
        let n_frames = self.params.search.n_buffered_frames;
        if relocalization.decide(&mut present) {
            present.set_max_particles(self.params.max_particles);
            self.is_confirmed = false;
            if self.n_updates >= n_frames {
                self.start = StartPosePrior::Anywhere;
            }
        }
        (self.present, self.relocalization) = (present, relocalization);
        let log_ratio = self.present.weighing.mean_log_likelihood;
        self.cameras[camera].remember(mount, (log_ratio, share), n_frames);
    }

    /// One step of the particle filter of a place. After an error the filter is not usable. [Schulz & Fox 2004, IV]
    pub(super) fn step<R: Rng + ?Sized>(
        &self,
        filter: &mut ColorFilter<SunAndShade<T>>,
        frame: &PreparedFrame<'_, L>,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        let seconds = self.cameras[frame.camera()].delta.seconds;
        filter.swap_camera(frame.camera(), &self.prior, || self.params.camera_pose_noise.sample(rng));
        filter.predict_lighting(seconds)?; // Eq. 6
        filter.weigh(frame, seconds, &self.params, rng)?; // Eqs. 14–16
        let ancestors = filter.resample(rng)?;
        filter.update_lighting(&ancestors, &self.params)?; // Eqs. 3–5
        filter.swap_camera(frame.camera(), &self.prior, CameraPoseError::default);
        Ok(())
    }

    pub(super) fn scene<'a, K>(&'a self, camera: usize, likelihood: &'a K) -> Scene<'a, K> {
        Scene {
            map: &self.map,
            camera: self.cameras[camera].model,
            camera_number: camera,
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
        // A hidden camera gives no evidence, nor does one that is silent.
        let is_seeing = |camera: &&RobotCamera| camera.delta.seconds <= params.search_interval;
        let support = |camera: &RobotCamera| camera.log_support().max(0.0);
        let is_explained = self.cameras.iter().filter(is_seeing).map(support).sum::<f64>() > odds.ln();
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
