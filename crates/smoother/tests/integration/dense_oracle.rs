//! The sparse solver against dense linear algebra that shares only the residuals.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use crate::common::world;
use approx::abs_diff_eq;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_smoother::{Between, Graph, Method, Params, RelativePosition, Residual, Stop};

/// Every method ends at the same minimum, where the gradient is zero.
#[test]
fn all_methods_end_at_the_same_minimum() {
    let minima: Vec<_> = [Method::GaussNewton, Method::LevenbergMarquardt, Method::Dogleg]
        .into_iter()
        .map(|method| {
            let mut world = world(3, 24, true);
            let params = Params { method, relative_decrease: 1e-14, ..Params::default() };
            let summary = world.graph.optimize(&params).unwrap();
            assert_eq!(summary.stop, Stop::Converged, "{method:?}");
            assert!(summary.cost < 0.5 * summary.start_cost && summary.cost > 1.0, "{method:?}: {summary:?}");
            let value = *world.graph.value(world.poses[20]).unwrap();
            world.graph.set_value(world.poses[20], value).unwrap(); // the graph does not know that it is the minimum
            let again = world.graph.optimize(&params).unwrap();
            assert!(
                again.stop == Stop::Converged && (1..=2).contains(&again.iterations),
                "{method:?} at the minimum: {again:?}"
            );
            (summary.cost, *world.graph.value(world.poses[20]).unwrap())
        })
        .collect();
    for (cost, pose) in &minima[1..] {
        assert!(abs_diff_eq!(cost / minima[0].0, 1.0, epsilon = 1e-9), "{cost} {}", minima[0].0);
        assert!(pose.local(&minima[0].1).norm() < 1e-6);
    }
}

/// One Gauss–Newton step is the dense least squares step; covariances are blocks of the dense inverse.
#[test]
fn step_and_covariances_equal_dense_algebra() {
    let mut dense = Dense::new();
    let mut graph = Graph::new();
    let first = graph.add_variable(Pose2::new(0.0, 0.0, 0.0));
    graph.fix(first).unwrap();
    let starts = [Pose2::new(1.1, 0.1, 0.2), Pose2::new(2.2, -0.1, 2.9), Pose2::new(1.0, 2.0, -3.0)];
    let poses: Vec<_> = std::iter::once(first).chain(starts.map(|pose| graph.add_variable(pose))).collect();
    let landmark = graph.add_variable(Vector2::new(1.5, 1.0));
    let information = Matrix3::new(40.0, 3.0, 1.0, 3.0, 50.0, -2.0, 1.0, -2.0, 90.0);
    for (from, to, motion) in [
        (0, 1, Pose2::new(1.0, 0.0, 0.1)),
        (1, 2, Pose2::new(1.0, 0.1, 2.5)),
        (2, 3, Pose2::new(-1.0, -2.0, 0.4)),
        (3, 0, Pose2::new(1.3, 1.5, 3.1)),
    ] {
        let residual = Between::new(motion);
        let (a, b) = (*graph.value(poses[from]).unwrap(), *graph.value(poses[to]).unwrap());
        let (by_a, by_b) = residual.jacobians((&a, &b));
        dense.add(&residual.value((&a, &b)), &[(from, &by_a), (to, &by_b)], &information);
        graph.add(residual, (poses[from], poses[to]), information).unwrap();
    }
    for (from, measured) in [(1, Vector2::new(0.5, 0.8)), (3, Vector2::new(-0.3, 1.2))] {
        let residual = RelativePosition { measured };
        let (robot, point) = (*graph.value(poses[from]).unwrap(), *graph.value(landmark).unwrap());
        let (by_robot, by_point) = residual.jacobians((&robot, &point));
        let weight = Matrix2::new(30.0, 4.0, 4.0, 20.0);
        dense.add(&residual.value((&robot, &point)), &[(from, &by_robot), (4, &by_point)], &weight);
        graph.add(residual, (poses[from], landmark), weight).unwrap();
    }

    let inverse = dense.hessian.clone().try_inverse().unwrap();
    let marginals = graph.marginals().unwrap();
    let close = |a: &DMatrix<f64>, b: DMatrix<f64>| (a - &b).amax() < 1e-9 * b.amax();
    for (i, pose) in poses.iter().enumerate().skip(1) {
        let block = inverse.view((Dense::row(i), Dense::row(i)), (3, 3)).into_owned();
        assert!(close(&marginals.covariance(*pose).unwrap(), block), "pose {i}");
        let cross = inverse.view((Dense::row(i), Dense::row(4)), (3, 2)).into_owned();
        assert!(close(&marginals.cross_covariance(*pose, landmark).unwrap(), cross), "pose {i} and landmark");
    }
    assert_eq!(marginals.covariance(first).unwrap().amax(), 0.0);
    let joint = marginals.joint(&[4, 2]).unwrap();
    assert_eq!(joint.shape(), (5, 5));
    assert!(marginals.joint(&[99]).is_err());

    let before = *graph.value(poses[2]).unwrap();
    let step = -&inverse * &dense.gradient;
    let params = Params { method: Method::GaussNewton, max_iterations: 1, ..Params::default() };
    graph.optimize(&params).unwrap();
    let expected = before.retract(&step.fixed_rows::<3>(Dense::row(2)).into_owned());
    assert!(expected.local(graph.value(poses[2]).unwrap()).norm() < 1e-10);
}

