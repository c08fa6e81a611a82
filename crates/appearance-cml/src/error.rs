use wayfix_gaussian_core::GaussianError;
use wayfix_integrity::IntegrityError;
use wayfix_kalman::KalmanError;

/// Why an operation was refused. Whatever it was called on is as it was before.
///
/// ```
/// use wayfix_appearance_cml::{AppearanceMapError, LinearSearch, PanoramaDescriptor, ReferenceId, ReferenceSearch};
/// let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let mut search = LinearSearch::default();
/// search.insert(ReferenceId(7), view(20)?)?;
/// let refused = search.insert(ReferenceId(7), view(50)?);
/// assert_eq!(refused, Err(AppearanceMapError::DuplicateReference { id: 7 }));
/// assert_eq!(search.get(ReferenceId(7)), Some(&view(20)?)); // unchanged
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AppearanceMapError {
    /// A reference with this number is in the map already.
    #[error("reference {id} is in the map already")]
    DuplicateReference {
        /// Its number.
        id: u32,
    },
    /// A reference of another shape than those of the map: of another camera, or described with other parameters.
    #[error("reference {id} cannot be compared with those of the map")]
    Incomparable {
        /// Its number.
        id: u32,
    },
    /// A picture without pixels, or with a number of pixels that differs from its size.
    #[error("{n_bytes} bytes for a picture of {} × {} pixels", size.0, size.1)]
    PixelCount {
        /// Columns and rows.
        size: (usize, usize),
        /// Bytes of red, green and blue that were given.
        n_bytes: usize,
    },
    /// A view of another size than those before it.
    #[error("a view of {} × {} pixels, the others are {} × {}", got.0, got.1, expected.0, expected.1)]
    ViewSize {
        /// Columns and rows of the others.
        expected: (usize, usize),
        /// Columns and rows of this one.
        got: (usize, usize),
    },
    /// A view without contrast: a covered lens, or darkness.
    #[error("a blank view: contrast {contrast:.2e}, at least {min_contrast} is needed")]
    BlankView {
        /// Standard deviation as a share of the range.
        contrast: f64,
        /// The least that is accepted.
        min_contrast: f64,
    },
    /// A view of little but black and white: too short or too long an exposure.
    #[error("a saturated view: {:.0} % of it is black or white, at most {:.0} % is accepted", 100.0 * share, 100.0 * max_share)]
    SaturatedView {
        /// Share of such pixels.
        share: f64,
        /// The most that is accepted.
        max_share: f64,
    },
    /// The ring of a raw omnidirectional image is none, or reaches beyond the image.
    #[error("a ring of radii {radii:?} about {center:?} in an image of {} × {} pixels", image.0, image.1)]
    OmnidirectionalRing {
        /// Centre, pixels.
        center: [f64; 2],
        /// Inner and outer radius, pixels.
        radii: [f64; 2],
        /// Width and height of the image.
        image: (usize, usize),
    },
    /// Numbers that are no spectrum of a panorama.
    #[error("not a descriptor: {n_coefficients} coefficients for {n_rings} rings, scale {scale}")]
    Descriptor {
        /// The scale of the coefficients.
        scale: f32,
        /// Rings.
        n_rings: u8,
        /// Coefficients.
        n_coefficients: usize,
    },
    /// A reference is named that the search does not hold.
    #[error("there is no view of reference {id}")]
    NoSuchReference {
        /// Its number.
        id: u32,
    },
    /// A distribution over poses is invalid.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// A parameter of the relocalization, or a measurement of its test, is invalid.
    #[error(transparent)]
    Integrity(#[from] IntegrityError),
    /// Something is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// What it is.
        what: &'static str,
    },
    /// A parameter is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values it may take.
        range: &'static str,
    },
    /// A measurement of the pose is invalid.
    #[error(transparent)]
    Kalman(#[from] KalmanError),
    /// A measurement of the pose fits no component of the belief.
    #[error("an outlier: NIS {nis:.1}, at most {threshold:.1} is expected")]
    Outlier {
        /// The least normalized innovation squared.
        nis: f64,
        /// The largest that would have been accepted.
        threshold: f64,
    },
    /// A measurement of the pose needs a pose to correct, and none is known.
    #[error("no pose is known that could be corrected")]
    UnknownPose,
    /// All numbers of references have been given out.
    #[error("no number is left for another reference")]
    ReferenceIdsExhausted,
}
