use std::collections::{BTreeMap, BTreeSet, VecDeque};

use nalgebra::{Matrix2, Matrix3, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::{Between, Graph, Kernel, Params, Prior, Variable, VariableId};

use super::{
    AntennaPosition, Heading, MountedRangeBearing, PointMapGaussian, PointSmootherParams, PoseObservation,
    SettledPose, gaussian::StartPrior, residuals::SamePoint,
};
use crate::SlamSmootherError;

/// A detection of a point whose landmark is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// m.
    pub range: f64,
    /// rad, 0 ahead, counter-clockwise.
    pub bearing: f64,
    /// Covariance of range and bearing.
    pub covariance: Matrix2<f64>,
}

/// Graph SLAM with points: a window of poses and the whole map, with the pairings of another.
///
/// Poses that leave the window are marginalized; what they knew of the map stays. A wrong pairing weighs little (Cauchy) while it is in the
/// window, and a landmark can be taken back.
pub struct PointSmoother {
    params: PointSmootherParams,
    /// What the graph holds of the start, until it is marginalized.
    pub(super) start: Option<StartPrior>,
    pub(super) graph: Graph,
    pub(super) scale: VariableId<Vector1<f64>>,
    /// Poses in the window, oldest first.
    pub(super) window: VecDeque<Frame>,
    n_poses: usize,
    solved_at: Option<f64>,
    pub(super) landmarks: BTreeMap<u32, VariableId<Vector2<f64>>>,
    pub(super) anchors: BTreeSet<u32>,
}

#[derive(Clone, Copy)]
pub(super) struct Frame {
    number: usize,
    /// Time of the first step after it, s.
    pub(super) seconds: Option<f64>,
    pub(super) pose: VariableId<Pose2<f64>>,
}

/// 95 % of the efficiency of least squares when there are no outliers.
const ROBUST: Kernel = Kernel::Cauchy { c: 2.385 };
/// What a motion is uncertain by at least, m and rad: motion models with fewer directions than three are singular.
pub(super) const LEAST_MOTION_SIGMA: [f64; 3] = [1e-4, 1e-4, 1e-5];
/// Two landmarks that are one are together to within this, m.
const SAME: f64 = 1e-3;
/// Online, a step follows a problem that was at its minimum: few iterations are left.
const ONLINE: Params = Params {
    method: wayfix_smoother::Method::LevenbergMarquardt,
    max_iterations: 5,
    relative_decrease: 1e-6,
    graduated: false,
};

impl PointSmoother {
    /// Starts from a Gaussian.
    ///
    /// # Errors
    /// [`SlamSmootherError::OutOfRange`] for a covariance of another size or that is none, and for numbers that are not finite.
    pub fn new(params: PointSmootherParams, start: &PointMapGaussian) -> Result<Self, SlamSmootherError> {
        start.check()?;
        let mut graph = Graph::new();
        let pose = graph.add_variable(start.pose);
        let scale = graph.add_variable(Vector1::new(start.log_range_scale));
        let place = |(id, place): &(u32, Vector2<f64>)| (*id, graph.add_variable(*place));
        let landmarks: Vec<_> = start.landmarks.iter().map(place).collect();
        let (mut uncertain, mut blocks) = (Vec::new(), start.blocks());
        hold_if_exact(&mut graph, pose, start, blocks.next(), &mut uncertain)?;
        hold_if_exact(&mut graph, scale, start, blocks.next(), &mut uncertain)?;
        for (_, landmark) in &landmarks {
            hold_if_exact(&mut graph, *landmark, start, blocks.next(), &mut uncertain)?;
        }
        let mut prior = None;
        if !uncertain.is_empty() {
            let information = start.information()?;
            graph.add_gaussian(&uncertain, information.clone())?;
            prior = Some(StartPrior { variables: uncertain, mean: start.uncertain_mean(), information });
        }
        Ok(Self {
            solved_at: None,
            params,
            start: prior,
            graph,
            scale,
            window: VecDeque::from([Frame { number: 0, seconds: None, pose }]),
            n_poses: 1,
            landmarks: landmarks.into_iter().collect(),
            anchors: BTreeSet::new(),
        })
    }

