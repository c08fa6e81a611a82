use nalgebra::{DMatrix, Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

use super::{PointSmoother, smoother::LEAST_MOTION_SIGMA};
use crate::SlamSmootherError;

/// Robot and map as a Gaussian: what a [`PointSmoother`] starts from, and what its window comes down to.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMapGaussian {
    /// Pose of the robot.
    pub pose: Pose2<f64>,
    /// Logarithm of the range scale.
    pub log_range_scale: f64,
    /// Landmarks with their identities.
    pub landmarks: Vec<(u32, Vector2<f64>)>,
    /// Joint covariance of the pose in the body frame, the logarithm of the range scale, and the landmarks in their order; zero where something is exact.
    pub covariance: DMatrix<f64>,
}

/// The residual of an uncertain start.
pub(super) struct StartPrior {
    /// Numbers of the variables that are not exact.
    pub(super) variables: Vec<usize>,
    /// Coordinates of their means.
    pub(super) mean: Vec<f64>,
    /// Information in their tangent spaces.
    pub(super) information: DMatrix<f64>,
}

impl StartPrior {
    /// Whether it is about one of these variables.
    pub(super) fn names(&self, variables: &[usize]) -> bool {
        self.variables.iter().any(|variable| variables.contains(variable))
    }
}

/// Coordinates of robot and range scale.
const ROBOT: usize = 4;

impl PointMapGaussian {
    /// A robot in an empty map; the covariance of the pose is in the body frame.
    pub fn without_landmarks(
        pose: Pose2<f64>,
        covariance: &Matrix3<f64>,
        log_range_scale_sigma: f64,
    ) -> Self {
        let mut joint = DMatrix::zeros(ROBOT, ROBOT);
        joint.view_mut((0, 0), (3, 3)).copy_from(covariance);
        joint[(3, 3)] = log_range_scale_sigma * log_range_scale_sigma;
        Self { pose, log_range_scale: 0.0, landmarks: Vec::new(), covariance: joint }
    }

    /// First coordinate and number of coordinates of pose, scale and each landmark.
    pub(super) fn blocks(&self) -> impl Iterator<Item = (usize, usize)> {
        let landmarks = (0..self.landmarks.len()).map(|k| (ROBOT + 2 * k, 2));
        [(0, 3), (3, 1)].into_iter().chain(landmarks)
    }

    /// Whether a block has no uncertainty.
    pub(super) fn is_exact(&self, (first, n): (usize, usize)) -> bool {
        (first..first + n).all(|k| self.covariance[(k, k)] == 0.0)
    }

    /// Coordinates of the means of the blocks that are not exact, in their order.
    pub(super) fn uncertain_mean(&self) -> Vec<f64> {
        let Pose2 { translation, .. } = self.pose;
        let robot = [translation.x, translation.y, self.pose.heading(), self.log_range_scale];
        let places = self.landmarks.iter().flat_map(|(_, place)| [place.x, place.y]);
        let all: Vec<f64> = robot.into_iter().chain(places).collect();
        let free = self.blocks().filter(|block| !self.is_exact(*block));
        free.flat_map(|(first, n)| all[first..first + n].to_vec()).collect()
    }

    /// Information of the blocks that are not exact, in their order.
    pub(super) fn information(&self) -> Result<DMatrix<f64>, SlamSmootherError> {
        let free = self.blocks().filter(|block| !self.is_exact(*block));
        let rows: Vec<usize> = free.flat_map(|(first, n)| first..first + n).collect();
        let mut covariance = self.covariance.select_rows(&rows).select_columns(&rows);
        if !self.is_exact((0, 3)) {
            for (k, sigma) in LEAST_MOTION_SIGMA.into_iter().enumerate() {
                covariance[(k, k)] += sigma * sigma;
            }
        }
        let (what, index, wanted) = ("joint covariance of a map of size", rows.len(), "positive definite");
        let value = covariance.diagonal().iter().copied().fold(f64::INFINITY, f64::min);
        let symmetric = covariance.symmetric_part();
        let cholesky = symmetric.cholesky().filter(|_| covariance.iter().all(|entry| entry.is_finite()));
        let error = SlamSmootherError::OutOfRange { what, index, value, wanted };
        Ok(cholesky.ok_or(error)?.inverse())
    }

    pub(super) fn check(&self) -> Result<(), SlamSmootherError> {
        let (index, got) = (ROBOT + 2 * self.landmarks.len(), self.covariance.shape());
        let refuse = |what, value, wanted| Err(SlamSmootherError::OutOfRange { what, index, value, wanted });
        if got != (index, index) {
            return refuse("joint covariance of a map of size", got.0 as f64, "square, of this size");
        }
        let places = self.landmarks.iter().flat_map(|(_, place)| [place.x, place.y]);
        let mut numbers =
            places.chain([self.pose.x(), self.pose.y(), self.pose.heading(), self.log_range_scale]);
        match numbers.find(|number| !number.is_finite()) {
            Some(number) => refuse("mean of a map of size", number, "finite"),
            None => Ok(()),
        }
    }
}

impl PointSmoother {
    /// What the window says of some landmarks and of the robot after a further motion from the newest pose: all else is marginalized. The smoother stays
    /// as it is.
    ///
    /// A smoother that starts from it goes on like this one, with the linearization that the window has now. [Sibley et al. 2010, section 3.2]
    ///
    /// # Errors
    /// [`SlamSmootherError::UnknownLandmark`], [`SlamSmootherError::Smoother`] when the window cannot be solved.
    pub fn gaussian(
        &self,
        landmarks: impl IntoIterator<Item = u32>,
        motion: &Pose2<f64>,
        motion_covariance: &Matrix3<f64>,
    ) -> Result<PointMapGaussian, SlamSmootherError> {
        let newest = self.last().pose;
        let mut variables = vec![newest.index(), self.scale.index()];
        let mut places = Vec::new();
        for landmark in landmarks {
            let id = self.landmarks.get(&landmark).ok_or(SlamSmootherError::UnknownLandmark { landmark })?;
            variables.push(id.index());
            places.push((landmark, *self.graph.value(*id)?));
        }
        let (step, mut covariance) = self.graph.gaussian(&variables)?;
        let pose = self.graph.value(newest)?.retract(&Vector3::new(step[0], step[1], step[2]));
        for (k, (_, place)) in places.iter_mut().enumerate() {
            *place += step.fixed_rows::<2>(ROBOT + 2 * k);
        }
        let mut carry = DMatrix::identity(covariance.nrows(), covariance.nrows());
        carry.view_mut((0, 0), (3, 3)).copy_from(&motion.inverse().adjoint());
        covariance = &carry * covariance * carry.transpose();
        let mut robot = covariance.view_mut((0, 0), (3, 3));
        robot += motion_covariance;
        Ok(PointMapGaussian {
            pose: pose.compose(motion),
            log_range_scale: self.graph.value(self.scale)?.x + step[3],
            landmarks: places,
            covariance,
        })
    }
}
