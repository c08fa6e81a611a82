use std::f64::consts::TAU;

use crate::RgbImage;

/// Number of points on an ellipse at which the gradient is evaluated.
pub(super) const N_POINTS: usize = 64;

/// The gradient of the grey values of a picture.
#[derive(Clone, Debug)]
pub(super) struct GradientField {
    width: usize,
    height: usize,
    gradients: Vec<[f32; 2]>,
}

/// The rim of an ellipse about the origin: points in whole pixels, and the normals there.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    points: Vec<([i64; 2], [f32; 2])>,
}

impl GradientField {
    pub(super) fn new(picture: &RgbImage) -> Self {
        let (width, height, grey) =
            (picture.width() as usize, picture.height() as usize, crate::picture::grey(picture));
        let at = |u: usize, v: usize| f32::from(grey[v * width + u]);
        let gradient = |i: usize| {
            let (u, v) = (i % width, i / width);
            [
                at((u + 1).min(width - 1), v) - at(u.saturating_sub(1), v),
                at(u, (v + 1).min(height - 1)) - at(u, v.saturating_sub(1)),
            ]
        };
        Self { width, height, gradients: (0..width * height).map(gradient).collect() }
    }

    /// The mean gradient across a rim about `center`, $`\frac1N \sum_i |n_i · g_i|`$; beyond the picture there is none. [Birchfield 1998]
    pub(super) fn across(&self, rim: &Rim, center: [i64; 2]) -> f64 {
        f64::from(self.strengths(rim, center).sum::<f32>()) / N_POINTS as f64
    }

    /// $`|n_i · g_i|`$ at every point of a rim about `center`.
    pub(super) fn strengths(&self, rim: &Rim, center: [i64; 2]) -> impl Iterator<Item = f32> {
        rim.points.iter().map(move |(offset, normal)| self.along(center, offset, normal).abs())
    }

    fn along(&self, center: [i64; 2], offset: &[i64; 2], normal: &[f32; 2]) -> f32 {
        let inside = |axis: usize, len: usize| {
            let place = usize::try_from(center[axis] + offset[axis]).ok()?;
            (place < len).then_some(place)
        };
        let (Some(u), Some(v)) = (inside(0, self.width), inside(1, self.height)) else { return 0.0 };
        let gradient = self.gradients[v * self.width + u];
        gradient[0] * normal[0] + gradient[1] * normal[1]
    }
}

impl Rim {
    /// Of the ellipse with the semi-axes `[a, b]`.
    pub(super) fn ellipse([a, b]: [f64; 2]) -> Self {
        let point = |i: usize| {
            let angle = TAU * i as f64 / N_POINTS as f64;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let (across, up) = (cos / a, sin / b);
            let length = (across * across + up * up).sqrt();
            let normal = [(across / length) as f32, (up / length) as f32];
            ([(a * cos).round() as i64, (b * sin).round() as i64], normal)
        };
        Self { points: (0..N_POINTS).map(point).collect() }
    }

    /// Every fourth point of the rim about `center`.
    pub(super) fn some_points(&self, center: [i64; 2]) -> Vec<[i64; 2]> {
        let place = |(offset, _): &([i64; 2], [f32; 2])| [center[0] + offset[0], center[1] + offset[1]];
        self.points.iter().step_by(4).map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rim_of_a_disc_is_where_its_edge_is() {
        let disc = |i: usize| (((i % 60) as f64 - 30.0).hypot((i / 60) as f64 - 25.0) < 12.0) as u8 * 200;
        let bytes = (0..60 * 50).flat_map(|i| [disc(i); 3]).collect();
        let field = GradientField::new(&RgbImage::from_raw(60, 50, bytes).expect("3 bytes a pixel"));
        let at = |radius: f64| field.across(&Rim::ellipse([radius; 2]), [30, 25]);
        assert!(at(12.0) > 100.0, "{}", at(12.0)); // half the step of 200 or more reaches each of two pixels
        assert!(at(8.0) < 1.0 && at(16.0) < 1.0);
        assert!(field.across(&Rim::ellipse([12.0; 2]), [-300, 25]) == 0.0);
    }
}
