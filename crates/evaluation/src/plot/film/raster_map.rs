use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{EncodedImage, ImageError};

/// Margin around the lines, m.
const MARGIN: f64 = 0.4;
const PAPER: [u8; 3] = [246, 247, 249];

/// A map of a part of the plane in pixels, y up.
#[derive(Clone, Debug)]
pub struct RasterMap {
    left: f64,
    top: f64,
    pixels_per_meter: f64,
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl RasterMap {
    /// An empty map of this width that shows all of the lines, or a square around the origin if there are none.
    pub fn around(lines: &[Vec<(f64, f64)>], width: usize) -> Self {
        let range = |of: fn(&(f64, f64)) -> f64| {
            let values = lines.iter().flatten().map(of);
            let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
            (low - MARGIN, high + MARGIN)
        };
        let ((left, right), (bottom, top)) = (range(|point| point.0), range(|point| point.1));
        let pixels_per_meter = width as f64 / (right - left);
        let height = ((top - bottom) * pixels_per_meter).ceil().clamp(1.0, 2.0 * width as f64) as usize;
        Self { left, top, pixels_per_meter, width, height, pixels: vec![PAPER; width * height] }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width as u32, self.height as u32)
    }

    /// The map as PNG.
    ///
    /// # Errors
    /// Returns an error if it cannot be encoded.
    pub fn image(&self) -> Result<EncodedImage, ImageError> {
        EncodedImage::png_rgb(self.width as u32, self.height as u32, &self.pixels.concat())
    }

    /// Draws a pose as a disc with a heading line.
    pub fn pose(&mut self, pose: &Pose2<f64>, ink: [u8; 3]) {
        let (sin, cos) = pose.heading().sin_cos();
        let ahead = 20.0 / self.pixels_per_meter;
        self.disc([pose.x(), pose.y()], 6.0, ink);
        self.line(&[(pose.x(), pose.y()), (pose.x() + ahead * cos, pose.y() + ahead * sin)], ink);
    }

    /// Draws a line through points.
    pub fn line(&mut self, points: &[(f64, f64)], ink: [u8; 3]) {
        for pair in points.windows(2) {
            let &[(x0, y0), (x1, y1)] = pair else { continue };
            let length = (x1 - x0).hypot(y1 - y0) * self.pixels_per_meter;
            // Bound the number of steps of a line.
            let n_steps = length.ceil().clamp(1.0, 10_000.0);
            for k in 0..=n_steps as usize {
                let share = k as f64 / n_steps;
                self.disc([x0 + share * (x1 - x0), y0 + share * (y1 - y0)], 1.0, ink);
            }
        }
    }

    /// Draws a disc with a radius in pixels; clips it to the sheet.
    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, ink: [u8; 3]) {
        let (column, row) = ((x - self.left) * self.pixels_per_meter, (self.top - y) * self.pixels_per_meter);
        let reach = radius.ceil() as i64;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (at_x, at_y) = (column.floor() + dx as f64, row.floor() + dy as f64);
                let is_inside =
                    (0.0..self.width as f64).contains(&at_x) && (0.0..self.height as f64).contains(&at_y);
                if is_inside && (dx as f64).hypot(dy as f64) <= radius {
                    self.pixels[at_y as usize * self.width + at_x as usize] = ink;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    const RED: [u8; 3] = [214, 39, 40];
    const ORANGE: [u8; 3] = [240, 160, 0];

    #[test]
    fn plane_up_is_picture_up_and_non_finite_is_not_drawn() {
        let mut map = RasterMap::around(&[vec![(-2.0, -1.0), (2.0, 1.0)]], 480);
        map.disc([-2.0, 1.0], 1.0, RED);
        map.disc([f64::NAN, 0.0], 3.0, ORANGE);
        map.disc([1e300, f64::INFINITY], 3.0, ORANGE);
        let at = map.pixels.iter().position(|pixel| *pixel == RED).expect("drawn");
        let (column, row) = ((at % map.width) as f64, (at / map.width) as f64);
        let margin = MARGIN * map.pixels_per_meter;
        assert_abs_diff_eq!(column, margin, epsilon = 3.0);
        assert_abs_diff_eq!(row, margin, epsilon = 3.0);
        assert!(!map.pixels.contains(&ORANGE));
    }
}
