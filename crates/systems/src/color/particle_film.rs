use std::sync::Arc;

use anyhow::Result;
use wayfix_color_model::LightingFilter;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{EncodedImage, Stamp};

use super::{ColorRun, ColorSystem, field_lines, uv_ellipses};
use wayfix_evaluation::plot::{CovarianceEllipsesPlot, FilmStrip, FilmStripFrame, NamedEllipse, SvgPlot};

/// Frames of the film; each represents a part of the run.
const N_FRAMES: usize = 6;
/// Frames per row; there are two rows.
const FRAMES_A_ROW: usize = 3;
/// Width of a frame, pixels.
const WIDTH: usize = 480;
/// Margin around the field, m.
const MARGIN: f64 = 0.4;
const PAPER: [u8; 3] = [246, 247, 249];
const LINES: [u8; 3] = [190, 196, 204];
const PARTICLES: [u8; 3] = [31, 119, 180];
const ESTIMATE: [u8; 3] = [240, 160, 0];
const TRUTH: [u8; 3] = [214, 39, 40];

/// The particles on the field and the colours of the light at some moments of a run, recorded during the run and drawn afterwards.
///
/// Of each sixth of the run it shows the moment with the most particles, where the uncertainty is largest.
pub struct ParticleSnapshots {
    n_camera_frames: usize,
    kept: [Option<Moment>; N_FRAMES],
}

struct Moment {
    stamp: Stamp,
    particles: Vec<[f64; 2]>,
    estimate: Pose2<f64>,
    /// Number of the active light, and its colours.
    light: (usize, Vec<NamedEllipse>),
}

impl ParticleSnapshots {
    /// Creates a film for a log of this many camera frames.
    pub fn new(n_camera_frames: usize) -> Self {
        Self { n_camera_frames, kept: [const { None }; N_FRAMES] }
    }

    /// Records the state of the system; call it after every record.
    pub fn observe(&mut self, system: &ColorSystem) {
        let (Some(frame), Some(localizer)) = (system.frames().last(), system.localizer()) else { return };
        let kept = &mut self.kept[part_of(system.frames().len() - 1, self.n_camera_frames)];
        let n_kept = kept.as_ref().map_or(0, |kept| kept.particles.len());
        if localizer.poses().count() > n_kept {
            let particles = localizer.poses().map(|(pose, _)| [pose.x(), pose.y()]).collect();
            let active = localizer.light().active();
            let light = (active, uv_ellipses(system.map().colors(), localizer.light().member(active)));
            *kept = Some(Moment { stamp: frame.stamp, particles, estimate: *frame.pose.mean(), light });
        }
    }

    /// The colours of each light's prior beside those of the active light over time, and the film of the particles. [Schulz & Fox 2004, Fig. 5]
    ///
    /// # Errors
    /// Returns an error if a picture cannot be drawn.
    pub fn draw(&self, run: &ColorRun) -> Result<[SvgPlot; 2]> {
        let moment = |moment: &Moment| {
            let (active, ellipses) = &moment.light;
            (format!("{:.1} s, light {active}, V", run.seconds(moment.stamp)), ellipses.clone())
        };
        let mut groups = priors(run)?;
        groups.extend(self.kept.iter().flatten().map(moment));
        let colors = CovarianceEllipsesPlot {
            title: "Colours of the priors, and of the active light over time (1σ in U and V)".to_owned(),
            x_label: "U".to_owned(),
            sigmas: 1.0,
            groups,
        };
        Ok([colors.draw()?, self.film(run)?])
    }

    fn film(&self, run: &ColorRun) -> Result<SvgPlot> {
        let field = field_lines(run.system.map());
        let sheet = Sheet::around(&field);
        let frame = |moment: &Moment| -> Result<FilmStripFrame> {
            let mut sheet = sheet.clone();
            field.iter().for_each(|line| sheet.line(line, LINES));
            moment.particles.iter().for_each(|&particle| sheet.disc(particle, 1.5, PARTICLES));
            if let Some(truth) = run.truth.at(moment.stamp) {
                sheet.pose(&truth, TRUTH);
            }
            sheet.pose(&moment.estimate, ESTIMATE);
            let image = EncodedImage::png_rgb(WIDTH as u32, sheet.height as u32, &sheet.pixels.concat())?;
            let caption = format!("{:.1} s, {} particles", run.seconds(moment.stamp), moment.particles.len());
            Ok(FilmStripFrame { image, caption })
        };
        let frames: Vec<FilmStripFrame> = self.kept.iter().flatten().map(frame).collect::<Result<_>>()?;
        let legends = ["blue: particles about the most probable place", "orange: estimate, red: truth"];
        let rows = frames.chunks(FRAMES_A_ROW).zip(legends);
        let film = FilmStrip {
            title: "Particles on the field".to_owned(),
            rows: rows.map(|(frames, legend)| (legend.to_owned(), frames.to_vec())).collect(),
            frame_size: (WIDTH as u32, sheet.height as u32),
        };
        Ok(film.draw()?)
    }
}

