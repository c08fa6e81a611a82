use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::LinearRgb;
use super::field::{HALF_LENGTH_M, HALF_WIDTH_M};
use super::picture::{Material, SceneSurface, SurfaceShape};
use crate::random::deviate::uniform;

const RED: [f64; 3] = [0.55, 0.05, 0.04];
const BLUE: [f64; 3] = [0.05, 0.08, 0.35];
const SHELL: [f64; 3] = [0.32, 0.32, 0.34];
const ORANGE: [f64; 3] = [0.80, 0.26, 0.04];
const TROUSERS: [f64; 3] = [0.03, 0.03, 0.035];
const BALL_RADIUS_M: f64 = 0.04;

/// Unmapped objects on the field: a red and a blue robot, an orange ball, a referee's legs. They move slowly and avoid the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct UnmappedObjects {
    red: Round,
    blue: Round,
    ball: Round,
    referee: Round,
}

/// A circular path about a point.
#[derive(Clone, Debug, PartialEq)]
struct Round {
    centre: Vector2<f64>,
    reach: Vector2<f64>,
    phase: f64,
    /// rad/s.
    rate: f64,
}

impl UnmappedObjects {
    /// Somewhere.
    pub fn draw<R: Rng + ?Sized>(rng: &mut R) -> Self {
        let mut round = |half_x: f64, half_y: f64, reach: f64, rate: f64| Round {
            centre: Vector2::new(uniform(-half_x, half_x, rng), uniform(-half_y, half_y, rng)),
            reach: Vector2::new(uniform(0.3, 1.0, rng), uniform(0.3, 1.0, rng)) * reach,
            phase: uniform(0.0, TAU, rng),
            rate: uniform(-rate, rate, rng),
        };
        Self {
            red: round(1.3, 0.7, 0.6, 0.3),
            blue: round(1.3, 0.7, 0.6, 0.3),
            ball: round(1.2, 0.7, 0.7, 0.4),
            referee: round(1.5, 0.2, 0.8, 0.15),
        }
    }

    /// Their surfaces at a time, away from the observing robot.
    pub fn surfaces(&self, seconds: f64, watcher: &Pose2<f64>) -> Vec<SceneSurface> {
        let mut surfaces = robot(&self.red.pose(seconds, watcher, 0.4), RED);
        surfaces.extend(robot(&self.blue.pose(seconds, watcher, 0.4), BLUE));
        let ball = self.ball.pose(seconds, watcher, 0.25).translation;
        let centre = Vector3::new(ball.x, ball.y, BALL_RADIUS_M);
        surfaces.push(SceneSurface {
            form: SurfaceShape::Ball { centre, radius: BALL_RADIUS_M },
            material: material(ORANGE),
        });
        surfaces.extend(self.legs(seconds));
        surfaces
    }

    /// The referee walks outside the boards, along the one side.
    fn legs(&self, seconds: f64) -> [SceneSurface; 2] {
        let (_, cos) = libm::sincos(self.referee.phase + self.referee.rate * seconds);
        let x = self.referee.centre.x + self.referee.reach.x * cos;
        [-0.13, 0.13].map(|aside| SceneSurface {
            form: SurfaceShape::Tube {
                axis: Vector3::new(x + aside, HALF_WIDTH_M + 0.35 + 0.5 * aside, 0.0),
                radius: 0.075,
                from: 0.0,
                to: 0.9,
            },
            material: material(TROUSERS),
        })
    }
}

impl Round {
    fn pose(&self, seconds: f64, watcher: &Pose2<f64>, distance: f64) -> Pose2<f64> {
        let angle = self.phase + self.rate * seconds;
        let (sin, cos) = libm::sincos(angle);
        let mut at = self.centre + Vector2::new(self.reach.x * cos, self.reach.y * sin);
        let apart = at - watcher.translation;
        let away = apart.try_normalize(0.0).unwrap_or_else(Vector2::x);
        at = watcher.translation + away * apart.norm().max(distance);
        at.x = at.x.clamp(-HALF_LENGTH_M, HALF_LENGTH_M);
        at.y = at.y.clamp(0.2 - HALF_WIDTH_M, HALF_WIDTH_M - 0.2);
        let heading = libm::atan2(self.reach.y * cos, -self.reach.x * sin);
        Pose2::new(at.x, at.y, if self.rate < 0.0 { heading + std::f64::consts::PI } else { heading })
    }
}

fn material(paint: [f64; 3]) -> Material {
    Material::Unmapped(LinearRgb::from(paint))
}

/// Four legs, a body with its team's patches, a head.
fn robot(place: &Pose2<f64>, team: [f64; 3]) -> Vec<SceneSurface> {
    let cuboid = |low, high, paint| SceneSurface::cuboid(place, low, high, material(paint));
    let mut parts: Vec<SceneSurface> = Vec::new();
    for (x, y) in [(-0.09, -0.06), (-0.09, 0.04), (0.07, -0.06), (0.07, 0.04)] {
        parts.extend(cuboid([x, y, 0.0], [x + 0.03, y + 0.02, 0.11], SHELL));
    }
    parts.extend(cuboid([-0.11, -0.05, 0.09], [0.11, 0.05, 0.18], SHELL));
    parts.extend(cuboid([-0.08, -0.054, 0.11], [0.06, 0.054, 0.184], team));
    parts.extend(cuboid([0.09, -0.035, 0.17], [0.19, 0.035, 0.25], SHELL));
    parts.extend(cuboid([0.10, -0.038, 0.19], [0.15, 0.038, 0.253], team));
    parts
}
