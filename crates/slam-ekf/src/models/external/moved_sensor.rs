use nalgebra::{DefaultAllocator, Matrix3};
use wayfix_estimation_traits::{
    Jacobian, LieGroup, Manifold, Pose2, SensorModel, TangentMatrix, UpdateAlloc,
};

/// A sensor that measures after a motion which the state does not include yet: $`h(x ∘ u)`$, with noise $`R + H Q H^T`$.
///
/// A filter that stays at the last keyframe takes measurements between keyframes with it. The error of the motion counts here and once more when
/// the state makes the motion, which gives a covariance that is rather too large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedSensor<S> {
    /// The sensor.
    pub sensor: S,
    /// $`u`$: the motion since the state.
    pub motion: Pose2<f64>,
    /// $`Q`$: its covariance, in the body frame at its end.
    pub covariance: Matrix3<f64>,
}

impl<S> SensorModel for MovedSensor<S>
where
    S: SensorModel<State = Pose2<f64>>,
    DefaultAllocator: UpdateAlloc<<Pose2<f64> as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    type State = Pose2<f64>;
    type Measurement = S::Measurement;

    fn expected(&self, pose: &Pose2<f64>) -> S::Measurement {
        self.sensor.expected(&pose.compose(&self.motion))
    }
    fn jacobian(&self, pose: &Pose2<f64>) -> Jacobian<S::Measurement, Pose2<f64>> {
        self.sensor.jacobian(&pose.compose(&self.motion)) * self.motion.inverse().adjoint()
    }
    fn noise(&self, pose: &Pose2<f64>) -> TangentMatrix<S::Measurement> {
        let moved = pose.compose(&self.motion);
        let jacobian = self.sensor.jacobian(&moved);
        self.sensor.noise(&moved) + &jacobian * self.covariance * jacobian.transpose()
    }
}
