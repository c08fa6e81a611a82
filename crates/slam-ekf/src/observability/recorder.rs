use std::collections::BTreeMap;

use nalgebra::{DMatrix, DMatrixView, DVector, DefaultAllocator, DimName, linalg::Cholesky};

use super::{
    UnobservableDirection,
    linearized_update::LinearizedUpdate,
    null_space::{null_space, readable},
};
use crate::{EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// Sums the information of a run's measurements about the robot at its start and the landmarks, without any prior.
///
/// $`J = \sum_k O_k^T S_k^{-1} O_k`$ with $`O_k = \begin{pmatrix} H_{r,k} Φ_k & H_{m,k} \end{pmatrix}`$ and
/// $`Φ_k = F_{k-1} ⋯ F_0`$: the rows of the local observability matrix, weighed as the total Fisher information of
/// [Andrade-Cetto 2005, Eqs. 13–14]. Its rank is that of the observability matrix.
///
/// An EKF linearizes each scan at a different point; in the plane this alone gives `J` spurious information about the heading of the map.
/// [`unobservable_directions`](Self::unobservable_directions) avoids this: it tests every scan, at its own linearization, for the motion of the world.
///
/// ```
/// use nalgebra::Vector1;
/// use wayfix_slam_ekf::{*, observability::ObservabilityRecorder};
/// let sensor = LineDistanceSensor { sigma: 0.1, sigma_per_meter: 0.0 };
/// let mut slam = EkfSlam::new(sensor, SlamParams::default(), Vector1::new(-1.0))?;
/// let mut recorder = ObservabilityRecorder::new(&slam);
/// let seen = |id, distance| Observation { label: Some(LandmarkId(id)), measurement: Vector1::new(distance) };
///
/// slam.update(&[seen(0, 2.0)], &mut KnownIdAssociation)?;
/// recorder.record(&slam, &[LandmarkId(0)]);
/// assert_eq!((recorder.dimension(), recorder.rank()), (2, 1));
/// assert_eq!(recorder.unobservable_directions()[0].to_string(), "translation of everything");
///
/// slam.add_anchor(LandmarkId(1), Vector1::new(0.0))?; // a landmark whose place is known
/// slam.update(&[seen(1, 1.0)], &mut KnownIdAssociation)?;
/// recorder.record(&slam, &[LandmarkId(1)]);
/// assert_eq!(recorder.rank(), 2);
/// assert!(recorder.unobservable_directions().is_empty());
/// # Ok::<(), SlamError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ObservabilityRecorder {
    /// $`Φ`$.
    transition: DMatrix<f64>,
    /// Start of each landmark's block in $`J`$.
    blocks: BTreeMap<LandmarkId, usize>,
    information: DMatrix<f64>,
    directions: &'static [&'static str],
    /// $`\sum (H N)^T S^{-1} H N`$ over the named directions $`N`$.
    constraint: DMatrix<f64>,
    /// Its diagonal for separate motions of robot and landmark.
    uncancelled: DVector<f64>,
}

/// Information below this share of its possible size is rounding: analytic Jacobians leave 1e-32 of it, central differences 1e-18.
const NOTHING: f64 = 1e-12;
/// Eigenvalue of the scaled information that counts as zero, in a rank: some thousand roundings.
const SINGULAR: f64 = 1e-11;

