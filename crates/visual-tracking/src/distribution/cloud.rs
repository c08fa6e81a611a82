use nalgebra::Vector3;

use super::{AffineColorMap, ColorDistributionState, PrincipalColors};
use crate::TrackingError;
use crate::error::checked;

/// Cells per axis in which colours are merged: finer than any histogram computed from them, so that a warped cloud has no gaps.
const N_CELLS: f64 = 64.0;

/// Pixels below which a remembered point is forgotten.
const FADED: f64 = 0.5;

/// The target's colours, $`\mathcal C_t`$, as points of the colour space with pixel counts. [Andrade-Cetto 2005, Sec. 3.3]
///
/// Pixels of nearly equal colour are one point, so the size of the cloud does not grow with the target.
/// ```
/// use wayfix_visual_tracking::ColorCloud;
/// let cloud = ColorCloud::from_colors([[0.2, 0.5, 0.5], [0.201, 0.5, 0.5], [0.6, 0.5, 0.5]], 1000)?;
/// assert_eq!((cloud.n_points(), cloud.n_pixels()), (2, 3.0));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColorCloud {
    points: Vec<Vector3<f64>>,
    counts: Vec<f64>,
}

impl ColorCloud {
    /// Of the colours of pixels, every axis from 0 to 1. Of more than `max_points` the rarest are left out.
    ///
    /// # Errors
    /// Returns [`TrackingError::Empty`] without colours or points, [`TrackingError::NotFinite`].
    pub fn from_colors(
        colors: impl IntoIterator<Item = [f64; 3]>,
        max_points: usize,
    ) -> Result<Self, TrackingError> {
        let counted = colors.into_iter().map(|color| (Vector3::from(color), 1.0));
        Self::from_counted(counted, max_points)
    }

    /// A cloud of colours with a pixel count each, not necessarily a whole number.
    /// # Errors
    /// Returns the errors of [`from_colors`](Self::from_colors), and [`TrackingError::Parameter`] for a count below zero.
    pub(crate) fn from_counted(
        colors: impl IntoIterator<Item = (Vector3<f64>, f64)>,
        max_points: usize,
    ) -> Result<Self, TrackingError> {
        let mut cells: Vec<(u32, Vector3<f64>, f64)> = Vec::new();
        for (index, (color, count)) in colors.into_iter().enumerate() {
            if let Some(&value) = color.iter().chain([&count]).find(|value| !value.is_finite()) {
                return Err(TrackingError::NotFinite { what: "colour", index, value });
            }
            checked("count of a colour", count, count >= 0.0, "not negative")?;
            cells.push((cell(&color), color, count));
        }
        cells.sort_by_key(|(cell, ..)| *cell);
        let mut means: Vec<(f64, Vector3<f64>)> = cells
            .chunk_by(|a, b| a.0 == b.0)
            .map(|same| {
                let count: f64 = same.iter().map(|(_, _, count)| count).sum();
                let sum: Vector3<f64> = same.iter().map(|(_, color, count)| color * *count).sum();
                (count, sum / count)
            })
            .filter(|(count, _)| *count > 0.0)
            .collect();
        if means.len() > max_points {
            means.sort_by(|a, b| b.0.total_cmp(&a.0));
            means.truncate(max_points);
        }
        if means.is_empty() {
            return Err(TrackingError::Empty { what: "colours" });
        }
        let (counts, points) = means.into_iter().unzip();
        Ok(Self { points, counts })
    }

    /// The points.
    pub fn points(&self) -> &[Vector3<f64>] {
        &self.points
    }

    /// Pixel count of each point.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// Number of pixels.
    pub fn n_pixels(&self) -> f64 {
        self.counts.iter().sum()
    }

    /// Principal colours of the cloud; axes continue those of `previous`.
    /// # Errors
    /// Returns the errors of [`PrincipalColors::of`].
    pub(crate) fn principal(
        &self,
        previous: Option<&PrincipalColors>,
    ) -> Result<PrincipalColors, TrackingError> {
        PrincipalColors::of(&self.points, &self.counts, previous)
    }

    /// Merges the cloud with an older one, warped by the change from `before` to `now` and weighted by `memory`. Points with fewer than `FADED`
    /// pixels are dropped.
    /// # Errors
    /// Returns the errors of [`from_counted`](Self::from_counted).
    pub(crate) fn with_memory_of(
        &self,
        older: &Self,
        [before, now]: [&PrincipalColors; 2],
        memory: f64,
        max_points: usize,
    ) -> Result<Self, TrackingError> {
        let mut state = ColorDistributionState::at_rest(now);
        let [theta, phi] = now.angles_since(before);
        (state.value[6], state.value[7]) = (theta, phi);
        let warp = state.warp_from(before);
        let kept = older.warped(&warp).map(|(color, count)| (color, memory * count));
        let kept = kept.filter(|(_, count)| *count >= FADED);
        let found = self.points.iter().copied().zip(self.counts.iter().copied());
        Self::from_counted(found.chain(kept), max_points)
    }

    /// Every point where `warp` carries it, with its number of pixels.
    pub fn warped<'a>(&'a self, warp: &'a AffineColorMap) -> impl Iterator<Item = (Vector3<f64>, f64)> + 'a {
        self.points.iter().zip(&self.counts).map(|(point, count)| (warp.apply(point), *count))
    }
}

fn cell(color: &Vector3<f64>) -> u32 {
    color.iter().fold(0, |cell, value| (cell << 6) | (value * N_CELLS).clamp(0.0, N_CELLS - 1.0) as u32)
}
