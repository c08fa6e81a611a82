use std::collections::BTreeMap;

use wayfix_estimation_traits::{LieGroup, Pose3};

/// The latest transform of every frame: where it is in its parent.
#[derive(Debug, Default)]
pub(super) struct Transforms {
    parents: BTreeMap<String, (String, Pose3<f64>)>,
}

/// Names of the robot's own frame [REP 105; REP 120 for the one on the ground], the better one last.
const BODY: [&str; 2] = ["base_link", "base_footprint"];

impl Transforms {
    pub(super) fn insert(&mut self, parent: &str, child: &str, pose: Pose3<f64>) {
        self.parents.insert(bare(child).to_owned(), (bare(parent).to_owned(), pose));
    }

    /// Pose of a frame in the robot's frame: the ground frame if there is one, else the child frame of odometry, else `base_link`.
    pub(super) fn in_body(&self, frame: &str, odometry_child: Option<&str>) -> Option<Pose3<f64>> {
        let rank = |name: &str| {
            let named = BODY.iter().position(|body| last_part(name) == *body);
            if odometry_child.is_some_and(|child| bare(child) == name) { named.max(Some(0)) } else { named }
        };
        // Of equals the one nearest to the frame.
        let mut best: Option<(usize, Pose3<f64>)> = None;
        for (name, pose) in self.ancestors(frame) {
            if let Some(rank) = rank(name)
                && best.as_ref().is_none_or(|(found, _)| rank > *found)
            {
                best = Some((rank, pose));
            }
        }
        best.map(|(_, pose)| pose)
    }

    /// Pose of a frame in the nearest ancestor of a name, with or without a namespace.
    pub(super) fn in_ancestor(&self, frame: &str, ancestor: &str) -> Option<Pose3<f64>> {
        self.ancestors(frame).find(|(name, _)| last_part(name) == ancestor).map(|(_, pose)| pose)
    }

    /// The frame and its ancestors, with the pose of the frame in each.
    fn ancestors<'a>(&'a self, frame: &'a str) -> impl Iterator<Item = (&'a str, Pose3<f64>)> {
        let mut next = Some((bare(frame), Pose3::identity()));
        // A circle of frames ends after all of them.
        (0..=self.parents.len()).map_while(move |_| {
            let (name, pose) = next.take()?;
            next = self.parents.get(name).map(|(parent, step)| (parent.as_str(), step.compose(&pose)));
            Some((name, pose))
        })
    }
}

/// Whether this is a name of the robot's own frame.
pub(super) fn is_body(frame: &str) -> bool {
    BODY.contains(&last_part(frame))
}

/// The name without its namespace.
pub(super) fn last_part(frame: &str) -> &str {
    frame.rsplit('/').next().unwrap_or(frame)
}

/// Before ROS 2, names of frames began with a slash.
fn bare(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    fn pose(x: f64, z: f64, yaw: f64) -> Pose3<f64> {
        Pose3 {
            translation: Vector3::new(x, 0.0, z),
            rotation: UnitQuaternion::from_euler_angles(0.0, 0.0, yaw),
        }
    }

    fn robot() -> Transforms {
        let mut transforms = Transforms::default();
        transforms.insert("odom", "base_footprint", pose(7.0, 0.0, 0.0));
        transforms.insert("base_footprint", "base_link", pose(0.0, 0.1, 0.0));
        transforms.insert("base_link", "mast", pose(1.0, 0.5, std::f64::consts::PI));
        transforms.insert("mast", "camera", pose(0.25, 0.0, 0.0));
        transforms
    }

    #[test]
    fn a_camera_on_a_mast_is_placed_on_the_ground_below_the_robot() {
        let camera = robot().in_body("/camera", Some("base_link")).unwrap();
        assert_abs_diff_eq!(camera.translation, Vector3::new(0.75, 0.0, 0.6), epsilon = 1e-15);
    }

    #[test]
    fn mount_falls_back_to_the_body_frame_and_then_to_none() {
        let mut transforms = Transforms::default();
        transforms.insert("r1/base_link", "r1/laser", pose(0.5, 0.25, 0.0));
        assert_eq!(transforms.in_body("r1/laser", None), Some(pose(0.5, 0.25, 0.0)));
        assert_eq!(transforms.in_body("elsewhere", None), None);
        transforms.insert("chassis", "lidar", pose(2.0, 0.0, 0.0));
        assert_eq!(transforms.in_body("lidar", Some("chassis")), Some(pose(2.0, 0.0, 0.0)));
    }

    #[test]
    fn frames_in_a_circle_end() {
        let mut transforms = Transforms::default();
        transforms.insert("a", "b", pose(1.0, 0.0, 0.0));
        transforms.insert("b", "a", pose(1.0, 0.0, 0.0));
        assert_eq!(transforms.in_ancestor("a", "map"), None);
        assert_eq!(transforms.in_body("a", None), None);
    }
}
