use crate::picture::rgb_pixels;
use crate::{PixelMask, RgbImage};

/// Source of edges near a point of a contour, for fitting a snake.
pub trait EdgeSearch {
    /// Signed distance in pixels from `point` along the unit vector `normal` to the edge, if there is one within `reach`.
    fn find(&self, point: [f64; 2], normal: [f64; 2], reach: f64) -> Option<f64>;

    /// Whether edges are known at a point; a point outside the image counts neither as on an edge nor as off it.
    fn covers(&self, point: [f64; 2]) -> bool;
}

/// The boundary of a mask, crossed from inside to outside along the normal: $`∇S`$.
///
/// ```
/// use wayfix_visual_tracking::{PixelMask, EdgeSearch, MaskEdgeSearch};
/// let mask = PixelMask::from_fn(20, 10, |u, _| u < 8)?;
/// let edges = MaskEdgeSearch::new(&mask, (0, 0));
/// assert_eq!(edges.find([5.5, 5.0], [1.0, 0.0], 6.0), Some(2.5)); // pixel 7 is the last, it ends at 8
/// assert_eq!(edges.find([11.5, 5.0], [1.0, 0.0], 6.0), Some(-3.5));
/// assert_eq!(edges.find([5.5, 5.0], [-1.0, 0.0], 4.0), None); // that way it stays inside
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MaskEdgeSearch<'a> {
    mask: &'a PixelMask,
    corner: (usize, usize),
}

impl<'a> MaskEdgeSearch<'a> {
    /// Edges of a mask whose top left pixel is pixel `corner` of the image.
    pub fn new(mask: &'a PixelMask, corner: (usize, usize)) -> Self {
        Self { mask, corner }
    }

    /// Unknown outside the mask.
    fn is_on(&self, point: [f64; 2]) -> Option<bool> {
        self.pixel(point).map(|(u, v)| self.mask.get(u, v))
    }

    fn pixel(&self, point: [f64; 2]) -> Option<(usize, usize)> {
        let (u, v) = (point[0] - self.corner.0 as f64, point[1] - self.corner.1 as f64);
        let inside = u >= 0.0 && v >= 0.0 && u < self.mask.width() as f64 && v < self.mask.height() as f64;
        inside.then_some((u as usize, v as usize))
    }
}

impl EdgeSearch for MaskEdgeSearch<'_> {
    fn find(&self, point: [f64; 2], normal: [f64; 2], reach: f64) -> Option<f64> {
        let on = |step: f64| self.is_on([point[0] + step * normal[0], point[1] + step * normal[1]]);
        // Searches outwards from inside the target, or inwards from outside.
        let starts_inside = on(0.0)?;
        let direction = if starts_inside { 1.0 } else { -1.0 };
        let mut step = 1.0;
        while step - 0.5 <= reach {
            if on(direction * step)? != starts_inside {
                return Some(direction * (step - 0.5));
            }
            step += 1.0;
        }
        None
    }

    fn covers(&self, point: [f64; 2]) -> bool {
        self.pixel(point).is_some()
    }
}

/// The strongest change of colour along the normal, optionally only where a mask allows it: $`∇I · \mathrm{dil}(∇S)`$.
/// [Andrade-Cetto 2005, Sec. 3.3, "Contour updating"]
#[derive(Clone, Copy, Debug)]
pub struct ColorEdgeSearch<'a> {
    picture: &'a RgbImage,
    band: Option<MaskEdgeSearch<'a>>,
    least_contrast: f64,
}

impl<'a> ColorEdgeSearch<'a> {
    /// Edges of an image whose colour changes by at least `least_contrast` grey values (root of the sum of squares over the channels) over two
    /// pixels.
    pub fn new(picture: &'a RgbImage, least_contrast: f64) -> Self {
        Self { picture, band: None, least_contrast }
    }

    /// Restricts the edges to a mask whose top left pixel is pixel `corner` of the image.
    pub fn within(self, band: &'a PixelMask, corner: (usize, usize)) -> Self {
        Self { band: Some(MaskEdgeSearch::new(band, corner)), ..self }
    }

