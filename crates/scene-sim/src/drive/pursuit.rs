use wayfix_estimation_traits::Pose2;

use super::WheeledRobotParams;
use crate::plane;
use crate::route::Route;

/// A driver that steers towards a point ahead on the route. [Coulter 1992]
///
/// It uses the true pose; a simulated log does not depend on estimates.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PurePursuit {
    /// Progress along the route, m.
    progress_m: f64,
    /// The commanded speed, m/s.
    speed_mps: f64,
}

impl PurePursuit {
    /// Forward speed (m/s) and turning rate (rad/s) for the next `step_s` seconds: $`ω = v \, 2y/(x^2+y^2)`$ for the goal at
    /// $`(x, y)`$ in the robot's frame.
    pub fn command(
        &mut self,
        step_s: f64,
        route: &Route,
        pose: &Pose2<f64>,
        params: &WheeledRobotParams,
    ) -> (f64, f64) {
        let nearest = route.at(self.progress_m);
        self.progress_m += plane::to_body(&nearest, &pose.translation).x;
        self.speed_mps = self.ramped_speed(step_s, route, params);
        let goal = plane::to_body(pose, &route.at(self.progress_m + params.lookahead_m).translation);
        let curvature = 2.0 * goal.y / goal.norm_squared().max(f64::MIN_POSITIVE);
        (self.speed_mps, self.speed_mps * curvature)
    }

    /// Speeds up and slows down no faster than allowed, and stops at the end of an open route.
    fn ramped_speed(&self, step_s: f64, route: &Route, params: &WheeledRobotParams) -> f64 {
        let left_m = if route.is_closed() { f64::INFINITY } else { route.length_m() - self.progress_m };
        let braking = (2.0 * params.acceleration_mps2 * left_m.max(0.0)).sqrt();
        let change = params.acceleration_mps2 * step_s;
        params.speed_mps.min(braking).min(self.speed_mps + change).max(self.speed_mps - change).max(0.0)
    }
}