    /// Number of the newest pose.
    pub fn newest(&self) -> usize {
        self.n_poses - 1
    }

    /// The newest pose.
    ///
    /// # Errors
    /// Never while the smoother is whole.
    pub fn pose(&self) -> Result<Pose2<f64>, SlamSmootherError> {
        Ok(*self.graph.value(self.last().pose)?)
    }

    /// Adds the pose after a motion. It starts at `guess`, else where the motion leads.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] for numbers that are not finite.
    pub fn advance(
        &mut self,
        motion: Pose2<f64>,
        covariance: &Matrix3<f64>,
        guess: Option<Pose2<f64>>,
    ) -> Result<usize, SlamSmootherError> {
        let before = self.last().pose;
        let led = self.graph.value(before)?.compose(&motion);
        let floor = Vector3::from(LEAST_MOTION_SIGMA).map(|sigma| sigma * sigma);
        let covariance = covariance + Matrix3::from_diagonal(&floor);
        let information = inverse(&covariance, "covariance of motion", self.n_poses)?;
        let pose = self.graph.add_variable(guess.unwrap_or(led));
        if let Err(error) = self.graph.add(Between::new(motion), (before, pose), information) {
            self.graph.remove_variables(&[pose.index()])?;
            return Err(error.into());
        }
        let number = self.n_poses;
        self.n_poses += 1;
        self.window.push_back(Frame { number, seconds: None, pose });
        Ok(number)
    }

    /// Holds a landmark at a place that is known from now on; an anchor stays where it is.
    ///
    /// # Errors
    /// Never while the smoother is whole.
    pub fn add_anchor(&mut self, landmark: u32, place: Vector2<f64>) -> Result<(), SlamSmootherError> {
        if !self.anchors.insert(landmark) {
            return Ok(());
        }
        let id = *self.landmarks.entry(landmark).or_insert_with(|| self.graph.add_variable(place));
        self.graph.set_value(id, place)?;
        Ok(self.graph.fix(id)?)
    }

    /// Adds a detection from the newest pose. An unknown landmark starts where it is seen.
    ///
    /// # Errors
    /// * [`SlamSmootherError::OutOfRange`] for a range that is not positive and finite.
    /// * [`SlamSmootherError::Smoother`] for other numbers that are not finite.
    pub fn detect(&mut self, landmark: u32, detection: &Detection) -> Result<(), SlamSmootherError> {
        let Detection { range, bearing, covariance } = *detection;
        let index = self.newest();
        if !(range > 0.0 && range.is_finite() && bearing.is_finite()) {
            let (what, wanted) = ("range of a detection from pose", "positive and finite, as its bearing");
            return Err(SlamSmootherError::OutOfRange { what, index, value: range, wanted });
        }
        let information = inverse(&covariance, "covariance of a detection from pose", index)?;
        let pose = self.last().pose;
        let id = match self.landmarks.get(&landmark) {
            Some(id) => *id,
            None => {
                let distance = range * (-self.graph.value(self.scale)?.x).exp();
                let (sin, cos) = bearing.sin_cos();
                let sensor = self.graph.value(pose)?.compose(&self.params.mount);
                self.graph.add_variable(sensor.transform(&(Vector2::new(cos, sin) * distance)))
            }
        };
        let residual = MountedRangeBearing { mount: self.params.mount, range, bearing };
        match self.graph.add(residual, (pose, id, self.scale), information) {
            Ok(added) => {
                self.landmarks.insert(landmark, id);
                Ok(self.graph.set_kernel(added, ROBUST)?)
            }
            Err(error) => {
                if !self.landmarks.contains_key(&landmark) {
                    self.graph.remove_variables(&[id.index()])?;
                }
                Err(error.into())
            }
        }
    }

