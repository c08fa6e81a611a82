use nalgebra::{DMatrix, DVector, DefaultAllocator, DimName, allocator::Allocator, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Tangent, TangentMatrix};

use super::{EkfSlam, LinearizationPoint};
use crate::{LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Adds a correction to all means and transports the covariance to the new means.
    ///
    /// This is the only difference between the kinds of filters. With $`g`$ the directions in which robot and landmarks move when the
    /// world is moved ([`LandmarkModel::symmetries`]), and $`ξ = g_r^† e_r`$ the displacement of the world by the robot's error:
    ///
    /// ```text
    /// newest            e_r keeps its direction in the world      e_m ← e_m
    /// first estimates   e_r ← e_r + (g_r' - g_r) ξ                e_m ← e_m
    /// invariant         e_r ← e_r + (g_r' - g_r) ξ                e_m ← e_m + (g_m' - g_m) ξ
    /// ```
    pub(super) fn step(&mut self, step: &DVector<f64>) {
        let robot_step = Tangent::<M::Robot>::from_fn(|row, _| step[row]);
        match self.params.linearization_point {
            LinearizationPoint::Newest => {
                self.step_robot(&robot_step);
                self.step_landmarks(step);
            }
            LinearizationPoint::FirstEstimates => {
                let (before, corrected) = (self.robot.clone(), self.robot.retract(&robot_step));
                self.transport_robot(&before, corrected);
                self.step_landmarks(step);
            }
            LinearizationPoint::Invariant => self.step_with_the_world(step),
        }
    }

    fn step_landmarks(&mut self, step: &DVector<f64>) {
        for slot in self.landmarks.values_mut() {
            let delta = Tangent::<M::Landmark>::from_fn(|row, _| step[slot.offset + row]);
            slot.mean = slot.mean.retract(&delta);
        }
    }

    /// Adds the correction to the robot's mean and transports its covariance to the tangent space there.
    ///
    /// Without the transport the covariance would stay in the frame of the old heading. With it the filter is numerically identical to one that
    /// keeps the robot's error in world coordinates.
    fn step_robot(&mut self, step: &Tangent<M::Robot>) {
        let corrected = self.robot.retract(step);
        let transport = self.robot.chart_jacobian(&corrected);
        self.robot = corrected;
        self.covariance.move_robot(&transport, &TangentMatrix::<M::Robot>::zeros());
    }

    /// Sets the robot's mean to `corrected`; its error there moves the world by the same displacement as before.
    fn transport_robot(&mut self, before: &M::Robot, corrected: M::Robot) {
        let turned = self.model.robot_symmetry(&corrected) - self.model.robot_symmetry(before);
        let transport = turned * self.world_motion_of_error(before);
        let identity = TangentMatrix::<M::Robot>::identity();
        let transport = TangentMatrix::<M::Robot>::from_fn(|row, column| {
            identity[(row, column)] + transport[(row, column)]
        });
        self.robot = corrected;
        self.covariance.move_robot(&transport, &TangentMatrix::<M::Robot>::zeros());
    }

    /// $`g_r^† = (g_r^T g_r)^{-1} g_r^T`$: how far an error of the robot moves the world.
    fn world_motion_of_error(&self, robot: &M::Robot) -> DMatrix<f64> {
        let directions = self.model.robot_symmetry(robot);
        let normal = directions.tr_mul(&directions);
        let projection = directions.transpose();
        Cholesky::new(normal).map_or_else(|| projection.clone() * 0.0, |normal| normal.solve(&projection))
    }

    /// The correction displaces the world as it displaces the robot, and moves every landmark relative to that.
    fn step_with_the_world(&mut self, step: &DVector<f64>) {
        let before = self.robot.clone();
        let by_error = self.world_motion_of_error(&before);
        let world = &by_error * step.rows(0, RobotDim::<M>::DIM);
        let robot_step = Tangent::<M::Robot>::from_fn(|row, _| step[row]);
        let corrected = carry(&before, |robot| self.model.robot_symmetry(robot), &world, &robot_step);

        let mut shear = DMatrix::zeros(step.len(), world.len());
        for slot in self.landmarks.values_mut() {
            let directions = |landmark: &M::Landmark| self.model.landmark_symmetry(landmark);
            let old = directions(&slot.mean);
            let own_step = Tangent::<M::Landmark>::from_fn(|row, _| step[slot.offset + row]);
            slot.mean = carry(&slot.mean, directions, &world, &own_step);
            let turned = directions(&slot.mean) - old;
            shear.view_mut((slot.offset, 0), turned.shape()).copy_from(&turned);
        }
        self.covariance.shear(&shear, &by_error);
        self.transport_robot(&before, corrected);
    }
}

/// The new position of a point when the world moves by `world` and the point's own error moves it by `step`, to first order.
///
/// $`\dot p = s + (g(p) - g(p_0))\, ξ`$ over unit time, one midpoint step: exact for a point that does not move, third order in turns.
fn carry<X: Manifold<Scalar = f64, Dim: DimName>>(
    point: &X,
    directions: impl Fn(&X) -> DMatrix<f64>,
    world: &DVector<f64>,
    step: &Tangent<X>,
) -> X
where
    DefaultAllocator: Allocator<X::Dim> + Allocator<X::Dim, X::Dim>,
{
    let moved = |at: &X| {
        let moved = directions(at) * world;
        Tangent::<X>::from_fn(|row, _| moved[row])
    };
    let half_way = point.retract(&(step * 0.5));
    let turned = half_way.chart_jacobian(point) * moved(&half_way) - moved(point);
    point.retract(&(step + turned))
}
