//! Simulated training venues, and the priors learned from them.

use anyhow::{Result, ensure};
use nalgebra::Vector3;
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use wayfix_color_model::{LabelledPixels, LightingPriors, PriorLearningParams, TrainingVenue, learn_priors};
use wayfix_scene_sim::{
    league::{
        COLOR_NAMES, ExposureMode, LampSetting, LeagueDrive, LeagueParams, LeaguePicture, LeagueVenue,
        N_COLORS,
    },
    random::{RandomStreamPurpose, RandomStreams},
};

/// Seed of the training venues; no log uses it.
const SEED: u64 = 2004;
/// Time between images, ms, long enough to change the view.
const PERIOD_MS: u32 = 2500;

/// Simulated halls with labelled images, each under both lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrainingHalls {
    /// Number of halls. Default 22, which makes 44 venues.
    pub n_halls: usize,
    /// Images of each under each light. Default 8.
    pub n_images: usize,
    /// Fewest pixels of a colour that make a mean. Default 30.
    pub min_pixels: u64,
    /// As in [`LeagueParams`]. Default [`ExposureMode::Manual`].
    pub exposure_mode: ExposureMode,
    /// As in [`LeagueParams`]. Default 1.
    pub paint_chroma: f64,
}

impl Default for TrainingHalls {
    fn default() -> Self {
        let LeagueParams { exposure_mode, paint_chroma, .. } = LeagueParams::default();
        Self { n_halls: 22, n_images: 8, min_pixels: 30, exposure_mode, paint_chroma }
    }
}

impl TrainingHalls {
    /// Learns `k` priors, darkest first. The built-in priors were made with `k` = 2 and the defaults.
    ///
    /// # Errors
    /// Returns an error if learning fails.
    pub(crate) fn learn_priors(&self, k: usize) -> Result<LightingPriors> {
        let venues: Vec<TrainingVenue> =
            self.gather(ChaCha8Rng::seed_from_u64(SEED))?.into_iter().map(|(_, venue)| venue).collect();
        let colors = COLOR_NAMES.map(str::to_owned);
        let mut rng = ChaCha8Rng::seed_from_u64(SEED + 1);
        Ok(learn_priors(&colors, &venues, k, &PriorLearningParams::default(), &mut rng)?)
    }

    /// Draws halls, simulates walks through them and takes images: first the dark venues, then the bright ones.
    ///
    /// # Errors
    /// Returns an error if there are no images, or a parameter is out of range.
    pub(crate) fn gather(&self, mut rng: ChaCha8Rng) -> Result<Vec<(LampSetting, TrainingVenue)>> {
        ensure!(self.n_halls > 0 && self.n_images > 0, "no images of training halls");
        let mut venues = Vec::new();
        let seeds: Vec<[u64; 2]> = (0..self.n_halls).map(|_| [rng.next_u64(), rng.next_u64()]).collect();
        for lighting in [LampSetting::Dark, LampSetting::Bright] {
            for (hall, seeds) in seeds.iter().enumerate() {
                let seed = seeds[usize::from(lighting == LampSetting::Bright)];
                venues.push((lighting, self.venue(hall, lighting, seeds[0], seed)?));
            }
        }
        Ok(venues)
    }