/// The colours of each light before the run. [Schulz & Fox 2004, Fig. 5a, b]
fn priors(run: &ColorRun) -> Result<Vec<(String, Vec<NamedEllipse>)>> {
    let prior = |(number, light): (usize, &Arc<LightingFilter>)| {
        let light = LightingFilter::new(light.prior().clone(), *light.params())?;
        Ok((format!("prior of light {number}, V"), uv_ellipses(run.system.map().colors(), &light)))
    };
    run.system.light().members().iter().enumerate().map(prior).collect()
}

/// The part of the run of a camera frame; a log may have more frames than announced.
fn part_of(frame: usize, n_camera_frames: usize) -> usize {
    (frame * N_FRAMES / n_camera_frames.max(1)).min(N_FRAMES - 1)
}

/// Pixels of a part of the plane, y up.
#[derive(Clone)]
struct Sheet {
    left: f64,
    top: f64,
    pixels_per_meter: f64,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Sheet {
    /// A white sheet that shows all of the lines, or a square around the origin if there are none.
    fn around(lines: &[Vec<(f64, f64)>]) -> Self {
        let range = |of: fn(&(f64, f64)) -> f64| {
            let values = lines.iter().flatten().map(of);
            let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
            (low - MARGIN, high + MARGIN)
        };
        let ((left, right), (bottom, top)) = (range(|point| point.0), range(|point| point.1));
        let pixels_per_meter = WIDTH as f64 / (right - left);
        let height = ((top - bottom) * pixels_per_meter).ceil().clamp(1.0, 2.0 * WIDTH as f64) as usize;
        Self { left, top, pixels_per_meter, height, pixels: vec![PAPER; WIDTH * height] }
    }

    /// Draws a pose as a disc with a heading line.
    fn pose(&mut self, pose: &Pose2<f64>, ink: [u8; 3]) {
        let (sin, cos) = pose.heading().sin_cos();
        let ahead = 20.0 / self.pixels_per_meter;
        self.disc([pose.x(), pose.y()], 6.0, ink);
        self.line(&[(pose.x(), pose.y()), (pose.x() + ahead * cos, pose.y() + ahead * sin)], ink);
    }

    fn line(&mut self, points: &[(f64, f64)], ink: [u8; 3]) {
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
    fn disc(&mut self, [x, y]: [f64; 2], radius: f64, ink: [u8; 3]) {
        let (column, row) = ((x - self.left) * self.pixels_per_meter, (self.top - y) * self.pixels_per_meter);
        let reach = radius.ceil() as i64;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (at_x, at_y) = (column.floor() + dx as f64, row.floor() + dy as f64);
                let is_inside =
                    (0.0..WIDTH as f64).contains(&at_x) && (0.0..self.height as f64).contains(&at_y);
                if is_inside && (dx as f64).hypot(dy as f64) <= radius {
                    self.pixels[at_y as usize * WIDTH + at_x as usize] = ink;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_parts_of_a_run_are_equal_and_all_of_it() {
        let parts = |n: usize| (0..n).map(|frame| part_of(frame, n)).collect::<Vec<_>>();
        assert_eq!(parts(12), [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]);
        assert_eq!(parts(3), [0, 2, 4]);
        assert_eq!((part_of(0, 0), part_of(99, 12)), (0, N_FRAMES - 1));
    }

    #[test]
    fn plane_up_is_picture_up_and_non_finite_is_not_drawn() {
        let mut sheet = Sheet::around(&[vec![(-2.0, -1.0), (2.0, 1.0)]]);
        sheet.disc([-2.0, 1.0], 1.0, TRUTH);
        sheet.disc([f64::NAN, 0.0], 3.0, ESTIMATE);
        sheet.disc([1e300, f64::INFINITY], 3.0, ESTIMATE);
        let at = sheet.pixels.iter().position(|pixel| *pixel == TRUTH).expect("drawn");
        let (column, row) = ((at % WIDTH) as f64, (at / WIDTH) as f64);
        let margin = MARGIN * sheet.pixels_per_meter;
        assert_abs_diff_eq!(column, margin, epsilon = 3.0);
        assert_abs_diff_eq!(row, margin, epsilon = 3.0);
        assert!(!sheet.pixels.contains(&ESTIMATE));
    }
}
