use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use nalgebra::{Matrix3, Vector3};
use wayfix_color_model::{ColorDensity, ColorMeans, TrainingVenue};
use wayfix_sensor_log::is_hidden;

use super::{carpet::density, image::VenueImage};

/// Data of one day's robot.
#[derive(Clone, Debug)]
pub(super) struct Venue {
    pub(super) name: String,
    pub(super) images: Vec<VenueImage>,
    /// Images without carpet.
    pub(super) n_skipped: u64,
    /// Images that cannot be read or have no usable boxes, and why.
    pub(super) unusable: Vec<String>,
}

impl Venue {
    /// All venues below `folder`, in the order of their names: folders `day/robot` with JPEG files.
    pub(super) fn read_all(folder: &Path) -> Result<Vec<Self>> {
        let mut venues = Vec::new();
        for day in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
            for robot in entries(&day)?.into_iter().filter(|path| path.is_dir()) {
                let name = robot.strip_prefix(folder).unwrap_or(&robot).display().to_string();
                venues.push(Self::read(name, &robot)?);
            }
        }
        Ok(venues)
    }

    fn read(name: String, folder: &Path) -> Result<Self> {
        let is_jpeg = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "jpg");
        let mut venue = Self { name, images: Vec::new(), n_skipped: 0, unusable: Vec::new() };
        for path in entries(folder)?.into_iter().filter(is_jpeg) {
            match VenueImage::read(&path) {
                Ok(Some(image)) => venue.images.push(image),
                Ok(None) => venue.n_skipped += 1,
                Err(error) => venue.unusable.push(format!("{error:#}")),
            }
        }
        Ok(venue)
    }

    /// The Gaussian of all ball pixels, if there are enough.
    pub(super) fn ball(&self) -> Option<ColorDensity> {
        Some(density(self.images.iter().flat_map(|image| &image.ball_pixels))?.0)
    }

    /// Means of carpet and ball of each image.
    pub(super) fn training(&self) -> TrainingVenue {
        let means = |image: &VenueImage| {
            let ball = density(image.ball_pixels.iter());
            ColorMeans::new([
                (Some(image.carpet.density.mean), image.carpet.n_pixels),
                (ball.map(|(ball, _)| ball.mean), ball.map_or(0, |(_, n)| n)),
            ])
        };
        TrainingVenue {
            name: self.name.clone(),
            images: self.images.iter().map(means).collect(),
            pixels: None,
        }
    }

    /// Covariances of pixels about their image's mean, of carpet and of ball: an entry per image.
    pub(super) fn pixel_covariances(&self) -> [Vec<Matrix3<f64>>; 2] {
        let carpets = self.images.iter().map(|image| image.carpet.density.covariance).collect();
        let ball = |image: &VenueImage| Some(density(image.ball_pixels.iter())?.0.covariance);
        [carpets, self.images.iter().filter_map(ball).collect()]
    }

    /// The mean of the images' ball means.
    pub(super) fn ball_mean(&self) -> Option<Vector3<f64>> {
        let ball = |image: &VenueImage| Some(density(image.ball_pixels.iter())?.0.mean);
        let means: Vec<_> = self.images.iter().filter_map(ball).collect();
        (!means.is_empty()).then(|| means.iter().sum::<Vector3<f64>>() / means.len() as f64)
    }
}

/// The entries of a folder except hidden files, sorted.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = || fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>();
    let mut paths = read().with_context(|| format!("cannot list {}", folder.display()))?;
    paths.retain(|path| !is_hidden(path));
    paths.sort();
    Ok(paths)
}
