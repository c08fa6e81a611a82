use std::collections::VecDeque;

use super::{PoseGraph, RigidPose};

/// Places poses along edges between consecutive identifiers, and where there are none along any edge; landmarks where they are first seen.
///
/// The first pose of each connected part is the origin.
pub(super) fn place<P: RigidPose>(graph: &mut PoseGraph<P>) {
    let n = graph.poses.len();
    let mut neighbours = vec![Vec::new(); n];
    for (number, edge) in graph.edges.iter().enumerate() {
        neighbours[edge.from].push(number);
        neighbours[edge.to].push(number);
    }
    let is_step = |a: usize, b: usize| graph.poses[a].0.abs_diff(graph.poses[b].0) == 1;
    let mut placed: Vec<Option<P>> = vec![None; n];
    for first in 0..n {
        if placed[first].is_some() {
            continue;
        }
        placed[first] = Some(P::identity());
        // Steps first, other edges when there is no step left.
        let (mut steps, mut others) = (VecDeque::from([first]), VecDeque::new());
        while let Some((at, only_steps)) =
            steps.pop_front().map(|at| (at, true)).or_else(|| others.pop_front().map(|at| (at, false)))
        {
            let Some(pose) = placed[at] else { continue };
            for edge in neighbours[at].iter().map(|number| &graph.edges[*number]) {
                let (to, motion) = if edge.from == at {
                    (edge.to, edge.measured)
                } else {
                    (edge.from, edge.measured.inverse())
                };
                if placed[to].is_none() && (!only_steps || is_step(at, to)) {
                    placed[to] = Some(pose.compose(&motion));
                    steps.push_back(to);
                }
            }
            if only_steps {
                others.push_back(at);
            }
        }
    }
    for (pose, placed) in graph.poses.iter_mut().zip(placed) {
        pose.1 = placed.unwrap_or(pose.1);
    }
    for edge in graph.point_edges.iter().rev() {
        let robot = graph.poses[edge.from].1;
        let mut seen = nalgebra::Vector3::zeros();
        seen.as_mut_slice()[..P::N].copy_from_slice(&P::coordinates(&edge.measured));
        graph.points[edge.to].1 = P::point_at(&(robot.rotation_part() * seen + robot.translation_part()));
    }
}