    /// Adds a measurement of the pose that the robot has after a further motion from the newest one.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] for a covariance that is none, and numbers that are not finite.
    pub fn observe(
        &mut self,
        observation: &PoseObservation,
        motion: &Pose2<f64>,
    ) -> Result<(), SlamSmootherError> {
        let (pose, index) = (self.last().pose, self.newest());
        let name = "covariance of a measured pose at pose";
        let added = match *observation {
            PoseObservation::Position { antenna, measured, covariance } => {
                let residual = AntennaPosition { antenna: motion.transform(&antenna), measured };
                self.graph.add(residual, (pose,), inverse(&covariance, name, index)?)?
            }
            PoseObservation::Heading { measured, variance } => {
                let residual = Heading { measured: measured - motion.heading() };
                self.graph.add(residual, (pose,), inverse(&variance, name, index)?)?
            }
            PoseObservation::Pose { measured, covariance } => {
                let back = measured.compose(&motion.inverse());
                let carry = motion.adjoint();
                let covariance = carry * covariance * carry.transpose();
                self.graph.add(Prior::new(back), (pose,), inverse(&covariance, name, index)?)?
            }
        };
        Ok(self.graph.set_kernel(added, ROBUST)?)
    }

    /// Takes a landmark back, with its detections in the window.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when what earlier poses knew of it cannot be marginalized.
    pub fn remove(&mut self, landmark: u32) -> Result<(), SlamSmootherError> {
        if let Some(id) = self.landmarks.get(&landmark).copied() {
            self.graph.remove_variables(&[id.index()])?;
            self.start.take_if(|start| start.names(&[id.index()]));
            self.landmarks.remove(&landmark);
            self.anchors.remove(&landmark);
        }
        Ok(())
    }

    /// Says that two landmarks are one: a batch takes the detections of both for those of one; in a window the second is marginalized.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when they cannot be joined.
    pub fn merge(&mut self, kept: u32, removed: u32) -> Result<(), SlamSmootherError> {
        let (Some(a), Some(b)) = (self.landmarks.get(&kept).copied(), self.landmarks.get(&removed).copied())
        else {
            return Ok(());
        };
        let is_in_start = self.start.as_ref().is_some_and(|start| start.names(&[b.index()]));
        if self.params.lag.is_none() && !is_in_start {
            self.reassign_detections(b, a)?;
            self.graph.remove_variables(&[b.index()])?;
        } else {
            self.graph.add(SamePoint, (a, b), Matrix2::identity() * SAME.powi(-2))?;
            self.graph.optimize(&ONLINE)?;
            self.marginalize(&[b.index()])?;
        }
        self.landmarks.remove(&removed);
        Ok(())
    }

    /// Moves the window to its minimum and to a time, in s; the poses that left it. Does nothing without a lag, and before the period has passed.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when the window cannot be solved.
    pub fn step(&mut self, seconds: f64) -> Result<Vec<SettledPose>, SlamSmootherError> {
        for frame in &mut self.window {
            frame.seconds.get_or_insert(seconds);
        }
        let Some(lag) = self.params.lag else { return Ok(Vec::new()) };
        let is_due = self.solved_at.is_none_or(|at| seconds >= at + self.params.period);
        if !is_due || self.graph.n_residuals() == 0 {
            return Ok(Vec::new());
        }
        self.solved_at = Some(seconds);
        self.graph.optimize(&ONLINE)?;
        let is_old = |frame: &&Frame| frame.seconds.is_some_and(|at| at < seconds - lag);
        let n_old = self.window.iter().take_while(is_old).count();
        let settled = self.settle(n_old.min(self.window.len() - 1), true)?;
        let dropped: Vec<usize> =
            self.window.drain(..settled.len()).map(|frame| frame.pose.index()).collect();
        if !dropped.is_empty() {
            self.marginalize(&dropped)?;
        }
        Ok(settled)
    }

    /// The poses that are left, at the minimum of all that is left.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when it cannot be solved.
    pub fn finish(&mut self) -> Result<Vec<SettledPose>, SlamSmootherError> {
        if self.graph.n_residuals() > 0 {
            self.graph.optimize(&Params::default())?;
        }
        self.settle(self.window.len(), self.params.lag.is_some())
    }

