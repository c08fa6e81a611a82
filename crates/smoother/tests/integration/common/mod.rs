//! A small world that tests share.
#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_smoother::{Between, Graph, RelativePosition, VariableId};

/// A robot that goes round a square twice and sees landmarks.
pub(crate) struct World {
    pub(crate) graph: Graph,
    pub(crate) poses: Vec<VariableId<Pose2<f64>>>,
    pub(crate) landmarks: Vec<VariableId<Vector2<f64>>>,
    pub(crate) true_poses: Vec<Pose2<f64>>,
}

/// The first pose is fixed when `is_anchored`; variables start about 0.1 from the truth.
pub(crate) fn world(seed: u64, n_poses: usize, is_anchored: bool) -> World {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = move |size: f64| size * (rng.random::<f64>() + rng.random::<f64>() - 1.0);
    let step = |i: usize| Pose2::new(1.0, 0.0, if i % 5 == 4 { std::f64::consts::FRAC_PI_2 } else { 0.0 });
    let mut true_poses = vec![Pose2::new(0.0, 0.0, 0.0)];
    for i in 1..n_poses {
        true_poses.push(true_poses[i - 1].compose(&step(i)));
    }
    let true_landmarks: Vec<_> =
        (0..4).map(|k| Vector2::new(f64::from(k) * 1.7 - 1.0, f64::from(k % 2) * 3.0 + 1.0)).collect();
    let mut graph = Graph::new();
    let poses: Vec<_> = true_poses
        .iter()
        .map(|pose| graph.add_variable(pose.retract(&Vector3::new(noise(0.1), noise(0.1), noise(0.1)))))
        .collect();
    let landmarks: Vec<_> = true_landmarks
        .iter()
        .map(|landmark| graph.add_variable(landmark + Vector2::new(noise(0.1), noise(0.1))))
        .collect();
    if is_anchored {
        graph.set_value(poses[0], true_poses[0]).unwrap();
        graph.fix(poses[0]).unwrap();
    }
    let motion_information = Matrix3::new(400.0, 10.0, 0.0, 10.0, 400.0, 5.0, 0.0, 5.0, 1600.0);
    for i in 1..n_poses {
        let motion = step(i).retract(&Vector3::new(noise(0.05), noise(0.05), noise(0.02)));
        graph.add(Between::new(motion), (poses[i - 1], poses[i]), motion_information).unwrap();
    }
    for (i, pose) in true_poses.iter().enumerate() {
        let k = i % true_landmarks.len();
        let measured = pose.inverse_transform(&true_landmarks[k]) + Vector2::new(noise(0.1), noise(0.1));
        let seen = RelativePosition { measured };
        graph.add(seen, (poses[i], landmarks[k]), Matrix2::identity() * 100.0).unwrap();
    }
    World { graph, poses, landmarks, true_poses }
}