    /// Colour between the centres of four pixels; beyond the rim the last pixel repeats.
    fn color(&self, point: [f64; 2]) -> [f64; 3] {
        let (width, height) = (self.picture.width() as usize, self.picture.height() as usize);
        let axis = |x: f64, n: usize| {
            let x = (x - 0.5).clamp(0.0, (n - 1) as f64);
            (x as usize, (x as usize + 1).min(n - 1), x.fract())
        };
        let ((u0, u1, du), (v0, v1, dv)) = (axis(point[0], width), axis(point[1], height));
        let pixels = rgb_pixels(self.picture);
        let at = |u: usize, v: usize| pixels[v * width + u].map(f64::from);
        let (a, b, c, d) = (at(u0, v0), at(u1, v0), at(u0, v1), at(u1, v1));
        [0, 1, 2].map(|k| (a[k] * (1.0 - du) + b[k] * du) * (1.0 - dv) + (c[k] * (1.0 - du) + d[k] * du) * dv)
    }
}

impl EdgeSearch for ColorEdgeSearch<'_> {
    fn find(&self, point: [f64; 2], normal: [f64; 2], reach: f64) -> Option<f64> {
        let n = reach.clamp(0.0, 1e3).floor() as i32;
        let at = |k: i32| [0, 1].map(|axis| point[axis] + f64::from(k) * normal[axis]);
        let difference = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let profile: Vec<[f64; 3]> = (-n - 1..=n + 1).map(|k| self.color(at(k))).collect();
        let contrast: Vec<f64> = profile.windows(3).map(|near| difference(near[0], near[2])).collect();
        // Of equal edges the nearer one.
        let score = |i: usize| {
            let k = i as i32 - n;
            let away = f64::from(k) / f64::from(n + 1);
            let allowed = self.band.is_none_or(|band| band.is_on(at(k)) == Some(true));
            if allowed && contrast[i] >= self.least_contrast {
                contrast[i] * (1.0 - 0.5 * away * away)
            } else {
                0.0
            }
        };
        let best =
            (0..contrast.len()).map(|i| (score(i), i)).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        (best.0 > 0.0).then(|| f64::from(best.1 as i32 - n) + vertex(&contrast, best.1))
    }

    fn covers(&self, [u, v]: [f64; 2]) -> bool {
        u >= 0.0
            && v >= 0.0
            && u < self.picture.width() as usize as f64
            && v < self.picture.height() as usize as f64
    }
}

/// Position between -½ and ½ of the vertex of the parabola through a value and its neighbours.
fn vertex(values: &[f64], i: usize) -> f64 {
    let (Some(&next), Some(&before)) = (values.get(i + 1), i.checked_sub(1).and_then(|i| values.get(i)))
    else {
        return 0.0;
    };
    let bend = before - 2.0 * values[i] + next;
    if bend < 0.0 { (0.5 * (before - next) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    #[test]
    fn a_step_between_two_colours_is_found_where_it_is() {
        let bytes =
            (0..20 * 10).flat_map(|i| if i % 20 < 8 { [200, 60, 60] } else { [60, 60, 60] }).collect();
        let picture = RgbImage::from_raw(20, 10, bytes).expect("3 bytes a pixel");
        let edges = ColorEdgeSearch::new(&picture, 20.0);
        for start in [5.0, 6.5, 8.0, 9.5] {
            let found = edges.find([start, 5.0], [1.0, 0.0], 5.0).unwrap();
            assert!(abs_diff_eq!(start + found, 8.0, epsilon = 0.5), "from {start}: {found}");
        }
        assert_eq!(edges.find([2.0, 5.0], [1.0, 0.0], 3.0), None);
        let elsewhere = PixelMask::from_fn(20, 10, |u, _| u > 12).unwrap();
        assert_eq!(edges.within(&elsewhere, (0, 0)).find([8.0, 5.0], [1.0, 0.0], 5.0), None);
    }
}
