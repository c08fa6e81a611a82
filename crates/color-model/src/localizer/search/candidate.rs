use nalgebra::{Vector3, Vector4};
use wayfix_estimation_traits::{LogWeight, Manifold, Pose2};

use super::trajectory::Trajectory;
use crate::likelihood::TileLight;

/// A trajectory, and how well it explains the frames.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) trajectory: Trajectory,
    pub(super) light: FittedLight,
    pub(super) log_evidence: LogWeight,
    /// Of each frame that was weighed, its index and its log-likelihood in the light.
    pub(super) log_likelihoods: Vec<(usize, LogWeight)>,
    pub(super) steps: Steps,
    /// The place of a filter before the search, if the candidate started there; it stays there.
    pub(super) known: Option<Pose2<f64>>,
}

/// The next step along each axis.
#[derive(Clone, Default)]
pub(super) struct Steps {
    /// Of the pose, in cells.
    pub(super) pose: Vector3<f64>,
    /// Of the camera's error at all frames alike, in standard deviations.
    pub(super) mount: Vector4<f64>,
    /// Of the odometry from the frame before to each frame, in standard deviations.
    pub(super) odometry: Vec<Vector3<f64>>,
    /// Of the camera's error at each frame, in standard deviations.
    pub(super) sway: Vec<Vector4<f64>>,
}

impl Steps {
    /// Steps of the pose of this many cells, and one standard deviation of all errors.
    pub(super) fn new(pose: f64, n_frames: usize) -> Self {
        Self {
            pose: Vector3::repeat(pose),
            mount: Vector4::repeat(1.0),
            odometry: vec![Vector3::repeat(1.0); n_frames],
            sway: vec![Vector4::repeat(1.0); n_frames],
        }
    }
}

/// The light that a candidate's frames show.
#[derive(Clone, Default)]
pub(super) struct FittedLight {
    /// Index of the tracker whose light it is.
    pub(super) tracker: usize,
    /// Which of its lights.
    pub(super) light: usize,
    /// The light, and its shade if there is any.
    pub(super) lights: Vec<TileLight>,
    /// Of the lights under the tracker's belief, nats.
    pub(super) log_density: LogWeight,
}

impl Candidate {
    pub(super) fn new(trajectory: Trajectory) -> Self {
        Self {
            trajectory,
            light: FittedLight::default(),
            log_evidence: f64::NEG_INFINITY,
            log_likelihoods: Vec::new(),
            steps: Steps::default(),
            known: None,
        }
    }
}

/// Keeps the `n` best that are at least a `distance` (m and rad) from each other, the best first, and the known ones.
pub(super) fn retain_distant(candidates: &mut Vec<Candidate>, n: usize, distance: f64) {
    candidates.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in candidates.drain(..) {
        let pose = candidate.trajectory.newest;
        let is_near = |other: &Candidate| other.trajectory.newest.local(&pose).norm() < distance;
        if candidate.known.is_some() || (kept.len() < n.max(1) && !kept.iter().any(is_near)) {
            kept.push(candidate);
        }
    }
    *candidates = kept;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_near_candidates_stays_and_the_known_ones_do() {
        let candidate = |x: f64, log_evidence: LogWeight, is_known: bool| {
            let newest = Pose2::new(x, 0.0, 0.0);
            let known = is_known.then_some(newest);
            Candidate { log_evidence, known, ..Candidate::new(Trajectory::through(&newest, 0, &[])) }
        };
        let all =
            [(0.0, 1.0, false), (0.2, 3.0, false), (1.0, 2.0, false), (2.0, 0.0, false), (0.1, -9.0, true)];
        let kept = |n: usize, distance: f64| {
            let mut candidates = all.map(|(x, log, is_known)| candidate(x, log, is_known)).to_vec();
            retain_distant(&mut candidates, n, distance);
            candidates.iter().map(|one| one.trajectory.newest.x()).collect::<Vec<_>>()
        };
        assert_eq!(kept(2, 0.3), [0.2, 1.0, 0.1]);
        assert_eq!(kept(usize::MAX, 0.15), [0.2, 1.0, 0.0, 2.0, 0.1]);
    }
}
