use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::plot::{MapPlot, wall_band};
use wayfix_slam_ekf::{ExpectedLandmarks, WallMeasurement};

use super::super::WallModel;

/// The scan in which most of the expected walls were found, in the frame of the robot. [Andrade-Cetto 2005, Fig. 1a]
#[derive(Default)]
pub(in super::super) struct SearchBandScan {
    n_found: usize,
    echoes: Vec<(f64, f64)>,
    segments: Vec<Vec<(f64, f64)>>,
    /// Outlines of the predictions. The search adds the noise of the segment.
    bands: Vec<Vec<(f64, f64)>>,
}

impl SearchBandScan {
    /// Takes a scan if more walls were found in it than in the one that is kept. `points` are in the frame of the robot, all else in that of a laser at `mount`.
    pub(in super::super) fn offer<'a>(
        &mut self,
        n_found: usize,
        (points, mount): (&[Vector2<f64>], &Pose2<f64>),
        segments: impl Iterator<Item = &'a WallMeasurement>,
        expected: &ExpectedLandmarks<WallModel>,
    ) {
        if n_found <= self.n_found {
            return;
        }
        let in_robot = |point: &Vector2<f64>| {
            let point = mount.transform(point);
            (point.x, point.y)
        };
        let band = |wall: &WallMeasurement, covariance: [[f64; 2]; 2]| {
            wall_band(
                wall.ends.each_ref().map(in_robot),
                wall.ends.map(|end| wall.line.along(&end)),
                covariance,
            )
        };
        *self = Self {
            n_found,
            echoes: points.iter().map(|point| (point.x, point.y)).collect(),
            segments: segments.map(|wall| wall.ends.iter().map(in_robot).collect()).collect(),
            bands: expected
                .predicted()
                .iter()
                .map(|wall| band(&wall.expected, wall.covariance.transpose().into()))
                .collect(),
        };
    }

    /// The picture; `None` if no expected wall was found.
    pub(super) fn plot(&self) -> Option<MapPlot> {
        (self.n_found > 0).then(|| MapPlot {
            title: format!(
                "A scan with the 2σ bands of {} predicted walls, {} of them found",
                self.bands.len(),
                self.n_found
            ),
            echoes: self.echoes.clone(),
            walls: self.segments.clone(),
            bands: self.bands.clone(),
            ..MapPlot::default()
        })
    }
}
