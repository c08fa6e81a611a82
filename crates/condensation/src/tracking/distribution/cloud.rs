use nalgebra::Vector3;

use super::{ColorWarp, PrincipalColors};
use crate::CondensationError;

/// Cells per axis in which colours are put together: finer than any histogram that is made of them, so that a warped cloud has no gaps.
const N_CELLS: f64 = 64.0;

/// The colours that belong to the target, $`\mathcal C_t`$, as points of the colour space with the number of pixels each stands for.
/// [Andrade-Cetto & Sanfeliu, section 3.3]
///
/// Pixels of nearly the same colour are one point, so that the cloud stays small however large the target is.
///
/// ```
/// use wayfix_condensation::ColorCloud;
/// let cloud = ColorCloud::from_colors([[0.2, 0.5, 0.5], [0.201, 0.5, 0.5], [0.6, 0.5, 0.5]], 1000)?;
/// assert_eq!((cloud.n_points(), cloud.n_pixels()), (2, 3.0));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
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
    /// [`CondensationError::Empty`] without colours or points, [`CondensationError::NotFinite`].
    pub fn from_colors(
        colors: impl IntoIterator<Item = [f64; 3]>,
        max_points: usize,
    ) -> Result<Self, CondensationError> {
        let mut cells: Vec<(u32, [f64; 3])> = Vec::new();
        for (index, color) in colors.into_iter().enumerate() {
            if let Some(value) = color.into_iter().find(|value| !value.is_finite()) {
                return Err(CondensationError::NotFinite { what: "colour", index, value });
            }
            cells.push((cell(&color), color));
        }
        cells.sort_by_key(|(cell, _)| *cell);
        let mut means: Vec<(f64, Vector3<f64>)> = cells
            .chunk_by(|a, b| a.0 == b.0)
            .map(|same| {
                let sum: Vector3<f64> = same.iter().map(|(_, color)| Vector3::from(*color)).sum();
                (same.len() as f64, sum / same.len() as f64)
            })
            .collect();
        if means.len() > max_points {
            means.sort_by(|a, b| b.0.total_cmp(&a.0));
            means.truncate(max_points);
        }
        if means.is_empty() {
            return Err(CondensationError::Empty { what: "colours" });
        }
        let (counts, points) = means.into_iter().unzip();
        Ok(Self { points, counts })
    }

    /// The points.
    pub fn points(&self) -> &[Vector3<f64>] {
        &self.points
    }

    /// How many pixels each point stands for.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// How many points there are.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// How many pixels there are.
    pub fn n_pixels(&self) -> f64 {
        self.counts.iter().sum()
    }

    /// Its parameters; axes continue those of `previous`.
    ///
    /// # Errors
    /// As [`PrincipalColors::of`].
    pub fn principal(
        &self,
        previous: Option<&PrincipalColors>,
    ) -> Result<PrincipalColors, CondensationError> {
        PrincipalColors::of(&self.points, &self.counts, previous)
    }

    /// Every point where `warp` carries it, with its number of pixels.
    pub fn warped<'a>(&'a self, warp: &'a ColorWarp) -> impl Iterator<Item = (Vector3<f64>, f64)> + 'a {
        self.points.iter().zip(&self.counts).map(|(point, count)| (warp.apply(point), *count))
    }
}

fn cell(color: &[f64; 3]) -> u32 {
    color.iter().fold(0, |cell, value| (cell << 6) | (value * N_CELLS).clamp(0.0, N_CELLS - 1.0) as u32)
}
