use std::collections::BTreeSet;

use nalgebra::DMatrix;
use wayfix_estimation_traits::{Pose2, Pose3};

use super::RigidPose;

/// The graph of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum G2o {
    /// Of poses in the plane.
    Planar(PoseGraph<Pose2<f64>>),
    /// Of poses in space.
    Spatial(PoseGraph<Pose3<f64>>),
}

/// Poses, landmarks, and what was measured between them.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseGraph<P: RigidPose> {
    /// Identifier and pose, in the order of the file.
    pub poses: Vec<(u64, P)>,
    /// Identifier and landmark, in the order of the file.
    pub points: Vec<(u64, P::Point)>,
    /// Measurements between poses.
    pub edges: Vec<Edge<P>>,
    /// Measurements of landmarks.
    pub point_edges: Vec<PointEdge<P>>,
    /// Identifiers of vertices that stay where they are.
    pub fixed: BTreeSet<u64>,
    /// Whether the file told no vertices, so that they are from dead reckoning.
    pub is_dead_reckoned: bool,
}

/// A pose measured from another.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge<P> {
    /// Place of the first pose in [`PoseGraph::poses`].
    pub from: usize,
    /// Place of the second.
    pub to: usize,
    /// The second as seen from the first.
    pub measured: P,
    /// Inverse of the covariance, in the order (translation, rotation).
    pub information: DMatrix<f64>,
    /// Line of the file, from 1.
    pub line: usize,
}

/// A landmark measured from a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct PointEdge<P: RigidPose> {
    /// Place of the pose in [`PoseGraph::poses`].
    pub from: usize,
    /// Place of the landmark in [`PoseGraph::points`].
    pub to: usize,
    /// The landmark in the body frame, metres.
    pub measured: P::Point,
    /// Inverse of the covariance.
    pub information: DMatrix<f64>,
    /// Line of the file, from 1.
    pub line: usize,
}

impl<P: RigidPose> PoseGraph<P> {
    /// Identifiers of the vertices that stay: those of `FIX`, else the first pose.
    pub fn held(&self) -> BTreeSet<u64> {
        if self.fixed.is_empty() {
            self.poses.first().map(|(id, _)| *id).into_iter().collect()
        } else {
            self.fixed.clone()
        }
    }

    /// Identifier of the variable with this number: poses come before landmarks.
    pub fn vertex(&self, variable: usize) -> u64 {
        match self.poses.get(variable) {
            Some((id, _)) => *id,
            None => self.points[variable - self.poses.len()].0,
        }
    }
}
