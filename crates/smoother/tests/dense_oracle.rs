//! The sparse solver against dense linear algebra that shares only the residuals.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

mod common;

use approx::abs_diff_eq;
use common::world;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_smoother::{Between, Graph, Method, Params, RelativePosition, Residual, Stop, VariableId};

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
            let again = world.graph.optimize(&params).unwrap();
            assert!(
                again.stop == Stop::Converged && again.iterations <= 2,
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

/// Covariances of a larger graph, beside the inverse of what single columns give.
#[test]
fn covariance_of_a_larger_graph_is_symmetric_and_grows() {
    let mut world = world(5, 40, true);
    world.graph.optimize(&Params::default()).unwrap();
    let trace = |world: &mut common::World, pose: VariableId<Pose2<f64>>| {
        let covariance = world.graph.marginals().unwrap().covariance(pose).unwrap();
        assert!(nalgebra::Cholesky::new(covariance.clone()).is_some());
        covariance.trace()
    };
    let (near, far) = (world.poses[1], world.poses[12]);
    assert!(trace(&mut world, near) < trace(&mut world, far));
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
