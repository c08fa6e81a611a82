use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::{LampSetting, LeagueDrive, LeagueParams, LeaguePicture, LeagueVenue, LinearRgb, N_COLORS, yuv};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, check};

/// Statistics of the map colours in labelled images of one venue under one light.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainingVenue {
    /// Its name; the two lights of one hall share the number.
    pub name: String,
    /// The lamps that are on.
    pub lighting: LampSetting,
    /// Colour means of each image.
    pub images: Vec<ColorMeans>,
    /// Variance of Y, U and V of the pixels of one colour in one picture, pooled over colours and pictures by their degrees of freedom.
    pub pixel_variance: [f64; 3],
    /// Those degrees of freedom.
    pub degrees_of_freedom: f64,
}

/// The mean colours of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMeans {
    /// Mean Y, U, V (BT.601 in full range, U and V about 128) of each map colour; `None` where too little is in view.
    pub means: [Option<[f64; 3]>; N_COLORS],
    /// Number of pixels of each colour.
    pub counts: [usize; N_COLORS],
}

/// Parameters of the training venues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrainingVenuesParams {
    /// Number of halls, each seen under both lights. Default 22, which makes 44 sets of pictures.
    pub n_halls: usize,
    /// Pictures of each under each light. Default 8.
    pub n_images_per_light: usize,
    /// Fewest pixels of a colour that make a mean. Default 30.
    pub min_pixels: usize,
}

impl Default for TrainingVenuesParams {
    fn default() -> Self {
        Self { n_halls: 22, n_images_per_light: 8, min_pixels: 30 }
    }
}

/// Time between images, ms, long enough to change the view.
const PERIOD_MS: u32 = 2500;

impl TrainingVenuesParams {
    /// Draws halls, simulates walks through them and takes images: first the dark sets, then the bright ones.
    ///
    /// A logged venue must not be one of these: draw it from another seed.
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::league::TrainingVenuesParams;
    /// let params = TrainingVenuesParams { n_halls: 2, n_images_per_light: 3, ..TrainingVenuesParams::default() };
    /// let sets = params.gather(ChaCha8Rng::seed_from_u64(1))?;
    /// assert_eq!(sets.len(), 4);
    /// assert!(sets.iter().flat_map(|set| &set.images).any(|image| image.means[0].is_some()), "some carpet");
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if there is to be too much of anything.
    pub fn gather(&self, mut rng: ChaCha8Rng) -> Result<Vec<TrainingVenue>, SimulationError> {
        check::count("halls", self.n_halls, 10_000)?;
        check::count("pictures", self.n_images_per_light, 10_000)?;
        let mut sets = Vec::new();
        let seeds: Vec<[u64; 2]> = (0..self.n_halls).map(|_| [rng.next_u64(), rng.next_u64()]).collect();
        for lighting in [LampSetting::Dark, LampSetting::Bright] {
            for (hall, seeds) in seeds.iter().enumerate() {
                let seed = seeds[usize::from(lighting == LampSetting::Bright)];
                sets.push(self.set(hall, lighting, seeds[0], seed)?);
            }
        }
        Ok(sets)
    }

    fn set(
        &self,
        hall: usize,
        lighting: LampSetting,
        venue_seed: u64,
        seed: u64,
    ) -> Result<TrainingVenue, SimulationError> {
        let streams = |seed| RandomStreams::new(ChaCha8Rng::seed_from_u64(seed));
        let venue = LeagueVenue::draw(streams(venue_seed).of(RandomStreamPurpose::Venue))?;
        let params = LeagueParams {
            n_frames: self.n_images_per_light,
            period_ms: PERIOD_MS,
            lamp_settings: vec![(0, lighting)],
            ..LeagueParams::default()
        };
        let mut pooled = Pooled::default();
        let mut images = Vec::new();
        for frame in LeagueDrive::in_venue(&params, venue, streams(seed))? {
            images.push(self.means(&frame.picture, &mut pooled));
        }
        let light = if lighting == LampSetting::Dark { "dark" } else { "bright" };
        Ok(TrainingVenue {
            name: format!("hall {hall:02} {light}"),
            lighting,
            images,
            pixel_variance: pooled.variance().into(),
            degrees_of_freedom: pooled.degrees_of_freedom,
        })
    }

    fn means(&self, picture: &LeaguePicture, pooled: &mut Pooled) -> ColorMeans {
        let mut sums = [Moments::default(); N_COLORS];
        for (pixel, &label) in picture.rgb.chunks_exact(3).zip(&picture.labels) {
            if let Some(sum) = usize::from(label).checked_sub(1).and_then(|color| sums.get_mut(color)) {
                sum.add(pixel);
            }
        }
        let seen = |sum: &Moments| sum.count >= self.min_pixels.max(2);
        sums.iter().filter(|sum| seen(sum)).for_each(|sum| pooled.add(sum));
        ColorMeans {
            means: sums
                .map(|sum| seen(&sum).then(|| (sum.mean() + LinearRgb::new(0.0, 128.0, 128.0)).into())),
            counts: sums.map(|sum| sum.count),
        }
    }
}

/// Count, sum and sum of squares of the pixels of one colour.
#[derive(Clone, Copy, Default)]
struct Moments {
    count: usize,
    sum: LinearRgb,
    squares: LinearRgb,
}

impl Moments {
    fn add(&mut self, rgb: &[u8]) {
        let yuv = yuv::from_rgb(&LinearRgb::from_iterator(rgb.iter().map(|&byte| f64::from(byte))));
        self.count += 1;
        self.sum += yuv;
        self.squares += yuv.component_mul(&yuv);
    }

    fn mean(&self) -> LinearRgb {
        self.sum / self.count as f64
    }
}

#[derive(Default)]
struct Pooled {
    squares: LinearRgb,
    degrees_of_freedom: f64,
}

impl Pooled {
    fn add(&mut self, sum: &Moments) {
        self.squares += sum.squares - sum.mean().component_mul(&sum.sum);
        self.degrees_of_freedom += (sum.count - 1) as f64;
    }

    fn variance(&self) -> LinearRgb {
        self.squares / self.degrees_of_freedom.max(1.0)
    }
}
