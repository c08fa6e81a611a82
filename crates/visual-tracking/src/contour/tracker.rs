use rand::Rng;

use super::ColorContourTrackerParams;
use super::follow::Found;
use super::history::History;
use super::hypotheses::candidate::Candidate;
use super::hypotheses::samples::Samples;
use super::reference::Reference;
use crate::error::check_size;
use crate::{
    AffineSnake, ColorDynamics, ColorQuantizer, Outline, PrincipalColors, RgbImage, TargetEstimate,
    TrackStatus, Tracker, TrackingError,
};

/// Tracks a target by its colours, which change, and its contour, which moves by affine maps: CONDENSATION in colour space, validated by
/// the contour. [Andrade-Cetto 2005, Sec. 3.3, Figs. 10, 13]
///
/// Every sample is a hypothesis about the colours. It warps the colours of the last image, selects their bins, segments the image and fits an
/// affine snake to the target's blob. Its weight is the agreement with the previous contour and area. The best hypothesis is refined on the image
/// edges; its interior is the reference for the next image.
///
/// If the target is not recognized at the expected position, the whole image is searched. The status is [`TrackStatus::Lost`] if the search
/// finds no blob of its shape and similar colours; the tracker does not learn from such an image.
/// ```
/// use rand::SeedableRng;
/// use wayfix_visual_tracking::{BoundingBox, ColorContourTracker, ColorContourTrackerParams, RgbImage, Tracker, TrackStatus};
/// let disk = |u: f64, color: [u8; 3]| {
///     let inside = |i: usize| (i as f64 % 80.0 - u).hypot((i / 80) as f64 - 30.0) < 12.0;
///     let bytes = (0..80 * 60).flat_map(|i| if inside(i) { color } else { [90, 120, 90] }).collect();
///     RgbImage::from_raw(80, 60, bytes).expect("3 bytes a pixel")
/// };
/// let first = disk(30.0, [200, 60, 60]);
/// let start = BoundingBox::from_corner(18.0, 18.0, 24.0, 24.0)?;
/// let mut tracker = ColorContourTracker::from_box(&first, &start, ColorContourTrackerParams::default())?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let target = tracker.track(&disk(33.0, [190, 62, 64]), &mut rng)?;
/// assert_eq!(target.status, TrackStatus::Tracked);
/// assert!(target.bounding_box.iou(&BoundingBox::from_corner(21.5, 18.5, 24.0, 24.0)?) > 0.8);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColorContourTracker {
    pub(super) params: ColorContourTrackerParams,
    pub(super) quantizer: ColorQuantizer,
    pub(super) dynamics: ColorDynamics,
    pub(super) size: (usize, usize),
    pub(super) reference: Reference,
    pub(super) history: History,
    pub(super) samples: Samples,
    pub(super) status: TrackStatus,
}

impl ColorContourTracker {
    /// The same with custom dynamics of the colours, for example learned ones ([`ColorDynamics::learn`]).
    #[must_use]
    pub fn with_dynamics(self, dynamics: ColorDynamics) -> Self {
        Self { dynamics, ..self }
    }

    /// The last observed parameters of the target's colours, $`\mathbf m`$, $`\boldsymbol λ`$ and the axes: the path of Fig. 13.
    pub fn colors(&self) -> &PrincipalColors {
        &self.reference.colors
    }

    /// The contour as it was seen last.
    pub fn snake(&self) -> &AffineSnake {
        &self.reference.snake
    }

    /// The target is where it was found.
    fn accept(&mut self, found: Found) -> Result<TargetEstimate, TrackingError> {
        let mut reference = self.reference.clone();
        let mut samples = found.samples;
        let Candidate { map, area, .. } = found.candidate;
        if self.status == TrackStatus::Lost || found.regrown {
            reference.jump_to(&map, area)?;
        } else {
            reference.move_to(&map, area)?;
        }
        if let Some(cloud) = found.cloud {
            let before = reference.colors;
            reference.colors = cloud.principal(Some(&before))?;
            let (memory, now) = (self.params.previous_colors_weight, &reference.colors);
            reference.cloud = cloud.with_memory_of(
                &reference.cloud,
                [&before, now],
                memory,
                self.params.max_color_points,
            )?;
            samples.measure(&before, &reference.colors);
        }
        let outline = found.outline.unwrap_or_else(|| reference.snake.outline());
        self.history.push(&reference);
        (self.reference, self.samples, self.status) = (reference, samples, TrackStatus::Tracked);
        Ok(target(&outline, TrackStatus::Tracked, found.quality))
    }

    /// Searches the whole image for a target that is not at its expected position.
    fn look_again<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        here: Option<Found>,
        rng: &mut R,
    ) -> Result<TargetEstimate, TrackingError> {
        let outline = self.reference.snake.outline();
        // Excludes the candidate that was just rejected.
        let here = here.filter(|_| self.status == TrackStatus::Lost);
        self.miss()?;
        let quality = |found: &Option<Found>| found.as_ref().map_or(0.0, |found| found.quality);
        let mut best = here;
        if quality(&best) < self.params.found_above_quality {
            let elsewhere = self.search(picture, rng)?;
            if quality(&elsewhere) > quality(&best) {
                best = elsewhere;
            }
        }
        match best {
            Some(found) if found.quality >= self.params.found_above_quality => self.accept(found),
            best => {
                self.samples.drift(&self.dynamics, rng);
                Ok(target(&outline, TrackStatus::Lost, quality(&best)))
            }
        }
    }

    /// Takes the target as it was before it began to vanish.
    fn miss(&mut self) -> Result<(), TrackingError> {
        if self.status == TrackStatus::Tracked {
            let before = self.history.restart().left_at(&self.reference);
            self.samples = Samples::at_start(&before.colors, self.params.n_samples)?;
            (self.reference, self.status) = (before, TrackStatus::Lost);
        }
        Ok(())
    }
}

impl Tracker for ColorContourTracker {
    /// One step of CONDENSATION.
    ///
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if image and first image differ in size.
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        rng: &mut R,
    ) -> Result<TargetEstimate, TrackingError> {
        check_size("width of the picture", self.size.0, picture.width() as usize)?;
        check_size("height of the picture", self.size.1, picture.height() as usize)?;
        match self.follow(picture, rng)? {
            Some(found)
                if self.status == TrackStatus::Tracked && found.quality >= self.params.lost_below_quality =>
            {
                self.accept(found)
            }
            found => {
                let mut next = self.clone();
                let target = next.look_again(picture, found, rng)?;
                *self = next;
                Ok(target)
            }
        }
    }
}

fn target(outline: &Outline, status: TrackStatus, quality: f64) -> TargetEstimate {
    TargetEstimate {
        bounding_box: outline.bounding_box(),
        outline: outline.points().to_vec(),
        status,
        quality,
    }
}