/// All covariances of 365 coordinates, and those with a landmark, beside the inverse of the dense matrix.
#[test]
fn covariances_of_a_larger_graph_equal_the_dense_inverse() {
    let mut world = world(5, 120, true);
    world.graph.optimize(&Params::default()).unwrap();
    let n_poses = world.poses.len();
    // The first pose is fixed; landmarks come after the poses.
    let row = |index: usize| {
        if index < n_poses { 3 * (index - 1) } else { 3 * (n_poses - 1) + 2 * (index - n_poses) }
    };
    let mut hessian = DMatrix::zeros(365, 365);
    let mut add = |named: &[usize], jacobians: [DMatrix<f64>; 2], information: DMatrix<f64>| {
        for (a, by_a) in named.iter().zip(&jacobians).filter(|(index, _)| **index > 0) {
            for (b, by_b) in named.iter().zip(&jacobians).filter(|(index, _)| **index > 0) {
                let mut block = hessian.view_mut((row(*a), row(*b)), (by_a.ncols(), by_b.ncols()));
                block += by_a.transpose() * &information * by_b;
            }
        }
    };
    let (graph, poses, landmarks) = (&world.graph, &world.poses, &world.landmarks);
    let pose = |index: usize| graph.value(poses[index]).unwrap();
    for (_, motion, named, information) in graph.residuals::<Between<Pose2<f64>>>() {
        let (a, b) = motion.jacobians((pose(named[0]), pose(named[1])));
        add(named, [a.dynamic(), b.dynamic()], information.dynamic());
    }
    for (_, seen, named, information) in graph.residuals::<RelativePosition<Vector2<f64>>>() {
        let landmark = graph.value(landmarks[named[1] - n_poses]).unwrap();
        let (a, b) = seen.jacobians((pose(named[0]), landmark));
        add(named, [a.dynamic(), b.dynamic()], information.dynamic());
    }
    let inverse = hessian.cholesky().unwrap().inverse();
    let landmark = world.landmarks[2];
    let marginals = world.graph.marginals().unwrap();
    let close = |a: &DMatrix<f64>, b: DMatrix<f64>| (a - &b).amax() < 1e-9 * b.amax();
    for (index, pose) in world.poses.iter().enumerate().skip(1) {
        let own = inverse.view((row(index), row(index)), (3, 3)).into_owned();
        assert!(close(&marginals.covariance(*pose).unwrap(), own), "pose {index}");
        let cross = inverse.view((row(index), row(n_poses + 2)), (3, 2)).into_owned();
        assert!(close(&marginals.cross_covariance(*pose, landmark).unwrap(), cross), "pose {index}");
    }
}

/// Normal equations without sparsity: pose 0 is fixed, the landmark is number 4.
struct Dense {
    hessian: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Dense {
    fn new() -> Self {
        Self { hessian: DMatrix::zeros(11, 11), gradient: DVector::zeros(11) }
    }

    fn row(variable: usize) -> usize {
        3 * (variable - 1)
    }

    fn add<const D: usize>(
        &mut self,
        value: &nalgebra::SVector<f64, D>,
        jacobians: &[(usize, &dyn AsDynamic)],
        information: &nalgebra::SMatrix<f64, D, D>,
    ) {
        let mut whole = DMatrix::zeros(D, 11);
        for (variable, jacobian) in jacobians.iter().filter(|(variable, _)| *variable > 0) {
            let jacobian = jacobian.dynamic();
            whole.view_mut((0, Self::row(*variable)), jacobian.shape()).copy_from(&jacobian);
        }
        self.hessian += whole.transpose() * information * &whole;
        self.gradient += whole.transpose() * information * value;
    }
}

trait AsDynamic {
    fn dynamic(&self) -> DMatrix<f64>;
}

impl<const R: usize, const C: usize> AsDynamic for nalgebra::SMatrix<f64, R, C> {
    fn dynamic(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(R, C, self.as_slice())
    }
}

/// A dense factorization of n rows: column k has n - k entries below the diagonal and on it, whatever the order.
#[test]
fn flop_of_a_full_graph_is_that_of_a_dense_matrix() {
    for n_poses in [3, 40] {
        let mut graph = Graph::new();
        let poses: Vec<_> =
            (0..n_poses).map(|k| graph.add_variable(Pose2::new(f64::from(k), 0.0, 0.0))).collect();
        graph.fix(poses[0]).unwrap();
        for (i, from) in poses.iter().enumerate() {
            for (k, to) in poses.iter().enumerate().skip(i + 1) {
                let residual = Between::new(Pose2::new((k - i) as f64, 0.0, 0.0));
                graph.add(residual, (*from, *to), Matrix3::identity()).unwrap();
            }
        }
        let n = 3 * (n_poses as usize - 1);
        let dense: usize = (1..=n).map(|entries| entries * entries).sum();
        let summary = graph.optimize(&Params::default()).unwrap();
        assert_eq!(summary.factorization_flop, dense as f64, "{n_poses}");
    }
}
