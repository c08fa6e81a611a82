use crate::AppearanceMapError;

/// Which way the azimuth grows from column to column.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMapError, AzimuthDirection, Panorama};
/// # use wayfix_appearance_cml::{PanoramaDescriptorExtractor, PanoramaDescriptorParams, ViewDescriptor};
/// # let panorama = Panorama::from_rgb(120, 25, (0..120 * 25).flat_map(|i| [(i % 120 * (i / 120 + 3) % 251) as u8; 3]).collect())?;
/// let turn = |azimuth_direction| -> Result<f64, AppearanceMapError> {
///     let params = PanoramaDescriptorParams { azimuth_direction, ..Default::default() };
///     let extractor = PanoramaDescriptorExtractor::new(params, 120, 25)?;
///     Ok(extractor.describe(&panorama.turned(10))?.compare(&extractor.describe(&panorama)?).rotation.to_degrees())
/// };
/// // Ten columns of 3°; angles are positive counterclockwise.
/// assert!((turn(AzimuthDirection::Clockwise)? + 30.0).abs() < 0.2);
/// assert!((turn(AzimuthDirection::Counterclockwise)? - 30.0).abs() < 0.2);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum AzimuthDirection {
    /// To the right, as a camera that pans clockwise records them.
    Clockwise,
    /// To the left, as angles are counted (REP 103).
    Counterclockwise,
}

/// A panorama of 8-bit red, green and blue: a column for each azimuth, once round, a row for each elevation.
///
/// Row by row from the top left, no padding.
///
/// ```
/// use wayfix_appearance_cml::Panorama;
/// let panorama = Panorama::from_rgb(4, 1, (0..12).collect())?;
/// assert_eq!(panorama.row(0).next(), Some(&[0, 1, 2]));
/// assert!(Panorama::from_rgb(4, 2, vec![0; 12]).is_err());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panorama {
    n_columns: usize,
    n_rows: usize,
    pixels: Vec<[u8; 3]>,
}

impl Panorama {
    /// From `3 · n_columns · n_rows` bytes.
    ///
    /// # Errors
    /// [`AppearanceMapError::PixelCount`] without pixels or when the bytes are not that many.
    pub fn from_rgb(n_columns: usize, n_rows: usize, bytes: Vec<u8>) -> Result<Self, AppearanceMapError> {
        let refused = AppearanceMapError::PixelCount { size: (n_columns, n_rows), n_bytes: bytes.len() };
        let expected = n_columns.checked_mul(n_rows).and_then(|n| n.checked_mul(3));
        if bytes.is_empty() || expected != Some(bytes.len()) {
            return Err(refused);
        }
        let pixels = bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Ok(Self { n_columns, n_rows, pixels })
    }

    pub(super) fn from_pixels(n_columns: usize, pixels: Vec<[u8; 3]>) -> Self {
        Self { n_columns, n_rows: pixels.len() / n_columns, pixels }
    }

    /// Columns, once round.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// Rows.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// The pixels of a row, the top one first.
    pub fn row(&self, row: usize) -> impl Iterator<Item = &[u8; 3]> {
        self.pixels.iter().skip(row.saturating_mul(self.n_columns)).take(self.n_columns)
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// The view after a turn of the camera by `n` columns in column order: column `n` comes first.
    ///
    /// ```
    /// use wayfix_appearance_cml::Panorama;
    /// let panorama = Panorama::from_rgb(3, 1, vec![10, 10, 10, 20, 20, 20, 30, 30, 30])?;
    /// assert_eq!(panorama.turned(1).pixels(), [[20; 3], [30; 3], [10; 3]]);
    /// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
    /// ```
    pub fn turned(&self, n: usize) -> Self {
        let mut pixels = self.pixels.clone();
        for row in pixels.chunks_exact_mut(self.n_columns) {
            row.rotate_left(n % self.n_columns);
        }
        Self { pixels, ..*self }
    }
}
