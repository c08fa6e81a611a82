use std::{fs, path::Path};

use anyhow::{Context, Result, ensure};
use wayfix_color_model::{
    LabelledPixels, LightingFilterParams, LightingPriors, PriorLearningParams, TrainingVenue, YuvImage,
    inner_labels, learn_grouped_priors,
};
use wayfix_sensor_log::{EncodedImage, image_files};
use wayfix_systems::color::ColorSystemParams;

/// End of the name of a file of labels.
const SUFFIX: &str = "_labels";

/// An image with its labels.
pub(super) struct Place {
    pub(super) name: String,
    pub(super) encoded: EncodedImage,
    pub(super) image: YuvImage,
    /// 0 next to another label.
    pub(super) labels: Vec<u8>,
    training: TrainingVenue,
}

impl Place {
    /// The labelled images of a folder.
    pub(super) fn read_all(folder: &Path, n_colors: usize, params: &ColorSystemParams) -> Result<Vec<Self>> {
        let mut places = Vec::new();
        for image in image_files(folder)? {
            let name = image.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let labels = folder.join(format!("{name}{SUFFIX}.png"));
            if labels.exists() {
                let place = Self::read(name, [&image, &labels], n_colors, params);
                places.push(place.with_context(|| image.display().to_string())?);
            }
        }
        ensure!(places.len() > 1, "{}: {} labelled images, two are needed", folder.display(), places.len());
        Ok(places)
    }

    fn read(name: String, files: [&Path; 2], n_colors: usize, params: &ColorSystemParams) -> Result<Self> {
        let encoded = |path: &Path| EncodedImage::from_bytes(fs::read(path)?).context("no image");
        let [encoded, labels] = [encoded(files[0])?, encoded(files[1])?];
        let (rgb, labels) = (encoded.decode_rgb()?, labels.decode_labels()?);
        let image = YuvImage::from_rgb(rgb.width, rgb.height, &rgb.pixels, params.yuv_standard)?;
        let size = (labels.width, labels.height);
        let pixels = LabelledPixels::from_image(&image, size, &labels.pixels, n_colors)?;
        Ok(Self {
            training: TrainingVenue::from_labelled_pixels(&name, &[pixels], params.localizer.min_pixels),
            labels: inner_labels(&labels.pixels, size),
            name,
            encoded,
            image,
        })
    }
}

/// The prior from all places but one.
pub(super) fn prior_without(left_out: usize, places: &[Place], colors: &[String]) -> Result<LightingPriors> {
    let others = places.iter().enumerate().filter(|(at, _)| *at != left_out);
    let venues: Vec<TrainingVenue> = others.map(|(_, place)| place.training.clone()).collect();
    // One image a venue does not show how its mean scatters.
    let mean_color_variance = Some(LightingFilterParams::default().mean_color_variance);
    let params = PriorLearningParams { mean_color_variance, ..PriorLearningParams::default() };
    learn_grouped_priors(colors, &venues, &vec![0; venues.len()], &params)
        .with_context(|| format!("without {}", places[left_out].name))
}
