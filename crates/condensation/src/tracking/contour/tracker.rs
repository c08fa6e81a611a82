use rand::Rng;

use super::candidate::Candidate;
use super::each::map_each;
use super::history::History;
use super::reference::Reference;
use super::samples::Samples;
use super::scene::Scene;
use super::start::{outline_in_box, outline_of_mask};
use super::{ContourTrackerParams, TrackingCues};
use crate::error::check_size;
use crate::{
    AffineSnake, BinSet, BitMask, BoundingBox, ColorDynamics, ColorQuantizer, ColorState, CondensationError,
    Outline, Picture, PrincipalColors, Target, TrackStatus, Tracker,
};

/// Follows a target by its colours, which change, and its contour, which moves only by affine maps: CONDENSATION in colour space,
/// validated by the contour. [Andrade-Cetto & Sanfeliu, section 3.3]
///
/// Every sample is a hypothesis about the colours. It warps the colours of the last picture, switches on the bins they fall into,
/// segments the picture, lays an affine snake on the blob of the target and is weighed by how well that agrees with the contour and the
/// area of before. The best one is refined on the edges of the picture; what lies inside is the reference for the next picture.
///
/// A target that is out of the picture, hidden or not recognized is [`TrackStatus::Lost`]; nothing is learned from such a picture, and the
/// whole of it is searched until the target is found again.
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_condensation::{BoundingBox, ContourTracker, ContourTrackerParams, Picture, Tracker, TrackStatus};
/// let disk = |u: f64, color: [u8; 3]| {
///     let inside = |i: usize| (i as f64 % 80.0 - u).hypot((i / 80) as f64 - 30.0) < 12.0;
///     let bytes = (0..80 * 60).flat_map(|i| if inside(i) { color } else { [90, 120, 90] }).collect();
///     Picture::from_rgb(80, 60, bytes)
/// };
/// let first = disk(30.0, [200, 60, 60])?;
/// let start = BoundingBox::from_corner(18.0, 18.0, 24.0, 24.0)?;
/// let mut tracker = ContourTracker::from_box(&first, &start, ContourTrackerParams::default())?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let target = tracker.track(&disk(33.0, [190, 62, 64])?, &mut rng)?;
/// assert_eq!(target.status, TrackStatus::Tracked);
/// assert!(target.bounding_box.iou(&BoundingBox::from_corner(21.5, 18.5, 24.0, 24.0)?) > 0.8);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContourTracker {
    params: ContourTrackerParams,
    quantizer: ColorQuantizer,
    dynamics: ColorDynamics,
    size: (usize, usize),
    reference: Reference,
    history: History,
    samples: Samples,
    status: TrackStatus,
}

impl ContourTracker {
    /// Starts from an outline in the first picture.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] for parameters out of range, [`CondensationError::Empty`] when no pixel of the picture is inside.
    pub fn from_outline(
        picture: &Picture,
        outline: &Outline,
        params: ContourTrackerParams,
    ) -> Result<Self, CondensationError> {
        params.validate()?;
        let quantizer = ColorQuantizer::new(params.color_space, params.bins)?;
        let dynamics = ColorDynamics::constant_velocity(params.damping, &params.noise())?;
        let snake = AffineSnake::new(outline, &params.snake)?;
        let size = (picture.width(), picture.height());
        let inside = BitMask::from_polygon(size.0, size.1, outline.points())?;
        let n_colors = params.max_colors;
        let cloud = crate::ColorCloud::from_colors(
            picture
                .pixels()
                .iter()
                .enumerate()
                .filter(|(i, _)| inside.get(i % size.0, i / size.0))
                .map(|(_, pixel)| params.color_space.convert(*pixel)),
            n_colors,
        )?;
        let reference = Reference::at_start(cloud, snake)?;
        let samples = Samples::at_start(&reference.colors, params.n_samples)?;
        let (history, status) = (History::at_start(&reference), TrackStatus::Tracked);
        Ok(Self { params, quantizer, dynamics, size, reference, history, samples, status })
    }

