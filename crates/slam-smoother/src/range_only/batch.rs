use std::collections::BTreeMap;

use nalgebra::{DMatrix, Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_smoother::{Between, Graph, Params, ResidualId, Summary, VariableId};

use super::{
    BeaconRange, Calibration, CalibrationPrior, RangeOnlyInput, RangeOnlyNoise, residuals::VectorPrior,
};
use crate::{ROBUST_KERNEL, SlamSmootherError};

/// Relative decrease of the cost that ends an optimization for the likelihood: some thousand measurements cost about as much each as one.
const LIKELIHOOD_DECREASE: f64 = 1e-5;

/// Path, beacons and calibration, as far as they are known.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub(super) poses: Vec<Pose2<f64>>,
    pub(super) beacons: BTreeMap<u32, Vector2<f64>>,
    pub(super) calibration: Vector2<f64>,
}

/// Place of a beacon with its covariance.
type PlacedBeacon = (Vector2<f64>, Matrix2<f64>);

/// The least squares problem of the first poses of a run.
pub(super) struct RangeGraph {
    graph: Graph,
    noise: RangeOnlyNoise,
    poses: Vec<VariableId<Pose2<f64>>>,
    beacons: BTreeMap<u32, VariableId<Vector2<f64>>>,
    calibration: VariableId<Vector2<f64>>,
    motions: Vec<(ResidualId, Pose2<f64>)>,
    ranges: Vec<ResidualId>,
}

impl RangeGraph {
    /// Ranges to beacons without a place are left out.
    pub(super) fn new(
        input: &RangeOnlyInput,
        start: &Solution,
        prior: &CalibrationPrior,
        noise: RangeOnlyNoise,
    ) -> Result<Self, SlamSmootherError> {
        let mut graph = Graph::new();
        let poses: Vec<_> = start.poses.iter().map(|pose| graph.add_variable(*pose)).collect();
        graph.fix(poses[0])?;
        let beacons: BTreeMap<_, _> =
            start.beacons.iter().map(|(id, beacon)| (*id, graph.add_variable(*beacon))).collect();
        let calibration = graph.add_variable(start.calibration);
        graph.add(VectorPrior(Vector2::zeros()), (calibration,), prior.information())?;
        let (mut motions, mut ranges) = (Vec::new(), Vec::new());
        for (pair, motion) in poses.windows(2).zip(&input.motions) {
            let information = noise.motion_information(motion);
            motions.push((graph.add(Between::new(*motion), (pair[0], pair[1]), information)?, *motion));
        }
        for measured in &input.ranges {
            let (Some(pose), Some(beacon)) = (poses.get(measured.pose), beacons.get(&measured.beacon)) else {
                continue;
            };
            let residual = BeaconRange { range: measured.range };
            let id = graph.add(residual, (*pose, *beacon, calibration), noise.range_information())?;
            graph.set_kernel(id, ROBUST_KERNEL)?;
            ranges.push(id);
        }
        Ok(Self { graph, noise, poses, beacons, calibration, motions, ranges })
    }

    pub(super) fn noise(&self) -> &RangeOnlyNoise {
        &self.noise
    }

    pub(super) fn n_ranges(&self) -> usize {
        self.ranges.len()
    }

    pub(super) fn set_noise(&mut self, noise: RangeOnlyNoise) -> Result<(), SlamSmootherError> {
        self.noise = noise;
        for (id, motion) in &self.motions {
            self.graph.set_information::<Between<Pose2<f64>>>(*id, noise.motion_information(motion))?;
        }
        for id in &self.ranges {
            self.graph.set_information::<BeaconRange>(*id, noise.range_information())?;
        }
        Ok(())
    }

    pub(super) fn optimize(&mut self) -> Result<Summary, SlamSmootherError> {
        Ok(self.graph.optimize(&Params::default())?)
    }

    /// At the minimum with the present noise, up to a constant.
    pub(super) fn negative_log_likelihood(&mut self) -> Result<f64, SlamSmootherError> {
        let params = Params { relative_decrease: LIKELIHOOD_DECREASE, ..Params::default() };
        let cost = self.graph.optimize(&params)?.cost;
        let log_determinant = self.graph.marginals()?.log_determinant();
        let of_motion =
            4.0 * self.noise.translation_per_sqrt_meter.ln() + 2.0 * self.noise.heading_per_sqrt_meter.ln();
        let of_ranges = 2.0 * self.noise.range.ln();
        Ok(cost
            + log_determinant
            + of_motion * self.motions.len() as f64
            + of_ranges * self.ranges.len() as f64)
    }

    pub(super) fn solution(&self) -> Result<Solution, SlamSmootherError> {
        let value = |(id, beacon): (&u32, &VariableId<Vector2<f64>>)| Ok((*id, *self.graph.value(*beacon)?));
        Ok(Solution {
            poses: self
                .poses
                .iter()
                .map(|pose| self.graph.value(*pose).copied())
                .collect::<Result<_, _>>()?,
            beacons: self.beacons.iter().map(value).collect::<Result<_, SlamSmootherError>>()?,
            calibration: *self.graph.value(self.calibration)?,
        })
    }

    /// Covariance of bias and logarithm of the scale.
    pub(super) fn calibration_covariance(&mut self) -> Result<Matrix2<f64>, SlamSmootherError> {
        let calibration = self.calibration;
        Ok(fixed(&self.graph.marginals()?.covariance(calibration)?))
    }

    /// Covariances of poses in their body frames.
    pub(super) fn pose_covariances(
        &mut self,
        numbers: &[usize],
    ) -> Result<Vec<(usize, Matrix3<f64>)>, SlamSmootherError> {
        let marginals = self.graph.marginals()?;
        let of = |number: &usize| Ok((*number, fixed(&marginals.covariance(self.poses[*number])?)));
        numbers.iter().map(of).collect()
    }

    /// Places of all beacons, with covariances.
    pub(super) fn placed_beacons(&mut self) -> Result<BTreeMap<u32, PlacedBeacon>, SlamSmootherError> {
        let mut beacons = BTreeMap::new();
        for (id, beacon) in &self.beacons {
            let place = *self.graph.value(*beacon)?;
            beacons.insert(*id, (place, fixed(&self.graph.marginals()?.covariance(*beacon)?)));
        }
        Ok(beacons)
    }

    /// Residuals of the ranges, m, without kernels.
    pub(super) fn range_residuals(&self) -> Result<Vec<f64>, SlamSmootherError> {
        let norms = self.graph.squared_norms();
        Ok(self.ranges.iter().map(|id| norms[id.index()].sqrt() * self.noise.range).collect())
    }

    /// Calibration of the present values.
    pub(super) fn calibration(&self) -> Result<Calibration, SlamSmootherError> {
        Ok((*self.graph.value(self.calibration)?).into())
    }
}

fn fixed<const N: usize>(matrix: &DMatrix<f64>) -> nalgebra::SMatrix<f64, N, N> {
    matrix.fixed_view::<N, N>(0, 0).into_owned()
}
