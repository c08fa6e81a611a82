use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector, DefaultAllocator};
use wayfix_estimation_traits::TangentMatrix;

use super::{
    EkfSlam, PredictedMeasurement,
    predict::{LARGEST_VARIANCE, check_covariance},
};
use crate::{
    Association, DataAssociation, Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim,
    Observation, ObservationOutcome, OutlierRule, RobotDim, SlamAlloc, SlamError, UpdateReport,
    covariance::SparseJacobian,
};

/// An observation that passed the gate, with its terms of the correction.
struct Accepted<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Its index in the scan.
    index: usize,
    predicted: PredictedMeasurement<M>,
    innovation: Innovation<M::Measurement>,
    noise: TangentMatrix<M::Measurement>,
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map with all observations of one scan.
    ///
    /// Observations are associated at the predicted state and gated one by one, and those that pass correct jointly; then new landmarks
    /// start ([`UpdateOrder`](crate::UpdateOrder) can select sequential corrections). The report has one outcome per observation, in their
    /// order. An unusable one (not finite, a second one of the same landmark, outside the gate, an invalid noise covariance) does not affect
    /// the others.
    ///
    /// # Errors
    /// Returns an error if the association violates its law and does not return one association per usable observation; the filter is then unchanged.
    pub fn update(
        &mut self,
        observations: &[Observation<M::Measurement>],
        association: &mut impl DataAssociation<M>,
    ) -> Result<UpdateReport<M::Measurement>, SlamError> {
        let usable: Vec<usize> =
            (0..observations.len()).filter(|&i| self.model.is_usable(&observations[i].measurement)).collect();
        let candidates: Vec<_> = usable.iter().map(|&i| observations[i].clone()).collect();
        let associations = association.associate(self, &candidates);
        let (expected, got) = (candidates.len(), associations.len());
        if expected != got {
            return Err(SlamError::Dimension { what: "list of associations", expected, got });
        }
        let associated: Vec<_> = usable.into_iter().zip(associations).collect();

        self.n_updates += 1;
        let mut outcomes = vec![ObservationOutcome::Unusable; observations.len()];
        let mut taken = BTreeSet::new();
        for batch in associated.chunks(self.params.update_order.batch_size(associated.len())) {
            self.update_batch(observations, batch, &mut taken, &mut outcomes);
        }
        let merges = self.merge_duplicates();
        self.remove_undetected();
        self.anchor_first();
        self.retire_revised();
        self.covariance.end_update();
        Ok(UpdateReport { outcomes, merges })
    }

    /// Observations that are linearized at the same state: gate each, correct with all, start new landmarks.
    fn update_batch(
        &mut self,
        observations: &[Observation<M::Measurement>],
        batch: &[(usize, Association)],
        taken: &mut BTreeSet<LandmarkId>,
        outcomes: &mut [ObservationOutcome<M::Measurement>],
    ) {
        let (mut accepted, mut new) = (Vec::new(), Vec::new());
        for &(i, association) in batch {
            let measurement = &observations[i].measurement;
            outcomes[i] = match association {
                Association::Matched(id) | Association::New(id) if !taken.insert(id) => {
                    ObservationOutcome::Duplicate { landmark: id }
                }
                Association::Matched(id) => self.weigh(id, i, measurement, &mut accepted),
                Association::New(id) => ObservationOutcome::Initialized { landmark: id },
                Association::Ambiguous => ObservationOutcome::Ambiguous,
                Association::Unlabelled => ObservationOutcome::Unlabelled,
            };
            if let ObservationOutcome::Initialized { landmark } | ObservationOutcome::Restarted { landmark } =
                outcomes[i]
            {
                new.push((i, landmark));
            }
        }
        let corrected = self.correct(&accepted).is_some();
        for Accepted { index, predicted, .. } in &accepted {
            if corrected {
                self.count_detection(predicted.landmark);
                self.extend(predicted.landmark, &observations[*index].measurement);
            } else {
                outcomes[*index] = ObservationOutcome::Unusable;
            }
        }
        for (i, id) in new {
            if self.start(id, &observations[i].measurement).is_err() {
                outcomes[i] = ObservationOutcome::Unusable;
            }
        }
    }

    /// Individual compatibility: the NIS against the chi-squared quantile, or a noise that grows with it.
    fn weigh(
        &self,
        landmark: LandmarkId,
        index: usize,
        measurement: &M::Measurement,
        accepted: &mut Vec<Accepted<M>>,
    ) -> ObservationOutcome<M::Measurement> {
        let noise = self.model.noise(measurement);
        if check_covariance("measurement noise", &noise).is_err() {
            return ObservationOutcome::Unusable;
        }
        let predicted = self.predicted_measurement(landmark);
        let seen = predicted.and_then(|predicted| {
            let noise = self.model.noise_at_expected(&predicted.expected, measurement, &noise);
            Some((predicted.innovation(measurement, &noise)?, predicted, noise))
        });
        let Some((innovation, predicted, noise)) = seen else {
            return ObservationOutcome::Unusable;
        };
        let threshold = self.gates.threshold(innovation.residual.len());
        if self.exceeds_restart_nis(landmark, &innovation) {
            return ObservationOutcome::Restarted { landmark };
        }
        if innovation.nis > threshold && self.params.outlier_rule == OutlierRule::Reject {
            return ObservationOutcome::Rejected { landmark, innovation, threshold };
        }
        let noise_scale = self.params.noise_scale(innovation.nis, threshold);
        let noise = noise * noise_scale + &predicted.landmark_noise;
        if noise.amax() >= LARGEST_VARIANCE {
            return ObservationOutcome::Rejected { landmark, innovation, threshold }; // so far out that its weight would be zero
        }
        accepted.push(Accepted { index, predicted, innovation: innovation.clone(), noise });
        ObservationOutcome::Accepted { landmark, innovation, noise_scale }
    }

    /// All accepted observations at once: one joint linear correction of covariance and means. Returns `None` and changes nothing if their
    /// innovation covariance is not positive definite. [Andrade-Cetto 2005, Eqs. 6–9]
    fn correct(&mut self, accepted: &[Accepted<M>]) -> Option<()> {
        if accepted.is_empty() {
            return Some(());
        }
        let (jacobian, noise, residual) = stack(accepted);
        let step = self.covariance.correct(&jacobian, &noise, &residual)?;
        self.step(&step);
        Some(())
    }
}

/// The rows of all observations below each other.
fn stack<M: LandmarkModel>(accepted: &[Accepted<M>]) -> (SparseJacobian, DMatrix<f64>, DVector<f64>)
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    let n_rows = accepted.iter().map(|accepted| accepted.innovation.residual.len()).sum();
    let mut jacobian = SparseJacobian::default();
    let (mut noise, mut residual) = (DMatrix::zeros(n_rows, n_rows), DVector::zeros(n_rows));
    for Accepted { predicted, innovation, noise: own_noise, .. } in accepted {
        let start = jacobian.nrows();
        let size = innovation.residual.len();
        for row in 0..size {
            let robot = predicted.robot_jacobian.row(row);
            match &predicted.landmark_jacobian {
                Some((offset, landmark)) => {
                    jacobian.push_row(robot.iter().copied(), *offset, landmark.row(row).iter().copied());
                }
                None => jacobian.push_row(robot.iter().copied(), 0, []),
            }
        }
        noise.view_mut((start, start), (size, size)).copy_from(own_noise);
        residual.rows_mut(start, size).copy_from(&innovation.residual);
    }
    (jacobian, noise, residual)
}