impl ObservabilityRecorder {
    /// No information about the robot, and no landmarks.
    pub fn new<M: LandmarkModel>(slam: &EkfSlam<M>) -> Self
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        let (size, directions) = (RobotDim::<M>::DIM, slam.model().symmetries());
        Self {
            transition: DMatrix::identity(size, size),
            blocks: BTreeMap::new(),
            information: DMatrix::zeros(size, size),
            directions,
            constraint: DMatrix::zeros(directions.len(), directions.len()),
            uncancelled: DVector::zeros(directions.len()),
        }
    }

    /// Records a motion of the robot by its Jacobian. A Jacobian that is not finite or of another size is ignored.
    pub fn record_motion<'a>(&mut self, jacobian: impl Into<DMatrixView<'a, f64>>) {
        let jacobian = jacobian.into();
        if jacobian.shape() == self.transition.shape() && jacobian.iter().all(|entry| entry.is_finite()) {
            self.transition = jacobian * &self.transition;
        }
    }

    /// Records a scan of these landmarks and anchors, linearized at the filter's present estimate: before the update for the paper's $`S`$, or
    /// after it to include new landmarks. Returns `false` and records nothing if none of them is in the map or $`S`$ is not positive definite.
    pub fn record<M: LandmarkModel>(&mut self, slam: &EkfSlam<M>, seen: &[LandmarkId]) -> bool
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        let update = LinearizedUpdate::of(slam, seen);
        update.jacobian.nrows() > 0 && self.add(&update, LandmarkDim::<M>::DIM)
    }

    /// Records a measurement of the robot alone, with its Jacobian and innovation covariance, as of [`EkfSlam::update_robot`].
    pub fn record_robot<'a, M: LandmarkModel>(
        &mut self,
        slam: &EkfSlam<M>,
        jacobian: impl Into<DMatrixView<'a, f64>>,
        innovation_covariance: impl Into<DMatrixView<'a, f64>>,
    ) -> bool
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        let (jacobian, covariance) =
            (jacobian.into().into_owned(), innovation_covariance.into().into_owned());
        let fits = jacobian.ncols() == RobotDim::<M>::DIM
            && covariance.shape() == (jacobian.nrows(), jacobian.nrows());
        let motion = slam.model().robot_symmetry(slam.robot());
        let update =
            LinearizedUpdate { jacobian, landmarks: Vec::new(), innovation_covariance: covariance, motion };
        fits && self.add(&update, LandmarkDim::<M>::DIM)
    }

    /// $`J`$: the robot at its start, then the landmarks in the order in which they were first recorded.
    pub fn information(&self) -> &DMatrix<f64> {
        &self.information
    }
    /// Dimension of the state of robot and recorded landmarks.
    pub fn dimension(&self) -> usize {
        self.information.nrows()
    }
    /// Number of coordinates or combinations that the measurements determine: the rank of the local observability matrix. Below full rank the bound
    /// of [Andrade-Cetto 2005, Eq. 16] does not exist. Cost O(n³).
    pub fn rank(&self) -> usize {
        self.dimension() - self.null_space().ncols()
    }
    /// Directions of the state without information, one unit vector per column. [Andrade-Cetto 2005, Eq. 18] Cost O(n³).
    pub fn null_space(&self) -> DMatrix<f64> {
        null_space(&self.information, &self.information.diagonal(), SINGULAR)
    }
    /// Motions of the whole world that no measurement has observed, among those that the model names ([`LandmarkModel::symmetries`]).
    pub fn unobservable_directions(&self) -> Vec<UnobservableDirection> {
        let basis = null_space(&self.constraint, &self.uncancelled, NOTHING);
        let named =
            |vector: DVector<f64>| UnobservableDirection::new(self.directions, vector.iter().copied());
        readable(basis).into_iter().map(named).collect()
    }

    fn add(&mut self, update: &LinearizedUpdate, landmark_size: usize) -> bool {
        let Some(factor) = Cholesky::new(update.innovation_covariance.clone()) else { return false };
        let robot_size = self.transition.nrows();
        let weighed = |matrix: &DMatrix<f64>| factor.l().solve_lower_triangular(matrix);
        let mut rows = update.jacobian.clone();
        let by_start = rows.columns(0, robot_size) * &self.transition;
        rows.columns_mut(0, robot_size).copy_from(&by_start);
        let by_robot = update.jacobian.columns(0, robot_size) * update.motion.rows(0, robot_size);
        let noticed = &update.jacobian * &update.motion;
        let by_landmarks = &noticed - &by_robot;
        let (Some(rows), Some(noticed), Some(by_robot), Some(by_landmarks)) =
            (weighed(&rows), weighed(&noticed), weighed(&by_robot), weighed(&by_landmarks))
        else {
            return false;
        };
        let squares =
            |matrix: &DMatrix<f64>| DVector::from_fn(matrix.ncols(), |i, _| matrix.column(i).norm_squared());
        let own = rows.tr_mul(&rows);
        if !own.iter().all(|entry| entry.is_finite()) {
            return false;
        }
        let places = self.places(&update.landmarks, landmark_size);
        for (column, &to_column) in places.iter().enumerate() {
            for (row, &to_row) in places.iter().enumerate() {
                self.information[(to_row, to_column)] += own[(row, column)];
            }
        }
        self.constraint += noticed.tr_mul(&noticed);
        self.uncancelled += squares(&by_robot) + squares(&by_landmarks);
        true
    }

    /// Offsets of robot and landmarks in $`J`$, which grows by the new landmarks.
    fn places(&mut self, landmarks: &[LandmarkId], size: usize) -> Vec<usize> {
        let mut places: Vec<usize> = (0..self.transition.nrows()).collect();
        for id in landmarks {
            let n = self.dimension();
            let start = *self.blocks.entry(*id).or_insert(n);
            if start == n {
                self.information.resize_mut(n + size, n + size, 0.0);
            }
            places.extend(start..start + size);
        }
        places
    }
}
