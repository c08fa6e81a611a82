use std::collections::{BTreeMap, BTreeSet, VecDeque};

use nalgebra::{Matrix3, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::{Between, Graph, Params, Variable, VariableId};

use super::{PointMapGaussian, PointSmootherParams, SettledPose, gaussian::StartPrior};
use crate::SlamSmootherError;

/// Graph SLAM with points: a window of poses and the whole map.
///
/// Poses that leave the window are marginalized; what they knew of the map stays. Detections come with the landmarks that another estimator pairs
/// them with. While a detection is in the window, a wrong pairing weighs little (Cauchy), and it can be taken back
/// ([`PointSmootherParams::pairs_anew`]), as a landmark can.
pub struct PointSmoother {
    pub(super) params: PointSmootherParams,
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
    n_paired_anew: usize,
}

#[derive(Clone, Copy)]
pub(super) struct Frame {
    number: usize,
    /// Time of the first step after it, s.
    pub(super) seconds: Option<f64>,
    pub(super) pose: VariableId<Pose2<f64>>,
}

/// What a motion is uncertain by at least, m and rad: motion models with fewer directions than three are singular.
pub(super) const LEAST_MOTION_SIGMA: [f64; 3] = [1e-4, 1e-4, 1e-5];
/// Online, a step follows a problem that was at its minimum: few iterations are left.
pub(super) const ONLINE: Params = Params {
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
            n_paired_anew: 0,
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
        self.solve(&ONLINE)?;
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
            self.solve(&Params::default())?;
        }
        self.settle(self.window.len(), self.params.lag.is_some())
    }

    /// Number of detections that were given another landmark since the start.
    pub fn n_paired_anew(&self) -> usize {
        self.n_paired_anew
    }

    /// Number of poses in the window, and of residuals.
    pub fn size(&self) -> (usize, usize) {
        (self.window.len(), self.graph.n_residuals())
    }

    /// Cost of the window, with what was marginalized.
    pub fn cost(&self) -> f64 {
        self.graph.cost()
    }

    /// Moves the window to its minimum, and to that with better pairings.
    fn solve(&mut self, params: &Params) -> Result<(), SlamSmootherError> {
        self.graph.optimize(params)?;
        if self.params.lag.is_some() && self.params.pairs_anew {
            let n_changed = self.pair_anew()?;
            self.n_paired_anew += n_changed;
            if n_changed > 0 {
                self.graph.optimize(params)?;
            }
        }
        Ok(())
    }

    pub(super) fn marginalize(&mut self, variables: &[usize]) -> Result<(), SlamSmootherError> {
        self.graph.marginalize(variables)?;
        self.start.take_if(|start| start.names(variables));
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

pub(super) fn inverse<const N: usize>(
    covariance: &nalgebra::SMatrix<f64, N, N>,
    what: &'static str,
    index: usize,
) -> Result<nalgebra::SMatrix<f64, N, N>, SlamSmootherError> {
    let symmetric = covariance.symmetric_part();
    let cholesky =
        nalgebra::Cholesky::new(symmetric).filter(|_| covariance.iter().all(|entry| entry.is_finite()));
    let (value, wanted) = (covariance.diagonal().min(), "positive definite");
    let error = SlamSmootherError::OutOfRange { what, index, value, wanted };
    let inverse = cholesky.ok_or(error)?.inverse();
    Ok(inverse.symmetric_part())
}