    /// Starts from a mask of the first picture, the largest blob in it.
    ///
    /// # Errors
    /// As [`from_outline`](Self::from_outline), and [`CondensationError::Dimension`] when the mask is not as large as the picture.
    pub fn from_mask(
        picture: &Picture,
        mask: &BitMask,
        params: ContourTrackerParams,
    ) -> Result<Self, CondensationError> {
        check_size("width of the mask", picture.width(), mask.width())?;
        check_size("height of the mask", picture.height(), mask.height())?;
        Self::from_outline(picture, &outline_of_mask(mask)?, params)
    }

    /// Starts from a box in the first picture. The outline is that of the blob in it whose colours are more frequent in the box than round
    /// it; where that does not fill the box, the ellipse that does.
    ///
    /// # Errors
    /// As [`from_outline`](Self::from_outline).
    pub fn from_box(
        picture: &Picture,
        bounds: &BoundingBox,
        params: ContourTrackerParams,
    ) -> Result<Self, CondensationError> {
        let quantizer = ColorQuantizer::new(params.color_space, params.bins)?;
        Self::from_outline(picture, &outline_in_box(picture, &quantizer, bounds)?, params)
    }

    /// The same with dynamics of the colours of one's own, learned ([`ColorDynamics::learn`]) for instance.
    #[must_use]
    pub fn with_dynamics(self, dynamics: ColorDynamics) -> Self {
        Self { dynamics, ..self }
    }

    /// The parameters of the target's colours, $`\mathbf m`$, $`\boldsymbol λ`$ and the axes, as they were seen last: the path of Fig. 13.
    pub fn colors(&self) -> &PrincipalColors {
        &self.reference.colors
    }

    /// The contour as it was seen last.
    pub fn snake(&self) -> &AffineSnake {
        &self.reference.snake
    }

    /// Round the place where the target is expected.
    fn follow<R: Rng + ?Sized>(
        &self,
        picture: &Picture,
        rng: &mut R,
    ) -> Result<Option<Found>, CondensationError> {
        let scene = Scene::around_target(&self.params, &self.quantizer, picture, &self.reference)?;
        let Some(scene) = scene else { return Ok(None) };
        if self.params.cues == TrackingCues::Shape {
            let candidate = Candidate::of_edges(&scene);
            let quality = candidate.agreement.score(&self.params);
            return Ok(Some(Found {
                candidate,
                quality,
                outline: None,
                cloud: None,
                samples: self.samples.clone(),
            }));
        }
        let states = self.hypotheses(rng)?;
        let candidates = map_each(&states, |state| Candidate::of_colors(&scene, state));
        let log_weights: Vec<f64> =
            candidates.iter().map(|candidate| candidate.agreement.log_weight(&self.params)).collect();
        let best = first_max(&log_weights);
        let set = scene.bin_set(&states[best]);
        let samples = self.samples.weighed(states, log_weights)?;
        let Some(mask) = scene.target_mask(&set) else { return Ok(None) };
        self.finish(&scene, candidates[best], &set, &mask, samples).map(Some)
    }

    /// In the whole picture.
    fn search<R: Rng + ?Sized>(
        &self,
        picture: &Picture,
        rng: &mut R,
    ) -> Result<Option<Found>, CondensationError> {
        if self.params.cues == TrackingCues::Shape {
            return Ok(None);
        }
        let scene = Scene::whole(&self.params, &self.quantizer, picture, &self.reference)?;
        let states = self.hypotheses(rng)?;
        let stride = states.len().div_ceil(self.params.n_search_samples);
        let states: Vec<ColorState> = states.into_iter().step_by(stride).collect();
        let found = map_each(&states, |state| scene.find(state));
        let better = |best: usize, i: usize| {
            let score = |i: usize| found[i].as_ref().map_or(0.0, |(candidate, _)| scene.score(candidate));
            if score(i) > score(best) { i } else { best }
        };
        let best = (0..found.len()).fold(0, better);
        let Some(Some((candidate, mask))) = found.get(best) else { return Ok(None) };
        let set = scene.bin_set(&states[best]);
        self.finish(&scene, *candidate, &set, mask, self.samples.clone()).map(Some)
    }

