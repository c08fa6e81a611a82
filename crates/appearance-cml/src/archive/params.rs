use super::{
    MapArchiveError,
    bytes::{Reader, Writer},
};
use crate::{AzimuthDirection, BrightnessNormalization, IntensityScale, PanoramaDescriptorParams};

/// Parameters that a map archive and its reader must share: the descriptor and the size of the pictures.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMap, ArchivedDescriptorFormat, LinearSearch, MapArchive};
/// # use wayfix_appearance_cml::{PanoramaDescriptor, PanoramaDescriptorParams};
/// # let map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// let written = ArchivedDescriptorFormat { views: PanoramaDescriptorParams::default(), size: (120, 25) };
/// let archive = MapArchive::from_bytes(&MapArchive::to_bytes(&written, &map, None))?;
/// // Views of larger panoramas cannot be compared with those of the map.
/// let larger = ArchivedDescriptorFormat { size: (240, 25), ..written };
/// assert!(archive.clone().into_map::<LinearSearch<_>>(&larger).is_err());
/// // The limits for refused views may differ.
/// let stricter = ArchivedDescriptorFormat { views: PanoramaDescriptorParams { min_contrast: 0.05, ..written.views }, ..written };
/// assert!(archive.into_map::<LinearSearch<_>>(&stricter).is_ok());
/// # Ok::<(), wayfix_appearance_cml::MapArchiveError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArchivedDescriptorFormat {
    /// How panoramas are described.
    pub views: PanoramaDescriptorParams,
    /// Columns and rows of a panorama.
    pub size: (usize, usize),
}

impl ArchivedDescriptorFormat {
    pub(super) fn write(&self, writer: &mut Writer) {
        let views = &self.views;
        for whole in [views.n_rings, views.n_sectors, views.n_harmonics, self.size.0, self.size.1] {
            writer.u32(u32::try_from(whole).unwrap_or(u32::MAX));
        }
        writer.u8(views.intensity_scale as u8);
        writer.u8(views.brightness_normalization as u8);
        writer.u8(views.azimuth_direction as u8);
        writer.f64s([views.min_contrast, views.max_saturated_share, views.smoothing_sigma]);
    }

    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader(bytes);
        let mut whole = [0; 5];
        for value in &mut whole {
            *value = reader.u32()? as usize;
        }
        let [n_rings, n_sectors, n_harmonics, columns, rows] = whole;
        let tone = match reader.u8()? {
            0 => IntensityScale::Linear,
            1 => IntensityScale::Logarithmic,
            _ => return None,
        };
        let normalization = match reader.u8()? {
            0 => BrightnessNormalization::None,
            1 => BrightnessNormalization::Mean,
            2 => BrightnessNormalization::MeanVariance,
            _ => return None,
        };
        let sense = match reader.u8()? {
            0 => AzimuthDirection::Clockwise,
            1 => AzimuthDirection::Counterclockwise,
            _ => return None,
        };
        let [min_contrast, max_saturated_share, smoothing] = reader.f64s()?;
        let views = PanoramaDescriptorParams {
            n_rings,
            n_sectors,
            n_harmonics,
            smoothing_sigma: smoothing,
            intensity_scale: tone,
            brightness_normalization: normalization,
            min_contrast,
            max_saturated_share,
            azimuth_direction: sense,
        };
        reader.0.is_empty().then_some(Self { views, size: (columns, rows) })
    }

    /// What is refused of a view may differ; what becomes of one must not.
    pub(super) fn check(&self, found: &Self) -> Result<(), MapArchiveError> {
        let properties = |params: &Self| {
            let views = &params.views;
            [
                ("n_rings", views.n_rings.to_string()),
                ("n_sectors", views.n_sectors.to_string()),
                ("n_harmonics", views.n_harmonics.to_string()),
                ("smoothing_sigma", views.smoothing_sigma.to_string()),
                ("intensity_scale", format!("{:?}", views.intensity_scale)),
                ("brightness_normalization", format!("{:?}", views.brightness_normalization)),
                ("azimuth_direction", format!("{:?}", views.azimuth_direction)),
                ("size of the panorama", format!("{} × {}", params.size.0, params.size.1)),
            ]
        };
        let mut pairs = properties(self).into_iter().zip(properties(found));
        let differs = pairs.find(|((_, expected), (_, found))| expected != found);
        differs.map_or(Ok(()), |((what, expected), (_, found))| {
            Err(MapArchiveError::Parameters { what, expected, found })
        })
    }
}
