use std::f64::consts::TAU;

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use super::camera::OmniCameraParams;
use super::panel::Panel;
use crate::plane;

/// First intersection of each ray of a view.
#[derive(Clone, Debug)]
pub(super) struct Depths {
    /// Unit vectors in the robot's frame, one an azimuth.
    rays: Vec<Vector2<f64>>,
    /// Tangents of the elevations, lowest first.
    pub(super) slopes: Vec<f64>,
    /// Angle between neighbouring rays across and down, radians.
    pub(super) steps: [f64; 2],
    eye_m: f64,
    met: Vec<PanelHit>,
}

/// A place on a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PanelHit {
    /// Number of the panel; [`PanelHit::NOTHING`] for floor and ceiling.
    pub(super) panel: u32,
    /// Horizontal distance, metres.
    pub(super) distance: f64,
    /// From the panel's left foot, metres.
    pub(super) along: f64,
    /// Metres along the panel from one ray to the next.
    pub(super) spread: f64,
}

impl PanelHit {
    pub(super) const NOTHING: u32 = u32::MAX;
    const FAR: Self = Self { panel: Self::NOTHING, distance: f64::INFINITY, along: 0.0, spread: 0.0 };
}

impl Depths {
    pub(super) fn new(params: &OmniCameraParams) -> Self {
        let (n_azimuths, n_elevations) =
            (params.n_columns * params.rays_per_pixel[0], params.n_rings * params.rays_per_pixel[1]);
        let across = TAU / n_azimuths as f64;
        let down = (params.max_elevation_rad - params.min_elevation_rad) / n_elevations as f64;
        let slope = |j| libm::tan(params.min_elevation_rad + (f64::from(j) + 0.5) * down);
        Self {
            rays: (0..n_azimuths).map(|k| plane::direction((k as f64 + 0.5) * across)).collect(),
            slopes: (0..n_elevations as u32).map(slope).collect(),
            steps: [across, down],
            eye_m: params.height_m,
            met: vec![PanelHit::FAR; n_azimuths * n_elevations],
        }
    }

    pub(super) fn clear(&mut self) {
        self.met.fill(PanelHit::FAR);
    }

    /// First intersections of the rays of one azimuth, the lowest first.
    pub(super) fn column(&self, azimuth: usize) -> &[PanelHit] {
        let n = self.slopes.len();
        &self.met[azimuth * n..(azimuth + 1) * n]
    }

    /// Direction of an azimuth in the robot's frame.
    pub(super) fn ray(&self, azimuth: usize) -> Vector2<f64> {
        self.rays[azimuth]
    }

    pub(super) fn n_azimuths(&self) -> usize {
        self.rays.len()
    }

    /// Draws a panel, seen from `pose`, in front of farther ones.
    pub(super) fn put(&mut self, number: u32, panel: &Panel, pose: &Pose2<f64>) {
        if !panel.faces(&pose.translation) {
            return;
        }
        let (left, right) = (plane::to_body(pose, &panel.left), plane::to_body(pose, &panel.right));
        let side = right - left;
        let (length, n) = (side.norm(), self.slopes.len());
        for azimuth in self.between(&right, &left) {
            let ray = self.rays[azimuth];
            let across = ray.perp(&side);
            let distance = left.perp(&side) / across;
            // At grazing angles the ray may pass the panel by a hair.
            if distance.is_nan() || distance <= 0.0 {
                continue;
            }
            let along = (left.perp(&ray) / across * length).clamp(0.0, length);
            let spread = distance * self.steps[0] * length / across.abs();
            let met = PanelHit { panel: number, distance, along, spread };
            let [low, high] = [panel.bottom_m, panel.top_m].map(|height| (height - self.eye_m) / distance);
            let column = &mut self.met[azimuth * n..(azimuth + 1) * n];
            for (seen, slope) in column.iter_mut().zip(&self.slopes) {
                if *slope >= low && *slope < high && distance < seen.distance {
                    *seen = met;
                }
            }
        }
    }

    /// The azimuths of the rays from the direction of one point counter-clockwise to that of another.
    fn between(&self, from: &Vector2<f64>, to: &Vector2<f64>) -> impl Iterator<Item = usize> + use<> {
        let n = self.rays.len();
        let azimuth =
            |point: &Vector2<f64>| libm::atan2(point.y, point.x).rem_euclid(TAU) / self.steps[0] - 0.5;
        let (first, last) = (azimuth(from), azimuth(to));
        let turns = if last < first { n as f64 } else { 0.0 };
        let (first, end) = (first.ceil(), (last + turns).floor());
        let count = (end - first + 1.0).clamp(0.0, n as f64) as usize;
        let first = first.rem_euclid(n as f64) as usize;
        (first..first + count).map(move |azimuth| azimuth % n)
    }
}