    fn venue(&self, hall: usize, lighting: LampSetting, venue_seed: u64, seed: u64) -> Result<TrainingVenue> {
        let streams = |seed| RandomStreams::new(ChaCha8Rng::seed_from_u64(seed));
        let venue = LeagueVenue::draw(streams(venue_seed).of(RandomStreamPurpose::Venue))?;
        let params = LeagueParams {
            n_frames: self.n_images,
            period_ms: PERIOD_MS,
            lamp_settings: vec![(0, lighting)],
            exposure_mode: self.exposure_mode,
            paint_chroma: self.paint_chroma,
            ..LeagueParams::default()
        };
        let labelled = |picture: &LeaguePicture| {
            let mut pixels = LabelledPixels::new(N_COLORS);
            let grey = Vector3::new(0.0, 128.0, 128.0);
            picture.yuv().zip(&picture.labels).for_each(|(yuv, label)| pixels.add(*label, &(yuv + grey)));
            pixels
        };
        let images: Vec<LabelledPixels> = LeagueDrive::in_venue(&params, venue, streams(seed))?
            .map(|frame| labelled(&frame.picture))
            .collect();
        let light = if lighting == LampSetting::Dark { "dark" } else { "bright" };
        let name = format!("hall {hall:02} {light}");
        Ok(TrainingVenue::from_labelled_pixels(name, &images, self.min_pixels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_color_map::ColorId;
    use wayfix_color_model::ColorMeans;

    fn halls() -> Vec<(LampSetting, TrainingVenue)> {
        TrainingHalls::default().gather(ChaCha8Rng::seed_from_u64(44)).unwrap()
    }

    /// Mean of one channel of one colour over the images that show it.
    fn mean_of(venue: &TrainingVenue, color: u8, channel: usize) -> Option<f64> {
        let values: Vec<f64> =
            venue.images.iter().filter_map(|image| Some(image.mean(ColorId(color))?[channel])).collect();
        (!values.is_empty()).then(|| mean(&values))
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn forty_four_venues_in_two_groups_of_brightness() {
        let venues = halls();
        assert_eq!(venues.len(), 44);
        let whites = |light| -> Vec<f64> {
            venues
                .iter()
                .filter(|(of, _)| *of == light)
                .filter_map(|(_, venue)| mean_of(venue, 1, 0))
                .collect()
        };
        let brightest = whites(LampSetting::Dark).into_iter().fold(0.0, f64::max);
        let dimmest = whites(LampSetting::Bright).into_iter().fold(255.0, f64::min);
        assert!(brightest < dimmest, "Y of white: dark up to {brightest}, bright from {dimmest}");
        let pixels = || venues.iter().filter_map(|(_, venue)| venue.pixels);
        assert!(pixels().all(|p| p.variances.min() > 0.0 && p.degrees_of_freedom > 1e4));
        let images: Vec<_> = venues.iter().flat_map(|(_, venue)| &venue.images).collect();
        for color in (0..N_COLORS as u8).map(ColorId) {
            let n_seen = images.iter().filter(|image| image.mean(color).is_some()).count();
            assert!(n_seen > 60, "{color:?} in {n_seen} of 352 images");
            assert!(color.0 < 2 || n_seen < 352, "{color:?} is always there");
            let is_consistent =
                |image: &&ColorMeans| image.mean(color).is_some() == (image.n_pixels(color) >= 30);
            assert!(images.iter().all(is_consistent));
        }
    }

    #[test]
    fn colors_of_a_hall_are_correlated() {
        // U of white and of pink over the halls of one light: what a joint prior lives on.
        for lighting in [LampSetting::Dark, LampSetting::Bright] {
            let of_light = halls().into_iter().filter(|(light, _)| *light == lighting);
            let pairs =
                of_light.filter_map(|(_, venue)| Some((mean_of(&venue, 1, 1)?, mean_of(&venue, 4, 1)?)));
            let (a, b): (Vec<f64>, Vec<f64>) = pairs.unzip();
            let (mean_a, mean_b) = (mean(&a), mean(&b));
            let moment = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
                a.iter().zip(&b).map(|(x, y)| f(x - mean_a, y - mean_b)).sum()
            };
            let variances = moment(&|x, _| x * x) * moment(&|_, y| y * y);
            let correlation = moment(&|x, y| x * y) / variances.sqrt();
            // With no correlation, 22 pairs exceed 0.54 with probability 0.5 %.
            assert!(correlation > 0.54, "{lighting:?}: {correlation} over {} halls", a.len());
        }
    }

    #[test]
    fn no_images_are_an_error() {
        let none = TrainingHalls { n_images: 0, ..TrainingHalls::default() };
        assert!(none.gather(ChaCha8Rng::seed_from_u64(1)).is_err());
    }
}
