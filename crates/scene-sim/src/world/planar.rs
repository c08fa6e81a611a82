use nalgebra::Vector2;
use wayfix_sensor_log::{DetectionTarget, TrueLandmark};

use super::{FloorPlan, Wall};
use crate::route::Route;

/// A world for sensors. Implement it for a custom world.
///
/// **Laws**: [`targets`](Self::targets) lists the same objects in the same order at every time (time-correlated errors belong to a place in this
/// list), and results depend only on the arguments.
pub trait SensorWorld {
    /// The surveyed landmarks: the truth in the log.
    fn landmarks(&self) -> Vec<TrueLandmark>;

    /// The surfaces visible to a laser. By default there are none.
    fn walls(&self) -> Vec<Wall> {
        Vec::new()
    }

    /// Everything that could be seen `seconds` after the start, wherever from, and where it is (metres).
    fn targets(&self, seconds: f64) -> Vec<(DetectionTarget, Vector2<f64>)>;

    /// Whether an object hides `point` from `eye`. By default none does.
    fn occludes(&self, eye: &Vector2<f64>, point: &Vector2<f64>) -> bool {
        let _ = (eye, point);
        false
    }
}

/// A world of points, walls and other robots.
///
/// ```
/// use wayfix_scene_sim::world::{FloorPlan, PlanarWorld, SensorWorld};
/// use wayfix_sensor_log::{DetectionTarget, TrueLandmark};
/// let plan = FloorPlan { landmarks: vec![TrueLandmark { id: 7, x: 1.0, y: 2.0 }], walls: vec![] };
/// let world = PlanarWorld::new(plan);
/// assert_eq!(world.targets(0.0)[0].0, DetectionTarget::Landmark(7));
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct PlanarWorld {
    /// Landmarks and walls.
    pub plan: FloorPlan,
    /// Things with a code that the log's own table does not list.
    pub unknown_codes: Vec<(u32, Vector2<f64>)>,
    /// Robots that drive about.
    pub other_robots: Vec<OtherRobot>,
}

/// A robot that follows its route to the millimetre; beyond the end of an open route it drives straight on.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherRobot {
    /// Its number.
    pub id: u32,
    /// Route of the robot.
    pub route: Route,
    /// Speed, m/s.
    pub speed_mps: f64,
}

impl PlanarWorld {
    /// A world of landmarks and walls only.
    pub fn new(plan: FloorPlan) -> Self {
        Self { plan, unknown_codes: Vec::new(), other_robots: Vec::new() }
    }
}

impl SensorWorld for PlanarWorld {
    fn landmarks(&self) -> Vec<TrueLandmark> {
        self.plan.landmarks.clone()
    }

    fn walls(&self) -> Vec<Wall> {
        self.plan.walls.clone()
    }

    fn targets(&self, seconds: f64) -> Vec<(DetectionTarget, Vector2<f64>)> {
        let landmarks =
            self.plan.landmarks.iter().map(|l| (DetectionTarget::Landmark(l.id), Vector2::new(l.x, l.y)));
        let codes = self.unknown_codes.iter().map(|(code, at)| (DetectionTarget::UnknownCode(*code), *at));
        let robots = self
            .other_robots
            .iter()
            .map(|r| (DetectionTarget::Robot(r.id), r.route.at(seconds * r.speed_mps).translation));
        landmarks.chain(codes).chain(robots).collect()
    }

    fn occludes(&self, eye: &Vector2<f64>, point: &Vector2<f64>) -> bool {
        self.plan.walls.iter().any(|wall: &Wall| wall.occludes(eye, point))
    }
}
