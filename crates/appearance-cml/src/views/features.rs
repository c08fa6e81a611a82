use super::{
    AzimuthDirection, Panorama, PanoramaDescriptor, PanoramaDescriptorParams, cosines::Cosines,
    sectors::cell_means,
};
use crate::{AppearanceMapError, check};

/// Turns the panoramas of one camera into descriptors.
///
/// Averages per ring and sector are normalized and expanded over the azimuth,
/// $`c_{rk} = \frac{1}{n} \sum_j f_{rj} e^{-2π\mathrm i jk/n}`$ for ring $`r`$ and harmonic $`k`$ [Gross et al. 2005, Sec. 2.2], and then over
/// the rings,
/// in cosines. There a Gaussian of standard deviation $`σ`$ cells smooths by $`e^{-σ² ((2πk/n)² + (πl/n_r)²) / 2}`$ for harmonic $`k`$ of $`n`$ sectors and
/// cosine $`l`$ of $`n_r`$ rings.
///
/// ```
/// use wayfix_appearance_cml::{ViewDescriptor, Panorama, PanoramaDescriptorExtractor, PanoramaDescriptorParams};
/// let features = PanoramaDescriptorExtractor::new(PanoramaDescriptorParams::default(), 120, 25)?;
/// let bytes = (0..120 * 25).flat_map(|i| [(i % 120 * (i / 120 + 3) % 251) as u8; 3]).collect();
/// let panorama = Panorama::from_rgb(120, 25, bytes)?;
/// let (before, after) = (features.describe(&panorama)?, features.describe(&panorama.turned(10))?);
/// let seen = after.compare(&before);
/// // Ten columns of 3° to the right is a turn by −30°.
/// assert!(seen.distance < 0.03 && (seen.rotation.to_degrees() + 30.0).abs() < 0.2);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PanoramaDescriptorExtractor {
    params: PanoramaDescriptorParams,
    size: (usize, usize),
    n_rings: usize,
    n_sectors: usize,
    /// cos and sin of $`2πj/n`$ for each sector.
    circle: Vec<(f64, f64)>,
    /// What smoothing leaves of each harmonic and of each cosine.
    kept: [Vec<f64>; 2],
}

impl PanoramaDescriptorExtractor {
    /// For panoramas of `n_columns` × `n_rows` pixels.
    ///
    /// # Errors
    /// [`AppearanceMapError::Parameter`] for parameters outside their range, or more harmonics than half the columns.
    pub fn new(
        params: PanoramaDescriptorParams,
        n_columns: usize,
        n_rows: usize,
    ) -> Result<Self, AppearanceMapError> {
        params.validate()?;
        check::count("rows of the panorama", n_rows)?;
        let (n_rings, n_sectors) = (params.n_rings.min(n_rows), params.n_sectors.min(n_columns));
        params.check_harmonics(n_sectors)?;
        let angle = |sector: usize| std::f64::consts::TAU * sector as f64 / n_sectors as f64;
        let circle = (0..n_sectors).map(|sector| (angle(sector).cos(), angle(sector).sin())).collect();
        let kept = |n: usize, step: f64| {
            (0..n).map(|k| (-0.5 * (params.smoothing_sigma * step * k as f64).powi(2)).exp()).collect()
        };
        let kept = [
            kept(params.n_harmonics, std::f64::consts::TAU / n_sectors as f64),
            kept(n_rings, std::f64::consts::PI / n_rings as f64),
        ];
        Ok(Self { params, size: (n_columns, n_rows), n_rings, n_sectors, circle, kept })
    }

    /// The parameters.
    pub fn params(&self) -> &PanoramaDescriptorParams {
        &self.params
    }

    /// Columns and rows of the panoramas.
    pub fn size(&self) -> (usize, usize) {
        self.size
    }

    /// The appearance of a panorama.
    ///
    /// # Errors
    /// [`AppearanceMapError::ViewSize`] when it is of another size than the others, [`AppearanceMapError::BlankView`] when it has no contrast,
    /// [`AppearanceMapError::SaturatedView`] when too many of its pixels are black or white.
    pub fn describe(&self, panorama: &Panorama) -> Result<PanoramaDescriptor, AppearanceMapError> {
        let got = (panorama.n_columns(), panorama.n_rows());
        if got != self.size {
            return Err(AppearanceMapError::ViewSize { expected: self.size, got });
        }
        self.check_saturation(panorama)?;
        let mut cells = cell_means(panorama, self.n_rings, self.n_sectors, self.params.intensity_scale);
        self.params.brightness_normalization.apply(
            self.params.intensity_scale,
            self.params.min_contrast,
            &mut cells,
        )?;
        let cosines = Cosines::over(self.n_rings as u8);
        let [of_harmonics, of_cosines] = &self.kept;
        let smoothed = |(part, values): (usize, &[f64])| {
            let kept = of_cosines
                .iter()
                .map(|of_cosine| of_harmonics[part.div_ceil(2)] * of_cosine)
                .collect::<Vec<_>>();
            cosines.transform(values).zip(kept).map(|(value, kept)| value * kept).collect::<Vec<_>>()
        };
        let spectrum = self.spectrum(&cells);
        let spectrum = spectrum.chunks_exact(self.n_rings).enumerate().flat_map(smoothed);
        Ok(PanoramaDescriptor::quantized(self.n_rings, &spectrum.collect::<Vec<f64>>()))
    }

    fn check_saturation(&self, panorama: &Panorama) -> Result<(), AppearanceMapError> {
        let is_saturated = |pixel: &&[u8; 3]| {
            pixel.iter().all(|&value| value >= 254) || pixel.iter().all(|&value| value <= 1)
        };
        let n_saturated = panorama.pixels().iter().filter(is_saturated).count();
        let share = n_saturated as f64 / panorama.pixels().len() as f64;
        if share > self.params.max_saturated_share {
            return Err(AppearanceMapError::SaturatedView {
                share,
                max_share: self.params.max_saturated_share,
            });
        }
        Ok(())
    }

    /// Harmonic by harmonic, the real parts of all rings and then their imaginary parts (none for the constant one), scaled so that the sum
    /// of squares of all harmonics is the mean square of the cells.
    fn spectrum(&self, cells: &[f64]) -> Vec<f64> {
        let (n, n_rings) = (self.n_sectors, self.n_rings);
        let mut spectrum = vec![0.0; n_rings * (2 * self.params.n_harmonics - 1)];
        let sign = if self.params.azimuth_direction == AzimuthDirection::Clockwise { 1.0 } else { -1.0 };
        let scale = (n_rings as f64).sqrt().recip() / n as f64;
        for (ring, cells) in cells.chunks_exact(n).enumerate() {
            for k in 0..self.params.n_harmonics {
                let (mut re, mut im) = (0.0, 0.0);
                for (j, cell) in cells.iter().enumerate() {
                    let (cos, sin) = self.circle[j * k % n];
                    re += cell * cos;
                    im -= cell * sin;
                }
                if k == 0 {
                    spectrum[ring] = scale * re;
                    continue;
                }
                // Both halves of the spectrum of a real function count.
                let scale = scale * std::f64::consts::SQRT_2;
                let at = (2 * k - 1) * n_rings + ring;
                (spectrum[at], spectrum[at + n_rings]) = (scale * re, sign * scale * im);
            }
        }
        spectrum
    }
}