    /// What the next picture shall be compared with.
    fn finish(
        &self,
        scene: &Scene<'_>,
        candidate: Candidate,
        set: &BinSet,
        mask: &BitMask,
        samples: Samples,
    ) -> Result<Found, CondensationError> {
        let quality = scene.confidence(&candidate, mask)?;
        let candidate = candidate.refined(scene, mask);
        let cloud = if self.params.adapts { scene.colors_of(&candidate, set, mask)? } else { None };
        let blob_outline = || Outline::of_mask(mask, scene.region.rect.corner());
        let outline = if self.params.cues == TrackingCues::Color { blob_outline() } else { None };
        Ok(Found { candidate, quality, outline, cloud, samples })
    }

    fn hypotheses<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<ColorState>, CondensationError> {
        if self.params.adapts {
            return self.samples.predicted(&self.dynamics, &self.params, rng);
        }
        Ok(vec![ColorState::at_rest(&self.reference.colors)])
    }

    /// The target is where it was found.
    fn accept(&mut self, found: Found) -> Result<Target, CondensationError> {
        let mut reference = self.reference.clone();
        let mut samples = found.samples;
        let Candidate { map, area, .. } = found.candidate;
        match self.status {
            TrackStatus::Tracked => reference.move_to(&map, area)?,
            TrackStatus::Lost => reference.jump_to(&map, area)?,
        }
        if let Some(cloud) = found.cloud {
            let before = reference.colors;
            reference.colors = cloud.principal(Some(&before))?;
            let (memory, now) = (self.params.color_memory, &reference.colors);
            reference.cloud =
                cloud.with_memory_of(&reference.cloud, [&before, now], memory, self.params.max_colors)?;
            samples.measure(&before, &reference.colors);
        }
        let outline = found.outline.unwrap_or_else(|| reference.snake.outline());
        self.history.push(&reference);
        (self.reference, self.samples, self.status) = (reference, samples, TrackStatus::Tracked);
        Ok(Target {
            bounding_box: outline.bounding_box(),
            outline: outline.points().to_vec(),
            status: TrackStatus::Tracked,
            quality: found.quality,
        })
    }

    /// The target is not to be seen: it is looked for as it was before it began to vanish, in colours that may have changed by as much as the
    /// dynamics allow.
    fn lose<R: Rng + ?Sized>(&mut self, quality: f64, rng: &mut R) -> Result<Target, CondensationError> {
        let outline = self.reference.snake.outline();
        if self.status == TrackStatus::Tracked {
            let before = self.history.restart().left_at(&self.reference);
            self.samples = Samples::at_start(&before.colors, self.params.n_samples)?;
            self.reference = before;
        }
        self.samples.drift(&self.dynamics, rng);
        self.status = TrackStatus::Lost;
        Ok(Target {
            bounding_box: outline.bounding_box(),
            outline: outline.points().to_vec(),
            status: TrackStatus::Lost,
            quality,
        })
    }
}

impl Tracker for ContourTracker {
    /// One step of CONDENSATION.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the picture is not as large as the first one.
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &Picture,
        rng: &mut R,
    ) -> Result<Target, CondensationError> {
        check_size("width of the picture", self.size.0, picture.width())?;
        check_size("height of the picture", self.size.1, picture.height())?;
        let least = match self.status {
            TrackStatus::Tracked => self.params.lost_below,
            TrackStatus::Lost => self.params.found_above,
        };
        let quality = |found: &Option<Found>| found.as_ref().map_or(0.0, |found| found.quality);
        let mut found = self.follow(picture, rng)?;
        if self.status == TrackStatus::Lost && quality(&found) < least {
            let elsewhere = self.search(picture, rng)?;
            if quality(&elsewhere) > quality(&found) {
                found = elsewhere;
            }
        }
        match found {
            Some(found) if found.quality >= least => self.accept(found),
            found => self.lose(quality(&found), rng),
        }
    }
}

/// Where the target was found, and what is to be learned from it.
struct Found {
    candidate: Candidate,
    quality: f64,
    /// Where it is not the snake that says.
    outline: Option<Outline>,
    cloud: Option<crate::ColorCloud>,
    samples: Samples,
}

fn first_max(values: &[f64]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}
