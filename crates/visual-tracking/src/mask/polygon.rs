use super::runs::fill;
use crate::{PixelMask, TrackingError};

impl PixelMask {
    /// The pixels whose centres are inside a closed polygon with corners `[u, v]` in pixels, by the even-odd rule. The polygon is clipped to the
    /// mask; polygons with a common side share no pixel.
    /// ```
    /// use wayfix_visual_tracking::PixelMask;
    /// let triangle = PixelMask::from_polygon(40, 40, &[[0.0, 0.0], [20.0, 0.0], [0.0, 20.0]])?;
    /// assert_eq!(triangle.area(), 20 * 19 / 2);
    /// assert!(PixelMask::from_polygon(40, 40, &[[0.0, f64::NAN]; 3]).is_err());
    /// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
    /// ```
    ///
    /// # Errors
    /// [`TrackingError::Extent`] as [`empty`](Self::empty), [`TrackingError::NotFinite`].
    pub fn from_polygon(width: usize, height: usize, corners: &[[f64; 2]]) -> Result<Self, TrackingError> {
        let mut mask = Self::empty(width, height)?;
        for (index, &value) in corners.as_flattened().iter().enumerate() {
            if !value.is_finite() {
                return Err(TrackingError::NotFinite { what: "coordinate of a polygon", index, value });
            }
        }
        let mut crossings = Vec::new();
        for (i, &corner) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            let [upper, lower] = if corner[1] <= next[1] { [corner, next] } else { [next, corner] };
            let slope = (lower[0] - upper[0]) / (lower[1] - upper[1]);
            for row in first_middle(upper[1], height)..first_middle(lower[1], height) {
                crossings.push((row, upper[0] + slope * (row as f64 + 0.5 - upper[1])));
            }
        }
        crossings.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        // Every row has an even number of crossings.
        for pair in crossings.chunks_exact(2) {
            let (from, to) = (first_middle(pair[0].1, width), first_middle(pair[1].1, width));
            fill(mask.row_mut(pair[0].0), from..to);
        }
        Ok(mask)
    }
}

/// The first pixel whose centre is not before `x`, at most `limit`. The conversion saturates.
fn first_middle(x: f64, limit: usize) -> usize {
    ((x - 0.5).ceil() as usize).min(limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_cut_off_at_the_edges() {
        let big = PixelMask::from_polygon(70, 5, &[[-9e9, -9e9], [9e9, -9e9], [9e9, 9e9], [-9e9, 9e9]]);
        assert_eq!(big, PixelMask::full(70, 5));
        for far in [[[80.0, 0.0], [90.0, 0.0], [90.0, 9.0]], [[-3.0, 0.0], [-1.0, 0.0], [-1.0, 9.0]]] {
            assert!(PixelMask::from_polygon(70, 5, &far).unwrap().is_empty());
        }
        let extreme = [[-f64::MAX, -f64::MAX], [f64::MAX, f64::MAX], [f64::MAX, -f64::MAX]];
        assert!(PixelMask::from_polygon(70, 5, &extreme).is_ok());
    }

    #[test]
    fn points_and_lines_have_no_inside() {
        for corners in [&[][..], &[[3.0, 3.0]], &[[0.0, 0.0], [9.0, 9.0]]] {
            assert!(PixelMask::from_polygon(10, 10, corners).unwrap().is_empty());
        }
    }

    #[test]
    fn a_star_is_hollow_where_it_crosses_itself() {
        let star: Vec<[f64; 2]> = (0..5)
            .map(|k| (k as f64 * 2.0 * std::f64::consts::TAU / 5.0).sin_cos())
            .map(|(sin, cos)| [50.0 + 40.0 * sin, 50.0 - 40.0 * cos])
            .collect();
        let mask = PixelMask::from_polygon(100, 100, &star).unwrap();
        assert!(!mask.get(50, 50) && mask.get(50, 20) && !mask.get(0, 0));
    }
}
