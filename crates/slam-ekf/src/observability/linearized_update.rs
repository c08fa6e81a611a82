use nalgebra::{DMatrix, DefaultAllocator, DimName};

use crate::{EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// One scan, linearized at the filter's estimate: only the columns of the robot and the observed landmarks.
pub(super) struct LinearizedUpdate {
    /// $`H`$: robot first, then the landmarks of the state in the order of `landmarks`.
    pub(super) jacobian: DMatrix<f64>,
    pub(super) landmarks: Vec<LandmarkId>,
    /// $`S = H P H^T + W`$.
    pub(super) innovation_covariance: DMatrix<f64>,
    /// Motion of robot and landmarks with the world, one column per named direction.
    pub(super) motion: DMatrix<f64>,
}

impl LinearizedUpdate {
    /// The predicted measurements of these landmarks and anchors, without those that are not in the map or not observable.
    pub(super) fn of<M: LandmarkModel>(slam: &EkfSlam<M>, seen: &[LandmarkId]) -> Self
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        let (robot_size, size, rows) = (RobotDim::<M>::DIM, LandmarkDim::<M>::DIM, MeasurementDim::<M>::DIM);
        let detections: Vec<_> = seen.iter().filter_map(|id| Linearized::of(slam, *id)).collect();
        let landmarks: Vec<LandmarkId> = detections
            .iter()
            .filter(|detection| detection.offset.is_some())
            .map(|detection| detection.id)
            .collect();

        let n = robot_size + size * landmarks.len();
        let (mut jacobian, mut noise) = (
            DMatrix::zeros(rows * detections.len(), n),
            DMatrix::zeros(rows * detections.len(), rows * detections.len()),
        );
        let mut motion = DMatrix::zeros(n, slam.model().symmetries().len());
        motion.rows_mut(0, robot_size).copy_from(&slam.model().robot_symmetry(slam.robot()));
        let mut places: Vec<usize> = (0..robot_size).collect(); // in the filter's covariance
        for (k, detection) in detections.iter().enumerate() {
            jacobian.view_mut((k * rows, 0), (rows, robot_size)).copy_from(&detection.robot);
            noise.view_mut((k * rows, k * rows), (rows, rows)).copy_from(&detection.noise);
            if let Some(offset) = detection.offset {
                let column = places.len();
                jacobian.view_mut((k * rows, column), (rows, size)).copy_from(&detection.landmark);
                motion.rows_mut(column, size).copy_from(&detection.motion);
                places.extend(offset..offset + size);
            }
        }
        let p = slam.covariance();
        let own = DMatrix::from_fn(n, n, |row, column| p[(places[row], places[column])]);
        let innovation_covariance = &jacobian * own * jacobian.transpose() + noise;
        Self { jacobian, landmarks, innovation_covariance, motion }
    }
}

/// The part of one observation in a scan.
struct Linearized {
    id: LandmarkId,
    /// `None` for anchors.
    offset: Option<usize>,
    robot: DMatrix<f64>,
    landmark: DMatrix<f64>,
    noise: DMatrix<f64>,
    motion: DMatrix<f64>,
}

impl Linearized {
    fn of<M: LandmarkModel>(slam: &EkfSlam<M>, id: LandmarkId) -> Option<Self>
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        let (mean, offset) = slam.place(id)?;
        let (model, robot) = (slam.model(), slam.robot());
        let expected = model.expected(robot, &mean);
        let dense = |rows: usize, columns: usize, entry: &dyn Fn(usize, usize) -> f64| {
            DMatrix::from_fn(rows, columns, entry)
        };
        let (size, rows) = (LandmarkDim::<M>::DIM, MeasurementDim::<M>::DIM);
        let by_robot = model.robot_jacobian(robot, &mean);
        let by_landmark = model.landmark_jacobian(robot, &mean);
        let noise = model.noise(&expected);
        let linearized = Self {
            id,
            offset,
            robot: dense(rows, RobotDim::<M>::DIM, &|i, j| by_robot[(i, j)]),
            landmark: dense(rows, size, &|i, j| by_landmark[(i, j)]),
            noise: dense(rows, rows, &|i, j| noise[(i, j)]),
            motion: model.landmark_symmetry(&mean),
        };
        let mut all =
            linearized.robot.iter().chain(linearized.landmark.iter()).chain(linearized.noise.iter());
        all.all(|entry| entry.is_finite()).then_some(linearized)
    }
}
