use std::sync::Arc;

use anyhow::Result;
use wayfix_color_model::LightingFilter;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::plot::{
    CovarianceEllipsesPlot, FilmStrip, FilmStripFrame, NamedEllipse, RasterMap, SvgPlot,
};
use wayfix_sensor_log::Stamp;
use wayfix_system_core::MOST_ESTIMATES;

use super::{ColorRun, ColorSystem, field_lines, uv_ellipses};

/// Frames of the film; each represents a part of the run.
const N_FRAMES: usize = 6;
/// Frames per row; there are two rows.
const FRAMES_A_ROW: usize = 3;
/// Width of a frame, pixels.
const WIDTH: usize = 480;
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
        let (Some(frame), Some(localizer)) = (system.latest(), system.localizer()) else { return };
        let number = system.sample().n_seen() - 1;
        // Of a long log, truth is known at the frames of the sample.
        if !number.is_multiple_of(self.n_camera_frames.div_ceil(MOST_ESTIMATES).next_power_of_two()) {
            return;
        }
        let kept = &mut self.kept[part_of(number, self.n_camera_frames)];
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
        let sheet = RasterMap::around(&field, WIDTH);
        let frame = |moment: &Moment| -> Result<FilmStripFrame> {
            let mut sheet = sheet.clone();
            field.iter().for_each(|line| sheet.line(line, LINES));
            moment.particles.iter().for_each(|&particle| sheet.disc(particle, 1.5, PARTICLES));
            if let Some(truth) = run.truth.at(moment.stamp) {
                sheet.pose(&truth, TRUTH);
            }
            sheet.pose(&moment.estimate, ESTIMATE);
            let image = sheet.image()?;
            let caption = format!("{:.1} s, {} particles", run.seconds(moment.stamp), moment.particles.len());
            Ok(FilmStripFrame { image, caption })
        };
        let frames: Vec<FilmStripFrame> = self.kept.iter().flatten().map(frame).collect::<Result<_>>()?;
        let legends = ["blue: particles about the most probable place", "orange: estimate, red: truth"];
        let rows = frames.chunks(FRAMES_A_ROW).zip(legends);
        let film = FilmStrip {
            title: "Particles on the field".to_owned(),
            rows: rows.map(|(frames, legend)| (legend.to_owned(), frames.to_vec())).collect(),
            frame_size: sheet.size(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_run_are_equal_and_all_of_it() {
        let parts = |n: usize| (0..n).map(|frame| part_of(frame, n)).collect::<Vec<_>>();
        assert_eq!(parts(12), [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]);
        assert_eq!(parts(3), [0, 2, 4]);
        assert_eq!((part_of(0, 0), part_of(99, 12)), (0, N_FRAMES - 1));
    }
}