    /// Landmarks, by identity.
    pub fn landmarks(&self) -> BTreeMap<u32, Vector2<f64>> {
        let place = |(id, variable): (&u32, &VariableId<Vector2<f64>>)| {
            Some((*id, *self.graph.value(*variable).ok()?))
        };
        self.landmarks.iter().filter_map(place).collect()
    }

    /// Whether a landmark or anchor is in the map.
    pub fn contains(&self, landmark: u32) -> bool {
        self.landmarks.contains_key(&landmark)
    }

    /// Number of poses in the window, and of residuals.
    pub fn size(&self) -> (usize, usize) {
        (self.window.len(), self.graph.n_residuals())
    }

    /// Cost of the window, with what was marginalized.
    pub fn cost(&self) -> f64 {
        self.graph.cost()
    }

    fn marginalize(&mut self, variables: &[usize]) -> Result<(), SlamSmootherError> {
        self.graph.marginalize(variables)?;
        self.start.take_if(|start| start.names(variables));
        Ok(())
    }

    /// Adds each detection of a landmark as one of another.
    fn reassign_detections(
        &mut self,
        from: VariableId<Vector2<f64>>,
        to: VariableId<Vector2<f64>>,
    ) -> Result<(), SlamSmootherError> {
        let poses: BTreeMap<_, _> =
            self.window.iter().map(|frame| (frame.pose.index(), frame.pose)).collect();
        let of_landmark = |(seen, named, information): (&MountedRangeBearing, &[usize], &Matrix2<f64>)| {
            (named[1] == from.index()).then_some((*seen, *poses.get(&named[0])?, *information))
        };
        let detections: Vec<_> = self.graph.residuals().filter_map(of_landmark).collect();
        for (detection, pose, information) in detections {
            let added = self.graph.add(detection, (pose, to, self.scale), information)?;
            self.graph.set_kernel(added, ROBUST)?;
        }
        Ok(())
    }

    /// The oldest poses of the window as they are.
    fn settle(&mut self, n: usize, with_covariance: bool) -> Result<Vec<SettledPose>, SlamSmootherError> {
        let mut settled = Vec::with_capacity(n);
        for Frame { number, pose, .. } in self.window.iter().take(n) {
            let covariance = Matrix3::zeros();
            settled.push(SettledPose { number: *number, pose: *self.graph.value(*pose)?, covariance });
        }
        if with_covariance && n > 0 && self.graph.n_residuals() > 0 {
            let marginals = self.graph.marginals()?;
            for (settled, frame) in settled.iter_mut().zip(&self.window) {
                settled.covariance.copy_from(&marginals.covariance(frame.pose)?.fixed_view::<3, 3>(0, 0));
            }
        }
        Ok(settled)
    }

    pub(super) fn last(&self) -> Frame {
        self.window[self.window.len() - 1]
    }
}

/// Fixes a variable whose block of the covariance is zero, or lists its number.
fn hold_if_exact<X: Variable>(
    graph: &mut Graph,
    variable: VariableId<X>,
    start: &PointMapGaussian,
    block: Option<(usize, usize)>,
    uncertain: &mut Vec<usize>,
) -> Result<(), SlamSmootherError> {
    if block.is_some_and(|block| start.is_exact(block)) {
        graph.fix(variable)?;
    } else {
        uncertain.push(variable.index());
    }
    Ok(())
}

fn inverse<const N: usize>(
    covariance: &nalgebra::SMatrix<f64, N, N>,
    what: &'static str,
    index: usize,
) -> Result<nalgebra::SMatrix<f64, N, N>, SlamSmootherError> {
    let symmetric = (covariance + covariance.transpose()) * 0.5;
    let cholesky =
        nalgebra::Cholesky::new(symmetric).filter(|_| covariance.iter().all(|entry| entry.is_finite()));
    let (value, wanted) = (covariance.diagonal().min(), "positive definite");
    let error = SlamSmootherError::OutOfRange { what, index, value, wanted };
    let inverse = cholesky.ok_or(error)?.inverse();
    Ok((inverse + inverse.transpose()) * 0.5)
}
