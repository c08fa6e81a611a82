use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;

use super::EkfSlam;
use crate::{LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// The region in which a landmark must lie to be compatible with a measurement: a bound that needs no derivative at the landmark.
///
/// With $`\hat m = g(x_r, z)`$ the difference $`m ⊟ \hat m`$ has, to first order, the same NIS as the innovation, and no variance of it is larger than
/// $`(\sqrt{\operatorname{tr} P_{mm}} + \sqrt{\operatorname{tr} G_r P_{rr} G_r^T} + \sqrt{\operatorname{tr} N})^2`$.
/// The models are not linear, so a landmark is excluded only beyond [`MARGIN`] times the bound.
#[derive(Clone, Debug)]
pub(crate) struct SearchRegion<L> {
    /// The landmark that the measurement would initialize.
    place: L,
    /// Standard deviation of its position, m for points.
    deviation: f64,
    /// Standard deviations that the limit on the NIS allows.
    n_sigmas: f64,
}

/// Factor on the distance.
const MARGIN: f64 = 2.0;

impl<L: Manifold<Scalar = f64>> SearchRegion<L>
where
    DefaultAllocator: Allocator<L::Dim>,
{
    /// Whether a landmark with this trace of its covariance may be compatible; always `true` if the measurement alone does not place a landmark.
    pub(crate) fn contains(&self, landmark: &L, variance: f64) -> bool {
        let distance = self.place.local(landmark).norm();
        let most = MARGIN * self.n_sigmas * (self.deviation + variance.max(0.0).sqrt());
        distance <= most || (distance - most).is_nan()
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The region of the landmarks that have a NIS of at most `limit` with a measurement.
    pub(crate) fn search_region(
        &self,
        limit: f64,
        measurement: &M::Measurement,
    ) -> SearchRegion<M::Landmark> {
        let new = self.model.initialize(&self.robot, measurement);
        let by_robot = &new.robot_jacobian * self.robot_covariance() * new.robot_jacobian.transpose();
        let deviation = by_robot.trace().max(0.0).sqrt() + new.covariance.trace().max(0.0).sqrt();
        SearchRegion { place: new.landmark, deviation, n_sigmas: limit.sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use wayfix_estimation_traits::Pose2;

    use crate::{EkfSlam, LandmarkId, LandmarkModel, RangeBearing, RangeBearingSensor, SlamParams};

    const SEED: u64 = 31;

    /// Robot and landmarks as uncertain as after a long path: metres, and ten degrees.
    #[test]
    fn preselection_keeps_every_landmark_within_the_nis_limit() {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let sensor = RangeBearingSensor { range_sigma: 1.0, bearing_sigma: 0.05, ..Default::default() };
        let start = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.03));
        let pose = Pose2::new(3.0, -2.0, 1.0);
        let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), pose, start).unwrap();
        for id in 0..400 {
            let place =
                Vector2::new(rng.random::<f64>() * 400.0 - 200.0, rng.random::<f64>() * 400.0 - 200.0);
            slam.insert(LandmarkId(id), place, Matrix2::identity() * rng.random::<f64>()).unwrap();
        }
        let (mut n_near, mut n_reached) = (0, 0);
        for _ in 0..100 {
            let measurement = RangeBearing::new(2.0 + 60.0 * rng.random::<f64>(), rng.random::<f64>() * 6.0);
            let (reach, noise) = (slam.search_region(40.0, &measurement), slam.model().noise(&measurement));
            let reached: Vec<_> = slam
                .predicted_measurements_within(Some(&[reach]))
                .map(|predicted| predicted.landmark)
                .collect();
            n_reached += reached.len();
            for predicted in slam.predicted_measurements() {
                if predicted.innovation_within(40.0, &measurement, &noise).is_some() {
                    n_near += 1;
                    assert!(reached.contains(&predicted.landmark), "{measurement:?} of {predicted:?}");
                }
            }
        }
        assert!(n_near > 100, "{n_near}"); // there was something to lose
        assert!(n_reached < 100 * 400 / 2, "{n_reached}"); // and something to save
    }
}
