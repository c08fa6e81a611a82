use anyhow::{Result, anyhow};
use wayfix_appearance_cml::{
    OmnidirectionalRing, Panorama, PanoramaDescriptor, PanoramaDescriptorExtractor, PanoramaDescriptorParams,
};
use wayfix_sensor_log::EncodedImage;

/// Computes descriptors of camera images: panoramas, or raw images whose ring is unwrapped first.
#[derive(Clone, Debug)]
pub struct ViewDescriptorReader {
    params: PanoramaDescriptorParams,
    donut: Option<OmnidirectionalRing>,
    /// Created for the size of the first image.
    features: Option<PanoramaDescriptorExtractor>,
}

/// Panorama columns per sector, and the maximum number of rows per ring, of an unwrapped ring.
const OVERSAMPLING: usize = 3;

impl ViewDescriptorReader {
    /// A reader of panoramas, or of raw images with a ring.
    pub fn new(params: PanoramaDescriptorParams, donut: Option<OmnidirectionalRing>) -> Self {
        Self { params, donut, features: None }
    }

    /// Parameters of the descriptors.
    pub fn params(&self) -> &PanoramaDescriptorParams {
        &self.params
    }

    /// Columns and rows of a panorama; `None` before the first.
    pub fn size(&self) -> Option<(usize, usize)> {
        self.features.as_ref().map(PanoramaDescriptorExtractor::size)
    }

    /// The panorama of an image.
    ///
    /// # Errors
    /// Returns an error if the image cannot be decoded, or has no such ring.
    pub fn panorama(&self, image: &EncodedImage) -> Result<Panorama> {
        let decoded = image.decode_rgb()?;
        let (width, height) = (decoded.width as usize, decoded.height as usize);
        let picture = Panorama::from_rgb(width, height, decoded.pixels)?;
        let Some(donut) = &self.donut else { return Ok(picture) };
        let depth = (donut.radii[1] - donut.radii[0]).max(1.0) as usize;
        let n_rows = depth.min(OVERSAMPLING * self.params.n_rings);
        let n_columns = OVERSAMPLING * self.params.n_sectors;
        Ok(donut.unwrap_image(width, height, picture.pixels(), n_columns, n_rows)?)
    }

    /// The descriptor of an image.
    ///
    /// # Errors
    /// Returns the errors of [`panorama`](Self::panorama), and when it is of another size than the first, blank or saturated.
    pub fn describe(&mut self, image: &EncodedImage) -> Result<PanoramaDescriptor> {
        let panorama = self.panorama(image)?;
        let size = (panorama.n_columns(), panorama.n_rows());
        let features = match &self.features {
            Some(features) => features,
            None => {
                let features = PanoramaDescriptorExtractor::new(self.params, size.0, size.1)
                    .map_err(|error| anyhow!("panoramas of {} × {} pixels: {error}", size.0, size.1))?;
                // The first view with content fixes the size.
                features.describe(&panorama)?;
                &*self.features.insert(features)
            }
        };
        Ok(features.describe(&panorama)?)
    }
}
