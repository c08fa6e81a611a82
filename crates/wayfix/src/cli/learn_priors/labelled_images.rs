use std::{collections::BTreeMap, fs, path::Path, path::PathBuf};

use anyhow::{Context, Result, ensure};
use wayfix_color_model::{LabelledPixels, YuvImage, YuvStandard};
use wayfix_sensor_log::{EncodedImage, image_files};

/// End of the name of a file of labels.
const SUFFIX: &str = "_labels";

/// An image and its labels.
#[derive(Debug, PartialEq)]
pub(super) struct LabelledImage {
    /// Name of the image's file, without its extension.
    pub(super) name: String,
    image: PathBuf,
    labels: PathBuf,
}

/// The images of a folder that have labels, and what is left over, by name.
#[derive(Debug, Default, PartialEq)]
pub(super) struct LabelledImages {
    pub(super) images: Vec<LabelledImage>,
    pub(super) without_labels: Vec<String>,
    pub(super) without_image: Vec<String>,
}

impl LabelledImages {
    /// Pairs `K.jpg` or `K.png` with `K_labels.png`, or with `K.png` in another folder.
    pub(super) fn find(images: &Path, labels: &Path) -> Result<Self> {
        let mut of_image = by_name(labels, |name| name.strip_suffix(SUFFIX).map(str::to_owned))?;
        if fs::canonicalize(images)? != fs::canonicalize(labels)? {
            let plain = by_name(labels, |name| (!name.ends_with(SUFFIX)).then(|| name.to_owned()))?;
            for (name, path) in plain {
                of_image.entry(name).or_insert(path);
            }
        }
        let mut found = Self::default();
        for (name, image) in by_name(images, |name| (!name.ends_with(SUFFIX)).then(|| name.to_owned()))? {
            match of_image.remove(&name) {
                Some(labels) => found.images.push(LabelledImage { name, image, labels }),
                None => found.without_labels.push(name),
            }
        }
        found.without_image = of_image.into_keys().collect();
        ensure!(
            !found.images.is_empty(),
            "no image in {} has labels in {}: the labels of K.jpg are K{SUFFIX}.png or K.png",
            images.display(),
            labels.display()
        );
        Ok(found)
    }
}

/// The images of a folder by the name that `name_of` makes of that of the file.
fn by_name(folder: &Path, name_of: impl Fn(&str) -> Option<String>) -> Result<BTreeMap<String, PathBuf>> {
    let mut by_name = BTreeMap::new();
    for path in image_files(folder)? {
        let Some(name) = path.file_stem().and_then(|stem| name_of(&stem.to_string_lossy())) else { continue };
        if let Some(other) = by_name.insert(name.clone(), path.clone()) {
            anyhow::bail!("{} and {} have the same name: remove one", other.display(), path.display());
        }
    }
    Ok(by_name)
}

impl LabelledImage {
    /// How a table may name it: without and with its extension.
    pub(super) fn keys(&self) -> impl Iterator<Item = &str> {
        let file = self.image.file_name().and_then(|name| name.to_str());
        std::iter::once(self.name.as_str()).chain(file)
    }

    /// The labelled pixels.
    pub(super) fn read(&self, n_colors: usize, standard: YuvStandard) -> Result<LabelledPixels> {
        let image = encoded(&self.image)?;
        let image = image.decode_rgb().with_context(|| self.image.display().to_string())?;
        let yuv = YuvImage::from_rgb(image.width, image.height, &image.pixels, standard)?;
        let labels = encoded(&self.labels)?;
        let labels = labels.decode_labels().with_context(|| self.labels.display().to_string())?;
        let size = (labels.width, labels.height);
        LabelledPixels::from_image(&yuv, size, &labels.pixels, n_colors)
            .with_context(|| self.labels.display().to_string())
    }
}

fn encoded(path: &Path) -> Result<EncodedImage> {
    let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    EncodedImage::from_bytes(bytes).with_context(|| format!("{} is no JPEG, PNG or PNM", path.display()))
}
